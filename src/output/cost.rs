//! Where the paths of a bake went, as a picture for a person: black where nothing was measured, then from dark blue
//! over green to yellow, a step of the scale for each doubling of a texel's paths. The scale begins at the first round,
//! 64 paths, and ends at a million.

use super::png::write_rgb;
use crate::bake::Page;
use crate::math::Portable;
use std::io::{self, Write};

/// Least length of the picture's longer side [pixels].
const LEAST_SIDE: u32 = 512;

/// Doublings of the first round that the scale begins and ends with.
const FIRST: f32 = 6.0;
const LAST: f32 = 20.0;

/// The scale: even steps for the eye, and for those who do not tell red from green (after viridis, Smith and van der
/// Walt 2015).
const SCALE: [[f32; 3]; 6] = [
    [68.0, 1.0, 84.0],
    [64.0, 67.0, 135.0],
    [41.0, 120.0, 142.0],
    [34.0, 167.0, 132.0],
    [121.0, 209.0, 81.0],
    [253.0, 231.0, 37.0],
];

/// Writes the picture, enlarged by a whole number where the page is small.
pub(super) fn write_cost(page: &Page, to: impl Write) -> io::Result<()> {
    let scale = (LEAST_SIDE / page.width.max(page.height).max(1)).max(1);
    let (width, height) = (page.width * scale, page.height * scale);
    let mut pixels = Vec::with_capacity(3 * width as usize * height as usize);
    for y in 0..height {
        for x in 0..width {
            let texel = (y / scale) as usize * page.width as usize + (x / scale) as usize;
            pixels.extend(colour(page.samples.get(texel).copied().unwrap_or(0)));
        }
    }
    write_rgb(width, height, pixels, to)
}

fn colour(samples: u32) -> [u8; 3] {
    if samples == 0 {
        return [0; 3];
    }
    let place = (Portable::log2(samples as f32) - FIRST) / (LAST - FIRST);
    let place = place.clamp(0.0, 1.0) * (SCALE.len() - 1) as f32;
    let step = (place as usize).min(SCALE.len() - 2);
    let share = place - step as f32;
    [0, 1, 2].map(|channel| {
        let [low, high] = [SCALE[step][channel], SCALE[step + 1][channel]];
        (low + share * (high - low)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_paths_are_brighter() {
        let light = |samples| colour(samples).map(u32::from).iter().sum::<u32>();
        assert_eq!(colour(0), [0; 3]);
        assert_eq!((colour(16), colour(1 << 20)), (colour(64), [253, 231, 37]));
        assert!((6..19).all(|power| light(1 << power) < light(2 << power)));
    }
}
