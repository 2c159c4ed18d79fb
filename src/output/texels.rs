//! A page as the bytes of one texture level.
//!
//! It owns what happens to a value that the format cannot hold: what is not a number or below zero becomes zero,
//! what is too large becomes the largest, and every texel so changed is counted.

use super::format::TexelFormat;
use super::rgb9e5;
use crate::bake::Page;
use glam::Vec3;
use half::f16;

/// Bytes, and how many texels had to be changed to fit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Encoded {
    /// The bytes.
    pub bytes: Vec<u8>,
    /// Texels with a value that was not finite, below zero, or beyond [`TexelFormat::limit`].
    pub clamped: u64,
}

/// The texels of a page as a texture's level 0: row by row, row 0 at v = 0, little-endian, without padding;
/// `width × height × `[`bytes_per_texel`](TexelFormat::bytes_per_texel) bytes. Texels that the page's layers do not
/// reach are black.
pub fn texel_bytes(page: &Page, format: TexelFormat) -> Encoded {
    let count = page.width as usize * page.height as usize;
    let mut encoded = Encoded { bytes: Vec::with_capacity(count * format.bytes_per_texel()), clamped: 0 };
    for index in 0..count {
        let radiance = page.radiance.get(index).copied().unwrap_or(Vec3::ZERO);
        let coverage = page.coverage.get(index).copied().unwrap_or(0.0);
        let colour = radiance.to_array().map(|channel| clamp(channel, format.limit()));
        let alpha = clamp(coverage, 1.0);
        let fits = match format {
            TexelFormat::Rgb9e5 => {
                encoded.bytes.extend(rgb9e5::encode(colour).to_le_bytes());
                colour == radiance.to_array()
            }
            TexelFormat::Rgba16f => {
                let [red, green, blue] = colour;
                for channel in [red, green, blue, alpha] {
                    encoded.bytes.extend(f16::from_f32(channel).to_le_bytes());
                }
                colour == radiance.to_array() && alpha == coverage
            }
        };
        encoded.clamped += u64::from(!fits);
    }
    encoded
}

/// The nearest value in [0, limit]; zero for what is not a number.
pub(super) fn clamp(value: f32, limit: f32) -> f32 {
    // `max` takes the number where the other is none; adding zero turns −0 into 0.
    value.max(0.0).min(limit) + 0.0
}

#[cfg(test)]
mod tests {
    use super::super::test_pages::{page, strange_page};
    use super::*;

    fn halves(bytes: &[u8]) -> Vec<f32> {
        bytes.chunks_exact(2).map(|half| f16::from_le_bytes([half[0], half[1]]).to_f32()).collect()
    }

    #[test]
    fn half_floats_hold_radiance_and_coverage() {
        let page = page(5, 4);
        let encoded = texel_bytes(&page, TexelFormat::Rgba16f);
        assert_eq!(encoded.clamped, 0);
        assert_eq!(encoded.bytes.len(), 5 * 4 * 8);
        let expected: Vec<f32> = page
            .radiance
            .iter()
            .zip(&page.coverage)
            .flat_map(|(radiance, &coverage)| [radiance.x, radiance.y, radiance.z, coverage])
            .map(|value| f16::from_f32(value).to_f32())
            .collect();
        assert_eq!(halves(&encoded.bytes), expected);
    }

    #[test]
    fn a_black_texel_that_is_covered_stays_black_and_covered() {
        let mut page = page(2, 2);
        page.radiance[1] = Vec3::ZERO;
        page.coverage[1] = 1.0;
        let bytes = texel_bytes(&page, TexelFormat::Rgba16f).bytes;
        assert_eq!(halves(&bytes[8..16]), [0.0, 0.0, 0.0, 1.0]);
        assert_eq!(texel_bytes(&page, TexelFormat::Rgb9e5).bytes[4..8], [0; 4]);
    }

    #[test]
    fn what_does_not_fit_is_clamped_and_counted() {
        let page = strange_page();
        let half = texel_bytes(&page, TexelFormat::Rgba16f);
        assert_eq!(half.clamped, 5);
        let values = halves(&half.bytes);
        assert_eq!(values[0..4], [0.0, 1.0, 2.0, 1.0], "not a number");
        assert_eq!(values[4..8], [65504.0, 0.0, 0.0, 1.0], "infinite");
        assert_eq!(values[8..12], [1.0, 0.0, 1.0, 1.0], "negative");
        assert_eq!(values[12..16], [65504.0, 65504.0, 65504.0, 1.0], "1e9");
        assert_eq!(values[16..20], [1.0, 2.0, 3.0, 0.0], "coverage that is not a number");
        assert!(values.iter().all(|value| value.is_finite()));

        let shared = texel_bytes(&page, TexelFormat::Rgb9e5);
        assert_eq!(shared.clamped, 4, "it does not store coverage");
        assert_eq!(shared.bytes[12..16], [0xff; 4]);
    }

    #[test]
    fn the_limits_themselves_fit() {
        for format in [TexelFormat::Rgb9e5, TexelFormat::Rgba16f] {
            let mut page = page(2, 2);
            page.radiance.fill(Vec3::splat(format.limit()));
            page.radiance[3] = Vec3::splat(-0.0);
            assert_eq!(texel_bytes(&page, format).clamped, 0);
            page.radiance[2].z = format.limit().next_up();
            assert_eq!(texel_bytes(&page, format).clamped, 1);
        }
    }

    #[test]
    fn missing_texels_are_black() {
        let mut page = page(2, 2);
        page.radiance.truncate(1);
        page.coverage.clear();
        let encoded = texel_bytes(&page, TexelFormat::Rgb9e5);
        assert_eq!(encoded.bytes.len(), 16);
        assert_eq!(encoded.bytes[4..], [0; 12]);
    }
}
