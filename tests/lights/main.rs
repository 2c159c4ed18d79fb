//! Lights against closed forms and quadrature: spheres, points, cones, suns and pictures of the sky; noise against
//! samples where the choice of light decides it; and the three estimators against each other.
//!
//! A test passes only if |mean − truth| + 4 standard errors ≤ tolerance: too noisy fails like wrong.

#[path = "../common/mod.rs"]
mod common;
mod lamps;
mod noise;
mod sky;

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::scene::{DirectionalLight, EnvironmentMap, Light, PointLight, Scene};
use bevy_kiln::trace::Estimator;
use common::meter::{at, by, read};
use common::statistics::mean_within;
use glam::{Quat, Vec2, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

const ALL: [Estimator; 3] = [Estimator::Mis, Estimator::Light, Estimator::Bsdf];

fn point_light(name: &str, position: Vec3, intensity: f32, radius: f32) -> PointLight {
    PointLight {
        id: StableId::new(name),
        name: name.into(),
        position,
        intensity: Vec3::splat(intensity),
        radius,
        range: None,
    }
}

/// A sphere of this radiance.
fn sphere_light(name: &str, position: Vec3, radiance: f32, radius: f32) -> Light {
    Light::Point(point_light(name, position, radiance * (PI as f32) * radius * radius, radius))
}

fn sun(name: &str, towards: Vec3, illuminance: f32, angular_diameter: f32) -> Light {
    Light::Directional(DirectionalLight {
        id: StableId::new(name),
        name: name.into(),
        direction: -towards.normalize(),
        illuminance: Vec3::splat(illuminance),
        angular_diameter,
    })
}

fn lit_by(lights: impl IntoIterator<Item = Light>) -> Scene {
    let scene = Scene { lights: lights.into_iter().collect(), ..Scene::default() };
    assert_eq!(scene.validate(), []);
    scene
}

/// A picture of the sky from its radiance in a direction of its own frame, taken at the pixels' middles.
fn picture(size: [u32; 2], world_from_map: Quat, radiance: impl Fn(Vec3) -> Vec3) -> EnvironmentMap {
    let [width, height] = size;
    let middle = |index: u32| {
        let place = Vec2::new((index % width) as f32 + 0.5, (index / width) as f32 + 0.5);
        EnvironmentMap::direction_of(place / Vec2::new(width as f32, height as f32))
    };
    EnvironmentMap {
        name: "sky".into(),
        width,
        height,
        radiance: (0..width * height).map(|index| radiance(middle(index))).collect(),
        world_from_map,
    }
}

fn under(map: EnvironmentMap) -> Scene {
    let scene = Scene { environment: Some(map), ..Scene::default() };
    assert_eq!(scene.validate(), []);
    scene
}

/// Holds a point against `truth`, to a relative `tolerance` (absolute for darkness), by these estimators.
#[track_caller]
fn assert_point(scene: &Scene, point: MeterPoint, truth: f64, tolerance: f64, estimators: &[Estimator]) {
    for &estimator in estimators {
        // Rays that leave the surface find what is small but rarely, so that less can be asked of them.
        let is_blind = estimator == Estimator::Bsdf && truth > 0.0;
        let (samples, tolerance) = if is_blind { (1 << 18, tolerance.max(0.03)) } else { (1 << 15, tolerance) };
        let reading = read(scene, &[point], samples, by(estimator))[0];
        let allowed = if truth == 0.0 { tolerance } else { tolerance * truth };
        mean_within(reading.irradiance.y, reading.stderr.y, truth, allowed)
            .unwrap_or_else(|reason| panic!("{estimator:?}: {reason}"));
    }
}

fn up() -> MeterPoint {
    at(Vec3::ZERO, Vec3::Y)
}

/// ∫ of the cosine over the part above the horizon of a cone of this half angle, its axis at this elevation, by
/// quadrature over the polar angle from the zenith.
fn above_the_horizon(elevation: f64, half_angle: f64) -> f64 {
    let steps = 200_000;
    let step = FRAC_PI_2 / f64::from(steps);
    let zenith = FRAC_PI_2 - elevation;
    let ring = |index: i32| {
        let theta = (f64::from(index) + 0.5) * step;
        // Half the width in longitude of the cone on this ring.
        let cosine = (half_angle.cos() - theta.cos() * zenith.cos()) / (theta.sin() * zenith.sin());
        2.0 * cosine.clamp(-1.0, 1.0).acos() * theta.cos() * theta.sin() * step
    };
    (0..steps).map(ring).sum()
}

#[test]
fn the_quadrature_is_right_where_the_answer_is_known() {
    // Wholly above: π sin² of the half angle × sin of the elevation. Half of it (Howell's catalogue, B-15): a − sin a
    // cos a.
    assert!((above_the_horizon(0.7, 0.3) / (PI * 0.3_f64.sin().powi(2) * 0.7_f64.sin()) - 1.0).abs() < 1e-6);
    assert!((above_the_horizon(0.0, 0.8) / (0.8 - 0.8_f64.sin() * 0.8_f64.cos()) - 1.0).abs() < 1e-5);
    assert!(above_the_horizon(-0.5, 0.4).abs() < 1e-12);
}
