//! Eight-bit pictures for a person to look at: exposed, through a tone curve or clipped, sRGB. Nothing is measured on
//! them.

use super::texels::clamp;
use super::tone::{Look, ToneCurve};
use crate::bake::{Page, Picture};
use crate::math::Portable;
use glam::Vec3;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageError};
use std::io::{self, Write};

/// Rec. 709 weights of luminance.
const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// The share of covered texels that a preview shows unclipped.
const PREVIEW_SHARE: f64 = 0.99;

/// A page, exposed by itself so that 99 % of its covered texels are not clipped; what no triangle covers is black.
pub(super) fn write_preview(page: &Page, to: impl Write) -> io::Result<()> {
    let exposure = preview_exposure(page);
    let pixels = page.radiance.iter().zip(&page.coverage).flat_map(|(&radiance, &coverage)| {
        let shown = if coverage > 0.0 { radiance } else { Vec3::ZERO };
        pixel(shown, exposure, ToneCurve::Clip)
    });
    write_rgb(page.width, page.height, pixels.collect(), to)
}

/// A picture as a camera shows it.
pub(super) fn write_picture(picture: &Picture, look: Look, to: impl Write) -> io::Result<()> {
    // Twice the precision: an exposure value far from a camera's own must not overflow.
    let exposure = 1.0 / (1.2 * Portable::exp2(f64::from(look.ev100)));
    let pixels = picture.radiance.iter().flat_map(|&radiance| pixel(radiance, exposure, look.tone));
    write_rgb(picture.width, picture.height, pixels.collect(), to)
}

/// What a preview multiplies radiance by [m²/cd].
fn preview_exposure(page: &Page) -> f64 {
    let covered = page.radiance.iter().zip(&page.coverage).filter(|(_, coverage)| **coverage > 0.0);
    let mut luminances: Vec<f32> =
        covered.map(|(radiance, _)| radiance.dot(LUMINANCE)).filter(|luminance| luminance.is_finite()).collect();
    if luminances.is_empty() {
        return 0.0;
    }
    let rank = (luminances.len() as f64 * PREVIEW_SHARE).ceil() as usize - 1;
    let (_, white, _) = luminances.select_nth_unstable_by(rank, f32::total_cmp);
    // A page that is dark but for a few texels is shown by its brightest.
    let white = if *white > 0.0 { *white } else { luminances.iter().fold(0.0, |a: f32, &b| a.max(b)) };
    if white > 0.0 { 1.0 / f64::from(white) } else { 0.0 }
}

/// A pixel of a radiance.
pub(super) fn pixel(radiance: Vec3, exposure: f64, tone: ToneCurve) -> [u8; 3] {
    let exposed = radiance.to_array().map(|channel| (f64::from(clamp(channel, f32::MAX)) * exposure) as f32);
    tone.apply(Vec3::from_array(exposed)).to_array().map(to_srgb)
}

/// The eight-bit code of a linear value, clipped to [0, 1] (IEC 61966-2-1:1999).
fn to_srgb(linear: f32) -> u8 {
    let linear = clamp(linear, 1.0);
    let encoded =
        if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * Portable::powf(linear, 1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}

/// Eight bits of red, green and blue, row by row.
pub(super) fn write_rgb(width: u32, height: u32, pixels: Vec<u8>, to: impl Write) -> io::Result<()> {
    PngEncoder::new(to).write_image(&pixels, width, height, ExtendedColorType::Rgb8).map_err(|error| match error {
        ImageError::IoError(error) => error,
        other => io::Error::other(other.to_string()),
    })
}

#[cfg(test)]
mod tests {
    use super::super::test_pages::{page, strange_page};
    use super::*;
    use crate::bake::BakeReport;

    fn decode(png: &[u8]) -> (u32, u32, Vec<[u8; 3]>) {
        let picture = image::load_from_memory_with_format(png, image::ImageFormat::Png).expect("a PNG file");
        let picture = picture.as_rgb8().expect("eight bits of red, green and blue").clone();
        (picture.width(), picture.height(), picture.pixels().map(|pixel| pixel.0).collect())
    }

    fn preview(page: &Page) -> Vec<[u8; 3]> {
        let mut png = Vec::new();
        write_preview(page, &mut png).unwrap();
        let (width, height, pixels) = decode(&png);
        assert_eq!((width, height), (page.width, page.height));
        pixels
    }

    /// The inverse of the standard's curve, at codes on both of its pieces.
    #[test]
    fn codes_are_those_of_the_standard() {
        for code in 0..=255_u8 {
            let encoded = f64::from(code) / 255.0;
            let linear = if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) };
            assert_eq!(to_srgb(linear as f32), code);
        }
        let known = [(0.5, 188), (0.18, 118), (0.003, 10), (-1.0, 0), (7.0, 255), (f32::NAN, 0)];
        for (linear, code) in known {
            assert_eq!(to_srgb(linear), code, "{linear}");
        }
    }

    #[test]
    fn a_picture_is_exposed_as_bevy_does() {
        let radiance = vec![Vec3::splat(1.2), Vec3::new(0.6, 0.0, 100.0), Vec3::NAN, Vec3::splat(0.0012)];
        let stderr = vec![Vec3::ZERO; 4];
        let mut picture = Picture { width: 4, height: 1, radiance, stderr, report: BakeReport::default() };
        let exposed = |picture: &Picture, ev100: f32| {
            let mut png = Vec::new();
            write_picture(picture, Look { ev100, tone: ToneCurve::Clip }, &mut png).unwrap();
            decode(&png).2
        };
        assert_eq!(exposed(&picture, 0.0), [[255; 3], [188, 0, 255], [0; 3], [3; 3]]);
        picture.radiance.iter_mut().for_each(|radiance| *radiance *= 2.0_f32.powf(9.7));
        assert_eq!(exposed(&picture, 9.7), [[255; 3], [188, 0, 255], [0; 3], [3; 3]]);
        assert_eq!(exposed(&picture, 1000.0), [[0; 3]; 4]);
    }

    #[test]
    fn a_preview_shows_what_is_covered_at_any_brightness() {
        for scale in [1e-4, 1.0, 1e4] {
            let mut page = page(20, 20);
            page.radiance.iter_mut().for_each(|radiance| *radiance = Vec3::splat(scale));
            page.radiance[0] = Vec3::splat(scale * 1000.0);
            page.radiance[1] = Vec3::splat(scale * 0.5);
            page.radiance[19] = Vec3::splat(scale * 1e6);
            let pixels = preview(&page);
            assert_eq!(pixels[0..4], [[255; 3], [188; 3], [255; 3], [255; 3]]);
            assert_eq!(pixels[19], [0; 3], "dilated or empty");
        }
    }

    #[test]
    fn a_preview_is_made_of_any_page() {
        let mut dark = page(8, 8);
        dark.radiance.fill(Vec3::ZERO);
        assert!(preview(&dark).iter().all(|pixel| *pixel == [0; 3]));
        // One lit texel in two hundred lies above the percentile.
        let mut nearly_dark = page(20, 20);
        nearly_dark.radiance.fill(Vec3::ZERO);
        nearly_dark.radiance[5] = Vec3::splat(3.0);
        assert_eq!(preview(&nearly_dark)[5], [255; 3]);
        let mut empty = page(4, 4);
        empty.coverage.fill(0.0);
        assert!(preview(&empty).iter().all(|pixel| *pixel == [0; 3]));
        assert_eq!(preview(&strange_page())[3], [255; 3]);
    }
}
