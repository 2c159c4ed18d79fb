//! What a bake says while it works, and how it is stopped.

use super::LiveSink;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What a bake is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Compiling the scene for rays, laying out texels and, in the fast mode, its first pass.
    Prepare,
    /// Tracing. The long one.
    Gather,
    /// Filling the texels beside the charts.
    Repair,
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

/// A switch that stops a bake. Clones share it.
#[derive(Clone, Debug, Default)]
pub struct CancelToken(Arc<AtomicBool>);

impl CancelToken {
    /// Asks the bake to stop. It does so within a few paths.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the bake was asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
