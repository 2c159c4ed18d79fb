//! A small museum: sun through windows, coloured glass, rectangular lights, metal, a plant, a red wall. Press B to bake;
//! then drag the line between the scene as Bevy shows it by itself and the same in baked light.
//!
//! ```text
//! cargo run --features full --example gallery
//! ```
//!
//! All but its lights and the line is in `examples/common`.

#[path = "../common/mod.rs"]
mod common;
mod lamps;
mod reflections;
mod slider;

use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use bevy_kiln::prelude::BakeVolumes;
use common::Stage;

const STAGE: Stage = Stage {
    name: "gallery",
    file: "scenes/gallery.glb",
    distance: 4.6,
    sky: [3000.0, 3800.0, 5000.0],
    background: Color::srgb(0.86, 0.93, 1.0),
    ev100: 9.7,
    tonemapping: Tonemapping::TonyMcMapface,
    // Nothing moves: what is seen of the lamps needs no light.
    volumes: BakeVolumes::Never,
    keys: "drag the line  before and after     ",
    besides: |app| {
        app.add_plugins((lamps::plugin, reflections::plugin, slider::plugin));
    },
    ..Stage::PLAIN
};

fn main() -> AppExit {
    common::run(STAGE)
}
