//! The independently scrambled runs of one estimate, which may be carried on: what was traced is never traced again.

use super::{Estimate, REPLICATES, Start};
use crate::bake::CancelToken;
use crate::math::{combine, luminance, student_t_two_sided_95};
use crate::trace::{Sobol, Tally};
use glam::{DVec3, Vec3};
use std::sync::LazyLock;

/// How many starts may be refused for each one that is wanted, before a path starts wherever it can.
const PATIENCE: u64 = 8;

/// Paths between two looks at the cancel switch.
const CANCEL_INTERVAL: u64 = 64;

/// By how many of its standard errors an estimate may miss the truth in 95 of 100 cases.
static QUANTILE: LazyLock<f64> = LazyLock::new(|| student_t_two_sided_95(f64::from(REPLICATES - 1)));

/// Sums over the paths so far.
#[derive(Clone, Debug)]
pub(in crate::bake) struct Runs {
    key: u64,
    clamp: Option<f32>,
    runs: [Run; REPLICATES as usize],
    /// Paths of each run that were not refused.
    accepted: u64,
    tally: Tally,
    not_light: u64,
}

/// One scramble of the sequence.
#[derive(Clone, Copy, Debug, Default)]
struct Run {
    sum: DVec3,
    /// What the clamp took, as luminance.
    taken: f64,
    /// Place in the sequence.
    index: u64,
}

impl Runs {
    /// None yet. A path may bring at most `clamp` in its strongest channel.
    pub(in crate::bake) fn new(key: u64, clamp: Option<f32>) -> Self {
        let runs = [Run::default(); REPLICATES as usize];
        Self { key, clamp, runs, accepted: 0, tally: Tally::default(), not_light: 0 }
    }

    /// Carries on until there are at least `count` paths in all. `numbers` makes a path's numbers of a key and a place in
    /// the sequence. `path` gives one path's value for its numbers and counts what it did, or refuses it; once too many
    /// have been refused it is asked for what cannot be ([`Start::Anywhere`]). `None` if cancelled.
    pub(in crate::bake) fn extend<N>(
        &mut self,
        count: u32,
        numbers: impl Fn(u64, u64) -> N,
        cancel: &CancelToken,
        mut path: impl FnMut(&N, Start, &mut Tally) -> Option<Vec3>,
    ) -> Option<()> {
        let per_run = Self::per_run(count);
        for number in 0..REPLICATES {
            let mut accepted = self.accepted;
            while accepted < per_run {
                if self.runs[number as usize].index.is_multiple_of(CANCEL_INTERVAL) && cancel.is_cancelled() {
                    return None;
                }
                let (numbers, start) = self.next(number, per_run, &numbers);
                let Some(value) = path(&numbers, start, &mut self.tally) else { continue };
                accepted += 1;
                self.add(number, value);
            }
        }
        self.have_all(per_run);
        Some(())
    }

    /// Paths of each run where there are to be at least `count` in all.
    pub(in crate::bake) fn per_run(count: u32) -> u64 {
        u64::from(count.div_ceil(REPLICATES))
    }

    /// The next start of a run that is not refused, and its path's numbers. At the end the path's value is to be added.
    pub(in crate::bake) fn start<T>(
        &mut self,
        number: u32,
        per_run: u64,
        start: impl Fn(&Sobol, Start) -> Option<T>,
    ) -> (T, Sobol) {
        loop {
            let (numbers, kind) = self.next(number, per_run, &Sobol::new);
            if let Some(start) = start(&numbers, kind) {
                return (start, numbers);
            }
        }
    }

    /// The numbers of a run's next try, and whether it may be refused.
    fn next<N>(&mut self, number: u32, per_run: u64, numbers: &impl Fn(u64, u64) -> N) -> (N, Start) {
        let run = &mut self.runs[number as usize];
        let start = if run.index < PATIENCE * per_run { Start::Drawn } else { Start::Anywhere };
        let numbers = numbers(combine(self.key, number.into()), run.index);
        run.index += 1;
        (numbers, start)
    }

    /// Paths of each run that were not refused.
    pub(in crate::bake) fn paths_per_run(&self) -> u64 {
        self.accepted
    }

