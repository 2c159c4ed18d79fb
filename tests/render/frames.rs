//! What a bake takes of the frames that run beside it: its textures on their way to the screen.

use crate::renderer::{app_with, spawn_camera};
use bevy::prelude::*;
use bevy_kiln::prelude::*;
use std::time::{Duration, Instant};

/// Of each texel: enough to see frames go by.
const PATHS: u32 = 32;

/// Rows of 512 pixels of 8 bytes need no padding. A small picture, since the processor draws it.
const SIZE: [u32; 2] = [512, 288];

/// Pages that have been written since the last look.
#[derive(Resource, Default)]
struct Written(usize);

fn count(mut images: MessageReader<AssetEvent<Image>>, mut written: ResMut<Written>) {
    written.0 +=
        images.read().filter(|event| matches!(event, AssetEvent::Added { .. } | AssetEvent::Modified { .. })).count();
}

fn median(times: &mut [Duration]) -> f64 {
    times.sort_unstable();
    1e3 * times[times.len() / 2].as_secs_f64()
}

/// Frames of the gallery while one thread bakes it, those with new texels on their way to the screen apart. A frame is
/// the main and the render world's part of it, one after the other.
#[test]
#[ignore = "takes minutes and measures time, which no test holds against a bound"]
fn what_new_texels_cost_a_frame() {
    let prepare = |app: &mut App| {
        app.init_resource::<Written>().add_systems(Last, count);
    };
    let Some(mut app) = app_with(prepare) else { return };
    let world = app.world_mut();
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenes/gallery.glb");
    let scene = world.resource::<AssetServer>().load(GltfAssetLabel::Scene(0).from_asset(scene));
    world.spawn((WorldAssetRoot(scene), LightmapReceiver::default()));
    let place = Transform::from_xyz(4.1, 1.72, 2.7).looking_at(Vec3::new(-0.9, 1.15, -1.6), Vec3::Y);
    spawn_camera(world, SIZE, 0.96, place);
    let patience = Instant::now() + Duration::from_secs(60);
    while world_is_empty(&mut app) {
        assert!(Instant::now() < patience, "the gallery did not come");
        app.update();
    }
    let frame = |app: &mut App| {
        app.world_mut().resource_mut::<Written>().0 = 0;
        let began = Instant::now();
        app.update();
        (began.elapsed(), app.world().resource::<Written>().0)
    };
    (0..20).for_each(|_| _ = frame(&mut app));
    let mut before: Vec<Duration> = (0..60).map(|_| frame(&mut app).0).collect();
    app.world_mut().trigger(BakeLightmaps {
        scene: SceneSettings { sky_radiance: Vec3::new(3000.0, 3800.0, 5000.0), ..default() },
        goal: BakeGoal::Samples(PATHS),
        volumes: BakeVolumes::Never,
        threads: 1,
        ..default()
    });
    let (mut with, mut without, mut all) = (Vec::new(), Vec::new(), Vec::new());
    let mut is_running = true;
    while is_running {
        let (time, written) = frame(&mut app);
        if written > 0 { &mut with } else { &mut without }.push(time);
        all.push((time, all.len(), written));
        is_running = app.world().resource::<BakeStatus>().running().is_some();
    }
    let [before, with_texels, without_texels] = [&mut before, &mut with, &mut without].map(|times| median(times));
    println!(
        "median frame before the bake {before:.1} ms; beside it {without_texels:.1} ms ({} frames), with new texels \
         {with_texels:.1} ms ({}): they cost {:.1} ms, {:.0} % of a frame",
        without.len(),
        with.len(),
        with_texels - without_texels,
        100.0 * (with_texels / without_texels - 1.0),
    );
    let frames = all.len();
    all.sort_unstable_by_key(|&(time, ..)| std::cmp::Reverse(time));
    for (time, number, written) in &all[..8] {
        println!("{:.0} ms: frame {number} of {frames}, {written} textures written", 1e3 * time.as_secs_f64());
    }
}

fn world_is_empty(app: &mut App) -> bool {
    let world = app.world_mut();
    let mut meshes = world.query::<&Mesh3d>();
    meshes.iter(world).next().is_none()
}
