//! A grey sphere that is carried through both rooms: the volume brings it the indirect light, its lamps stay real time.

use crate::accuracy::{PLACES, air, check};
use crate::{extract, open};
use bevy_kiln::bake::{Goal, VolumeBoxes, VolumeSettings};
use glam::Vec3;

/// Side of a cell [m].
const SPACING: f32 = 0.5;

/// Of each probe. Most of the light comes straight through windows, which no probe knows of, so that the error that is
/// asked for by default, 5 % of each face, takes an hour here.
const PATHS_OF_PROBE: u32 = 4096;

/// For the truth.
const PATHS: u32 = 512;

#[test]
fn a_sphere_is_lit_all_over_the_gallery() {
    let mut scene = extract(&mut open());
    scene.indirect_only = scene.lights.iter().map(|light| light.id().clone()).collect();
    // The cabinet is a fifth of the air.
    let hall = air(&scene, Vec3::new(-4.5, 0.0, -3.0), Vec3::new(4.5, 3.6, 3.0), PLACES - PLACES / 5);
    let cabinet = air(&scene, Vec3::new(4.7, 0.0, -1.8), Vec3::new(7.7, 3.6, 1.8), PLACES / 5);
    let boxes = VolumeBoxes::Automatic { spacing: Some(SPACING) };
    let settings = VolumeSettings { goal: Goal::Samples(PATHS_OF_PROBE), boxes, ..VolumeSettings::default() };
    check("gallery", &scene, &[hall, cabinet].concat(), PATHS, &settings);
}
