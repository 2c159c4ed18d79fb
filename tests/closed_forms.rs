//! The light meter against closed forms: direct light from Lambert's formula, light between surfaces from furnaces.
//!
//! A test passes only if |mean − truth| + 4 standard errors ≤ tolerance: too noisy fails like wrong.

mod common;

use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, MeterPoint, bake_lightmap};
use bevy_kiln::math::{coaxial_disk, corner_parallel_rectangle, corner_perpendicular_rectangle};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::{Estimator, Transport};
use common::meter::{at, by, mean, on_walls, read};
use common::scenes::{SceneBuilder, cornell_lamp, furnace, generalised_furnace, glowing, grey, lit_room};
use common::statistics::mean_within;
use glam::{Vec2, Vec3};
use std::f64::consts::PI;

/// Holds the mean over points against `truth`, to a relative `tolerance`.
#[track_caller]
fn assert_scene_mean(scene: &Scene, points: &[MeterPoint], samples: u32, truth: f64, tolerance: f64) {
    let readings = read(scene, points, samples, Transport::default());
    for channel in 0..3 {
        let (mean, error) = mean(&readings, channel);
        mean_within(mean, error, truth, tolerance * truth).unwrap();
    }
}

/// Holds a single point against `truth`, to a relative `tolerance`, by every estimator that can see it.
#[track_caller]
fn assert_direct(scene: &Scene, point: MeterPoint, truth: f64, tolerance: f64) {
    for estimator in [Estimator::Mis, Estimator::Light] {
        let transport = Transport { max_bounces: Some(0), ..by(estimator) };
        let reading = read(scene, &[point], 1 << 14, transport)[0];
        mean_within(reading.irradiance.x, reading.stderr.x, truth, tolerance * truth)
            .unwrap_or_else(|reason| panic!("{estimator:?}: {reason}"));
    }
}

#[test]
fn furnace_of_albedo_one_half() {
    assert_scene_mean(&furnace(0.5), &on_walls(Vec3::NEG_ONE, Vec3::ONE, 4), 1 << 14, PI / 0.5, 1e-3);
}

#[test]
fn furnace_of_albedo_nine_tenths() {
    assert_scene_mean(&furnace(0.9), &on_walls(Vec3::NEG_ONE, Vec3::ONE, 4), 1 << 13, PI / 0.1, 1e-3);
}

#[test]
fn furnace_of_albedo_ninety_nine_hundredths() {
    assert_scene_mean(&furnace(0.99), &on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), 1 << 13, PI / 0.01, 3e-3);
}

#[test]
fn furnace_with_different_albedos_is_equally_bright_everywhere() {
    let points = on_walls(Vec3::new(-1.0, 0.0, -2.0), Vec3::new(2.0, 1.0, 1.0), 2);
    let readings = read(&generalised_furnace(3.0), &points, 1 << 16, Transport::default());
    for (point, reading) in points.iter().zip(&readings) {
        mean_within(reading.irradiance.y, reading.stderr.y, 3.0 * PI, 0.01 * 3.0 * PI)
            .unwrap_or_else(|reason| panic!("{}: {reason}", point.position));
    }
    let (mean, error) = mean(&readings, 1);
    mean_within(mean, error, 3.0 * PI, 2e-3 * 3.0 * PI).unwrap();
}

#[test]
fn a_bounce_cap_loses_the_light_that_the_series_says() {
    // A furnace cut after n bounces: π·(1 + ρ + … + ρⁿ).
    let transport = Transport { max_bounces: Some(3), ..Transport::default() };
    let readings = read(&furnace(0.8), &on_walls(Vec3::NEG_ONE, Vec3::ONE, 3), 1 << 12, transport);
    let (mean, error) = mean(&readings, 0);
    let truth = PI * (1.0 + 0.8 + 0.64 + 0.512);
    mean_within(mean, error, truth, 2e-3 * truth).unwrap();
}

