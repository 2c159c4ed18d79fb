//! The triangle test by itself: the error that it states, and edges that two triangles share.

use super::{Crossing, ShearedRay, exact_difference_of_products, plane_distance};
use crate::math::testing::Random;
use crate::trace::testing::of_any_size;
use glam::Vec3;

fn vector(random: &mut Random) -> Vec3 {
    2.0 * Vec3::new(random.unit(), random.unit(), random.unit()) - Vec3::ONE
}

/// Needles so narrow that all three edge functions round to zero in f32 are met where they are, and only there.
#[test]
fn needles_that_f32_cannot_resolve_are_met() {
    let mut random = Random::new(3);
    let (mut inside, mut unresolved) = (0, 0);
    for _ in 0..200_000 {
        let (along, aside) = (vector(&mut random), 1e-7 * vector(&mut random));
        let [a, b, c] = [-along, along + aside, along - of_any_size(&mut random, -2.0, 0.0) * aside];
        let triangle = [a, b, c].map(|vertex| vertex.with_z(1.0));
        let edge = |p: Vec3, q: Vec3| f64::from(p.x) * f64::from(q.y) - f64::from(p.y) * f64::from(q.x);
        let edges = [edge(c, b), edge(a, c), edge(b, a)];
        let is_inside = edges.iter().all(|&edge| edge >= 0.0) || edges.iter().all(|&edge| edge <= 0.0);
        let is_met = ShearedRay::new(Vec3::ZERO, Vec3::Z).cross(&triangle).is_some();
        assert_eq!(is_met, is_inside && edges.iter().sum::<f64>() != 0.0, "{triangle:?} {edges:?}");
        inside += u32::from(is_inside);
        unresolved += u32::from([(c, b), (a, c), (b, a)].iter().all(|(p, q)| p.x * q.y - p.y * q.x == 0.0));
    }
    assert!(inside > 1000 && unresolved > 100, "{inside} {unresolved}");
}

/// The stated error of the distance holds against the plane's distance in f64, and is not vacuously large.
#[test]
fn the_stated_error_holds() {
    let mut random = Random::new(1);
    let (mut count, mut worst, mut tight) = (0, 0.0_f64, 0);
    for _ in 0..200_000 {
        let place = of_any_size(&mut random, -2.0, 3.0) * vector(&mut random);
        let triangle = [0, 1, 2].map(|_| place + vector(&mut random));
        let (origin, target) = (place + 3.0 * vector(&mut random), place + vector(&mut random));
        let direction = (target - origin).normalize();
        let Some(Crossing { t, t_error, .. }) = ShearedRay::new(origin, direction).cross(&triangle) else {
            continue;
        };
        count += 1;
        let off = (f64::from(t) - plane_distance(origin, direction, &triangle)).abs();
        worst = worst.max(off / f64::from(t_error));
        tight += u32::from(t_error < 1e-4);
    }
    assert!(count > 5000 && worst < 1.0, "{count}, {worst}");
    // At unit size the bound is small: the f64 decision is the exception.
    assert!(tight > count / 2, "{tight} of {count}");
}

/// Rays through the common edge of two triangles meet at least one, whatever the order of the vertices.
#[test]
fn no_ray_passes_between_two_triangles() {
    let mut random = Random::new(2);
    let mut crossings = 0;
    for index in 0..100_000 {
        let size = of_any_size(&mut random, -3.0, 3.0);
        let [a, b] = [0, 1].map(|_| size * vector(&mut random));
        let origin = size * (Vec3::splat(3.0) + vector(&mut random));
        let on_edge = a + random.unit() * (b - a);
        let direction = (on_edge - origin).normalize();
        // A triangle on either side of the edge as the ray sees it.
        let aside = direction.cross(b - a);
        let [left, right] = [1.0, -1.0].map(|side| on_edge + side * (0.1 + random.unit()) * aside);
        let triangles = match index % 3 {
            0 => [[a, b, left], [a, b, right]],
            1 => [[a, b, left], [b, a, right]],
            _ => [[left, b, a], [b, right, a]],
        };
        let ray = ShearedRay::new(origin, direction);
        let met = triangles.iter().filter(|triangle| ray.cross(triangle).is_some()).count();
        assert!(met > 0, "{triangles:?} from {origin} in {direction}");
        crossings += met;
    }
    assert!(crossings < 110_000, "the triangles overlap: {crossings}");
}

#[test]
fn beside_behind_and_edge_on() {
    let triangle = [Vec3::new(0.0, 0.0, 2.0), Vec3::new(1.0, 0.0, 2.0), Vec3::new(0.0, 1.0, 2.0)];
    let cross = |origin, direction| ShearedRay::new(origin, direction).cross(&triangle);
    let hit = cross(Vec3::new(0.25, 0.5, 0.0), Vec3::Z).expect("inside");
    assert_eq!((hit.t, hit.barycentric), (2.0, [0.25, 0.5]));
    assert!(hit.t_error > 0.0 && hit.t_error < 1e-4, "{hit:?}");
    assert!(cross(Vec3::new(0.75, 0.75, 0.0), Vec3::Z).is_none());
    assert_eq!(cross(Vec3::new(0.25, 0.5, 3.0), Vec3::Z).map(|hit| hit.t), Some(-1.0));
    assert!(cross(Vec3::new(-1.0, 0.25, 2.0), Vec3::X).is_none());
    // From the back, with the same weights.
    assert_eq!(cross(Vec3::new(0.25, 0.5, 5.0), Vec3::NEG_Z).map(|hit| hit.barycentric), Some([0.25, 0.5]));
}

#[test]
fn differences_of_products_keep_their_sign() {
    let (a, b) = (1.0 + f32::EPSILON, 1.0 - f32::EPSILON);
    assert_eq!(a * b - 1.0, 0.0);
    assert!(exact_difference_of_products(a, b, 1.0, 1.0) < 0.0);
    assert!(exact_difference_of_products(1.0, 1.0, a, b) > 0.0);
    assert!(exact_difference_of_products(1e-30, 1e-30, 0.0, 0.0) > 0.0);
    assert_eq!(exact_difference_of_products(3.0, 5.0, 5.0, 3.0), 0.0);
}
