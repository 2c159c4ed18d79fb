//! Texels that light missed by chance.
//!
//! Where light is found by few paths only, some texels find none: all their runs say nothing, and agree, which looks
//! like a black that is known without error. If light comes to each texel about λ times, a share of exp(−λ) of them
//! finds none; and λ is known, since rare light of any one strength has a mean squared over its variance of λ. So a
//! black texel is unlucky if light was found about it, if no more of its surrounding is black than by such chance, and
//! if those that were found do not all lie to one side. It then has the mean variance of its surrounding, and so has a
//! lucky one, or the lucky would give way and the unlucky not. Otherwise it is black: beyond a shadow's edge there are
//! too many like it.
//!
//! Each channel by itself. Owns this guess; changes no value.

use super::texels::Texels;
use super::window::{Reached, Window};
use crate::math::Portable;
use glam::{Vec2, Vec3};

/// How many standard deviations more than expected may be black, and how many the lit ones may lie off the middle.
const BLACK: f64 = 4.0;
const ASIDE: f64 = 2.5;

/// The variances of all texels where chance is seen to rule, and of all others what they are.
pub(super) fn variance_of_unlucky(texels: &Texels, window: &Window) -> Vec<Vec3> {
    let mut variance = texels.variance.clone();
    let any_black = [0, 1, 2].map(|channel| texels.measured.iter().any(|&index| is_black(texels, index, channel)));
    if any_black == [false; 3] {
        return variance;
    }
    for &index in &texels.measured {
        let reached = window.reach(texels, index);
        for channel in (0..3).filter(|&channel| any_black[channel]) {
            if let Some(shared) = Surrounding::new(texels, &reached, channel).variance_by_chance() {
                variance[index][channel] = shared as f32;
            }
        }
    }
    variance
}

fn is_black(texels: &Texels, index: usize, channel: usize) -> bool {
    texels.variance[index][channel] == 0.0 && texels.mean(index)[channel] == 0.0
}

/// One channel of what is about a texel.
#[derive(Clone, Copy, Debug, Default)]
struct Surrounding {
    /// Texels, and those of them that are black.
    count: f64,
    black: f64,
    /// Sums of values and of their variances.
    value: f64,
    variance: f64,
    /// Sums of the steps to all and to the lit ones, and of the squares of the former [texels].
    steps: Vec2,
    steps_to_lit: Vec2,
    squares: f64,
}

impl Surrounding {
    fn new(texels: &Texels, reached: &[Reached], channel: usize) -> Self {
        let mut sums = Self::default();
        for other in reached {
            let step = Vec2::from(other.step.map(|step| step as f32));
            sums.count += 1.0;
            sums.value += f64::from(texels.mean(other.index)[channel]);
            sums.variance += f64::from(texels.variance[other.index][channel]);
            sums.steps += step;
            sums.squares += f64::from(step.length_squared());
            if is_black(texels, other.index, channel) {
                sums.black += 1.0;
            } else {
                sums.steps_to_lit += step;
            }
        }
        sums
    }

    /// Mean variance of a half if chance made the black ones.
    fn variance_by_chance(&self) -> Option<f64> {
        let lit = self.count - self.black;
        if lit == 0.0 || self.black == 0.0 || self.variance == 0.0 {
            return None;
        }
        // A half has twice the variance of the whole.
        let expected = self.value * self.value / (self.count * 0.5 * self.variance);
        let missed = Portable::exp(-expected);
        let deviation = f64::sqrt(self.count * missed * (1.0 - missed));
        let is_too_black = self.black > self.count * missed + BLACK * deviation;
        let middle = self.steps / self.count as f32;
        let aside = f64::from((self.steps_to_lit / lit as f32 - middle).length_squared());
        let spread = self.squares / self.count - f64::from(middle.length_squared());
        let is_aside = aside > ASIDE * ASIDE * spread * (self.black / self.count) / lit;
        (!is_too_black && !is_aside).then_some(self.variance / self.count)
    }
}
