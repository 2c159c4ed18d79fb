//! What probes measure where the answer is known.

use crate::common::scenes::{SceneBuilder, generalised_furnace, grey};
use crate::{along_axes, bake, given};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{Goal, Volume, VolumeBake, VolumeSettings};
use bevy_kiln::math::{AmbientCube, FACES, ambient_cube_weights, square_to_uniform_sphere};
use bevy_kiln::scene::{Light, PointLight, Scene};
use bevy_kiln::trace::{Estimator, Transport};
use glam::{DVec3, Vec2, Vec3};
use std::f32::consts::PI;

/// Seeds whose spread is the error of their mean.
const SEEDS: u64 = 16;

/// One channel of the faces of the first probe, and the standard error of each.
fn faces(scene: &Scene, settings: &VolumeSettings) -> [[f64; 2]; FACES] {
    let of_seed = |seed: u64| {
        let transport = Transport { seed, ..settings.transport };
        bake(scene, &VolumeSettings { transport, ..settings.clone() }).volumes[0].cubes[0]
    };
    let bakes: Vec<[Vec3; FACES]> = (0..SEEDS).map(of_seed).collect();
    let count = SEEDS as f64;
    std::array::from_fn(|face| {
        let values = bakes.iter().map(|cube| f64::from(cube[face].x));
        let mean = values.clone().sum::<f64>() / count;
        let squares: f64 = values.map(|value| (value - mean).powi(2)).sum();
        [mean, (squares / (count * (count - 1.0))).sqrt()]
    })
}

/// Whether all faces are within a tolerance of the truth, their noise included.
fn near(faces: &[[f64; 2]; FACES], truth: &[f64; FACES], tolerance: f64) -> Result<(), String> {
    for (face, (&[mean, error], &truth)) in faces.iter().zip(truth).enumerate() {
        if (mean - truth).abs() + 4.0 * error > tolerance {
            return Err(format!("face {face}: {mean} ± {error}, not {truth}"));
        }
    }
    Ok(())
}

/// The faces of the cube of least squares for light of this radiance by direction, by a fine sum.
fn best_cube(radiance: impl Fn(Vec3) -> f64) -> [f64; FACES] {
    const SIDE: u32 = 2000;
    let mut moments = [DVec3::ZERO; FACES];
    for place in 0..SIDE * SIDE {
        let at = Vec2::new((place % SIDE) as f32 + 0.5, (place / SIDE) as f32 + 0.5) / SIDE as f32;
        let direction = square_to_uniform_sphere(at);
        for (moment, weight) in moments.iter_mut().zip(ambient_cube_weights(direction)) {
            *moment += DVec3::splat(radiance(direction) * f64::from(weight));
        }
    }
    AmbientCube::fit(&moments.map(|moment| moment / f64::from(SIDE * SIDE))).faces.map(|face| face.x)
}

/// A box of one cell around a point.
fn at(point: Vec3, paths: u32) -> VolumeSettings {
    given(vec![along_axes(point - 0.05, point + 0.05, 1.0)], paths)
}

#[test]
fn in_a_furnace_every_face_of_every_probe_is_the_same() {
    let scene = generalised_furnace(3.0);
    let settings = given(vec![along_axes(Vec3::new(-0.9, 0.1, -1.9), Vec3::new(1.9, 0.9, 0.9), 0.8)], 1 << 14);
    let VolumeBake { mut volumes, report } = bake(&scene, &settings);
    let (volume, error) = (volumes.remove(0), 4.0 * report.relative_stderr.max as f32);
    assert!(error > 0.0);
    assert_eq!(volume.resolution.to_array(), [4, 1, 4]);
    for cube in volume.cubes {
        for face in cube {
            let off = (face / 3.0 - 1.0).abs().max_element();
            assert!(off + error < 0.03, "{face}: off by {off}, noise {error}");
        }
    }
}

/// Half a sky over a wide black floor: E/π is L (1 + n_y) / 2.
#[test]
fn under_half_a_sky() {
    let floor = [Vec3::Z * 4000.0, Vec3::X * 4000.0];
    let scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-2000.0, 0.0, -2000.0), floor, grey(0.0))
        .sky(Vec3::splat(2.0))
        .build();
    let truth = best_cube(|direction| if direction.y > 0.0 { 2.0 } else { 0.0 });
    let measured = faces(&scene, &at(Vec3::Y, 4096));
    near(&measured, &truth, 0.005).unwrap();
    let cube = AmbientCube { faces: truth.map(DVec3::splat) };
    let worst = (0..100).map(|number| {
        let normal = square_to_uniform_sphere(Vec2::new(0.5, (number as f32 + 0.5) / 100.0));
        (cube.at(normal).x - f64::from(1.0 + normal.y)).abs()
    });
    println!("half a sky: the best cube is within {:.3} of E/π = 1 + n_y", worst.fold(0.0, f64::max));
    let faulty = [truth[0], truth[1], truth[3], truth[2], truth[4], truth[5]];
    assert!(near(&measured, &faulty, 0.005).is_err(), "the other way round");
    assert!(near(&measured, &truth.map(|face| 1.05 * face), 0.005).is_err());
}

