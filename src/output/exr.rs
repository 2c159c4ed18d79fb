//! OpenEXR files of 32-bit floats, for measuring and comparing.
//!
//! One part, losslessly compressed, whose further layers are channels named `layer.channel`, as every reader
//! knows them: the plain channels open anywhere as the picture itself.

use super::texels::clamp;
use crate::bake::{Page, Picture};
use exr::prelude::{
    Blocks, Compression, Encoding, Image, Layer, LayerAttributes, LineOrder, SpecificChannels, Text, Vec2,
    WritableImage,
};
use glam::Vec3;
use std::io::{self, Seek, Write};

/// Every layer of a page: `R,G,B` after repair, `A` coverage, `raw` and `stderr`; row 0 at v = 0 [cd/m²].
pub(super) fn write_page(page: &Page, to: impl Write + Seek) -> io::Result<()> {
    let width = page.width as usize;
    let channels = SpecificChannels::build()
        .with_channel::<f32>("R")
        .with_channel::<f32>("G")
        .with_channel::<f32>("B")
        .with_channel::<f32>("A")
        .with_channel::<f32>("raw.R")
        .with_channel::<f32>("raw.G")
        .with_channel::<f32>("raw.B")
        .with_channel::<f32>("stderr.R")
        .with_channel::<f32>("stderr.G")
        .with_channel::<f32>("stderr.B")
        .with_pixel_fn(|Vec2(x, y)| {
            let index = y * width + x;
            let [red, green, blue] = finite_radiance(page.radiance[index]).to_array();
            let [raw_red, raw_green, raw_blue] = finite_radiance(page.raw[index]).to_array();
            let [stderr_red, stderr_green, stderr_blue] = finite_stderr(page.stderr[index]).to_array();
            let alpha = clamp(page.coverage[index], 1.0);
            (red, green, blue, alpha, raw_red, raw_green, raw_blue, stderr_red, stderr_green, stderr_blue)
        });
    let layer = Layer::new((width, page.height as usize), attributes("E/pi [cd/m^2]"), encoding(), channels);
    Image::from_layer(layer).write().to_buffered(to).map_err(io_error)
}

/// A picture: `R,G,B` radiance and `stderr`; row 0 on top [cd/m²].
pub(super) fn write_picture(picture: &Picture, to: impl Write + Seek) -> io::Result<()> {
    let width = picture.width as usize;
    let channels = SpecificChannels::build()
        .with_channel::<f32>("R")
        .with_channel::<f32>("G")
        .with_channel::<f32>("B")
        .with_channel::<f32>("stderr.R")
        .with_channel::<f32>("stderr.G")
        .with_channel::<f32>("stderr.B")
        .with_pixel_fn(|Vec2(x, y)| {
            let index = y * width + x;
            let [red, green, blue] = finite_radiance(picture.radiance[index]).to_array();
            let [stderr_red, stderr_green, stderr_blue] = finite_stderr(picture.stderr[index]).to_array();
            (red, green, blue, stderr_red, stderr_green, stderr_blue)
        });
    let layer = Layer::new((width, picture.height as usize), attributes("radiance [cd/m^2]"), encoding(), channels);
    Image::from_layer(layer).write().to_buffered(to).map_err(io_error)
}

/// Texels of a page that [`write_page`] cannot store as they are.
pub(super) fn count_clamped(page: &Page) -> u64 {
    let changed = |index: usize| {
        finite_radiance(page.radiance[index]) != page.radiance[index]
            || finite_radiance(page.raw[index]) != page.raw[index]
            || finite_stderr(page.stderr[index]) != page.stderr[index]
            || clamp(page.coverage[index], 1.0) != page.coverage[index]
    };
    (0..page.radiance.len()).filter(|&index| changed(index)).count() as u64
}

/// Radiance that tools can work with: finite and not negative.
fn finite_radiance(value: Vec3) -> Vec3 {
    Vec3::from(value.to_array().map(|channel| clamp(channel, f32::MAX)))
}

/// A standard error that tools can work with. What is not a number is not known, so it becomes the largest: zero
/// would claim that the value beside it is exact.
fn finite_stderr(value: Vec3) -> Vec3 {
    Vec3::from(value.to_array().map(|channel| if channel.is_nan() { f32::MAX } else { clamp(channel, f32::MAX) }))
}

fn attributes(unit: &str) -> LayerAttributes {
    LayerAttributes {
        comments: Some(Text::from(unit)),
        software_name: Some(Text::from(concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION")))),
        ..LayerAttributes::default()
    }
}

/// Lossless, in blocks of rows from the first to the last, so that the bytes do not depend on threads.
fn encoding() -> Encoding {
    Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing }
}

fn io_error(error: exr::error::Error) -> io::Error {
    match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}
