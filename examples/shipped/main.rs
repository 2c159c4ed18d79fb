//! A game as it ships: the gallery, lit by the folder that was baked before, and nothing in it that could bake.
//!
//! ```text
//! cargo run --no-default-features --features window --example shipped
//! ```
//!
//! The folder is made by `cargo run --features full --example gallery -- --spp 256 --density 12 --save
//! assets/baked/gallery --screenshot out/gallery.png`.

#[path = "../gallery/lamps.rs"]
mod lamps;
#[path = "../gallery/reflections.rs"]
mod reflections;
#[path = "../common/unattended.rs"]
mod unattended;

use bevy::prelude::*;
use bevy::world_serialization::WorldInstanceReady;
use bevy_kiln::plugin::AppliedLightmaps;
use bevy_kiln::prelude::*;
use std::f32::consts::TAU;

/// How long the view takes to swing to and fro [s], and how far it swings to each side [rad].
const PERIOD: f32 = 24.0;
const SWING: f32 = 0.35;

fn main() -> AppExit {
    App::new()
        .add_plugins((
            DefaultPlugins,
            KilnPlugin,
            lamps::plugin,
            reflections::plugin,
            unattended::Unattended { prepare: |_| {}, keys: &[], is_busy: |_| false },
        ))
        .insert_resource(GlobalAmbientLight::NONE)
        .insert_resource(ClearColor(Color::srgb(0.86, 0.93, 1.0)))
        .add_systems(Startup, open)
        .add_systems(Update, (swing, report))
        .add_observer(cast_shadows)
        .run()
}

fn open(mut commands: Commands, assets: Res<AssetServer>) {
    commands.spawn((
        WorldAssetRoot(assets.load(GltfAssetLabel::Scene(0).from_asset("scenes/gallery.glb"))),
        BakedLightmaps(assets.load("baked/gallery/kiln.ron")),
    ));
    commands.spawn((
        Text::default(),
        TextShadow::default(),
        Node { position_type: PositionType::Absolute, left: px(12), bottom: px(10), ..default() },
    ));
}

/// What stays of baked lights is their gloss, which would shine through walls.
fn cast_shadows(_: On<WorldInstanceReady>, mut suns: Query<&mut DirectionalLight>, mut lamps: Query<&mut PointLight>) {
    suns.iter_mut().for_each(|mut sun| sun.shadow_maps_enabled = true);
    lamps.iter_mut().for_each(|mut lamp| lamp.shadow_maps_enabled = true);
}

/// The camera of the file looks around, but for a picture.
fn swing(time: Res<Time>, mut cameras: Query<&mut Transform, With<Camera3d>>, mut first: Local<Option<Quat>>) {
    let Ok(mut camera) = cameras.single_mut() else { return };
    let middle = *first.get_or_insert(camera.rotation);
    let is_for_a_picture = std::env::args().any(|word| word == "--screenshot");
    let turn = if is_for_a_picture { 0.0 } else { SWING * (TAU * time.elapsed_secs() / PERIOD).sin() };
    camera.rotation = Quat::from_rotation_y(turn) * middle;
}

/// Says what of the folder has been found in the scene.
fn report(
    roots: Query<(&BakedLightmaps, &AppliedLightmaps)>,
    folders: Res<Assets<BakedFolder>>,
    mut words: Single<&mut Text>,
) {
    for (baked, applied) in &roots {
        let Some(folder) = folders.get(&baked.0) else { continue };
        let of = folder.manifest.placements.len() + folder.manifest.baked_lights.len();
        words.0 = format!("{} of {of} objects and lights are as they were baked", applied.len());
    }
}
