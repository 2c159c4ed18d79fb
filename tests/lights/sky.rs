//! Suns of all sizes, and pictures of the sky.

use super::common::meter::at;
use super::common::scenes::{SceneBuilder, grey};
use super::{ALL, above_the_horizon, assert_point, lit_by, picture, point_light, sun, under, up};
use bevy_kiln::scene::Light;
use bevy_kiln::trace::Estimator;
use glam::{Quat, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// E sin of the elevation, whatever the diameter, while all of the disc is up; the quadrature's part of it where not.
#[test]
fn suns_of_several_diameters() {
    for diameter in [0.0_f32, 1e-4, 0.0093, 0.3, 1.0] {
        let elevation = 0.6_f64;
        let towards = Vec3::new(elevation.cos() as f32, elevation.sin() as f32, 0.0);
        let estimators = if diameter > 0.1 || diameter == 0.0 { &ALL[..] } else { &ALL[..2] };
        assert_point(&lit_by([sun("sun", towards, 7.0, diameter)]), up(), 7.0 * elevation.sin(), 2e-3, estimators);
    }
    let half_the_sky = lit_by([sun("sun", Vec3::Y, 7.0, std::f32::consts::PI)]);
    assert_point(&half_the_sky, up(), 7.0, 1e-3, &ALL);
    assert_point(&half_the_sky, at(Vec3::ZERO, Vec3::X), 3.5, 2e-3, &ALL);
    for (elevation, diameter) in [(0.1_f64, 0.5_f32), (-0.1, 0.5), (0.5, 3.0), (0.0, 0.1)] {
        let towards = Vec3::new(0.0, elevation.sin() as f32, elevation.cos() as f32);
        let half = 0.5 * f64::from(diameter);
        let truth = 5.0 / (PI * half.sin().powi(2)) * above_the_horizon(elevation, half);
        let estimators = if diameter > 0.3 && elevation > 0.0 { &ALL[..] } else { &ALL[..2] };
        assert_point(&lit_by([sun("sun", towards, 5.0, diameter)]), up(), truth, 4e-3, estimators);
    }
    assert_point(&lit_by([sun("sun", Vec3::NEG_Y, 5.0, 0.5)]), up(), 0.0, 1e-12, &ALL);
}

/// Uniform: E = π L, whatever the size and the rotation.
#[test]
fn a_uniform_picture_of_the_sky() {
    let tilted = Quat::from_euler(glam::EulerRot::XYZ, 0.5, -1.2, 2.0);
    for (size, rotation) in [([64, 32], Quat::IDENTITY), ([1, 1], tilted), ([1024, 512], tilted)] {
        let scene = under(picture(size, rotation, |_| Vec3::new(1.0, 2.0, 3.0)));
        assert_point(&scene, up(), 2.0 * PI, 1e-3, &ALL);
    }
}

/// L = cos of the angle to a direction, 0 beyond: E = 2π/3 facing it; where the picture's up is rotated, too.
#[test]
fn a_gradient() {
    let rotation = Quat::from_rotation_arc(Vec3::Y, Vec3::new(0.48, 0.6, -0.64));
    for rotation in [Quat::IDENTITY, rotation] {
        let scene = under(picture([1024, 512], rotation, |w| Vec3::splat(w.y.max(0.0))));
        assert_point(&scene, at(Vec3::ZERO, rotation * Vec3::Y), 2.0 * PI / 3.0, 1e-3, &ALL);
    }
    // Coarse: constant over each row. ∫ of it by rows, exactly.
    let coarse: f64 = (0..16)
        .map(|row| {
            let [top, bottom] = [row, row + 1].map(|edge| PI * f64::from(edge) / 32.0);
            PI * (bottom.sin().powi(2) - top.sin().powi(2)) * (0.5 * (top + bottom)).cos()
        })
        .sum();
    assert_point(&under(picture([64, 32], Quat::IDENTITY, |w| Vec3::splat(w.y.max(0.0)))), up(), coarse, 1e-3, &ALL);
}

/// A picture lies where its convention says, turned by its rotation: one bright octant and a meter on each side.
#[test]
fn pictures_are_the_right_way_round() {
    let rotation = Quat::from_euler(glam::EulerRot::YXZ, 0.7, 0.2, -1.1);
    let octant = picture([64, 32], rotation, |w| Vec3::splat(if w.cmpgt(Vec3::ZERO).all() { 1.0 } else { 0.0 }));
    let scene = under(octant);
    for (axis, truth) in [(Vec3::X, PI / 4.0), (Vec3::Y, PI / 4.0), (Vec3::Z, PI / 4.0), (Vec3::NEG_X, 0.0)] {
        let tolerance = if truth == 0.0 { 1e-4 } else { 2e-3 };
        assert_point(&scene, at(Vec3::ZERO, rotation * axis), truth, tolerance, &ALL);
    }
}

/// The floor of a long slot, and a wall across half of the view, under the same sky as a picture and as a constant.
#[test]
fn a_slot_and_a_wall_under_both_kinds_of_sky() {
    let skies = |build: &dyn Fn() -> SceneBuilder| {
        let mut pictured = build().build();
        pictured.environment = Some(picture([64, 32], Quat::from_rotation_z(0.3), |_| Vec3::ONE));
        [build().sky(Vec3::ONE).build(), pictured]
    };
    for (height, truth) in [(0.5_f32, 0.5_f64.sqrt()), (1.0, 0.447213595), (2.0, 0.242535625)] {
        let slot = || {
            let long = Vec3::Z * 2e4;
            SceneBuilder::default()
                .quad("floor", Vec3::new(-0.5, 0.0, -1e4), [long, Vec3::X], grey(0.0))
                .quad("left", Vec3::new(-0.5, 0.0, -1e4), [Vec3::Y * height, long], grey(0.0))
                .quad("right", Vec3::new(0.5, 0.0, -1e4), [long, Vec3::Y * height], grey(0.0))
        };
        for scene in skies(&slot) {
            assert_point(&scene, up(), PI * truth, 8e-3, &[Estimator::Mis]);
            assert_point(&scene, up(), PI * truth, 0.02, &[Estimator::Light, Estimator::Bsdf]);
        }
    }
    for elevation in [0.3_f64, 0.8] {
        let wall = || {
            let top = Vec3::Y * elevation.tan() as f32;
            let corner = Vec3::new(1.0, 0.0, -1e4);
            SceneBuilder::default().quad("wall", corner, [Vec3::Z * 2e4, top], grey(0.0))
        };
        for scene in skies(&wall) {
            assert_point(&scene, up(), FRAC_PI_2 * (1.0 + elevation.cos()), 4e-3, &ALL);
        }
    }
}

/// A sun, a point and a sky of one radiance over a floor: E = 3 cos 30° + 5 cos θ / d² + π/4.
#[test]
fn sun_point_and_sky_together() {
    let towards_sun = Vec3::new(0.0, 30.0_f32.to_radians().cos(), 30.0_f32.to_radians().sin());
    let lamp = Vec3::new(0.5, 2.0, -0.3);
    let mut scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-2.0, 0.0, -2.0), [Vec3::Z * 4.0, Vec3::X * 4.0], grey(0.0))
        .sky(Vec3::splat(0.25))
        .build();
    scene.lights = vec![sun("sun", towards_sun, 3.0, 0.0), Light::Point(point_light("bulb", lamp, 5.0, 0.0))];
    for (x, z) in [(0.0, 0.0), (1.1, -0.83), (-1.7, 1.9)] {
        let position = Vec3::new(x, 0.0, z);
        let offset = lamp - position;
        let truth = 3.0 * 30.0_f64.to_radians().cos()
            + 5.0 * f64::from(offset.y) / f64::from(offset.length()).powi(3)
            + PI / 4.0;
        assert_point(&scene, at(position, Vec3::Y), truth, 2e-3, &ALL);
    }
}
