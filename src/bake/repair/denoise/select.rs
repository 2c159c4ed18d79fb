//! Blends what a small and a large window make of a texel, by the error that each has.
//!
//! The large one has less noise, the small one follows the light better. Which is nearer to the truth shows in what is
//! left of the measurement when the large one is taken out: the small one's difference from it is light as far as it
//! goes with that rest, and noise as far as it does not. What goes together by noise alone is known, by the share of
//! each measurement in its own fit (Stein's unbiased estimate of the error, 1981; for denoising Li, Wu and Chuang
//! 2012, Rousselle et al. 2012), and is taken off first. The share of the difference that is light is one number for
//! all channels of a surrounding.
//!
//! At the border of a chart fits see one side only, where curvature is mostly noise. There a share of the plane through
//! the small window is blended in, found in the same way. Elsewhere planes would take a little light from peaks.
//!
//! Owns the choice; knows nothing of how the fits are made.

use super::fit::Fitted;
use super::texels::Texels;
use super::window::Window;
use super::{Level, live, root};
use crate::bake::BakeError;
use crate::bake::workers::Workers;
use glam::Vec3;

/// Over which surrounding a share is estimated [texels].
const RADIUS: f32 = 10.0;

/// What a texel may be.
#[derive(Clone, Copy, Debug, Default)]
struct Candidate {
    value: Vec3,
    /// Its standard error, but for what was blurred.
    residual: Vec3,
    /// The share of the texel's own measurement in it.
    own: f32,
}

impl Candidate {
    /// The mean of two independent halves.
    fn of_halves([first, second]: [Fitted; 2]) -> Self {
        Self {
            value: 0.5 * (first.value + second.value),
            residual: 0.5 * root(first.variance + second.variance),
            own: 0.5 * (first.own + second.own),
        }
    }

    /// This with a share of another. Residuals are mixed as if both had the same error: they are made of the same
    /// texels.
    fn blended(self, other: Self, share: f32) -> Self {
        Self {
            value: self.value.lerp(other.value, share),
            residual: self.residual.lerp(other.residual, share),
            own: self.own + share * (other.own - self.own),
        }
    }
}

/// The best value of each measured texel by a small and a large window, and its standard error, in their order.
pub(super) fn best(
    texels: &Texels,
    [small, large]: [&[Level]; 2],
    workers: &Workers<'_>,
) -> Result<Vec<[Vec3; 2]>, BakeError> {
    let candidates = |levels: &[Level], halves: fn(&Level) -> [Fitted; 2]| {
        let mut candidates = vec![Candidate::default(); texels.links.len()];
        for (&index, level) in texels.measured.iter().zip(levels) {
            candidates[index] = Candidate::of_halves(halves(level));
        }
        candidates
    };
    let window = Window::new(RADIUS);
    let mut best = candidates(large, |level| level.crossed);
    let mut blend = |wanted: &[usize], other: &[Candidate]| -> Result<(), BakeError> {
        let choice = Choice { texels, best: &best, other };
        let blends = workers.gather_quietly(wanted, |&index, cancel| {
            live(cancel)?;
            Some(best[index].blended(other[index], choice.share_of_other(index, &window)))
        })?;
        wanted.iter().zip(blends).for_each(|(&index, blended)| best[index] = blended);
        Ok(())
    };
    blend(&texels.measured, &candidates(small, |level| level.crossed))?;
    let borders: Vec<usize> = texels.measured.iter().copied().filter(|&index| !texels.is_whole(index)).collect();
    blend(&borders, &candidates(small, |level| level.flat))?;
    Ok(texels.measured.iter().map(|&index| [best[index].value, best[index].residual]).collect())
}

/// Between two candidates of each texel.
struct Choice<'a> {
    texels: &'a Texels,
    best: &'a [Candidate],
    other: &'a [Candidate],
}

impl Choice<'_> {
    /// The share of the other candidate that is best about a texel, in [0, 1].
    fn share_of_other(&self, index: usize, window: &Window) -> f32 {
        let texels = self.texels;
        let (mut gain, mut squares) = (0.0, 0.0);
        for reached in window.reach(texels, index) {
            let there = reached.index;
            if texels.is_whole(there) != texels.is_whole(index) {
                // At a border fits look to one side only, which makes other errors.
                continue;
            }
            let near = 1.0 - reached.squared_distance() / (RADIUS * RADIUS);
            let [best, other] = [self.best[there], self.other[there]];
            // All in standard errors of the measurement.
            let scale = root(0.5 * texels.variance[there]);
            let is_measured = scale.cmpgt(Vec3::ZERO);
            let in_errors = |value: Vec3| Vec3::select(is_measured, value / scale, Vec3::ZERO);
            let difference = in_errors(other.value - best.value);
            let rest = in_errors(texels.mean(there) - best.value);
            let by_noise = Vec3::select(is_measured, Vec3::splat(other.own - best.own), Vec3::ZERO);
            gain += near * (difference * rest - by_noise).element_sum();
            squares += near * difference.length_squared();
        }
        if squares > 0.0 { (gain / squares).clamp(0.0, 1.0) } else { 0.0 }
    }
}
