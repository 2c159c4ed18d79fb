//! Things that move through a room of baked light. The room has a lightmap; the balls have none, and are lit by the
//! irradiance volume that is baked along with it. Press B to bake, V to see them without.
//!
//! ```text
//! cargo run --features full --example volume
//! ```
//!
//! All but the balls is shared with the example `cornell_box`.

#[path = "../cornell_box/args.rs"]
mod args;
#[path = "../cornell_box/bake.rs"]
mod bake;
mod balls;
#[path = "../cornell_box/folder.rs"]
mod folder;
#[path = "../cornell_box/overlay.rs"]
mod overlay;
#[path = "../cornell_box/room.rs"]
mod room;
#[path = "../cornell_box/run.rs"]
mod run;
#[path = "../cornell_box/shoot.rs"]
mod shoot;
#[path = "../cornell_box/stage.rs"]
mod stage;

use bevy::prelude::*;
use stage::Stage;

const STAGE: Stage = Stage {
    name: "volume",
    file: "scenes/furnished.glb",
    distance: 3.5,
    sky: [1200.0, 1500.0, 2000.0],
    background: Color::WHITE,
    ev100: 9.0,
    size: [1280, 720],
    window: [1280, 720],
    keys: "V  balls with or without the volume     ",
    besides: balls::plugin,
};

fn main() -> AppExit {
    run::run(STAGE)
}
