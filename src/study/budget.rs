//! How long each part of a study may take. Shares out what is left of the time by weights, so that what one part does
//! not use falls to those after it; decides how many paths come next and tells how far the study is. The clock decides
//! how far curves go, and nothing else.

use super::{Effort, StudyProgress};
use crate::bake::REPLICATES;
use std::time::{Duration, Instant};

/// Share of the time that is given away: the files have to be written as well.
const SPENT: f64 = 0.97;

/// Most paths from a texel, whatever the time.
const MOST_PATHS: u32 = 1 << 26;

/// Time between two reports [s].
const REPORT: f64 = 1.0;

/// What is left of the time.
pub(super) struct Budget<'a> {
    began: Instant,
    effort: Effort,
    /// All weights, and those of parts that have not begun.
    weights: f64,
    left: f64,
    progress: &'a dyn Fn(&StudyProgress),
}

/// A part of a study.
pub(super) struct Part<'b> {
    what: String,
    began: Instant,
    /// Time that it may take; `None` where paths are what is limited.
    limit: Option<Duration>,
    /// Most paths.
    most: u32,
    /// Share of the whole study before it, and of the part itself.
    share: [f64; 2],
    budget: &'b Budget<'b>,
}

impl<'a> Budget<'a> {
    pub(super) fn new(effort: Effort, weights: f64, began: Instant, progress: &'a dyn Fn(&StudyProgress)) -> Self {
        Self { began, effort, weights, left: weights, progress }
    }

    /// Time that has passed.
    pub(super) fn elapsed(&self) -> Duration {
        self.began.elapsed()
    }

    /// Begins a part of this weight, with up to `paths` times the paths that were asked for, where paths were.
    pub(super) fn part(&mut self, what: impl Into<String>, weight: f64, paths: f64) -> Part<'_> {
        let share = weight / self.left.max(weight);
        let before = 1.0 - self.left / self.weights;
        self.left = (self.left - weight).max(0.0);
        let (limit, most) = match self.effort {
            Effort::Time(time) => {
                let rest = (SPENT * time.as_secs_f64() - self.elapsed().as_secs_f64()).max(0.0);
                (Some(Duration::from_secs_f64(share * rest)), MOST_PATHS)
            }
            Effort::Paths(count) => (None, (f64::from(count) * paths) as u32),
        };
        let share = [before, weight / self.weights];
        Part { what: what.into(), began: Instant::now(), limit, most, share, budget: self }
    }
}

impl Part<'_> {
    /// The same with no more paths than these.
    pub(super) fn at_most(mut self, paths: u32) -> Self {
        self.most = self.most.min(paths);
        self
    }

    /// Most paths.
    pub(super) fn most(&self) -> u32 {
        self.most.max(REPLICATES)
    }

    /// Whether so many seconds more can be spent.
    pub(super) fn has_room(&self, seconds: f64) -> bool {
        self.limit.is_none_or(|limit| self.began.elapsed().as_secs_f64() + seconds <= limit.as_secs_f64())
    }

    /// Whether to finish what was begun in good faith: not where it takes far longer than was foreseen, as on a machine
    /// that is busy with other things.
    pub(super) fn goes_on(&self) -> bool {
        self.limit.is_none_or(|limit| self.began.elapsed() <= limit + limit / 4)
    }

    /// Time that is left; `None` where only paths are limited [s].
    pub(super) fn left(&self) -> Option<f64> {
        self.limit.map(|limit| (limit.as_secs_f64() - self.began.elapsed().as_secs_f64()).max(0.0))
    }

    /// Tells how far the study is: `done` of this part.
    pub(super) fn report(&self, done: f64) {
        let elapsed = self.budget.elapsed().as_secs_f64();
        let (done, seconds_left) = match self.budget.effort {
            Effort::Time(time) => {
                let left = (time.as_secs_f64() - elapsed).max(0.0);
                (elapsed / time.as_secs_f64().max(1e-9), Some(left))
            }
            Effort::Paths(_) => (self.share[0] + self.share[1] * done.clamp(0.0, 1.0), None),
        };
        (self.budget.progress)(&StudyProgress { what: self.what.clone(), done: done.min(1.0), seconds_left });
    }

    /// Doubles paths as long as there is room, and calls `trace` to carry on to a number of them, in steps that are
    /// short enough to tell about. `reached` hears of every doubling.
    pub(super) fn double<E>(
        &self,
        mut trace: impl FnMut(u32) -> Result<(), E>,
        mut reached: impl FnMut(u32),
    ) -> Result<(), E> {
        let clock = Instant::now();
        let mut count = REPLICATES;
        self.report(0.0);
        trace(count)?;
        reached(count);
        while let Some(next) = count.checked_mul(2).filter(|&next| next <= self.most()) {
            // As many as all before.
            let so_far = clock.elapsed().as_secs_f64();
            if !self.has_room(so_far) {
                break;
            }
            let per_path = so_far / f64::from(count);
            let step = ((REPORT / per_path.max(1e-9)) as u32 / REPLICATES * REPLICATES).max(REPLICATES);
            while count < next {
                if !self.goes_on() {
                    return Ok(());
                }
                count = (count + step).min(next);
                trace(count)?;
                self.report(f64::from(count) / f64::from(self.most()));
            }
            reached(count);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_double_up_to_what_was_asked() {
        let mut budget = Budget::new(Effort::Paths(100), 2.0, Instant::now(), &|_| ());
        let (mut traced, mut reached) = (Vec::new(), Vec::new());
        let part = budget.part("curve", 1.0, 1.0);
        part.double(
            |count| {
                traced.push(count);
                Ok::<(), ()>(())
            },
            |count| reached.push(count),
        )
        .unwrap();
        assert_eq!(reached, [16, 32, 64]);
        assert!(traced.is_sorted() && traced.last() == Some(&64));
        assert_eq!(budget.part("reference", 1.0, 8.0).most(), 800);
    }

    #[test]
    fn without_time_there_are_the_first_paths_only() {
        let mut budget = Budget::new(Effort::Time(Duration::ZERO), 2.0, Instant::now(), &|_| ());
        let mut reached = Vec::new();
        budget.part("curve", 1.0, 1.0).double(|_| Ok::<(), ()>(()), |count| reached.push(count)).unwrap();
        assert_eq!(reached, [16]);
    }
}
