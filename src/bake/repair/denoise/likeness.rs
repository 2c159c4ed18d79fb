//! How much two texels look alike, by themselves and their neighbours, but for the slope between them.

use super::fit::Fitted;
use super::texels::Texels;
use glam::{Vec3, Vec3A};

/// The share of what may differ up to which two texels are alike in full.
const PLATEAU: f32 = 0.25;

/// Texels of a whole surrounding.
const WHOLE: f32 = 9.0;

/// What texels look like, and how much of their differences may be noise.
pub(super) struct Looks<'a> {
    texels: &'a Texels,
    /// Values and their variances.
    values: Vec<[Vec3A; 2]>,
    /// Change from texel to texel, along the columns and the rows.
    slopes: Vec<[Vec3; 2]>,
    /// Mean squared difference of two like surroundings, in units of its variance, that is noise without doubt, and by
    /// how much it may be exceeded.
    noise: f32,
    excess: f32,
}

impl<'a> Looks<'a> {
    /// One half as measured. Differences of independent texels are 1 in the mean.
    pub(super) fn measured(texels: &'a Texels, half: usize) -> Self {
        let of_texel = |(value, variance): (&Vec3, &Vec3)| [Vec3A::from(*value), Vec3A::from(*variance)];
        let values = texels.halves[half].iter().zip(&texels.variance).map(of_texel).collect();
        let slopes = vec![[Vec3::ZERO; 2]; texels.links.len()];
        Self { texels, values, slopes, noise: 1.0, excess: 3.0 }
    }

    /// The same with another excess.
    #[cfg(test)]
    pub(super) fn exceeded_by(self, excess: f32) -> Self {
        Self { excess, ..self }
    }

    /// One half as fitted. Fits that share texels differ by less than their variances say, all of a surrounding in the
    /// same way.
    pub(super) fn fitted(texels: &'a Texels, fits: impl Iterator<Item = Fitted>) -> Self {
        let count = texels.links.len();
        let (mut values, mut slopes) = (vec![[Vec3A::ZERO; 2]; count], vec![[Vec3::ZERO; 2]; count]);
        for (&index, fit) in texels.measured.iter().zip(fits) {
            values[index] = [fit.value, fit.variance].map(Vec3A::from);
            slopes[index] = fit.slope;
        }
        Self { texels, values, slopes, noise: 0.5, excess: 3.5 }
    }

    /// How much two texels look alike, in [0, 1].
    pub(super) fn likeness(&self, here: usize, there: usize, step: [i32; 2]) -> f32 {
        let texels = self.texels;
        if texels.variance[there] == Vec3::ZERO && texels.variance[here] != Vec3::ZERO {
            // One that no path ever changed has nothing to say about one whose paths differ, and would drag it down
            // where light is found but rarely.
            return 0.0;
        }
        let rise = Vec3A::from(self.rise(here, there, step));
        let difference = |here: usize, there: usize| {
            let [[here, variance_here], [there, variance_there]] = [self.values[here], self.values[there]];
            let difference = here + rise - there;
            difference * difference / (variance_here + variance_there + Vec3A::splat(f32::MIN_POSITIVE))
        };
        let both = texels.links[here] & texels.links[there];
        let (mut sum, mut count) = (difference(here, there), 1.0);
        for number in (0..8).filter(|number| both >> number & 1 == 1) {
            sum += difference(texels.neighbour(here, number), texels.neighbour(there, number));
            count += 1.0;
        }
        // Added up as three numbers: four would be in an order that depends on the processor.
        let sum = Vec3::from(sum).element_sum() / 3.0;
        // The fewer there are the more the mean may be off by chance.
        let excess = (sum / count - self.noise).max(0.0) * f32::sqrt(count / WHOLE);
        ((1.0 - excess / self.excess) / (1.0 - PLATEAU)).clamp(0.0, 1.0)
    }

    /// What the slopes of both say about their difference: all of it, if both lie on one paraboloid.
    fn rise(&self, here: usize, there: usize, [x, y]: [i32; 2]) -> Vec3 {
        let [[hx, hy], [tx, ty]] = [self.slopes[here], self.slopes[there]];
        0.5 * ((hx + tx) * x as f32 + (hy + ty) * y as f32)
    }
}
