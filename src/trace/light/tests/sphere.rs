//! Spheres: their directions follow the density that is claimed for them, however large they are and wherever the
//! receiver is; a ray meets them where their samples are; points and cones give what Bevy's shader says.

use super::{along, free, lights, source};
use crate::math::testing::{ChiSquared, Domain, Random, Rejection};
use crate::math::{Frame, square_to_uniform_sphere};
use crate::trace::light::emitter::Cone;
use crate::trace::light::{Emitter, EmitterShape, End};
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::PI;

fn sphere(radius: f32) -> Emitter {
    source(EmitterShape::Sphere { centre: Vec3::new(0.3, -0.2, 0.1), radius }, false)
}

/// A sphere and a receiver at so many radii from its centre, in some direction.
fn cases() -> Vec<(Emitter, Vec3)> {
    let towards = Vec3::new(0.48, -0.6, 0.64);
    let case = |radius: f32, radii: f32| {
        let sphere = sphere(radius);
        (sphere, sphere.centre() + towards * (radius * radii))
    };
    // Far, near, all but touching, touching, inside; tiny and huge.
    let mut cases: Vec<_> =
        [30.0, 3.0, 1.05, 1.001, 1.0, 0.9, 1e-3].into_iter().map(|radii| case(1.0, radii)).collect();
    cases.extend([case(1e-6, 3e3), case(1e-3, 5.0), case(1e6, 1.5), case(1e6, 0.5)]);
    cases
}

/// 1 − cos of the half angle, and cos: from the tangent's length, not from the sine.
fn cone(emitter: &Emitter, receiver: Vec3) -> (f64, DVec3) {
    let EmitterShape::Sphere { centre, radius } = emitter.shape else { unreachable!("{emitter:?} is a sphere") };
    let offset = centre.as_dvec3() - receiver.as_dvec3();
    let radius = f64::from(radius).min(offset.length());
    let tangent = (offset.length_squared() - radius * radius).max(0.0).sqrt();
    let half_angle = radius.atan2(tangent);
    (2.0 * (0.5 * half_angle).sin().powi(2), offset)
}

/// χ² on the disc onto which the cone maps with equal areas: dω = 2 · height · dA.
fn verdict(emitter: &Emitter, receiver: Vec3, fault: impl Fn(Vec3) -> f64) -> Result<f64, Rejection> {
    let (height, offset) = cone(emitter, receiver);
    let frame = Frame::new(offset.normalize().as_vec3());
    let disc_from_world = |wi: Vec3| {
        let local = frame.local_from_world(wi);
        // A sample on the very rim may lie beside it by a rounding.
        let inside = 1.0 - 1e-6 - 2e-7 / (2.0 * height as f32).sqrt();
        (local.truncate() / ((1.0 + local.z) * height as f32).sqrt() * inside).extend(0.0)
    };
    let world_from_disc = |p: Vec3| {
        let drop = height as f32 * p.truncate().length_squared();
        frame.world_from_local((p.truncate() * (height as f32 * (2.0 - drop)).sqrt()).extend(1.0 - drop))
    };
    let density = |p: Vec3| {
        let wi = world_from_disc(p);
        let pdf = emitter.solid_angle(receiver, wi, 1.0).map_or(0.0, f64::recip);
        if p.length_squared() > 1.0 { 0.0 } else { pdf * 2.0 * height * fault(wi) }
    };
    let domain = Domain::Plane(Vec2::NEG_ONE, Vec2::ONE);
    let test = ChiSquared { cells: [31, 31], samples: 20_000, ..ChiSquared::over(domain) };
    test.run(|u| disc_from_world(emitter.sample(receiver, u).expect("it shines").wi), density)
}

#[test]
fn directions_follow_their_density() {
    for (emitter, receiver) in cases() {
        let p = verdict(&emitter, receiver, |_| 1.0);
        assert!(p.is_ok(), "{:?} from {receiver}: {p:?}", emitter.shape);
    }
}

/// Planted: a density 5 % too large, one over the sphere's disc instead of its solid angle, and one that forgets the
/// sine.
#[test]
fn wrong_densities_are_rejected() {
    for (emitter, receiver) in cases() {
        let too_large = verdict(&emitter, receiver, |_| 1.05);
        assert!(matches!(too_large, Err(Rejection::Total(_))), "{too_large:?}");
    }
    let (emitter, receiver) = cases()[2];
    let (height, offset) = cone(&emitter, receiver);
    let cosine = |wi: Vec3| wi.as_dvec3().dot(offset.normalize());
    // Both with their mean over the cone taken out: the shape alone must show.
    let projected = verdict(&emitter, receiver, |wi| cosine(wi) / (1.0 - 0.5 * height));
    assert!(matches!(projected, Err(Rejection::Counts(_))), "{projected:?}");
    let half_angle = (1.0 - height).acos();
    let by_angle = verdict(&emitter, receiver, |wi| height / (half_angle * cosine(wi).clamp(0.0, 1.0).acos().sin()));
    assert!(by_angle.is_err(), "{by_angle:?}");
}

