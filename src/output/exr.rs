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

/// Every layer of a page, which must be as long as the page has texels: `R,G,B` after repair, `A` coverage, `raw` and
/// `stderr` [cd/m²], and of what was measured the half-width `interval.Y` of the 95 % interval of luminance [cd/m²],
/// `cost.samples` (paths) and `cost.rays`; row 0 at v = 0.
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
        .with_channel::<f32>("interval.Y")
        .with_channel::<f32>("cost.samples")
        .with_channel::<f32>("cost.rays")
        .with_pixel_fn(|Vec2(x, y)| {
            let index = y * width + x;
            let half_width = page.half_width.get(index).map_or(0.0, |&width| clamp(width, f32::MAX));
            let samples = page.samples.get(index).map_or(0.0, |&samples| samples as f32);
            let rays = page.rays.get(index).map_or(0.0, |&rays| rays as f32);
            let [red, green, blue] = finite_radiance(page.radiance[index]).to_array();
            let [raw_red, raw_green, raw_blue] = finite_radiance(page.raw[index]).to_array();
            let [stderr_red, stderr_green, stderr_blue] = finite_stderr(page.stderr[index]).to_array();
            let alpha = clamp(page.coverage[index], 1.0);
            (
                red,
                green,
                blue,
                alpha,
                raw_red,
                raw_green,
                raw_blue,
                stderr_red,
                stderr_green,
                stderr_blue,
                half_width,
                samples,
                rays,
            )
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

#[cfg(test)]
mod tests {
    use super::super::test_pages::{page, strange_page};
    use super::*;
    use crate::bake::BakeReport;
    use exr::prelude::{ReadChannels, ReadLayers, read, read_first_rgba_layer_from_file};
    use std::collections::BTreeMap;
    use std::io::Cursor;

    fn bytes(write: impl FnOnce(&mut Cursor<Vec<u8>>) -> io::Result<()>) -> Vec<u8> {
        let mut to = Cursor::new(Vec::new());
        write(&mut to).expect("written");
        to.into_inner()
    }

    /// Every channel of a file by name, and the size of the only part.
    fn channels(file: Vec<u8>) -> (Vec2<usize>, BTreeMap<String, Vec<f32>>) {
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .from_buffered(Cursor::new(file))
            .expect("an EXR file");
        assert_eq!(image.layer_data.len(), 1);
        let layer = &image.layer_data[0];
        assert_eq!(layer.encoding.compression, Compression::ZIP16);
        let values = |channel: &exr::prelude::AnyChannel<exr::prelude::FlatSamples>| {
            (channel.name.to_string(), channel.sample_data.values_as_f32().collect())
        };
        (layer.size, layer.channel_data.list.iter().map(values).collect())
    }

    fn layer(channels: &BTreeMap<String, Vec<f32>>, prefix: &str) -> Vec<Vec3> {
        let [red, green, blue] = ["R", "G", "B"].map(|channel| &channels[&format!("{prefix}{channel}")]);
        (0..red.len()).map(|index| Vec3::new(red[index], green[index], blue[index])).collect()
    }

    #[test]
    fn a_page_comes_back_exactly() {
        let plain = page(7, 35);
        let counts = || (0..7 * 35).map(|index| index * index);
        let page = Page {
            half_width: counts().map(|count| 0.01 * count as f32).collect(),
            samples: counts().collect(),
            rays: counts().map(|count| 9 * u64::from(count)).collect(),
            ..plain
        };
        let (size, channels) = channels(bytes(|to| write_page(&page, to)));
        assert_eq!(size, Vec2(7, 35));
        assert_eq!(channels.len(), 13);
        assert_eq!(channels["interval.Y"], page.half_width);
        assert!(channels["cost.samples"].iter().zip(&page.samples).all(|(a, b)| *a == *b as f32));
        assert!(channels["cost.rays"].iter().zip(&page.rays).all(|(a, b)| *a == *b as f32));
        assert_eq!(layer(&channels, ""), page.radiance);
        assert_eq!(layer(&channels, "raw."), page.raw);
        assert_eq!(layer(&channels, "stderr."), page.stderr);
        assert_eq!(channels["A"], page.coverage);
        assert_eq!(count_clamped(&page), 0);
    }

    #[test]
    fn a_reader_of_plain_pictures_sees_the_repaired_layer() {
        let folder = temp_dir::TempDir::new().unwrap();
        let path = folder.path().join("page.exr");
        let page = page(5, 4);
        std::fs::write(&path, bytes(|to| write_page(&page, to))).unwrap();
        let image = read_first_rgba_layer_from_file(
            &path,
            |size, _| vec![[0.0_f32; 4]; size.area()],
            |pixels, Vec2(x, y), (red, green, blue, alpha): (f32, f32, f32, f32)| {
                pixels[y * 5 + x] = [red, green, blue, alpha];
            },
        )
        .expect("a plain picture");
        let expected: Vec<[f32; 4]> =
            page.radiance.iter().zip(&page.coverage).map(|(colour, &alpha)| colour.extend(alpha).to_array()).collect();
        assert_eq!(image.layer_data.channel_data.pixels, expected);
    }

    #[test]
    fn bytes_do_not_depend_on_threads() {
        let page = page(200, 150);
        let first = bytes(|to| write_page(&page, to));
        let single = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert_eq!(single.install(|| bytes(|to| write_page(&page, to))), first);
    }

    #[test]
    fn nothing_is_written_that_is_no_number() {
        let mut page = strange_page();
        page.raw[8].y = f32::NEG_INFINITY;
        page.stderr[9] = Vec3::new(f32::NAN, f32::INFINITY, 0.5);
        // Not a number, infinite, negative, coverage, raw, stderr; 1e9 fits.
        assert_eq!(count_clamped(&page), 6);
        let (_, channels) = channels(bytes(|to| write_page(&page, to)));
        assert!(channels.values().flatten().all(|value| value.is_finite() && *value >= 0.0));
        assert_eq!(layer(&channels, "")[0], Vec3::new(0.0, 1.0, 2.0));
        assert_eq!(layer(&channels, "")[3], Vec3::splat(1e9));
        assert_eq!(layer(&channels, "stderr.")[9], Vec3::new(f32::MAX, f32::MAX, 0.5));
    }

    #[test]
    fn a_picture_comes_back_exactly() {
        let Page { width, height, radiance, stderr, .. } = page(6, 4);
        let picture = Picture { width, height, radiance, stderr, report: BakeReport::default() };
        let (_, channels) = channels(bytes(|to| write_picture(&picture, to)));
        assert_eq!(channels.len(), 6);
        assert_eq!(layer(&channels, ""), picture.radiance);
        assert_eq!(layer(&channels, "stderr."), picture.stderr);
    }
}
