//! Filling the texels beside the charts, which texture filtering also reads.
//!
//! Each pass gives every empty texel that touches a filled one the mean of its filled neighbours. Covered texels are
//! read and never written. Whether a texel is filled is kept apart from its colour: black is a value like any other.

use super::Field;
use glam::Vec3;

/// Passes: bicubic filtering reads two texels beyond a chart, and block compression mixes four.
const PASSES: u32 = 4;

/// Fills up to [`PASSES`] rings of texels around the measured ones, in place.
pub(super) fn dilate(field: &mut Field) {
    let mut filled: Vec<bool> = (0..field.value.len()).map(|index| field.is_measured(index)).collect();
    for _ in 0..PASSES {
        let mut ring = Vec::new();
        for index in (0..filled.len()).filter(|&index| !filled[index]) {
            let mut sum = Vec3::ZERO;
            let mut count = 0;
            let steps = (-1..=1).flat_map(|y| (-1..=1).map(move |x| [x, y]));
            for neighbour in steps.filter_map(|step| field.step(index, step)).filter(|&neighbour| filled[neighbour]) {
                sum += field.value[neighbour];
                count += 1;
            }
            if count > 0 {
                ring.push((index, sum / count as f32));
            }
        }
        if ring.is_empty() {
            return;
        }
        for (index, value) in ring {
            field.value[index] = value;
            filled[index] = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bake::repair::TexelState;

    #[test]
    fn covered_texels_keep_their_value_and_the_rest_is_filled_to_its_radius() {
        let (width, height) = (16_usize, 12_usize);
        let mut field = Field::empty([width as u32, height as u32]);
        field.value.fill(Vec3::splat(-1.0));
        // A black texel and a bright one, side by side.
        for (x, value) in [(4, 0.0), (5, 8.0)] {
            field.state[5 * width + x] = TexelState::Measured;
            field.value[5 * width + x] = Vec3::splat(value);
        }
        dilate(&mut field);
        let values = field.value;
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
