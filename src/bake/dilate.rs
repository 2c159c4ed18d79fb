//! Filling the texels beside the charts, which texture filtering also reads.
//!
//! Each pass gives every empty texel that touches a filled one the mean of its filled neighbours. Covered texels are
//! read and never written. Whether a texel is filled is kept apart from its colour: black is a value like any other.

use glam::Vec3;

/// Passes: bicubic filtering reads two texels beyond a chart, and block compression mixes four.
pub(super) const PASSES: u32 = 4;

/// Fills up to [`PASSES`] rings of empty texels around the covered ones, in place.
pub(super) fn dilate(values: &mut [Vec3], coverage: &[f32], [width, height]: [u32; 2]) {
    let (width, height) = (width as usize, height as usize);
    let mut filled: Vec<bool> = coverage.iter().map(|&coverage| coverage > 0.0).collect();
    for _ in 0..PASSES {
        let mut ring = Vec::new();
        for index in (0..values.len()).filter(|&index| !filled[index]) {
            let (x, y) = (index % width, index / width);
            let mut sum = Vec3::ZERO;
            let mut count = 0;
            for row in y.saturating_sub(1)..(y + 2).min(height) {
                for column in x.saturating_sub(1)..(x + 2).min(width) {
                    let neighbour = row * width + column;
                    if filled[neighbour] {
                        sum += values[neighbour];
                        count += 1;
                    }
                }
            }
            if count > 0 {
                ring.push((index, sum / count as f32));
            }
        }
        if ring.is_empty() {
            return;
        }
        for (index, value) in ring {
            values[index] = value;
            filled[index] = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn covered_texels_keep_their_value_and_the_rest_is_filled_to_its_radius() {
        let (width, height) = (16_usize, 12_usize);
        let mut coverage = vec![0.0; width * height];
        let mut values = vec![Vec3::splat(-1.0); width * height];
        // A black texel and a bright one, side by side.
        for (x, value) in [(4, 0.0), (5, 8.0)] {
            coverage[5 * width + x] = 0.5;
            values[5 * width + x] = Vec3::splat(value);
        }
        dilate(&mut values, &coverage, [width as u32, height as u32]);
        assert_eq!(values[5 * width + 4], Vec3::ZERO);
        assert_eq!(values[5 * width + 5], Vec3::splat(8.0));
        assert_eq!(values[4 * width + 3], Vec3::ZERO, "a black neighbour is a neighbour");
        assert_eq!(values[4 * width + 4], Vec3::splat(4.0));
        for y in 0..height {
            for x in 0..width {
                let distance = y.abs_diff(5).max(if x < 4 { 4 - x } else { x.saturating_sub(5) });
                let filled = values[y * width + x] != Vec3::splat(-1.0);
                assert_eq!(filled, distance <= PASSES as usize, "{x} {y}");
            }
        }
    }
}
