//! A furnished room, to look for what lightmaps get wrong: seams, leaks, blotches. Press B to bake it, F to change how
//! texels are filtered; or show what the command has baked:
//!
//! ```text
//! cargo kiln bake assets/scenes/furnished.glb -o out/furnished --sky 1200,1500,2000 --spp 64
//! cargo run --features full --example furnished -- --folder out/furnished --bicubic
//! ```
//!
//! All but the scene is in `examples/common`.

#[path = "../common/mod.rs"]
mod common;

use bevy::prelude::*;
use common::Stage;

const STAGE: Stage = Stage {
    name: "furnished",
    file: "scenes/furnished.glb",
    distance: 3.5,
    sky: [1200.0, 1500.0, 2000.0],
    background: Color::WHITE,
    ev100: 9.0,
    ..Stage::PLAIN
};

fn main() -> AppExit {
    common::run(STAGE)
}
