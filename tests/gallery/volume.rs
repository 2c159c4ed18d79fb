//! A grey sphere that is carried through both rooms: the volume brings it the indirect light, its lamps stay real time.

use crate::accuracy::{PLACES, air, check};
use crate::{extract, open};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{Goal, VolumeBox, VolumeBoxes, VolumeSettings};
use bevy_kiln::scene::Scene;
use glam::{Quat, Vec3};

/// Of each probe. Most of the light comes straight through windows, which no probe knows of, so that the error that is
/// asked for by default, 5 % of each face, takes half an hour here.
const PATHS_OF_PROBE: u32 = 4096;

/// For the truth.
const PATHS: u32 = 512;

/// The rooms, from corner to corner [m].
const HALL: [Vec3; 2] = [Vec3::new(-4.5, 0.0, -3.0), Vec3::new(4.5, 3.6, 3.0)];
const CABINET: [Vec3; 2] = [Vec3::new(4.7, 0.0, -1.8), Vec3::new(7.7, 3.6, 1.8)];

fn with_lamps_in_real_time() -> Scene {
    let mut scene = extract(&mut open());
    scene.indirect_only = scene.lights.iter().map(|light| light.id().clone()).collect();
    scene
}

fn settings(boxes: VolumeBoxes) -> VolumeSettings {
    VolumeSettings { goal: Goal::Samples(PATHS_OF_PROBE), boxes, ..VolumeSettings::default() }
}

#[test]
fn a_sphere_is_lit_all_over_the_cabinet() {
    let scene = with_lamps_in_real_time();
    let [low, high] = CABINET;
    let (centre, rotation, size) = (0.5 * (low + high), Quat::IDENTITY, high - low);
    let around = VolumeBox { id: StableId::new("cabinet"), centre, rotation, size, spacing: None };
    let places = air(&scene, low, high, PLACES);
    check("cabinet", &scene, &places, PATHS, &settings(VolumeBoxes::Given(vec![around])));
}

#[test]
#[ignore = "its 20 000 probes take minutes"]
fn a_sphere_is_lit_all_over_the_gallery() {
    let scene = with_lamps_in_real_time();
    // The cabinet is a fifth of the air.
    let hall = air(&scene, HALL[0], HALL[1], PLACES - PLACES / 5);
    let cabinet = air(&scene, CABINET[0], CABINET[1], PLACES / 5);
    check("gallery", &scene, &[hall, cabinet].concat(), PATHS, &settings(VolumeBoxes::default()));
}
