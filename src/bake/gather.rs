//! One estimate: the mean over many paths and its standard error.
//!
//! Samples of one Owen-scrambled Sobol sequence are not independent, so their spread says little about the error of
//! their mean. The paths of an estimate are therefore dealt to [`REPLICATES`] runs with scrambles of their own; the
//! runs' means are independent and equally distributed, and their spread is the standard error (Owen 1997).

mod runs;

pub(super) use runs::Runs;

use super::{CancelToken, RelativeError};
use crate::math::{combine, luminance};
use crate::trace::{Sobol, Tally};
use glam::{DVec3, Vec3};

/// How many independently scrambled runs share the paths of each estimate; their spread is its standard error.
pub const REPLICATES: u32 = 16;

/// What a random number is for: keys of different kinds never meet.
#[derive(Clone, Copy, Debug)]
pub(super) enum KeyKind {
    Texel = 1,
    Point = 2,
    Pixel = 3,
    Balance = 4,
    Probe = 5,
    VolumeProbe = 6,
}

/// The key of the paths of kind `kind` under `seed` that belong to an object (or nothing: 0) and a place on it.
pub(super) fn key(kind: KeyKind, seed: u64, object: u64, place: u64) -> u64 {
    combine(combine(combine(seed, kind as u64), object), place)
}

/// The paths of one estimate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paths {
    /// Whose random numbers they are.
    pub(super) key: u64,
    /// How many there are at least.
    pub(super) count: u32,
    /// The most that one of them may bring, in its strongest channel.
    pub(super) clamp: Option<f32>,
}

/// Where a path may start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Start {
    /// Where its numbers say, or nowhere.
    Drawn,
    /// Where it can: there may be no refusal.
    Anywhere,
}

/// A mean and its standard error, per channel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Estimate {
    pub(super) mean: DVec3,
    pub(super) stderr: DVec3,
    /// Standard error of the luminance: lights of different colours need not err together.
    pub(super) luminance_error: f64,
    /// The mean over every second run: the other half's is `2 mean - half`, and the two are independent.
    pub(super) half: DVec3,
    pub(super) samples: u64,
    /// Rays traced, but for those that ask whether a path may start somewhere.
    pub(super) rays: u64,
    /// Share of the starts that were not refused, in (0, 1].
    pub(super) accepted: f64,
    /// What the clamp took from the mean, as luminance.
    pub(super) clamped: f64,
    /// Paths whose light was no number, or negative. They count as dark.
    pub(super) not_light: u64,
    /// Paths that were cut because nothing ended them.
    pub(super) endless: u64,
    /// Half the width of the interval of luminance that holds the truth in 95 of 100 cases [cd/m²].
    pub(super) half_width: f64,
    /// The luminance that its error is relative to [cd/m²].
    pub(super) level: f64,
}

impl Estimate {
    /// Runs the paths. `path` gives one path's value for its numbers and counts what it did. `None` if cancelled.
    pub(super) fn gather(
        paths: Paths,
        cancel: &CancelToken,
        mut path: impl FnMut(&Sobol, &mut Tally) -> Vec3,
    ) -> Option<Self> {
        let mut runs = Runs::new(paths.key, paths.clamp);
        runs.extend(paths.count, Sobol::new, cancel, |sobol, _, tally| Some(path(sobol, tally)))?;
        Some(runs.estimate())
    }

    /// Standard error over value, by luminance; `None` for a black estimate.
    pub(super) fn relative_stderr(&self) -> Option<f64> {
        let value = luminance(self.mean);
        (value > 0.0).then(|| self.luminance_error / value)
    }
}

/// Share of the light that the clamp took; `None` where nothing was to be clamped.
pub(super) fn clamped_share(estimates: &[Estimate], clamp: Option<f32>) -> Option<f64> {
    clamp?;
    let taken: f64 = estimates.iter().map(|estimate| estimate.clamped).sum();
    let kept: f64 = estimates.iter().map(|estimate| luminance(estimate.mean)).sum();
    Some(if taken > 0.0 { taken / (taken + kept) } else { 0.0 })
}

