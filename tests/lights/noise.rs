//! How noisy light is at equal samples, and whether all ways to sample it mean the same.

use super::common::meter::{agree, at, on_walls, read};
use super::common::scenes::{SceneBuilder, grey};
use super::{ALL, lit_by, picture, point_light, sphere_light, sun, under, up};
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::math::Welford;
use bevy_kiln::scene::{Light, Scene, SpotLight};
use bevy_kiln::trace::{Estimator, Transport};
use glam::{Quat, Vec2, Vec3};

/// Variance of a single sample's worth, from the standard error.
fn variance(scene: &Scene, point: MeterPoint, samples: u32, estimator: Estimator) -> (f64, f64) {
    let mut spread = Welford::default();
    for run in 0..32 {
        let transport = Transport { estimator, seed: 100 * (estimator as u64 + 1) + run, ..Transport::default() };
        spread.push(read(scene, &[point], samples, transport)[0].irradiance.y);
    }
    (spread.mean(), spread.variance())
}

/// One bright pixel: aiming at it leaves less than a hundredth of the variance of going where the cosine leads.
#[test]
fn one_bright_pixel() {
    let bright = Vec3::new(0.3, 0.8, -0.5).normalize();
    let scene =
        under(picture([64, 32], Quat::IDENTITY, |w| Vec3::splat(if w.distance(bright) < 0.05 { 1000.0 } else { 0.1 })));
    let [(mis, mis_variance), (light, light_variance), (bsdf, bsdf_variance)] =
        ALL.map(|estimator| variance(&scene, up(), 1024, estimator));
    println!(
        "variance over 1024 samples: mis {mis_variance:.3e}, light {light_variance:.3e}, bsdf {bsdf_variance:.3e}"
    );
    assert!((mis / light - 1.0).abs() < 0.02 && (mis / bsdf - 1.0).abs() < 0.1, "{mis} {light} {bsdf}");
    assert!(bsdf_variance > 100.0 * mis_variance, "{bsdf_variance} {mis_variance}");
    assert!(bsdf_variance > 100.0 * light_variance, "{bsdf_variance} {light_variance}");
}

/// A ceiling of 500 small lamps against one of the same extent and power: as much light, and an error at equal samples
/// of at most twice as much.
#[test]
fn five_hundred_small_lamps_are_as_good_as_a_large_one() {
    let (columns, rows) = (25, 20);
    let size = Vec2::new(2.5, 2.0);
    let pitch = size / Vec2::new(columns as f32, rows as f32);
    let centre = |index: u32| {
        let place = (Vec2::new((index % columns) as f32, (index / columns) as f32) + 0.5) * pitch - 0.5 * size;
        Vec3::new(place.x, 2.0, place.y)
    };
    let one = SceneBuilder::default().rect_light("lamp", Vec3::Y * 2.0, Vec3::NEG_Y, size, Vec3::ONE).build();
    // A quarter of the area, four times the radiance.
    let panels = (0..columns * rows).fold(SceneBuilder::default(), |scene, index| {
        scene.rect_light(&format!("lamp {index}"), centre(index), Vec3::NEG_Y, 0.5 * pitch, Vec3::splat(4.0))
    });
    let panels = panels.build();
    let bulbs = lit_by((0..columns * rows).map(|index| {
        let intensity = pitch.element_product();
        Light::Point(point_light(&format!("bulb {index}"), centre(index), intensity, 0.01))
    }));
    let mut worst = 0.0_f64;
    for point in [
        up(),
        at(Vec3::new(1.5, 0.0, 1.0), Vec3::Y),
        at(Vec3::new(0.2, 1.0, 0.1), Vec3::Y),
        at(Vec3::new(3.0, 0.5, 0.0), Vec3::NEG_X),
    ] {
        for estimator in [Estimator::Mis, Estimator::Light] {
            let found = [&one, &panels, &bulbs].map(|scene| variance(scene, point, 256, estimator));
            let [one, panels, bulbs] = found.map(|(mean, variance)| variance.sqrt() / mean);
            println!(
                "{estimator:?} at {}: relative error of one lamp {one:.5}, of 500 panels {panels:.5}, of 500 bulbs \
                 {bulbs:.5}",
                point.position,
            );
            assert!((found[1].0 / found[0].0 - 1.0).abs() < 0.01, "{found:?}");
            if estimator == Estimator::Mis {
                worst = worst.max(panels / one);
            }
        }
    }
    assert!(worst < 2.0, "{worst}");
}

/// A room with a window and a shelf.
fn room() -> SceneBuilder {
    let side = || grey(0.6);
    SceneBuilder::default()
        .quad("floor", Vec3::ZERO, [Vec3::Z * 3.0, Vec3::X * 3.0], side())
        .quad("back", Vec3::ZERO, [Vec3::X * 3.0, Vec3::Y * 3.0], side())
        .quad("left", Vec3::ZERO, [Vec3::Y * 3.0, Vec3::Z * 3.0], side())
        .quad("shelf", Vec3::new(0.5, 1.0, 0.2), [Vec3::Z, Vec3::X * 1.5], side())
}

#[test]
fn three_estimators_agree() {
    let lamps = [
        sphere_light("bulb", Vec3::new(2.0, 1.5, 1.5), 3.0, 0.3),
        sphere_light("large", Vec3::new(1.0, 3.2, 2.0), 0.5, 0.9),
        sun("sun", Vec3::new(0.5, 1.0, 0.7), 2.0, 0.5),
        Light::Spot(SpotLight {
            bulb: point_light("spot", Vec3::new(2.5, 2.5, 2.5), 3.0, 0.2),
            direction: Vec3::new(-1.0, -1.0, -1.0).normalize(),
            inner_angle: 0.2,
            outer_angle: 0.7,
        }),
        sun("low", Vec3::new(1.0, 0.1, 0.2), 1.0, 0.0),
    ];
    let sky =
        picture([32, 16], Quat::from_rotation_y(0.4), |w| Vec3::splat(0.2 + 3.0 * w.dot(Vec3::X).max(0.0).powi(8)));
    let mut all = room().build();
    all.lights = lamps.to_vec();
    all.environment = Some(sky.clone());
    let mut bulbs = room().build();
    bulbs.lights = lamps[..2].to_vec();
    let mut suns = room().build();
    suns.lights = vec![lamps[2].clone(), lamps[4].clone()];
    let mut pictured = room().build();
    pictured.environment = Some(sky);
    let points = on_walls(Vec3::ZERO, Vec3::splat(3.0), 2);
    let points = [&points[..4], &points[8..12]].concat();
    for (name, scene) in [("all", all), ("bulbs", bulbs), ("suns", suns), ("picture", pictured)] {
        let [mis, light, bsdf] = ALL.map(|estimator| {
            let samples = if estimator == Estimator::Bsdf { 8192 } else { 1024 };
            let mut means = Welford::default();
            for run in 0..16 {
                let transport =
                    Transport { estimator, seed: 1000 * (estimator as u64 + 1) + run, ..Transport::default() };
                let readings = read(&scene, &points, samples, transport);
                means.push(readings.iter().map(|reading| reading.irradiance.y).sum::<f64>() / points.len() as f64);
            }
            means
        });
        for other in [&light, &bsdf] {
            agree(&mis, other).unwrap_or_else(|reason| panic!("{name}: {reason}"));
        }
        let mut biased = Welford::default();
        for run in 0..16 {
            biased.push(mis.mean() * 1.02 + mis.variance().sqrt() * (f64::from(run) - 7.5) / 5.0);
        }
        agree(&mis, &biased).expect_err("a planted bias of 2 % went unseen");
    }
}
