//! The kiln's panel over any scene: look at what a bake would cost, bake, hold, look at what was left out.
//!
//! ```text
//! cargo run --features full --example editor -- FILE.glb
//! ```
//!
//! A scene without a camera is looked at from outside; one without a light gets a sun and a sky.

mod args;
#[path = "../common/unattended.rs"]
mod unattended;
mod view;

use args::Args;
use bevy::asset::UnapprovedPathMode;
use bevy::camera_controller::free_camera::FreeCameraPlugin;
use bevy::prelude::*;
use bevy_kiln::prelude::*;
use unattended::Unattended;

/// For a run without a person.
const UNATTENDED: Unattended = Unattended {
    prepare: |_| {},
    keys: &[KeyCode::ControlLeft, KeyCode::KeyB],
    is_busy: |world| world.resource::<BakeStatus>().running().is_some(),
};

fn main() -> AppExit {
    let args = match Args::parse(std::env::args().skip(1)) {
        Ok(args) => args,
        Err(sentence) => {
            eprintln!("{sentence}");
            return AppExit::from_code(2);
        }
    };
    // The scene may lie anywhere.
    let assets = AssetPlugin { unapproved_path_mode: UnapprovedPathMode::Allow, ..default() };
    App::new()
        .add_plugins((DefaultPlugins.set(assets), FreeCameraPlugin))
        .add_plugins((KilnPlugin, KilnPanel, KilnShortcuts, view::plugin))
        .add_plugins(UNATTENDED)
        .insert_resource(GlobalAmbientLight::NONE)
        .insert_resource(args)
        .run()
}