/// What a ray finds is what was sampled: direction, distance, radiance over density.
#[test]
fn rays_meet_what_was_sampled() {
    let mut random = Random::new(11);
    for (emitter, receiver) in cases() {
        let (height, offset) = cone(&emitter, receiver);
        for _ in 0..500 {
            let u = 0.5 + 0.99 * (random.square() - 0.5);
            let sample = emitter.sample(receiver, u).expect("it shines");
            let found = emitter.intersect(receiver, sample.wi).expect("the sample lies on the sphere");
            let slack = 1e-3 * sample.distance.min(offset.length()) + 3e-4 * emitter.area().sqrt();
            assert!((f64::from(found) - sample.distance).abs() <= slack, "{found} {}", sample.distance);
            let solid_angle = sample.solid_angle.expect("it has a size");
            assert!((solid_angle / (2.0 * PI * height) - 1.0).abs() < 1e-6, "{solid_angle}");
            let radiance = emitter.radiance_towards(receiver, sample.wi).as_dvec3();
            assert!((radiance * solid_angle / sample.value - 1.0).abs().max_element() < 1e-5);
            if let End::At(target) = sample.end {
                assert!((target - receiver).dot(sample.wi) > 0.0);
            }
        }
        // Beside it, and behind the receiver, there is nothing.
        let axis = offset.normalize().as_vec3();
        assert_eq!(emitter.intersect(receiver, -axis), None);
        assert_eq!(emitter.intersect(receiver, (Frame::new(axis).tangent - 0.01 * axis).normalize()), None);
    }
}

/// Seen from afar a sphere is a point of its intensity; the integral over the cone says so at every distance.
#[test]
fn a_receiver_that_faces_the_sphere_gets_its_intensity_over_distance_squared() {
    for (emitter, receiver) in cases() {
        let (_, offset) = cone(&emitter, receiver);
        let axis = offset.normalize().as_vec3();
        let steps = 64;
        let grid =
            (0..steps * steps).map(|i| Vec2::new((i % steps) as f32 + 0.5, (i / steps) as f32 + 0.5) / steps as f32);
        let mean: f64 = grid
            .map(|u| emitter.sample(receiver, u).expect("it shines"))
            .map(|sample| sample.value.x * f64::from(sample.wi.dot(axis)))
            .sum::<f64>()
            / f64::from(steps * steps);
        let expected = 1.0 / offset.length_squared();
        assert!((mean / expected - 1.0).abs() < 1e-3, "{:?} from {receiver}: {mean} {expected}", emitter.shape);
    }
}

#[test]
fn a_point_gives_its_intensity_over_distance_squared_and_no_ray_meets_it() {
    let point = source(EmitterShape::Point { centre: Vec3::new(0.0, 2.0, 0.0) }, false);
    let lights = lights(vec![point]);
    let sample = lights.sample(&free(Vec3::ZERO), Vec2::splat(0.5), 0.5).expect("it shines");
    assert_eq!((sample.wi, sample.end, sample.pdf), (Vec3::Y, End::At(2.0 * Vec3::Y), None));
    assert_eq!((sample.value, sample.distance), (Vec3::splat(0.25), 2.0));
    assert_eq!(lights.pdf(0, &free(Vec3::ZERO), Vec3::Y, 2.0), 0.0);
    assert_eq!(lights.passed(&free(Vec3::ZERO), along(Vec3::ZERO, Vec3::Y, 9.0)).count(), 0);
}

/// Bevy's shader: saturate((cos θ − cos outer) / (cos inner − cos outer))², over all of the sphere.
#[test]
fn the_cone_of_a_spot_light() {
    let cone = Cone { direction: Vec3::NEG_Y, inner_angle: 0.3, outer_angle: 0.9 };
    for (radius, shape) in [(0.0, EmitterShape::Point { centre: Vec3::ZERO }), (0.2, sphere(0.2).shape)] {
        let spot = Emitter { cone: Some(cone), ..source(shape, false) };
        for angle in [0.0_f32, 0.2, 0.4, 0.6, 0.8, 0.89, 1.0, 2.0, 3.0] {
            let receiver = spot.centre() + 2.0 * Vec3::new(angle.sin(), -angle.cos(), 0.0);
            let share = ((angle.cos() - 0.9_f32.cos()) / (0.3_f32.cos() - 0.9_f32.cos())).clamp(0.0, 1.0);
            let found = spot.sample(receiver, Vec2::new(0.3, 0.6)).map_or(0.0, |sample| {
                let lit = spot_value(radius) * f64::from(share * share);
                sample.value.x / lit
            });
            let expected = if share > 0.0 { 1.0 } else { 0.0 };
            assert!((found - expected).abs() < 1e-4, "{angle}: {found}");
        }
    }
}

/// Radiance × solid angle of a sphere of 1 cd at 2 m.
fn spot_value(radius: f64) -> f64 {
    let cosine = (1.0 - (radius / 2.0).powi(2)).sqrt();
    0.5 / (1.0 + cosine)
}

/// Light sets out in proportion to flux: all around a sphere evenly, within a cone, from both sides of a leaf.
#[test]
fn departures_go_where_light_goes() {
    let mut random = Random::new(4);
    let mut mean = Vec3::ZERO;
    for _ in 0..20_000 {
        let u = [random.unit(), random.unit(), random.unit(), random.unit()];
        let (origin, direction) = sphere(0.5).depart(u);
        assert!((origin.distance(sphere(0.5).centre()) - 0.5).abs() < 1e-5);
        assert!(direction.dot(origin - sphere(0.5).centre()) >= 0.0);
        mean += direction / 20_000.0;
        let cone = Cone { direction: Vec3::Z, inner_angle: 0.1, outer_angle: 0.4 };
        let (_, direction) = Emitter { cone: Some(cone), ..sphere(0.5) }.depart(u);
        assert!(direction.angle_between(Vec3::Z) < 0.401);
        let (_, direction) = source(EmitterShape::Point { centre: Vec3::ZERO }, false).depart(u);
        assert_eq!(direction, square_to_uniform_sphere(Vec2::new(u[0], u[1])));
    }
    assert!(mean.length() < 0.02, "{mean}");
}
