//! A page as the bytes of one texture level.
//!
//! It owns what happens to a value that the format cannot hold: what is not a number or below zero becomes zero,
//! what is too large becomes the largest, and every texel so changed is counted.

use super::format::TexelFormat;
use super::{bc6h, rgb9e5};
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
/// [`bytes_per_texel`](TexelFormat::bytes_per_texel) bytes for each texel of the
/// [`stored_size`](TexelFormat::stored_size). Texels that the page's layers do not reach are black; those that fill
/// up the blocks of a compressed format repeat the last ones.
pub fn texel_bytes(page: &Page, format: TexelFormat) -> Encoded {
    let colours = stored_colours(page, format);
    let bytes = match format {
        TexelFormat::Rgb9e5 => colours.flat_map(|colour| rgb9e5::encode(colour).to_le_bytes()).collect(),
        TexelFormat::Rgba16f => {
            let texels = colours.zip(coverages(page)).map(|([red, green, blue], coverage)| {
                [red, green, blue, clamp(coverage, 1.0)].map(|value| f16::from_f32(value).to_le_bytes())
            });
            texels.collect::<Vec<_>>().into_flattened().into_flattened()
        }
        TexelFormat::Bc6h => {
            let [width, height] = format.stored_size(page);
            let colours: Vec<[f32; 3]> = colours.collect();
            let at =
                |x: u32, y: u32| y.min(page.height - 1) as usize * page.width as usize + x.min(page.width - 1) as usize;
            let filled: Vec<[f32; 3]> =
                (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| colours[at(x, y)]).collect();
            bc6h::encode(&filled, width)
        }
    };
    Encoded { bytes, clamped: clamped(page, format) }
}

/// Texels that the format cannot hold as they are.
fn clamped(page: &Page, format: TexelFormat) -> u64 {
    let texels = radiances(page).zip(stored_colours(page, format)).zip(coverages(page));
    let changed = texels.filter(|((radiance, colour), coverage)| {
        let coverage_fits = match format {
            TexelFormat::Rgb9e5 | TexelFormat::Bc6h => true,
            TexelFormat::Rgba16f => clamp(*coverage, 1.0) == *coverage,
        };
        *colour != radiance.to_array() || !coverage_fits
    });
    changed.count() as u64
}

/// The colours of a page as the format can hold them, before it rounds them.
pub(super) fn stored_colours(page: &Page, format: TexelFormat) -> impl Iterator<Item = [f32; 3]> {
    radiances(page).map(move |radiance| radiance.to_array().map(|channel| clamp(channel, format.limit())))
}

/// The radiance of every texel of a page.
fn radiances(page: &Page) -> impl Iterator<Item = Vec3> {
    let count = page.width as usize * page.height as usize;
    (0..count).map(|index| page.radiance.get(index).copied().unwrap_or(Vec3::ZERO))
}

fn coverages(page: &Page) -> impl Iterator<Item = f32> {
    (0..).map(|index: usize| page.coverage.get(index).copied().unwrap_or(0.0))
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
        for format in [TexelFormat::Rgb9e5, TexelFormat::Rgba16f, TexelFormat::Bc6h] {
            let mut page = page(2, 2);
            page.radiance.fill(Vec3::splat(format.limit()));
            page.radiance[3] = Vec3::splat(-0.0);
            assert_eq!(texel_bytes(&page, format).clamped, 0);
            page.radiance[2].z = format.limit().next_up();
            assert_eq!(texel_bytes(&page, format).clamped, 1);
        }
    }

    #[test]
    fn blocks_are_filled_up_with_the_last_row_and_column() {
        let mut page = page(5, 3);
        for (index, colour) in page.radiance.iter_mut().enumerate() {
            *colour = Vec3::splat(if index % 5 == 4 { 8.0 } else { 1.0 });
        }
        let encoded = texel_bytes(&page, TexelFormat::Bc6h);
        assert_eq!(TexelFormat::Bc6h.stored_size(&page), [8, 4]);
        assert_eq!(encoded.bytes.len(), 8 * 4);
        for (index, colour) in bc6h::decode(&encoded.bytes, 8).iter().enumerate() {
            let wanted = if index % 8 >= 4 { 8.0 } else { 1.0 };
            assert!((colour[0] - wanted).abs() < 0.01 * wanted, "{index}: {colour:?}");
        }
        let empty = texel_bytes(&Page { width: 0, height: 0, ..page }, TexelFormat::Bc6h);
        assert_eq!(empty, Encoded { bytes: vec![], clamped: 0 });
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
