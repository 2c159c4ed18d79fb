//! Volumes in two rooms, against the light meter.

use crate::accuracy::{PLACES, air, check};
use crate::common::glb;
use crate::common::scenes::SceneBuilder;
use crate::{along_axes, bake, denoise_scenes};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{Goal, LaterBounces, VolumeBox, VolumeBoxes, VolumeSettings};
use bevy_kiln::math::luminance;
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::Transport;
use glam::{Vec2, Vec3};

/// For the truth.
const PATHS: u32 = 1024;

/// The same with the glowing quad of the Cornell box as a light that is drawn in real time.
fn lamp_apart(mut scene: Scene) -> Scene {
    let radiance = scene.materials.iter().map(|material| material.emitted_radiance).fold(Vec3::ZERO, Vec3::max);
    for material in &mut scene.materials {
        material.emitted_radiance = Vec3::ZERO;
    }
    // Its corners are those of the file: 2.13 to 3.43 m and 2.27 to 3.32 m, at 5.488 m.
    let middle = Vec3::new(2.78, 5.487, 2.795);
    let lamp = SceneBuilder::default().rect_light("lamp", middle, Vec3::NEG_Y, Vec2::new(1.3, 1.05), radiance).build();
    scene.lights = lamp.lights;
    scene.indirect_only.insert(StableId::new("lamp"));
    scene
}

fn to_error(boxes: VolumeBoxes) -> VolumeSettings {
    VolumeSettings { boxes, ..VolumeSettings::default() }
}

fn one(low: Vec3, high: Vec3, spacing: f32) -> VolumeBoxes {
    VolumeBoxes::Given(vec![VolumeBox { id: StableId::new("volume"), ..along_axes(low, high, spacing) }])
}

#[test]
fn in_the_cornell_box() {
    let scene = lamp_apart(glb::load("cornell"));
    let (low, high) = (Vec3::ZERO, Vec3::new(5.5, 5.48, 5.59));
    check("Cornell box", &scene, &air(&scene, low, high, PLACES), PATHS, &to_error(one(low, high, 0.4)));
}

#[test]
fn in_a_room_in_the_sun() {
    let scene = denoise_scenes::sunlit().scene;
    let (low, high) = (Vec3::ZERO, Vec3::new(3.5, 2.375, 3.0));
    check("room in the sun", &scene, &air(&scene, low, high, PLACES), PATHS, &to_error(VolumeBoxes::default()));
}

/// Paths that end at a coarse lightmap bring what whole ones bring: over all probes the means differ by no more than 2 %,
/// noise included.
#[test]
fn paths_that_end_early_bring_the_same() {
    for (name, scene) in [("sun", denoise_scenes::sunlit().scene), ("Cornell", glb::load("cornell"))] {
        let mean = |later_bounces: LaterBounces| {
            let of_seed = |seed: u64| {
                let transport = Transport { seed, ..Transport::default() };
                let boxes = one(Vec3::splat(0.2), Vec3::new(3.3, 2.2, 2.8), 0.6);
                let goal = Goal::Samples(2048);
                let settings = VolumeSettings { transport, goal, boxes, later_bounces, ..VolumeSettings::default() };
                let cubes = bake(&scene, &settings).volumes.remove(0).cubes;
                let sum: Vec3 = cubes.iter().flatten().sum();
                luminance(sum.as_dvec3()) / (6 * cubes.len()) as f64
            };
            let all: Vec<f64> = (0..8).map(of_seed).collect();
            let mean = all.iter().sum::<f64>() / 8.0;
            let squares: f64 = all.iter().map(|value| (value - mean).powi(2)).sum();
            [mean, (squares / (8.0 * 7.0)).sqrt()]
        };
        let [whole, early] = [LaterBounces::Traced, LaterBounces::Reused].map(mean);
        let (off, noise) = (early[0] / whole[0] - 1.0, whole[1].hypot(early[1]) / whole[0]);
        println!("{name}: ending early {:+.2} ± {:.2} %", 100.0 * off, 100.0 * noise);
        assert!(off.abs() + 4.0 * noise <= 0.02, "{name}: {off} ± {noise}");
    }
}