    /// Adds a path's value to a run.
    pub(in crate::bake) fn add(&mut self, number: u32, value: Vec3) {
        if !is_light(value) {
            self.not_light += 1;
            return;
        }
        let run = &mut self.runs[number as usize];
        let kept = clamped(value, self.clamp);
        run.taken += luminance(value - kept);
        run.sum += kept.as_dvec3();
    }

    /// Notes that all runs have had so many paths.
    pub(in crate::bake) fn have_all(&mut self, per_run: u64) {
        self.accepted = self.accepted.max(per_run);
    }

    /// What its paths did.
    pub(in crate::bake) fn tally(&mut self) -> &mut Tally {
        &mut self.tally
    }

    /// The luminance of a sum of estimates that are made of the same random numbers, each with its factor, and its
    /// standard error: the spread of the sums of their runs.
    pub(in crate::bake) fn luminance_of_sum(terms: &[(f64, Self)]) -> [f64; 2] {
        let of_run = |run: usize| -> f64 {
            terms.iter().map(|(factor, of)| factor * luminance(of.runs[run].sum / of.accepted.max(1) as f64)).sum()
        };
        let sums: [f64; REPLICATES as usize] = std::array::from_fn(of_run);
        let count = f64::from(REPLICATES);
        let mean = sums.iter().sum::<f64>() / count;
        let squares: f64 = sums.iter().map(|sum| (sum - mean).powi(2)).sum();
        [mean, (squares / (count * (count - 1.0))).sqrt()]
    }

    /// What they say.
    pub(in crate::bake) fn estimate(&self) -> Estimate {
        let count = f64::from(REPLICATES);
        let means = self.runs.map(|run| run.sum / self.accepted.max(1) as f64);
        let mean = means.iter().sum::<DVec3>() / count;
        let squares: DVec3 = means.iter().map(|&value| (value - mean) * (value - mean)).sum();
        let variance_of_mean = squares / (count * (count - 1.0));
        let stderr = DVec3::from(variance_of_mean.to_array().map(f64::sqrt));
        let off = |&value: &DVec3| luminance(value - mean);
        let luminance_error =
            (means.iter().map(|value| off(value).powi(2)).sum::<f64>() / (count * (count - 1.0))).sqrt();
        let half = means.iter().step_by(2).sum::<DVec3>() / (0.5 * count);
        let samples = self.accepted * u64::from(REPLICATES);
        let tries: u64 = self.runs.iter().map(|run| run.index).sum();
        Estimate {
            mean,
            stderr,
            luminance_error,
            half,
            samples,
            rays: self.tally.rays,
            accepted: samples as f64 / tries.max(1) as f64,
            clamped: self.runs.iter().map(|run| run.taken).sum::<f64>() / samples.max(1) as f64,
            not_light: self.not_light,
            endless: self.tally.endless,
            half_width: *QUANTILE * luminance_error,
            level: luminance(mean),
        }
    }
}

/// Whether a path's value can be light: one that is not would spoil the mean of all.
fn is_light(value: Vec3) -> bool {
    value.is_finite() && value.min_element() >= 0.0
}

/// A value with its hue and, in its strongest channel, at most `limit`.
fn clamped(value: Vec3, limit: Option<f32>) -> Vec3 {
    match limit {
        Some(limit) if value.max_element() > limit => value * (limit / value.max_element()),
        _ => value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{Dimensions, Sampler};

    /// Carried on in rounds, with some refused, it is what it would be in one go.
    #[test]
    fn rounds_make_what_one_go_makes() {
        let cancel = CancelToken::default();
        let path = |sobol: &Sobol, _: Start, tally: &mut Tally| {
            tally.rays += 1;
            let [u, v, ..] = sobol.draw(Dimensions::Start);
            (v > 0.3).then(|| Vec3::new(u, u * u, 1.0))
        };
        let mut at_once = Runs::new(7, Some(0.8));
        at_once.extend(512, Sobol::new, &cancel, path).unwrap();
        let mut carried_on = Runs::new(7, Some(0.8));
        for count in [64, 64, 100, 512] {
            carried_on.extend(count, Sobol::new, &cancel, path).unwrap();
        }
        let [a, b] = [&at_once, &carried_on].map(Runs::estimate);
        assert_eq!(format!("{a:?}"), format!("{b:?}"));
        assert!(a.samples == 512 && a.rays > 600 && a.accepted < 0.8, "{a:?}");
    }
}
