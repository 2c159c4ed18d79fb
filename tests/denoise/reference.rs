//! Long bakes, kept as pictures: `R,G,B` and the standard error of their luminance, `E`.

use bevy_kiln::bake::Page;
use exr::prelude::{
    Encoding, Image, Layer, LayerAttributes, ReadChannels, ReadLayers, SpecificChannels, Vec2, WritableImage, read,
};
use glam::Vec3;
use std::path::{Path, PathBuf};

/// A long bake [cd/m²].
#[derive(Default)]
pub struct Reference {
    pub value: Vec<Vec3>,
    /// Standard error of the luminance.
    pub stderr: Vec<f64>,
}

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(format!("denoise_{name}.exr"))
}

pub fn load(name: &str) -> Reference {
    let path = file(name);
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(&path)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let channel = |name: &str| -> Vec<f32> {
        let found = image.layer_data.channel_data.list.iter().find(|channel| channel.name.to_string() == name);
        found
            .unwrap_or_else(|| panic!("{} has no channel {name}", path.display()))
            .sample_data
            .values_as_f32()
            .collect()
    };
    let [red, green, blue] = ["R", "G", "B"].map(channel);
    let value = red.iter().zip(&green).zip(&blue).map(|((r, g), b)| Vec3::new(*r, *g, *b)).collect();
    Reference { value, stderr: channel("E").into_iter().map(f64::from).collect() }
}

pub fn save(name: &str, page: &Page) {
    let width = page.width as usize;
    let channels = SpecificChannels::build()
        .with_channel::<f32>("R")
        .with_channel::<f32>("G")
        .with_channel::<f32>("B")
        .with_channel::<f32>("E")
        .with_pixel_fn(|Vec2(x, y)| {
            let index = y * width + x;
            let [red, green, blue] = page.raw[index].to_array();
            (red, green, blue, page.stderr[index].dot(Vec3::new(0.2126, 0.7152, 0.0722)))
        });
    let size = (width, page.height as usize);
    let layer = Layer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
    Image::from_layer(layer).write().to_file(file(name)).unwrap();
}
