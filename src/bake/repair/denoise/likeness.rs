//! How much two texels look alike, by themselves and their neighbours, but for the slope between them.

use super::fit::Fitted;
use super::texels::Texels;
use glam::Vec3;

/// The share of what may differ up to which two texels are alike in full.
const PLATEAU: f32 = 0.25;

/// Texels of a whole surrounding.
const WHOLE: f32 = 9.0;

/// What texels look like, and how much of their differences may be noise.
pub(super) struct Looks<'a> {
    texels: &'a Texels,
    fitted: Vec<Fitted>,
    /// Mean squared difference of two like surroundings, in units of its variance, that is noise without doubt, and by
    /// how much it may be exceeded.
    noise: f32,
    excess: f32,
}

impl<'a> Looks<'a> {
    /// One half as measured. Differences of independent texels are 1 in the mean.
    pub(super) fn measured(texels: &'a Texels, half: usize) -> Self {
        let of_texel = |(value, variance): (&Vec3, &Vec3)| Fitted::of_texel(*value, *variance);
        let fitted = texels.halves[half].iter().zip(&texels.variance).map(of_texel).collect();
        Self { texels, fitted, noise: 1.0, excess: 1.6 }
    }

    /// One half as fitted. Fits that share texels differ by less than their variances say, all of a surrounding in the
    /// same way.
    pub(super) fn fitted(texels: &'a Texels, fits: impl Iterator<Item = Fitted>) -> Self {
        let mut fitted = vec![Fitted::default(); texels.links.len()];
        for (&index, fit) in texels.measured.iter().zip(fits) {
            fitted[index] = fit;
        }
        Self { texels, fitted, noise: 0.5, excess: 3.5 }
    }

    /// How much two texels look alike, in [0, 1].
    pub(super) fn likeness(&self, here: usize, there: usize, step: [i32; 2]) -> f32 {
        let texels = self.texels;
        if texels.variance[there] == Vec3::ZERO && texels.variance[here] != Vec3::ZERO {
            // One that no path ever changed has nothing to say about one whose paths differ, and would drag it down
            // where light is found but rarely.
            return 0.0;
        }
        let rise = self.rise(here, there, step);
        let difference = |here: usize, there: usize| {
            let [here, there] = [&self.fitted[here], &self.fitted[there]];
            let difference = here.value + rise - there.value;
            (difference * difference / (here.variance + there.variance + f32::MIN_POSITIVE)).element_sum() / 3.0
        };
        let both = texels.links[here] & texels.links[there];
        let (mut sum, mut count) = (difference(here, there), 1.0);
        for number in (0..8).filter(|number| both >> number & 1 == 1) {
            sum += difference(texels.neighbour(here, number), texels.neighbour(there, number));
            count += 1.0;
        }
        // The fewer there are the more the mean may be off by chance.
        let excess = (sum / count - self.noise).max(0.0) * f32::sqrt(count / WHOLE);
        ((1.0 - excess / self.excess) / (1.0 - PLATEAU)).clamp(0.0, 1.0)
    }

    /// What the slopes of both say about their difference: all of it, if both lie on one paraboloid.
    fn rise(&self, here: usize, there: usize, [x, y]: [i32; 2]) -> Vec3 {
        let [[hx, hy], [tx, ty]] = [self.fitted[here].slope, self.fitted[there].slope];
        0.5 * ((hx + tx) * x as f32 + (hy + ty) * y as f32)
    }
}
