//! Spheres, points and cones.

use super::common::meter::{at, mean, on_walls, read};
use super::common::scenes::{SceneBuilder, grey};
use super::common::statistics::mean_within;
use super::{ALL, above_the_horizon, assert_point, lit_by, point_light, sphere_light, up};
use bevy_kiln::math::sphere_above_horizon;
use bevy_kiln::scene::{Light, PointLight, SpotLight};
use bevy_kiln::trace::{Estimator, Transport};
use glam::Vec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// π L (r/d)² cos θ.
#[test]
fn a_sphere_above_the_horizon() {
    for (centre, radius) in
        [(Vec3::new(0.0, 2.0, 0.0), 0.5_f32), (Vec3::new(2.0, 1.5, -0.5), 0.7), (Vec3::Y * 3.0, 2.9)]
    {
        let scene = lit_by([sphere_light("bulb", centre, 1.0, radius)]);
        let direction = f64::from(centre.normalize().y);
        let truth = PI * sphere_above_horizon(f64::from(radius), f64::from(centre.length()), direction);
        assert_point(&scene, up(), truth, 2e-3, &ALL);
    }
    let truth = 0.196349541;
    assert_point(&lit_by([sphere_light("bulb", Vec3::Y * 2.0, 1.0, 0.5)]), up(), truth, 1e-3, &ALL);
}

/// A room and its bulb made smaller together keep their light: no length of the program's own decides what is a sphere.
/// And a bulb too small for any direction to tell gives what a point gives.
#[test]
fn a_bulb_of_any_size() {
    for scale in [1e-12_f32, 1e-6, 1.0, 1e6] {
        let scene = lit_by([sphere_light("bulb", Vec3::Y * 2.0 * scale, 1.0, 0.5 * scale)]);
        assert_point(&scene, up(), 0.196349541, 1e-3, &ALL);
    }
    for radius in [1e-6_f32, 1e-12, 1e-20, 0.0] {
        let scene = lit_by([Light::Point(point_light("bulb", Vec3::new(0.6, 0.8, 0.0), 2.0, radius))]);
        assert_point(&scene, up(), 1.6, 1e-4, &[Estimator::Mis, Estimator::Light]);
    }
}

#[test]
fn a_sphere_that_the_horizon_cuts() {
    for (elevation, half_angle) in [(0.2_f64, 0.5_f64), (-0.3, 0.6), (0.0, 0.25)] {
        let centre = 3.0 * Vec3::new(elevation.cos() as f32, elevation.sin() as f32, 0.0);
        let scene = lit_by([sphere_light("bulb", centre, 1.0, (3.0 * half_angle.sin()) as f32)]);
        assert_point(&scene, up(), above_the_horizon(elevation, half_angle), 3e-3, &ALL);
    }
    // Wholly below.
    assert_point(&lit_by([sphere_light("bulb", Vec3::new(1.0, -0.6, 0.0), 1.0, 0.5)]), up(), 0.0, 1e-9, &ALL);
}

/// A receiver inside sees the sphere shrunk until it touches: as much light as from its middle.
#[test]
fn a_receiver_inside_a_sphere() {
    let lamp = Light::Point(point_light("bulb", Vec3::new(0.3, 0.4, 0.0), 2.0, 1.5));
    assert_point(
        &lit_by([lamp.clone()]),
        up(),
        2.0 / 0.25 * above_the_horizon(0.8_f64.asin(), FRAC_PI_2) / PI,
        3e-3,
        &ALL,
    );
    // Facing it, where nothing is lost below the horizon.
    let facing = at(Vec3::ZERO, Vec3::new(0.6, 0.8, 0.0));
    assert_point(&lit_by([lamp]), facing, 2.0 / 0.25, 2e-3, &ALL);
}

/// I cos θ / d², under Bevy's range window and in Bevy's cone.
#[test]
fn points_and_spots() {
    let position = Vec3::new(0.5, 2.0, 1.0);
    let point = point_light("bulb", position, 3.0, 0.0);
    let bare = 3.0 * f64::from(position.normalize().y) / f64::from(position.length_squared());
    assert_point(&lit_by([Light::Point(point.clone())]), up(), bare, 1e-5, &ALL);
    let ranged = PointLight { range: Some(3.0), ..point.clone() };
    let window = (1.0 - (f64::from(position.length_squared()) / 9.0).powi(2)).powi(2);
    assert_point(&lit_by([Light::Point(ranged)]), up(), bare * window, 1e-4, &ALL);
    let out_of_range = PointLight { range: Some(2.0), ..point.clone() };
    assert_point(&lit_by([Light::Point(out_of_range)]), up(), 0.0, 1e-12, &ALL);
    for (inner, outer) in [(0.1_f32, 0.8_f32), (0.0, 0.6), (0.3, 0.3), (0.7, 0.7)] {
        let spot =
            |bulb| Light::Spot(SpotLight { bulb, direction: Vec3::NEG_Y, inner_angle: inner, outer_angle: outer });
        let cosine = f64::from(position.normalize().y);
        let [inside, outside] = [inner, outer].map(|angle| f64::from(angle).cos());
        let share = ((cosine - outside) / (inside - outside).max(1e-4)).clamp(0.0, 1.0).powi(2);
        assert_point(&lit_by([spot(point.clone())]), up(), bare * share, 1e-4, &ALL);
        // All of a sphere is dimmed alike.
        let sphere = PointLight { radius: 0.4, ..point.clone() };
        assert_point(&lit_by([spot(sphere)]), up(), bare * share, 3e-3, &ALL);
    }
}

/// Light passes a lamp that blocks nothing, from a lamp that is inside another, and the room keeps what it gets.
#[test]
fn bulbs_in_a_closed_room_balance() {
    let wall = || grey(0.5);
    let mut scene = SceneBuilder::default()
        .room(Vec3::ZERO, Vec3::splat(2.0), [wall(), wall(), wall(), wall(), wall(), wall()])
        .build();
    scene.lights = vec![
        sphere_light("large", Vec3::splat(1.0), 1.0, 0.5),
        sphere_light("small", Vec3::new(1.1, 0.9, 1.2), 4.0, 0.1),
        Light::Point(point_light("point", Vec3::new(0.4, 1.3, 1.2), 1.0, 0.0)),
    ];
    // Mean E over the walls: flux / (area · (1 − ρ)).
    let flux = 4.0 * PI * (PI * 0.25 + PI * 4.0 * 0.01 + 1.0);
    let points = on_walls(Vec3::ZERO, Vec3::splat(2.0), 8);
    let readings = read(&scene, &points, 256, Transport::default());
    let (found, error) = mean(&readings, 0);
    mean_within(found, error, flux / (24.0 * 0.5), 0.01 * flux / 12.0).unwrap();
}
