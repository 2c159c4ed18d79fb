//! Three estimators of the same light, held against each other: they share the geometry and nothing of the sampling
//! that could be wrong in the same way.

mod common;

use bevy_kiln::bake::{MeterPoint, MeterReading};
use bevy_kiln::math::Welford;
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::{Estimator, Transport};
use common::meter::{agree, at, on_walls, read};
use common::scenes::{SceneBuilder, generalised_furnace, glowing, grey, lit_room};
use glam::{Vec2, Vec3};

/// Independent runs of each estimator.
const RUNS: u64 = 16;

/// Means over all points, one per run, each under a seed of its own.
fn runs(scene: &Scene, points: &[MeterPoint], samples: u32, estimator: Estimator) -> Welford {
    let mut means = Welford::default();
    for run in 0..RUNS {
        let transport = Transport {
            estimator,
            max_bounces: None,
            seed: 1000 * (estimator as u64 + 1) + run,
            ..Transport::default()
        };
        let readings: Vec<MeterReading> = read(scene, points, samples, transport);
        means.push(readings.iter().map(|reading| reading.irradiance.y).sum::<f64>() / points.len() as f64);
    }
    means
}

fn assert_agreement(scene: &Scene, points: &[MeterPoint], samples: [u32; 3]) {
    let [mis, light, bsdf] = [Estimator::Mis, Estimator::Light, Estimator::Bsdf];
    let mis = runs(scene, points, samples[0], mis);
    let light = runs(scene, points, samples[1], light);
    let bsdf = runs(scene, points, samples[2], bsdf);
    agree(&mis, &light).unwrap();
    agree(&mis, &bsdf).unwrap();
    // The check itself: half a per cent of bias in so steady a mean, or 2 % in any, must be seen.
    let mut biased = Welford::default();
    for run in 0..RUNS {
        biased.push(mis.mean() * 1.02 + mis.variance().sqrt() * (run as f64 - 7.5) / 5.0);
    }
    agree(&mis, &biased).expect_err("a planted bias of 2 % went unseen");
}

#[test]
fn glowing_walls_of_different_albedo() {
    let points = on_walls(Vec3::new(-1.0, 0.0, -2.0), Vec3::new(2.0, 1.0, 1.0), 2);
    assert_agreement(&generalised_furnace(2.0), &points, [256, 256, 256]);
}

#[test]
fn a_light_that_blocks_nothing_in_a_closed_room() {
    let points = on_walls(Vec3::ZERO, Vec3::splat(4.0), 2);
    assert_agreement(&lit_room(0.6, 10.0), &points, [1024, 1024, 16384]);
}

/// Flush with the ceiling, where rounding decides which of the two a ray meets first.
#[test]
fn a_light_in_the_plane_of_the_ceiling() {
    let side = || grey(0.5);
    let scene = SceneBuilder::default()
        .room(Vec3::ZERO, Vec3::new(4.0, 3.3, 4.0), [side(), side(), side(), side(), side(), side()])
        .rect_light("lamp", Vec3::new(1.7, 3.3, 2.2), Vec3::NEG_Y, Vec2::new(1.3, 1.1), Vec3::ONE)
        .build();
    let points = on_walls(Vec3::ZERO, Vec3::new(4.0, 3.3, 4.0), 2);
    assert_agreement(&scene, &points, [1024, 1024, 8192]);
    let total = runs(&scene, &points[8..12], 1024, Estimator::Mis).mean();
    let direct = std::f64::consts::PI * 1.43 / 16.0;
    assert!(total > 0.5 * direct, "the floor gets {total} of a flux of {direct} per square metre");
}

#[test]
fn two_lamps_a_sky_and_a_blocker() {
    let double_sided = bevy_kiln::scene::Material { double_sided: true, ..glowing(0.3, 5.0) };
    let triangle = vec![Vec3::new(-1.0, 1.0, 0.5), Vec3::new(-0.2, 1.6, 0.4), Vec3::new(-0.7, 1.2, 1.4)];
    let scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-2.0, 0.0, -2.0), [Vec3::Z * 4.0, Vec3::X * 4.0], grey(0.6))
        .quad("shelf", Vec3::new(-1.0, 0.5, -1.0), [Vec3::Z, Vec3::X], grey(0.8))
        .mesh("lamp", triangle, vec![0, 1, 2], None, double_sided)
        .rect_light(
            "panel",
            Vec3::new(0.8, 1.2, -0.3),
            Vec3::new(-0.3, -1.0, 0.2),
            Vec2::new(0.7, 0.9),
            Vec3::splat(4.0),
        )
        .sky(Vec3::splat(0.2))
        .build();
    let points = [(-0.5, -0.5), (0.3, 0.4), (-1.2, 0.8), (1.1, -0.9), (0.1, 1.6)]
        .map(|(x, z)| at(Vec3::new(x, 0.0, z), Vec3::Y));
    assert_agreement(&scene, &points, [1024, 1024, 8192]);
}
