//! The Cornell box, dark but for its lamp until it is baked: press B and look on.
//!
//! `cargo run --features full --example cornell_box`. With `--screenshot FILE` it bakes, takes a picture of
//! its window and ends, for a run without a person. What it shows of the plugin is in `bake.rs`, `folder.rs` and
//! `room.rs` of `examples/common`; the rest is a window, a camera and words on the screen.

#[path = "../common/mod.rs"]
mod common;

use bevy::prelude::*;
use common::Stage;

const STAGE: Stage = Stage {
    name: "cornell_box",
    file: "scenes/cornell_box.glb",
    distance: 10.8,
    size: [640; 2],
    window: [900; 2],
    ..Stage::PLAIN
};

fn main() -> AppExit {
    common::run(STAGE)
}
