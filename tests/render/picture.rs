//! Pictures as a screen shows them, in linear light: 1 is white.

use bevy_kiln::bake::Picture;
use bevy_kiln::math::exposure_from_ev100;
use glam::DVec3;
use image::{Rgb, RgbImage};
use std::path::Path;

/// Row 0 on top.
#[derive(Clone)]
pub struct Shown {
    pub width: usize,
    pub height: usize,
    pub linear: Vec<DVec3>,
}

impl Shown {
    /// What is in a file, with the sRGB curve undone.
    pub fn from_file(path: &Path) -> Self {
        let picture = image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_rgb8();
        let linear = picture.pixels().map(|pixel| DVec3::from(pixel.0.map(|byte| linear(f64::from(byte) / 255.0))));
        Self { width: picture.width() as usize, height: picture.height() as usize, linear: linear.collect() }
    }

    /// What a camera at an exposure value makes of radiance.
    pub fn exposed(picture: &Picture, ev100: f64) -> Self {
        let exposure = exposure_from_ev100(ev100);
        let linear = picture.radiance.iter().map(|radiance| radiance.as_dvec3() * exposure).collect();
        Self { width: picture.width as usize, height: picture.height as usize, linear }
    }

    /// Each pixel after `change`.
    pub fn map(&self, change: impl Fn(usize, DVec3) -> DVec3) -> Self {
        let linear = self.linear.iter().enumerate().map(|(pixel, &value)| change(pixel, value)).collect();
        Self { linear, ..*self }
    }

    /// Writes it for a person to look at.
    pub fn save(&self, path: &Path) {
        let mut picture = RgbImage::new(self.width as u32, self.height as u32);
        for (pixel, value) in picture.pixels_mut().zip(&self.linear) {
            *pixel = Rgb(value.to_array().map(|v| (255.0 * encoded(v.clamp(0.0, 1.0))).round() as u8));
        }
        picture.save(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
}

/// IEC 61966-2-1.
fn linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

fn encoded(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[test]
fn the_curve_is_undone() {
    for byte in 0..=255 {
        let value = f64::from(byte) / 255.0;
        assert!((encoded(linear(value)) - value).abs() < 1e-6, "{byte}");
    }
    assert!((linear(0.5) - 0.214_041).abs() < 1e-6);
}
