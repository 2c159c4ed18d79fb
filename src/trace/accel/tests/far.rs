//! Rays from outside the scene, from next to it to a billion of its sizes away.

use crate::math::testing::Random;
use crate::scene::Material;
use crate::trace::Tally;
use crate::trace::accel::Accel;
use crate::trace::sampler::Sobol;
use crate::trace::testing::{Shape, of_any_size};
use crate::trace::{Tracer, Transport};
use glam::{Affine3A, DVec3, Vec3};

/// Distances in sizes of the scene, up to those at which f32 direction and f64 length still mean something.
const DISTANCES: [f32; 7] = [1.0, 3.0, 30.0, 1e4, 1e6, 1e8, 3e9];

/// Along the axes, where a direction has no error: what lies ahead is met, at the distance at which it lies, and what
/// lies beside is not, to f32's own steps in the scene.
#[test]
fn along_the_axes() {
    for size in [1e-6, 1.0, 1e6] {
        let shape = Shape::cube().moved(|vertex| size * vertex);
        let accel = Accel::new(&shape.corners());
        let mut random = Random::new(1);
        for distance in DISTANCES {
            for axis in 0..3 {
                for sign in [1.0, -1.0] {
                    let mut direction = Vec3::ZERO;
                    direction[axis] = -sign;
                    let mut from = |low: f32, high: f32| {
                        let mut within = || size * (low + (high - low) * random.unit());
                        let mut from = Vec3::new(within(), within(), within());
                        from[axis] = sign * distance * size + 0.5 * size;
                        from
                    };
                    for _ in 0..50 {
                        let origin = from(1e-6, 1.0 - 1e-6);
                        let wall = if sign > 0.0 { size } else { 0.0 };
                        let truth = sign * (origin[axis] - wall);
                        let hit = accel.closest(origin, direction, f32::INFINITY);
                        assert!(
                            hit.is_some_and(|hit| (hit.t - truth).abs() <= 1e-6 * truth.max(size)),
                            "{origin} {direction} {hit:?} {truth}"
                        );
                        assert!(accel.is_blocked_towards(origin, direction));
                        let beyond = origin + 2.0 * (distance + 1.0) * size * direction;
                        assert!(accel.is_blocked(origin, beyond) && accel.is_blocked(beyond, origin), "{origin}");
                        assert!(!accel.is_blocked(origin, origin - distance * size * direction));
                        assert!(accel.closest(origin, direction, 0.9 * truth).is_none());

                        let beside = from(1.0 + 1e-5, 1.5);
                        let beyond = beside + 2.0 * (distance + 1.0) * size * direction;
                        assert!(accel.closest(beside, direction, f32::INFINITY).is_none(), "{beside}");
                        assert!(!accel.is_blocked_towards(beside, direction) && !accel.is_blocked(beside, beyond));
                    }
                }
            }
        }
    }
}

/// In any direction, against the f64 line: a sphere's rim, to the sphere's own facets.
#[test]
fn past_the_rim_of_a_sphere() {
    let corners = Shape::icosphere(4).corners();
    // As far inside as facets cut into the sphere.
    let inner = corners.iter().map(|[a, b, c]| a.cross(*b).dot(*c) / (b - a).cross(c - a).length());
    let inner = inner.fold(1.0_f32, |inner, facet| inner.min(facet.abs()));
    let accel = Accel::new(&corners);
    let mut random = Random::new(2);
    let [mut met, mut passed] = [0, 0];
    for _ in 0..100_000 {
        let origin = of_any_size(&mut random, 0.5, 6.0) * random.direction();
        let towards = 1.3 * random.direction() * random.unit();
        let target = origin.as_dvec3() + (towards - origin).as_dvec3();
        let direction = (target - origin.as_dvec3()).normalize().as_vec3();
        // Exactly how far from the centre the line passes, of the direction as it is.
        let (o, d): (DVec3, DVec3) = (origin.as_dvec3(), direction.as_dvec3().normalize());
        let nearest = (o - d * o.dot(d)).length();
        let is_met = accel.closest(origin, direction, f32::INFINITY).is_some();
        assert_eq!(accel.is_blocked_towards(origin, direction), is_met);
        if nearest < f64::from(inner) - 1e-6 {
            assert!(is_met, "{origin} {direction} passes at {nearest}");
            met += 1;
        } else if nearest > 1.0 + 1e-6 {
            assert!(!is_met, "{origin} {direction} passes at {nearest}");
            passed += 1;
        }
    }
    assert!(met > 10_000 && passed > 5_000, "{met} {passed}");
}

/// A segment to somewhere so far that the square of its length is no f32.
#[test]
fn to_the_end_of_the_world() {
    let accel = Accel::new(&Shape::cube().corners());
    for distance in [1e6, 1e9, 1e12, 1e18, 1e30] {
        let above = Vec3::new(0.3, distance, 0.4);
        assert!(accel.is_blocked(Vec3::splat(0.5), above), "{distance}");
        // From farther away a ray is off by more than the room is large.
        if distance > 1e12 {
            continue;
        }
        let roof = Vec3::new(0.3, 1.5, 0.4);
        assert!(!accel.is_blocked(roof, above) && !accel.is_blocked(above, roof), "{distance}");
        assert!(accel.is_blocked(above, Vec3::splat(0.5)) && accel.is_blocked(above.with_y(-distance), above));
        assert!(!accel.is_blocked(above + Vec3::X, above), "{distance}");
    }
}

/// A pane of 1 m² that glows with 1 cd/m² gives 1/d² lx, and shows 1 cd/m², however far away.
#[test]
fn a_pane_seen_from_afar() {
    let pane = Shape {
        positions: vec![
            Vec3::new(-0.5, -0.5, 0.0),
            Vec3::new(0.5, -0.5, 0.0),
            Vec3::new(0.5, 0.5, 0.0),
            Vec3::new(-0.5, 0.5, 0.0),
        ],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    let scene = pane.scene(Material::emissive("pane", Vec3::ONE), Affine3A::IDENTITY);
    let tracer = Tracer::new(&scene);
    let transport = Transport::default();
    for distance in DISTANCES.into_iter().skip(2) {
        let look = |x: f32| {
            let (eye, ahead) = (Vec3::new(x, 0.2, distance), Vec3::NEG_Z);
            tracer.camera_radiance(eye, ahead, &Sobol::new(1, 0), &transport, &mut Tally::default()).y
        };
        assert_eq!([look(0.0), look(0.499), look(0.501)], [1.0, 1.0, 0.0], "{distance}");
        let start = tracer.start_at(Vec3::new(0.1, 0.2, distance), Vec3::NEG_Z);
        let path = |index| {
            f64::from(tracer.diffuse_radiance(&start, &Sobol::new(2, index), &transport, &mut Tally::default()).y)
        };
        let found = (0..64).map(path).sum::<f64>() / 64.0 * std::f64::consts::PI;
        let truth = f64::from(distance).powi(-2);
        let tolerance = truth * (1e-5 + truth);
        assert!((found - truth).abs() < tolerance, "{distance}: {found} {truth}");
    }
}
