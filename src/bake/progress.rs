//! What a bake says while it works, and how it is stopped.

use super::LiveSink;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// What a bake is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Compiling the scene for rays, laying out texels and, in the fast mode, its first pass.
    Prepare,
    /// Tracing. The long one.
    Gather,
    /// Filling the texels beside the charts.
    Repair,
    /// Tracing for the probes of irradiance volumes.
    Probes,
}

/// How far a bake is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What it is doing.
    pub stage: Stage,
    /// Finished parts of the stage: texels, points or pixels.
    pub done: u64,
    /// All parts of the stage.
    pub total: u64,
    /// Mean relative standard error of what is done, once known.
    pub relative_stderr: Option<f64>,
}

/// Hears how far a bake is, from any of its threads.
pub trait ProgressSink: Sync {
    /// Takes one report. Called often: be quick.
    fn report(&self, progress: Progress);

    /// Who watches the texels of a lightmap as they come.
    fn live(&self) -> Option<&dyn LiveSink> {
        None
    }
}

/// Hears nothing.
impl ProgressSink for () {
    fn report(&self, _: Progress) {}
}

impl<F: Fn(Progress) + Sync> ProgressSink for F {
    fn report(&self, progress: Progress) {
        self(progress);
    }
}

/// A switch that stops a bake, or holds it for a while. Clones share it.
#[derive(Clone, Debug, Default)]
pub struct CancelToken(Arc<Switch>);

#[derive(Debug, Default)]
struct Switch {
    is_cancelled: AtomicBool,
    /// Changed under `waiting` alone; to be looked at often.
    is_paused: AtomicBool,
    waiting: Mutex<()>,
    is_over: Condvar,
}

impl CancelToken {
    /// Asks the bake to stop. It does so within a few paths, also while it is paused.
    pub fn cancel(&self) {
        // Under the lock, or a thread that is about to wait would not hear of it.
        let _waiting = self.lock();
        self.0.is_cancelled.store(true, Ordering::Relaxed);
        self.0.is_over.notify_all();
    }

    /// Whether the bake was asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.0.is_cancelled.load(Ordering::Relaxed)
    }

    /// Asks the bake to wait: its threads end what they are at, which takes a tile's time, and then use no processor
    /// until [`Self::resume`]. What comes out is the same to the bit; time that is asked for by
    /// [`Goal::Time`](super::Goal::Time) goes on.
    pub fn pause(&self) {
        let _waiting = self.lock();
        self.0.is_paused.store(true, Ordering::Relaxed);
    }

    /// Lets it go on.
    pub fn resume(&self) {
        let _waiting = self.lock();
        self.0.is_paused.store(false, Ordering::Relaxed);
        self.0.is_over.notify_all();
    }

    /// Whether the bake was asked to wait.
    pub fn is_paused(&self) -> bool {
        self.0.is_paused.load(Ordering::Relaxed)
    }

    /// Waits while it is paused and not cancelled.
    pub(super) fn wait_while_paused(&self) {
        let is_to_wait = |(): &mut ()| self.is_paused() && !self.is_cancelled();
        if is_to_wait(&mut ()) {
            drop(self.0.is_over.wait_while(self.lock(), is_to_wait).unwrap_or_else(PoisonError::into_inner));
        }
    }

    fn lock(&self) -> MutexGuard<'_, ()> {
        self.0.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::{RecvTimeoutError, channel};
    use std::time::Duration;

    #[test]
    fn who_waits_is_woken_by_either() {
        for wake in [CancelToken::resume, CancelToken::cancel] {
            let token = CancelToken::default();
            token.wait_while_paused();
            token.pause();
            assert!(token.is_paused());
            let (theirs, (sender, receiver)) = (token.clone(), channel());
            let waiting = std::thread::spawn(move || {
                theirs.wait_while_paused();
                sender.send(())
            });
            // However long this takes, nothing can come.
            assert_eq!(receiver.recv_timeout(Duration::from_millis(20)), Err(RecvTimeoutError::Timeout));
            wake(&token);
            assert!(waiting.join().unwrap().is_ok());
        }
    }
}
