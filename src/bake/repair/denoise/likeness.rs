//! How much two texels of one half look alike, by themselves and their neighbours.

use super::texels::Texels;
use glam::Vec3;

/// By how much the mean squared difference of two like surroundings, in units of its variance, may exceed 1.
const EXCESS: f32 = 1.2;

/// The share of that up to which they are alike in full.
const PLATEAU: f32 = 0.25;

/// Texels of a whole surrounding.
const WHOLE: f32 = 9.0;

/// How much two texels look alike, in [0, 1].
pub(super) fn likeness(texels: &Texels, half: usize, here: usize, there: usize) -> f32 {
    if texels.variance[there] == Vec3::ZERO && texels.variance[here] != Vec3::ZERO {
        // One that no path ever changed has nothing to say about one whose paths differ, and would drag it down where
        // light is found but rarely.
        return 0.0;
    }
    let values = &texels.halves[half];
    let difference = |here: usize, there: usize| {
        let difference = values[here] - values[there];
        let variance = texels.variance[here] + texels.variance[there] + f32::MIN_POSITIVE;
        (difference * difference / variance).element_sum() / 3.0
    };
    let both = texels.links[here] & texels.links[there];
    let (mut sum, mut count) = (difference(here, there), 1.0);
    for number in (0..8).filter(|number| both >> number & 1 == 1) {
        sum += difference(texels.neighbour(here, number), texels.neighbour(there, number));
        count += 1.0;
    }
    // The fewer there are the more the mean may be off by chance.
    let excess = (sum / count - 1.0).max(0.0) * f32::sqrt(count / WHOLE);
    ((1.0 - excess / EXCESS) / (1.0 - PLATEAU)).clamp(0.0, 1.0)
}