/// A lamp of one side, alone: three estimators have the same mean, which is that of its solid angle.
#[test]
fn beside_a_lone_lamp() {
    let size = Vec2::new(0.8, 0.5);
    let scene = SceneBuilder::default()
        .rect_light("lamp", Vec3::Y, Vec3::NEG_Y, size, Vec3::splat(10.0))
        .quad("wall", Vec3::new(-5.0, -5.0, -5.0), [Vec3::Z, Vec3::X], grey(0.0))
        .build();
    let point = Vec3::new(0.3, 0.2, -0.1);
    let truth = best_cube(|direction| {
        let met = point + direction * ((1.0 - point.y) / direction.y);
        let is_on_it = direction.y > 0.0 && met.x.abs() < 0.5 * size.x && met.z.abs() < 0.5 * size.y;
        if is_on_it { 10.0 } else { 0.0 }
    });
    for estimator in [Estimator::Mis, Estimator::Light, Estimator::Bsdf] {
        let paths = if estimator == Estimator::Bsdf { 1 << 16 } else { 4096 };
        let transport = Transport { estimator, ..Transport::default() };
        let measured = faces(&scene, &VolumeSettings { transport, ..at(point, paths) });
        near(&measured, &truth, 0.01 * truth[2]).unwrap_or_else(|reason| panic!("{estimator:?}: {reason}"));
        assert!(near(&measured, &truth.map(|face| 1.05 * face), 0.01 * truth[2]).is_err(), "{estimator:?}");
    }
}

fn bulb(radius: f32) -> Light {
    Light::Point(PointLight {
        id: StableId::new("bulb"),
        name: "bulb".into(),
        position: Vec3::new(0.0, 2.0, 0.0),
        intensity: Vec3::splat(8.0),
        radius,
        range: None,
    })
}

/// What Bevy draws in real time is left out; what is off in real time is in, by its closed form.
#[test]
fn direct_light_is_in_only_where_real_time_lacks_it() {
    let dark = SceneBuilder::default().quad("wall", Vec3::splat(-50.0), [Vec3::Z, Vec3::X], grey(0.0));
    let mut scene = dark.build();
    scene.lights.push(bulb(0.0));
    let dark_volume: Volume = bake(&scene, &at(Vec3::ZERO, 256)).volumes.remove(0);
    assert!(dark_volume.cubes[0].iter().all(|face| *face == Vec3::ZERO), "{:?}", dark_volume.cubes[0]);
    scene.off_in_real_time.insert(StableId::new("bulb"));
    // All of it comes from straight above: E = I / d², so that ∫ L dω is 2.
    let moments = ambient_cube_weights(Vec3::Y).map(|weight| DVec3::splat(f64::from(weight * 2.0 / (4.0 * PI))));
    let truth = AmbientCube::fit(&moments).faces.map(|face| face.x);
    near(&faces(&scene, &at(Vec3::ZERO, 256)), &truth, 1e-3).unwrap();
    scene.lights[0] = bulb(0.2);
    near(&faces(&scene, &at(Vec3::ZERO, 4096)), &truth, 1e-2).unwrap();
    scene.indirect_only.insert(StableId::new("bulb"));
    let dark_again = bake(&scene, &at(Vec3::ZERO, 256));
    assert!(dark_again.volumes[0].cubes[0].iter().all(|face| *face == Vec3::ZERO));
}

/// To an error, all probes are known as well as was asked for, and no more paths are traced than for a tenth of it.
#[test]
fn an_error_is_met() {
    let scene = crate::common::scenes::lit_room(0.6, 20.0);
    let corners = along_axes(Vec3::splat(0.1), Vec3::splat(3.9), 1.0);
    let to = |error: f64| bake(&scene, &VolumeSettings { goal: Goal::Error(error), ..given(vec![corners.clone()], 1) });
    let [coarse, fine] = [to(0.1), to(0.02)];
    for (bake, target) in [(&coarse, 0.1), (&fine, 0.02)] {
        let intervals = bake.report.intervals;
        assert_eq!((intervals.target, intervals.missed), (Some(target), 0));
        assert!(intervals.half_width.max <= target && intervals.half_width.max > 0.0, "{intervals:?}");
    }
    assert!(fine.report.samples > 3 * coarse.report.samples, "{} {}", fine.report.samples, coarse.report.samples);
}