/// Relative standard errors over the estimates brighter than 1e-3 of their mean.
pub(super) fn relative_error(estimates: &[Estimate]) -> RelativeError {
    if estimates.is_empty() {
        return RelativeError::default();
    }
    let mean = estimates.iter().map(|estimate| luminance(estimate.mean)).sum::<f64>() / estimates.len() as f64;
    let lit = estimates.iter().filter(|estimate| luminance(estimate.mean) > 1e-3 * mean);
    RelativeError::of(lit.filter_map(Estimate::relative_stderr).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{Dimensions, Sampler};

    fn paths(key: u64, count: u32) -> Paths {
        Paths { key, count, clamp: None }
    }

    #[test]
    fn a_clamp_says_what_it_took() {
        let bright = |sobol: &Sobol, _: &mut Tally| {
            let one_in_four = sobol.draw(Dimensions::Start)[0] < 0.25;
            if one_in_four { Vec3::new(9.0, 9.0, 9.0) } else { Vec3::splat(1.0) }
        };
        let cancel = CancelToken::default();
        let estimate = Estimate::gather(Paths { clamp: Some(5.0), ..paths(3, 4096) }, &cancel, bright).unwrap();
        // A quarter brings 5 instead of 9: 2 is left of 3.
        assert!((estimate.mean.x - 2.0).abs() < 1e-3, "{estimate:?}");
        let share = clamped_share(&[estimate], Some(5.0)).unwrap();
        assert!((share - 1.0 / 3.0).abs() < 1e-3, "{share}");
        assert_eq!(clamped_share(&[estimate], None), None);
    }

    /// A constant has no error; a uniform number has mean 1/2 and an honest error.
    #[test]
    fn mean_and_error_of_known_integrands() {
        let cancel = CancelToken::default();
        let constant = Estimate::gather(paths(1, 100), &cancel, |_, _| Vec3::splat(0.3)).expect("not cancelled");
        assert_eq!(constant.samples, 112);
        assert!((constant.mean - DVec3::splat(0.3_f32.into())).length() < 1e-12);
        assert!(constant.stderr.length() < 1e-12);

        let mut inside = 0;
        for key in 0..400 {
            let uniform = Estimate::gather(paths(combine(7, key), 64), &cancel, |sobol, _| {
                Vec3::splat(sobol.draw(Dimensions::Start)[0].powi(4))
            })
            .expect("not cancelled");
            // Student's t with 15 degrees of freedom: 95 % within 2.131.
            if (uniform.mean.x - 0.2).abs() < 2.131 * uniform.stderr.x {
                inside += 1;
            }
        }
        assert!((368..=392).contains(&inside), "{inside} of 400 intervals hold the truth");
    }

    /// What is no light is left out and counted; the rest stands.
    #[test]
    fn what_is_no_light_is_left_out() {
        for wrong in [Vec3::NAN, Vec3::INFINITY, Vec3::new(1.0, -1e-3, 1.0), Vec3::new(0.0, f32::NEG_INFINITY, 0.0)] {
            let path = |sobol: &Sobol, _: &mut Tally| {
                if sobol.draw(Dimensions::Start)[0] < 0.25 { wrong } else { Vec3::ONE }
            };
            let estimate = Estimate::gather(paths(3, 4096), &CancelToken::default(), path).unwrap();
            assert!((estimate.mean - DVec3::splat(0.75)).length() < 1e-3, "{wrong}: {estimate:?}");
            assert!(estimate.not_light.abs_diff(1024) < 4 && estimate.stderr.is_finite(), "{estimate:?}");
        }
    }

    #[test]
    fn cancelled_is_none() {
        let cancel = CancelToken::default();
        cancel.cancel();
        assert!(Estimate::gather(paths(1, 100), &cancel, |_, _| Vec3::ONE).is_none());
    }
}
