//! The twenty lines of the README: a scene, and a key that bakes it.
//!
//! ```text
//! cargo run --features full --example quickstart
//! ```

#[path = "../common/unattended.rs"]
mod unattended;

use bevy::prelude::*;
use bevy_kiln::prelude::*;
use unattended::Unattended;

/// For a run without a person.
const UNATTENDED: Unattended = Unattended {
    prepare: |world| world.resource_mut::<NextBake>().goal = BakeGoal::Error(0.2),
    keys: &[KeyCode::ControlLeft, KeyCode::KeyB],
    is_busy: |world| world.resource::<BakeStatus>().running().is_some(),
};

fn main() -> AppExit {
    App::new()
        .add_plugins((DefaultPlugins, KilnPlugin, KilnShortcuts))
        .add_plugins(UNATTENDED)
        .insert_resource(GlobalAmbientLight::NONE) // Bevy adds its own to everything otherwise
        .add_systems(Startup, open)
        .add_observer(|at: On<BakeProgress>, mut words: Single<&mut Text>| {
            words.0 = format!("{:?} {:.0} %", at.stage, 100.0 * at.fraction());
        })
        .add_observer(|done: On<BakeFinished>, mut words: Single<&mut Text>| {
            words.0 = format!("{} texels in {:.1} s", done.texels, done.seconds);
        })
        .add_observer(|failed: On<BakeFailed>, mut words: Single<&mut Text>| words.0 = failed.reason.clone())
        .run()
}

fn open(mut commands: Commands, assets: Res<AssetServer>) {
    let room = assets.load(GltfAssetLabel::Scene(0).from_asset("scenes/cornell_box.glb"));
    commands.spawn((WorldAssetRoot(room), LightmapReceiver::default()));
    commands.spawn(Text::new("Ctrl+B bakes, and stops"));
}
