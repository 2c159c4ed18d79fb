//! No light through walls: a dark room beside a bright one, with a wall between them that is thinner than a cell, or has
//! no thickness at all.

use crate::common::scenes::{SceneBuilder, grey};
use crate::common::volume::{Bound, look_up};
use crate::{along_axes, bake, given};
use bevy_kiln::bake::{CancelToken, Goal, MeterPoint, MeterSettings, VolumeBoxes, VolumeSettings, measure_irradiance};
use bevy_kiln::math::{luminance, square_to_uniform_sphere};
use bevy_kiln::scene::Scene;
use glam::{Vec2, Vec3};
use std::f64::consts::PI;

/// From a wall in the dark, light must be gone after this far [m].
const CLEARANCE: f32 = 0.1;

/// Two closed rooms side by side along x, 3 m wide each, with this much between them; a lamp in the first.
fn two_rooms(between: f32) -> (Scene, [[Vec3; 2]; 2]) {
    let size = Vec3::new(3.0, 2.5, 3.0);
    let other = Vec3::X * (3.0 + between);
    let scene = SceneBuilder::default()
        .chamber("bright", Vec3::ZERO, size, grey(0.6))
        .chamber("dark", other, other + size, grey(0.6))
        .rect_light("lamp", Vec3::new(1.5, 2.4, 1.5), Vec3::NEG_Y, Vec2::splat(0.6), Vec3::splat(50.0))
        .build();
    (scene, [[Vec3::ZERO, size], [other, other + size]])
}

/// Two rooms with a slanted wall of no thickness between them, which no cut along an axis can follow.
fn slanted() -> Scene {
    let size = Vec3::new(4.0, 2.5, 4.0);
    let diagonal = [Vec3::new(4.0, 0.0, 4.0), Vec3::Y * 2.5];
    SceneBuilder::default()
        .chamber("room", Vec3::ZERO, size, grey(0.6))
        .quad("one side", Vec3::ZERO, diagonal, grey(0.6))
        .rect_light("lamp", Vec3::new(3.0, 2.4, 1.0), Vec3::NEG_Y, Vec2::splat(0.5), Vec3::splat(50.0))
        .build()
}

/// Points of a box, evenly.
fn places(low: Vec3, high: Vec3, per_side: u32) -> impl Iterator<Item = Vec3> {
    (0..per_side.pow(3)).map(move |number| {
        let cell = [number % per_side, number / per_side % per_side, number / per_side.pow(2)];
        low + (high - low) * (Vec3::from(cell.map(|along| along as f32)) + 0.5) / per_side as f32
    })
}

fn mean_luminance(volumes: &[Bound], place: Vec3) -> f64 {
    let normals = (0..24).map(|number| {
        square_to_uniform_sphere(Vec2::new((number as f32 + 0.5) / 24.0, (number as f32 * 0.618_034).fract()))
    });
    normals.map(|normal| luminance(look_up(volumes, place, normal).as_dvec3())).sum::<f64>() / 24.0
}

/// Of the irradiance over all normals, what the meter says [cd/m²].
fn truth(scene: &Scene, places: &[Vec3]) -> Vec<f64> {
    let normals: Vec<Vec3> = (0..24)
        .map(|number| {
            square_to_uniform_sphere(Vec2::new((number as f32 + 0.5) / 24.0, (number as f32 * 0.618_034).fract()))
        })
        .collect();
    let points: Vec<MeterPoint> = places
        .iter()
        .flat_map(|&position| normals.iter().map(move |&normal| MeterPoint { position, normal }))
        .collect();
    let settings = MeterSettings { samples_per_point: 256, ..MeterSettings::default() };
    let readings = measure_irradiance(scene, &points, &settings, &(), &CancelToken::default()).unwrap().readings;
    readings.chunks(24).map(|of| of.iter().map(|one| luminance(one.irradiance) / PI).sum::<f64>() / 24.0).collect()
}

fn automatic(spacing: f32) -> VolumeSettings {
    let boxes = VolumeBoxes::Automatic { spacing: Some(spacing) };
    VolumeSettings { goal: Goal::Samples(256), boxes, ..VolumeSettings::default() }
}

#[test]
fn rooms_behind_thin_walls_get_boxes_of_their_own() {
    for between in [0.0, 0.02, 0.2, 0.6] {
        let (scene, [bright, dark]) = two_rooms(between);
        let bake = bake(&scene, &automatic(0.5));
        assert!((2..=3).contains(&bake.volumes.len()), "{between} m: {} volumes", bake.volumes.len());
        let bound: Vec<Bound> = bake.volumes.iter().map(Bound::new).collect();
        let inner = |[low, high]: [Vec3; 2]| [low + CLEARANCE, high - CLEARANCE];
        let [lit, unlit] = [inner(bright), inner(dark)];
        let bright_places: Vec<Vec3> = places(lit[0], lit[1], 4).collect();
        let expected = truth(&scene, &bright_places);
        let level = expected.iter().sum::<f64>() / expected.len() as f64;
        let leak = places(unlit[0], unlit[1], 9).map(|place| mean_luminance(&bound, place)).fold(0.0, f64::max);
        println!(
            "{between} m between: the brightest dark place has {:.4} % of the bright room's",
            100.0 * leak / level
        );
        assert!(leak <= 0.01 * level, "{between} m: {leak} of {level}");
        for (&place, expected) in bright_places.iter().zip(expected) {
            // Under the lamp, nearer than a cell, nothing coarse can follow; elsewhere nothing is lost to the dark.
            if (place - Vec3::new(1.5, 2.4, 1.5)).length() > 1.0 {
                let shown = mean_luminance(&bound, place);
                assert!((shown / expected - 1.0).abs() < 0.1, "{between} m, {place}: {shown}, not {expected}");
            }
        }
    }
}

#[test]
fn one_box_over_both_rooms_darkens_rather_than_leaks() {
    for (between, spacing) in [(0.0, 0.5), (0.1, 0.4), (0.3, 0.35)] {
        let (scene, [bright, dark]) = two_rooms(between);
        let bake = bake(&scene, &given(vec![along_axes(bright[0], dark[1], spacing)], 256));
        let bound = [Bound::new(&bake.volumes[0])];
        let level = mean_luminance(&bound, Vec3::splat(1.25));
        let unlit = places(dark[0] + CLEARANCE, dark[1] - CLEARANCE, 12);
        let leak = unlit.map(|place| mean_luminance(&bound, place)).fold(0.0, f64::max);
        println!("{between} m between, one box: {:.4} %", 100.0 * leak / level);
        assert!(leak <= 0.01 * level, "{between} m: {leak} of {level}");
    }
}

#[test]
fn nothing_shines_through_a_slanted_wall() {
    let scene = slanted();
    let bake = bake(&scene, &automatic(0.35));
    let bound: Vec<Bound> = bake.volumes.iter().map(Bound::new).collect();
    let level = mean_luminance(&bound, Vec3::new(3.0, 1.2, 1.0));
    let behind = places(Vec3::splat(0.1), Vec3::new(3.9, 2.4, 3.9), 14).filter(|place| place.z - place.x > 0.15);
    let leak = behind.map(|place| mean_luminance(&bound, place)).fold(0.0, f64::max);
    println!("a slanted wall: {:.4} %", 100.0 * leak / level);
    assert!(leak <= 0.01 * level && level > 0.0, "{leak} of {level}");
}
