//! What a linear Rec. 709 colour weighs as light.

use glam::DVec3;

/// The luminance of a linear Rec. 709 colour (a `Vec3` or a `DVec3`), in the colour's own unit (ITU-R BT.709-6, item
/// 3.2).
#[inline]
pub fn luminance(colour: impl Into<DVec3>) -> f64 {
    colour.into().dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_one_and_green_weighs_most() {
        assert!((luminance(DVec3::ONE) - 1.0).abs() < 1e-15);
        let weights = [(DVec3::X, 0.2126), (DVec3::Y, 0.7152), (DVec3::Z, 0.0722)];
        for (colour, weight) in weights {
            assert_eq!(luminance(colour), weight);
            assert_eq!(luminance(colour.as_vec3()), weight);
        }
    }
}
