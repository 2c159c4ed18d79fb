//! The Cornell box, dark but for its lamp until it is baked: press B and look on.
//!
//! `cargo run --features full --example cornell_box`. With `--screenshot FILE` it bakes, takes a picture of
//! its window and ends, for a run without a person. What it shows of the plugin is in `bake.rs`, `folder.rs` and
//! `room.rs`; the rest is a window, a camera and words on the screen.

mod args;
mod bake;
mod folder;
mod overlay;
mod room;
mod run;
mod shoot;
mod stage;

use bevy::prelude::*;
use stage::Stage;

const STAGE: Stage = Stage {
    name: "cornell_box",
    file: "scenes/cornell_box.glb",
    distance: 10.8,
    sky: [0.0; 3],
    background: Color::BLACK,
    ev100: 9.7,
    size: [640; 2],
    window: [900; 2],
    keys: "",
    besides: |_| {},
};

fn main() -> AppExit {
    run::run(STAGE)
}
