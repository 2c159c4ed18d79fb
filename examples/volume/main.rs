//! Things that move through a room of baked light. The room has a lightmap; the balls have none, and are lit by the
//! irradiance volume that is baked along with it. Press B to bake, V to see them without.
//!
//! ```text
//! cargo run --features full --example volume
//! ```
//!
//! All but the balls is in `examples/common`.

mod balls;
#[path = "../common/mod.rs"]
mod common;

use bevy::prelude::*;
use common::Stage;

const STAGE: Stage = Stage {
    name: "volume",
    file: "scenes/furnished.glb",
    distance: 3.5,
    sky: [1200.0, 1500.0, 2000.0],
    background: Color::WHITE,
    ev100: 9.0,
    keys: "V  balls with or without the volume     ",
    besides: balls::plugin,
    ..Stage::PLAIN
};

fn main() -> AppExit {
    common::run(STAGE)
}
