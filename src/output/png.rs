//! Eight-bit pictures for a person to look at: exposed, clipped, sRGB. Nothing is measured on them, so there is no
//! tone curve beside the exposure.

use super::texels::clamp;
use crate::bake::{Page, Picture};
use glam::Vec3;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageError};
use std::io::{self, Write};

/// Rec. 709 weights of luminance.
const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// The share of covered texels that a preview shows unclipped.
const PREVIEW_SHARE: f64 = 0.99;

/// A page, exposed so that 99 % of its covered texels are not clipped; what no triangle covers is black.
pub(super) fn write_preview(page: &Page, to: impl Write) -> io::Result<()> {
    let exposure = preview_exposure(page);
    let pixels = page.radiance.iter().zip(&page.coverage).flat_map(|(&radiance, &coverage)| {
        let shown = if coverage > 0.0 { radiance } else { Vec3::ZERO };
        pixel(shown, exposure)
    });
    write_rgb(page.width, page.height, pixels.collect(), to)
}

/// A picture as a camera at this exposure value shows it: 1 is 1.2 · 2^EV100 cd/m² (Lagarde and de Rousiers 2014,
/// Moving Frostbite to Physically Based Rendering, section 5.1.2), as in Bevy.
pub(super) fn write_picture(picture: &Picture, ev100: f32, to: impl Write) -> io::Result<()> {
    // Twice the precision: an exposure value far from a camera's own must not overflow.
    let exposure = 1.0 / (1.2 * 2.0_f64.powf(f64::from(ev100)));
    let pixels = picture.radiance.iter().flat_map(|&radiance| pixel(radiance, exposure));
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
fn pixel(radiance: Vec3, exposure: f64) -> [u8; 3] {
    radiance.to_array().map(|channel| to_srgb((f64::from(clamp(channel, f32::MAX)) * exposure) as f32))
}

/// The eight-bit code of a linear value, clipped to [0, 1] (IEC 61966-2-1:1999).
fn to_srgb(linear: f32) -> u8 {
    let linear = clamp(linear, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}

fn write_rgb(width: u32, height: u32, pixels: Vec<u8>, to: impl Write) -> io::Result<()> {
    PngEncoder::new(to).write_image(&pixels, width, height, ExtendedColorType::Rgb8).map_err(|error| match error {
        ImageError::IoError(error) => error,
        other => io::Error::other(other.to_string()),
    })
}
