//! A furnished room, to look for what lightmaps get wrong: seams, leaks, blotches. Press B to bake it, F to change how
//! texels are filtered; or show what the command has baked:
//!
//! ```text
//! cargo kiln bake assets/scenes/furnished.glb -o out/furnished --sky 1200,1500,2000 --spp 64
//! cargo run --features full --example furnished -- --folder out/furnished --bicubic
//! ```
//!
//! All but the scene is shared with the example `cornell_box`.

#[path = "../cornell_box/args.rs"]
mod args;
#[path = "../cornell_box/bake.rs"]
mod bake;
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
    name: "furnished",
    file: "scenes/furnished.glb",
    distance: 3.5,
    sky: [1200.0, 1500.0, 2000.0],
    background: Color::WHITE,
    ev100: 9.0,
    size: [1280, 720],
    window: [1280, 720],
    keys: "",
    besides: |_| {},
};

fn main() -> AppExit {
    run::run(STAGE)
}
