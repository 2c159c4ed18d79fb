//! What the kiln is at, for whoever shows it: a panel, a status line, another process. Read only; the kiln writes it
//! once per frame.

use super::stopwatch::Stopwatch;
use super::warning::KilnWarning;
use crate::bake::{BakePlan, Progress, Stage};
use bevy::prelude::*;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

/// Endings that are remembered.
const REMEMBERED: usize = 32;
/// Share of the tracing from which on the time left is told; before that it would jump about.
const ENOUGH_TO_TELL: f64 = 0.01;

/// Which job of this run of the app. Jobs are bakes and plans, counted from 1 in the order in which they were asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub struct BakeId(pub u64);

impl std::fmt::Display for BakeId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

/// What is done with the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KilnWork {
    /// Finding out what a bake would do and cost.
    Plan,
    /// Making lightmaps.
    Bake,
}

/// The job that is under way.
#[derive(Clone, Debug)]
pub struct RunningJob {
    /// Which.
    pub id: BakeId,
    /// What it does.
    pub work: KilnWork,
    /// Whether its snapshot is yet to be taken, at the end of the frame.
    pub is_waiting: bool,
    /// Whether it was asked to wait.
    pub is_paused: bool,
    /// What it is doing.
    pub stage: Stage,
    /// Share of the stage that is done, in [0, 1].
    pub fraction: f64,
    /// Mean relative standard error of the texels that are done, once known. They come in an order of place and not of
    /// error, so this is also what is to be expected of the whole.
    pub relative_stderr: Option<f64>,
    /// Time that it has worked, pauses not counted [s].
    pub seconds: f64,
    /// Time that tracing will take yet if it goes on as it went so far [s]; known only while it traces.
    pub seconds_left: Option<f64>,
    watch: Stopwatch,
    /// When tracing began, by the watch [s].
    gather_began: Option<f64>,
}

/// How a job ended.
#[derive(Clone, Debug)]
pub enum KilnEnding {
    /// The lightmaps are on their entities.
    Baked {
        /// Covered texels.
        texels: u64,
        /// Of these, those that were kept from the bake before.
        kept: u64,
        /// Paths that started from them.
        samples: u64,
        /// Time that passed [s].
        seconds: f64,
        /// Entities that got a lightmap.
        entities: usize,
    },
    /// The plan is made.
    Planned(Arc<BakePlan>),
    /// Nothing came of it.
    Failed {
        /// Why, as a sentence that says what to do.
        reason: String,
        /// Whether a person stopped it.
        cancelled: bool,
    },
}

/// A job that is over.
#[derive(Clone, Debug)]
pub struct KilnOutcome {
    /// Which.
    pub id: BakeId,
    /// How it ended.
    pub ending: KilnEnding,
    /// What was left out or changed.
    pub warnings: Vec<KilnWarning>,
}

/// What the kiln is at, and how the last jobs ended.
#[derive(Resource, Clone, Debug, Default)]
pub struct BakeStatus {
    running: Option<RunningJob>,
    outcomes: VecDeque<KilnOutcome>,
    count: u64,
}

impl BakeStatus {
    /// The job that is under way; `None` is a kiln that takes the next.
    pub fn running(&self) -> Option<&RunningJob> {
        self.running.as_ref()
    }

    /// The last jobs that are over, latest first; the last 32 are remembered.
    pub fn outcomes(&self) -> impl Iterator<Item = &KilnOutcome> {
        self.outcomes.iter()
    }

    /// How a job ended, if it is over and remembered.
    pub fn outcome(&self, id: BakeId) -> Option<&KilnOutcome> {
        self.outcomes().find(|outcome| outcome.id == id)
    }

    /// The latest plan.
    pub fn plan(&self) -> Option<&Arc<BakePlan>> {
        self.outcomes().find_map(|outcome| match &outcome.ending {
            KilnEnding::Planned(plan) => Some(plan),
            _ => None,
        })
    }

    /// The number of another job.
    pub(super) fn next_id(&mut self) -> BakeId {
        self.count += 1;
        BakeId(self.count)
    }

    pub(super) fn waiting(&mut self, id: BakeId, work: KilnWork) {
        self.running = Some(RunningJob {
            id,
            work,
            is_waiting: true,
            is_paused: false,
            stage: Stage::Prepare,
            fraction: 0.0,
            relative_stderr: None,
            seconds: 0.0,
            seconds_left: None,
            watch: Stopwatch::started(Instant::now()),
            gather_began: None,
        });
    }

    pub(super) fn started(&mut self) {
        if let Some(running) = &mut self.running {
            running.is_waiting = false;
        }
    }

    pub(super) fn held(&mut self, is_held: bool) {
        if let Some(running) = &mut self.running {
            running.is_paused = is_held;
            running.watch.hold(is_held, Instant::now());
        }
    }

    /// Takes what the job has said since the last look.
    pub(super) fn heard(&mut self, news: Option<Progress>) {
        let Some(running) = &mut self.running else { return };
        running.seconds = running.watch.elapsed(Instant::now()).as_secs_f64();
        let Some(news) = news else { return };
        if news.stage != running.stage {
            running.gather_began = None;
        }
        running.stage = news.stage;
        running.fraction = if news.total == 0 { 0.0 } else { news.done as f64 / news.total as f64 };
        running.relative_stderr = news.relative_stderr.or(running.relative_stderr);
        running.seconds_left = None;
        if matches!(news.stage, Stage::Gather | Stage::Probes) {
            let traced = running.seconds - *running.gather_began.get_or_insert(running.seconds);
            if running.fraction >= ENOUGH_TO_TELL {
                running.seconds_left = Some(traced * (1.0 - running.fraction) / running.fraction);
            }
        }
    }

    pub(super) fn ended(&mut self, outcome: KilnOutcome) {
        self.running.take_if(|running| running.id == outcome.id);
        self.outcomes.push_front(outcome);
        self.outcomes.truncate(REMEMBERED);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_job_waits_works_and_is_remembered_among_the_last() {
        let mut status = BakeStatus::default();
        for number in 1..=40 {
            let id = status.next_id();
            assert_eq!(id, BakeId(number));
            status.waiting(id, KilnWork::Bake);
            assert!(status.running().is_some_and(|running| running.is_waiting && running.id == id));
            status.started();
            let news = |done| Progress { stage: Stage::Gather, done, total: 4, relative_stderr: Some(0.5) };
            status.heard(Some(news(0)));
            assert_eq!(status.running().unwrap().seconds_left, None, "too early to tell");
            status.heard(Some(news(1)));
            let running = status.running().unwrap();
            assert!(!running.is_waiting && running.fraction == 0.25 && running.seconds_left.is_some());
            let ending = KilnEnding::Failed { reason: "x".to_owned(), cancelled: false };
            // The end of another one leaves this one running.
            status.ended(KilnOutcome { id: BakeId(1000), ending: ending.clone(), warnings: Vec::new() });
            assert!(status.running().is_some());
            status.ended(KilnOutcome { id, ending, warnings: Vec::new() });
            assert!(status.running().is_none() && status.outcome(id).is_some());
        }
        assert_eq!(status.outcomes().count(), REMEMBERED);
        assert!(status.outcome(BakeId(1)).is_none() && status.plan().is_none());
    }
}