#[test]
fn parallel_rectangle_over_its_corner() {
    let scene =
        SceneBuilder::default().quad("lamp", Vec3::new(0.0, 1.5, 0.0), [Vec3::X * 2.0, Vec3::Z], glowing(0.0, 1.0));
    let truth = PI * corner_parallel_rectangle(2.0, 1.0, 1.5);
    assert_direct(&scene.build(), at(Vec3::ZERO, Vec3::Y), truth, 1e-3);
}

#[test]
fn perpendicular_rectangle_at_its_corner() {
    // In the plane x = 0, one edge along z at the receiver's height, shining along +x.
    let scene = SceneBuilder::default().quad(
        "lamp",
        Vec3::new(0.0, 0.0, 0.0),
        [Vec3::Y * 1.2, Vec3::Z * 2.0],
        glowing(0.0, 1.0),
    );
    let truth = PI * corner_perpendicular_rectangle(2.0, 1.2, 0.7);
    assert_direct(&scene.build(), at(Vec3::new(0.7, 0.0, 0.0), Vec3::Y), truth, 2e-3);
}

#[test]
fn disk_on_the_axis() {
    let corners = 720;
    let rim = |index: u32| {
        let angle = std::f32::consts::TAU * index as f32 / corners as f32;
        // Equal in area to the true disk: half of the polygon's error lies outside, half inside.
        let radius = 0.8 * (1.0 + std::f32::consts::TAU.powi(2) / 12.0 / (corners * corners) as f32);
        Vec3::new(radius * angle.cos(), 1.0, radius * angle.sin())
    };
    let mut positions = vec![Vec3::Y];
    positions.extend((0..corners).map(rim));
    let indices = (0..corners).flat_map(|index| [0, 1 + index, 1 + (index + 1) % corners]).collect();
    let scene = SceneBuilder::default().mesh("disk", positions, indices, None, glowing(0.0, 1.0)).build();
    assert_direct(&scene, at(Vec3::ZERO, Vec3::Y), PI * coaxial_disk(0.8, 1.0), 1e-3);
}

#[test]
fn four_points_on_the_cornell_floor() {
    // E/L of the lamp at full precision, by Lambert's formula (tested against Nori's values in `math`).
    let floor = [
        (278.0, 279.5, 0.044632475),
        (100.0, 100.0, 0.030656670),
        (450.0, 450.0, 0.031541122),
        (50.0, 500.0, 0.025393683),
    ];
    let scene = cornell_lamp();
    for (x, z, truth) in floor {
        assert_direct(&scene, at(Vec3::new(x, 0.0, z), Vec3::Y), truth, 1e-3);
    }
}

#[test]
fn half_a_unit_under_the_lamp_is_as_good_as_the_middle_of_the_floor() {
    let scene = cornell_lamp();
    let points = [at(Vec3::new(278.0, 0.0, 279.5), Vec3::Y), at(Vec3::new(278.0, 548.3, 279.5), Vec3::Y)];
    let transport = Transport { max_bounces: Some(0), ..Transport::default() };
    let readings = read(&scene, &points, 1 << 14, transport);
    for (reading, truth) in readings.iter().zip([0.044632475, 3.141382]) {
        mean_within(reading.irradiance.x, reading.stderr.x, truth, 5e-4 * truth).unwrap();
    }
}

#[test]
fn a_wall_and_a_floor_under_a_sky() {
    let sky = Vec3::new(1.0, 2.0, 0.5);
    // A slot twice as wide as deep, far longer than both: E/π at the floor's centre is sin(atan(w / 2h)).
    let slot = SceneBuilder::default()
        .quad("floor", Vec3::new(-1.0, 0.0, -1e4), [Vec3::Z * 2e4, Vec3::X * 2.0], grey(0.0))
        .quad("left", Vec3::new(-1.0, 0.0, -1e4), [Vec3::Y, Vec3::Z * 2e4], grey(0.0))
        .quad("right", Vec3::new(1.0, 0.0, -1e4), [Vec3::Z * 2e4, Vec3::Y], grey(0.0))
        .sky(sky)
        .build();
    let readings = read(&slot, &[at(Vec3::ZERO, Vec3::Y)], 1 << 16, Transport::default());
    for channel in 0..3 {
        let truth = PI * f64::from(sky[channel]) * (1.0_f64).atan().sin();
        mean_within(readings[0].irradiance[channel], readings[0].stderr[channel], truth, 2e-3 * truth).unwrap();
    }
}

