//! Threads that work through a list, tell how far they are, and stop when asked to.

use super::{BakeError, CancelToken, LiveSink, Progress, ProgressSink, Stage};
use cpu_time::ThreadTime;
use rayon::prelude::*;
use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Duration;

/// The most items that one thread takes at a time: few enough to share out evenly, many enough to keep neighbours
/// together.
const LARGEST_CHUNK: usize = 32;

/// How many times a thread should come back for more, so that all end at about the same time.
const TURNS: usize = 8;

/// What was made of a group, and the group's number.
type OfGroup<T> = (usize, Vec<T>);

/// Threads, and whom they answer to.
pub(super) struct Workers<'a> {
    pool: rayon::ThreadPool,
    progress: &'a dyn ProgressSink,
    cancel: &'a CancelToken,
}

/// What the workers made, in the order of the items.
pub(super) struct Work<T> {
    pub(super) results: Vec<T>,
    /// Processor time of all threads.
    pub(super) cpu: Duration,
}

#[derive(Default)]
struct Tally {
    done: u64,
    cpu: Duration,
    error_sum: f64,
    error_count: u64,
}

impl<'a> Workers<'a> {
    pub(super) fn new(
        threads: Option<NonZeroUsize>,
        progress: &'a dyn ProgressSink,
        cancel: &'a CancelToken,
    ) -> Result<Self, BakeError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.map_or(0, NonZeroUsize::get))
            .thread_name(|index| format!("kiln {index}"))
            .build()
            .map_err(|error| BakeError::Threads { reason: error.to_string() })?;
        Ok(Self { pool, progress, cancel })
    }

    /// Who watches the texels as they come.
    pub(super) fn live(&self) -> Option<&'a dyn LiveSink> {
        self.progress.live()
    }

    /// Tells about a stage that is not worked through by items.
    pub(super) fn announce(&self, stage: Stage) -> Result<(), BakeError> {
        self.progress.report(Progress { stage, done: 0, total: 1, relative_stderr: None });
        if self.cancel.is_cancelled() { Err(BakeError::Cancelled) } else { Ok(()) }
    }

    /// Does `work` on every item. `error` reads a result's relative standard error, where it has one.
    pub(super) fn gather<I: Sync, T: Send>(
        &self,
        items: &[I],
        work: impl Fn(&I, &CancelToken) -> Option<T> + Sync,
        error: impl Fn(&T) -> Option<f64> + Sync,
    ) -> Result<Work<T>, BakeError> {
        let chunk = (items.len() / (TURNS * self.pool.current_num_threads())).clamp(1, LARGEST_CHUNK);
        let chunks: Vec<&[I]> = items.chunks(chunk).collect();
        let of_chunk = |chunk: &&[I], cancel: &CancelToken| chunk.iter().map(|item| work(item, cancel)).collect();
        self.gather_groups(&chunks, items.len(), of_chunk, error)
    }

    /// The same for groups of items, of which there are `total`: `work` makes one result for each item of a group. Groups
    /// are begun in their order.
    pub(super) fn gather_groups<G: Sync, T: Send>(
        &self,
        groups: &[G],
        total: usize,
        work: impl Fn(&G, &CancelToken) -> Option<Vec<T>> + Sync,
        error: impl Fn(&T) -> Option<f64> + Sync,
    ) -> Result<Work<T>, BakeError> {
        let tally = Mutex::new(Tally::default());
        let of_group = |group: &G| -> Option<Vec<T>> {
            self.cancel.wait_while_paused();
            let clock = ThreadTime::now();
            let results = work(group, self.cancel)?;
            self.tell(&tally, total, &results, clock.elapsed(), &error);
            Some(results)
        };
        let next = AtomicUsize::new(0);
        let of_thread = |_: rayon::BroadcastContext<'_>| -> Option<Vec<OfGroup<T>>> {
            let mut own = Vec::new();
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let Some(group) = groups.get(number) else { return Some(own) };
                own.push((number, of_group(group)?));
            }
        };
        let of_threads: Option<Vec<Vec<OfGroup<T>>>> = self.pool.broadcast(of_thread).into_iter().collect();
        let mut of_groups: Vec<OfGroup<T>> = of_threads.ok_or(BakeError::Cancelled)?.into_iter().flatten().collect();
        of_groups.sort_unstable_by_key(|&(number, _)| number);
        let results = of_groups.into_iter().flat_map(|(_, results)| results).collect();
        let cpu = tally.lock().map_or(Duration::ZERO, |tally| tally.cpu);
        Ok(Work { results, cpu })
    }

    /// Does `work` on every item without a word.
    pub(super) fn gather_quietly<I: Sync, T: Send>(
        &self,
        items: &[I],
        work: impl Fn(&I, &CancelToken) -> Option<T> + Sync,
    ) -> Result<Vec<T>, BakeError> {
        let of_item = |item: &I| {
            self.cancel.wait_while_paused();
            work(item, self.cancel)
        };
        let results: Option<Vec<T>> = self.pool.install(|| items.par_iter().map(of_item).collect());
        results.ok_or(BakeError::Cancelled)
    }

    /// The same as a part of what comes before the bake proper, with word of how far it is.
    pub(super) fn prepare<I: Sync, T: Send>(
        &self,
        items: &[I],
        work: impl Fn(&I, &CancelToken) -> Option<T> + Sync,
    ) -> Result<Vec<T>, BakeError> {
        let done = AtomicU64::new(0);
        let total = items.len() as u64;
        self.gather_quietly(items, |item, cancel| {
            let result = work(item, cancel)?;
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            if done.is_multiple_of(LARGEST_CHUNK as u64) {
                self.progress.report(Progress { stage: Stage::Prepare, done, total, relative_stderr: None });
            }
            Some(result)
        })
    }

    fn tell<T>(
        &self,
        tally: &Mutex<Tally>,
        total: usize,
        results: &[T],
        cpu: Duration,
        error: impl Fn(&T) -> Option<f64>,
    ) {
        // A poisoned lock means that another thread panicked; its panic is what matters.
        let Ok(mut tally) = tally.lock() else {
            return;
        };
        tally.done += results.len() as u64;
        tally.cpu += cpu;
        for error in results.iter().filter_map(error) {
            tally.error_sum += error;
            tally.error_count += 1;
        }
        let relative_stderr = (tally.error_count > 0).then(|| tally.error_sum / tally.error_count as f64);
        self.progress.report(Progress { stage: Stage::Gather, done: tally.done, total: total as u64, relative_stderr });
    }
}
