//! Blends what fits of several kinds make of a texel, by the error that each has.
//!
//! A wide and stiff fit has the least noise, a narrow or supple one follows the light better. Which of the two is
//! nearer to the truth shows in what is left of the measurement when the stiffer one is taken out: the supple fit's
//! difference from it is light as far as it goes with that rest, and noise as far as it does not. What goes together by
//! noise alone is known, by the weight of each measurement in its own fit (Stein's unbiased estimate of the error,
//! 1981; for denoising Li, Wu and Chuang 2012, Rousselle et al. 2012), and is taken off first. The share of the
//! difference that is light is one number for all channels of a small surrounding.
//!
//! Owns the choice; knows nothing of how the fits are made.

use super::fit::Fitted;
use super::texels::Texels;
use super::window::Window;
use super::{Filtered, Kind, live, root};
use crate::bake::BakeError;
use crate::bake::workers::Workers;
use glam::Vec3;

/// Over which surrounding a share is estimated [texels].
const RADIUS: f32 = 7.0;

/// What the share of each kind after the first must exceed, in its standard errors. Curvature is there unless it is
/// seen not to be: a plane would take the dip out of contact shadows. A small window must show that it is needed.
const CHAIN: [(Kind, f32); 2] = [(Kind::WideParaboloid, -0.6), (Kind::Paraboloid, 0.5)];

/// The channels of one path come together: their errors are as good as one.
const CHANNELS: f32 = 3.0;

/// What a texel may be.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Candidate {
    pub(super) value: Vec3,
    /// Its standard error, but for what was blurred.
    pub(super) residual: Vec3,
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

    fn blended(self, other: Self, share: f32) -> Self {
        Self {
            value: self.value + share * (other.value - self.value),
            // As if their errors were the same: they are made of the same texels.
            residual: self.residual + share * (other.residual - self.residual),
            own: self.own + share * (other.own - self.own),
        }
    }
}

/// The best of each measured texel, in their order.
pub(super) fn best(
    texels: &Texels,
    filtered: &Filtered,
    workers: &Workers<'_>,
) -> Result<Vec<Candidate>, BakeError> {
    let candidates = |kind: Kind| {
        let mut candidates = vec![Candidate::default(); texels.links.len()];
        for (&index, halves) in texels.measured.iter().zip(filtered.of(kind)) {
            candidates[index] = Candidate::of_halves(halves);
        }
        candidates
    };
    let window = Window::new(RADIUS);
    let mut best = candidates(Kind::WidePlane);
    for (kind, least) in CHAIN {
        let other = candidates(kind);
        let choice = Choice { texels, best: &best, other: &other, least };
        let shares = workers.gather_quietly(&texels.measured, |&index, cancel| {
            live(cancel)?;
            Some(choice.share(index, &window))
        })?;
        for (&index, share) in texels.measured.iter().zip(shares) {
            best[index] = best[index].blended(other[index], share);
        }
    }
    Ok(texels.measured.iter().map(|&index| best[index]).collect())
}

/// Between two candidates of each texel.
struct Choice<'a> {
    texels: &'a Texels,
    best: &'a [Candidate],
    other: &'a [Candidate],
    least: f32,
}

impl Choice<'_> {
    /// The share of the other candidate that is best about a texel, in [0, 1].
    fn share(&self, index: usize, window: &Window) -> f32 {
        let texels = self.texels;
        let is_whole = |index: usize| texels.links[index] == u8::MAX;
        let (mut gain, mut squares, mut noise) = (0.0, 0.0, 0.0);
        for reached in window.reach(texels, index) {
            let there = reached.index;
            if is_whole(there) != is_whole(index) {
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
            noise += near * near * difference.length_squared();
        }
        if squares > 0.0 {
            ((gain - self.least * f32::sqrt(CHANNELS * noise)) / squares).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }
}
