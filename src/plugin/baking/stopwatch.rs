//! Time that a job has worked, without the time for which it was paused. For display only: no result depends on it.

use std::time::{Duration, Instant};

/// Runs from its making on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stopwatch {
    before: Duration,
    running_since: Option<Instant>,
}

impl Stopwatch {
    pub(super) fn started(now: Instant) -> Self {
        Self { before: Duration::ZERO, running_since: Some(now) }
    }

    /// Holds it, or lets it run on.
    pub(super) fn hold(&mut self, is_held: bool, now: Instant) {
        if is_held {
            self.before = self.elapsed(now);
            self.running_since = None;
        } else {
            self.running_since.get_or_insert(now);
        }
    }

    pub(super) fn elapsed(&self, now: Instant) -> Duration {
        self.before + self.running_since.map_or(Duration::ZERO, |since| now.saturating_duration_since(since))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pause_does_not_count() {
        let start = Instant::now();
        let at = |seconds| start + Duration::from_secs(seconds);
        let mut watch = Stopwatch::started(start);
        watch.hold(false, at(1));
        assert_eq!(watch.elapsed(at(2)).as_secs(), 2);
        watch.hold(true, at(3));
        watch.hold(true, at(5));
        assert_eq!(watch.elapsed(at(9)).as_secs(), 3);
        watch.hold(false, at(10));
        assert_eq!(watch.elapsed(at(14)).as_secs(), 7);
    }
}
