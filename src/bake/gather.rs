//! One estimate: the mean over many paths and its standard error.
//!
//! Samples of one Owen-scrambled Sobol sequence are not independent, so their spread says little about the error of
//! their mean. The paths of an estimate are therefore dealt to [`REPLICATES`] runs with scrambles of their own; the
//! runs' means are independent and equally distributed, and their spread is the standard error (Owen 1997).

use super::{CancelToken, RelativeError};
use crate::math::combine;
use crate::math::luminance;
use crate::trace::Sobol;
use glam::{DVec3, Vec3};

/// How many independently scrambled runs share the paths of each estimate; their spread is its standard error.
pub const REPLICATES: u32 = 16;

/// Paths between two looks at the cancel switch.
const CANCEL_INTERVAL: u64 = 64;

/// What a random number is for: keys of different kinds never meet.
#[derive(Clone, Copy, Debug)]
pub(super) enum KeyKind {
    Texel = 1,
    Point = 2,
    Pixel = 3,
    Balance = 4,
}

/// The key of the paths of kind `kind` under `seed` that belong to an object (or nothing: 0) and a place on it.
pub(super) fn key(kind: KeyKind, seed: u64, object: u64, place: u64) -> u64 {
    combine(combine(combine(seed, kind as u64), object), place)
}

/// A mean and its standard error, per channel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Estimate {
    pub(super) mean: DVec3,
    pub(super) stderr: DVec3,
    pub(super) samples: u64,
    pub(super) rays: u64,
}

impl Estimate {
    /// Runs at least `samples` paths. `path` gives one path's value for its numbers and counts its rays. `None` if
    /// cancelled.
    pub(super) fn gather(
        key: u64,
        samples: u32,
        cancel: &CancelToken,
        mut path: impl FnMut(&Sobol, &mut u64) -> Vec3,
    ) -> Option<Self> {
        let per_replicate = u64::from(samples.div_ceil(REPLICATES));
        let mut rays = 0;
        let mut means = [DVec3::ZERO; REPLICATES as usize];
        for (replicate, mean) in means.iter_mut().enumerate() {
            let key = combine(key, replicate as u64);
            let mut sum = DVec3::ZERO;
            for index in 0..per_replicate {
                if index.is_multiple_of(CANCEL_INTERVAL) && cancel.is_cancelled() {
                    return None;
                }
                sum += path(&Sobol::new(key, index), &mut rays).as_dvec3();
            }
            *mean = sum / per_replicate as f64;
        }
        let count = f64::from(REPLICATES);
        let mean = means.iter().sum::<DVec3>() / count;
        let squares: DVec3 = means.iter().map(|&value| (value - mean) * (value - mean)).sum();
        let variance_of_mean = squares / (count * (count - 1.0));
        let stderr = DVec3::from(variance_of_mean.to_array().map(f64::sqrt));
        Some(Self { mean, stderr, samples: per_replicate * u64::from(REPLICATES), rays })
    }

    /// Standard error over value, by luminance; `None` for a black estimate.
    pub(super) fn relative_stderr(&self) -> Option<f64> {
        let value = luminance(self.mean);
        (value > 0.0).then(|| luminance(self.stderr) / value)
    }
}

/// Relative standard errors over the estimates brighter than 1e-3 of their mean.
pub(super) fn relative_error(estimates: &[Estimate]) -> RelativeError {
    if estimates.is_empty() {
        return RelativeError::default();
    }
    let mean = estimates.iter().map(|estimate| luminance(estimate.mean)).sum::<f64>() / estimates.len() as f64;
    let mut errors: Vec<f64> = estimates
        .iter()
        .filter(|estimate| luminance(estimate.mean) > 1e-3 * mean)
        .filter_map(Estimate::relative_stderr)
        .collect();
    if errors.is_empty() {
        return RelativeError::default();
    }
    errors.sort_by(f64::total_cmp);
    RelativeError {
        mean: errors.iter().sum::<f64>() / errors.len() as f64,
        p95: errors[(errors.len() - 1) * 95 / 100],
        max: errors[errors.len() - 1],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{Dimensions, Sampler};

    /// A constant has no error; a uniform number has mean 1/2 and an honest error.
    #[test]
    fn mean_and_error_of_known_integrands() {
        let cancel = CancelToken::default();
        let constant = Estimate::gather(1, 100, &cancel, |_, _| Vec3::splat(0.3)).expect("not cancelled");
        assert_eq!(constant.samples, 112);
        assert!((constant.mean - DVec3::splat(0.3_f32.into())).length() < 1e-12);
        assert!(constant.stderr.length() < 1e-12);

        let mut inside = 0;
        for key in 0..400 {
            let uniform = Estimate::gather(combine(7, key), 64, &cancel, |sobol, _| {
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

    #[test]
    fn cancelled_is_none() {
        let cancel = CancelToken::default();
        cancel.cancel();
        assert!(Estimate::gather(1, 100, &cancel, |_, _| Vec3::ONE).is_none());
    }
}