#[test]
fn a_rectangular_light_in_a_closed_room_balances() {
    // Mean over all surfaces: E·S·(1 − ρ) = Φ, whatever the shape (4³ m room, S = 96 m², Φ = π·L·A).
    let (albedo, radiance) = (0.7, 200.0);
    let truth = PI * f64::from(radiance) * 0.5 / (96.0 * (1.0 - f64::from(albedo)));
    let settings = BakeSettings { goal: Goal::Samples(256), density: 4.0, ..BakeSettings::default() };
    let lightmap = bake_lightmap(&lit_room(albedo, radiance), &settings, &(), &CancelToken::default()).unwrap();
    let (mut sum, mut squares, mut count) = (0.0, 0.0, 0.0);
    for page in &lightmap.pages {
        for (index, _) in page.coverage.iter().enumerate().filter(|(_, coverage)| **coverage > 0.0) {
            sum += PI * f64::from(page.raw[index].y);
            squares += (PI * f64::from(page.stderr[index].y)).powi(2);
            count += 1.0;
        }
    }
    assert_eq!(count, 6.0 * 16.0 * 16.0, "every texel of six walls is covered whole");
    mean_within(sum / count, squares.sqrt() / count, truth, 5e-3 * truth).unwrap();
    let balance = lightmap.report.energy_balance.expect("the room is closed");
    assert!((balance - 1.0).abs() < 5e-3, "{balance}");
}

#[test]
fn light_is_linear_in_its_power() {
    let point = [at(Vec3::new(1.0, 0.0, 1.5), Vec3::Y)];
    let reading = |radiance| read(&lit_room(0.5, radiance), &point, 1 << 10, Transport::default())[0].irradiance;
    let unit = reading(1.0);
    for power in [1e-6_f32, 1e6] {
        let ratio = reading(power) / unit / f64::from(power);
        assert!((ratio - 1.0).abs().max_element() < 1e-5, "{ratio}");
    }
}

#[test]
fn the_back_of_a_lamp_is_dark_unless_it_is_double_sided() {
    for double_sided in [false, true] {
        let lamp = bevy_kiln::scene::Material { double_sided, ..glowing(0.0, 1.0) };
        let scene = SceneBuilder::default().quad("lamp", Vec3::Y, [Vec3::X, Vec3::Z], lamp).build();
        let readings =
            read(&scene, &[at(Vec3::Y * 2.0, Vec3::NEG_Y), at(Vec3::ZERO, Vec3::Y)], 1 << 10, Transport::default());
        let [above, below] = [0, 1].map(|index: usize| readings[index].irradiance.x > 0.0);
        assert_eq!((above, below), (double_sided, true));
    }
}

#[test]
fn bevys_range_window_dims_a_rectangular_light() {
    let mut scene = SceneBuilder::default().rect_light("lamp", Vec3::Y, Vec3::NEG_Y, Vec2::ONE, Vec3::ONE).build();
    let point = [at(Vec3::ZERO, Vec3::Y)];
    let reading = |scene: &Scene, estimator| read(scene, &point, 1 << 14, by(estimator))[0].irradiance.x;
    let full = reading(&scene, Estimator::Mis);
    let bevy_kiln::scene::Light::Rect(light) = &mut scene.lights[0] else { unreachable!("the lamp is a rectangle") };
    light.range = Some(2.0);
    let window = (1.0 - 0.5_f64.powi(4)).powi(2);
    for estimator in [Estimator::Mis, Estimator::Light, Estimator::Bsdf] {
        let ratio = reading(&scene, estimator) / full;
        assert!((ratio / window - 1.0).abs() < 0.01, "{estimator:?} {ratio} {window}");
    }
}
