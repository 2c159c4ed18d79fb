//! Where rays start: off their own triangle, however large, small, far away or distorted it is, and no farther.

use crate::math::testing::Random;
use crate::math::{Frame, square_to_cosine_hemisphere, square_to_triangle};
use crate::trace::accel::Accel;
use crate::trace::surface::Placement;
use crate::trace::testing::{Shape, of_any_size};
use crate::trace::{PathStart, Tracer};
use glam::{Affine3A, Mat3, Quat, Vec2, Vec3};
use std::f32::consts::TAU;

/// A neighbour this many times as far as the ray's start is moved must be seen. The move and the rounding of both
/// triangles take up less than two.
const NEIGHBOUR: f32 = 4.0;

fn vector(random: &mut Random) -> Vec3 {
    2.0 * Vec3::new(random.unit(), random.unit(), random.unit()) - Vec3::ONE
}

/// Any invertible transform: turned, stretched, sheared, mirrored, moved; each over `decades` powers of ten.
fn any_transform(random: &mut Random, decades: f32) -> Affine3A {
    let turn = Mat3::from_quat(Quat::from_scaled_axis(3.0 * vector(random)));
    let mut size = || of_any_size(random, -0.25 * decades, 0.25 * decades);
    let scale = Vec3::new(size(), size(), size());
    let mirror = Vec3::new(if random.unit() < 0.5 { -1.0 } else { 1.0 }, 1.0, 1.0);
    let shear = Mat3::from_cols(Vec3::X, Vec3::new(2.0 * random.unit(), 1.0, 0.0), Vec3::new(0.0, -random.unit(), 1.0));
    let distance = of_any_size(random, -0.5 * decades, 0.5 * decades);
    Affine3A::from_mat3_translation(turn * Mat3::from_diagonal(scale * mirror) * shear, distance * vector(random))
}

/// Random scenes of one triangle under one transform.
fn scenes(count: usize, seed: u64) -> impl Iterator<Item = (Tracer, Random)> {
    let mut random = Random::new(seed);
    let scene = move |_| {
        let place = of_any_size(&mut random, -8.0, 8.0) * vector(&mut random);
        let size = of_any_size(&mut random, -8.0, 8.0);
        let triangle = Shape::triangle([0, 1, 2].map(|_| place + size * vector(&mut random)));
        let tracer = triangle.tracer(any_transform(&mut random, 16.0));
        (tracer, Random::new(random.bits()))
    };
    // What rounds to no area or is refused as singular is no scene.
    (0..count).map(scene).filter(|(tracer, _)| tracer.triangle_count() == 1)
}

/// Whether a ray from `start` on the tracer's only triangle meets anything, in `count` directions on the side of
/// `normal`; every second one runs along the surface.
fn self_hits(tracer: &Tracer, start: &PathStart, normal: Vec3, count: u32, random: &mut Random) -> u32 {
    let frame = Frame::new(normal);
    let mut hits = 0;
    for index in 0..count {
        let local = if index % 2 == 0 {
            square_to_cosine_hemisphere(random.square())
        } else {
            // Down to the surface, where rounding weighs most.
            Vec2::from_angle(TAU * random.unit()).extend(of_any_size(random, -6.0, -2.0)).normalize()
        };
        let direction = frame.world_from_local(local);
        hits += u32::from(
            normal.dot(direction) > 0.0 && tracer.accel.closest(start.origin(), direction, f32::INFINITY).is_some(),
        );
    }
    hits
}

#[test]
fn no_ray_meets_the_triangle_that_it_leaves() {
    let mut count = 0;
    for (tracer, mut random) in scenes(4000, 1) {
        count += 1;
        for side in [1.0, -1.0] {
            let weights = square_to_triangle(random.square()).to_array();
            let normal = side * tracer.normal(0);
            let start = tracer.start_on_triangle(0, weights, normal);
            let hits = self_hits(&tracer, &start, normal, 200, &mut random);
            assert_eq!(hits, 0, "{:?} at {weights:?}", tracer.vertices(0));
        }
    }
    assert!(count > 2500, "{count}");
}

/// The other half: starts are so near that a wall close by is still in front of them.
#[test]
fn a_neighbour_is_not_missed() {
    let mut count = 0;
    for (tracer, mut random) in scenes(4000, 2) {
        let shape = tracer.triangles[0];
        for side in [1.0, -1.0] {
            let weights = (Vec2::splat(0.2) + 0.2 * random.square()).to_array();
            let normal = side * shape.normal;
            let step = NEIGHBOUR * shape.error.dot(normal.abs());
            let neighbour = shape.vertices.map(|vertex| vertex + step * normal);
            let [a, b, c] = shape.vertices;
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            // Beside a triangle that is hardly wider than the step, rays may pass.
            let is_wide = 2.0 * shape.area() / f64::from(longest) > f64::from(50.0 * step);
            if !is_wide {
                continue;
            }
            count += 1;
            let accel = Accel::new(&[shape.vertices, neighbour]);
            let start = tracer.start_on_triangle(0, weights, normal);
            for _ in 0..50 {
                // Within 45° of the normal.
                let local = (0.7 * random.unit() * Vec2::from_angle(TAU * random.unit())).extend(1.0).normalize();
                let direction = Frame::new(normal).world_from_local(local);
                let hit = accel.closest(start.origin(), direction, f32::INFINITY);
                assert_eq!(hit.map(|hit| hit.triangle), Some(1), "{:?} at {weights:?}, step {step}", shape.vertices);
            }
        }
    }
    assert!(count > 1000, "{count}");
}

/// Planted: without the move, rays meet the triangle that they leave.
#[test]
fn starts_on_the_surface_itself_are_rejected() {
    let mut found = 0;
    for (tracer, mut random) in scenes(400, 3) {
        let normal = tracer.normal(0);
        let weights = square_to_triangle(random.square()).to_array();
        let start = PathStart::free(tracer.triangles[0].position(weights), normal);
        found += u32::from(self_hits(&tracer, &start, normal, 200, &mut random) > 0);
    }
    assert!(found > 50, "{found}");
}

/// The bound itself: a point computed from weights lies off the plane through the exact vertices by no more.
#[test]
fn points_lie_within_the_bound() {
    let mut random = Random::new(4);
    let mut worst = 0.0_f64;
    for _ in 0..20_000 {
        let transform = any_transform(&mut random, 8.0);
        let place = of_any_size(&mut random, -4.0, 4.0) * vector(&mut random);
        let local = [0, 1, 2].map(|_| place + vector(&mut random));
        let Some(shape) = Placement::new(&transform).triangle(local) else {
            continue;
        };
        let matrix = Mat3::from(transform.matrix3).as_dmat3();
        let exact = local.map(|vertex| matrix * vertex.as_dvec3() + Vec3::from(transform.translation).as_dvec3());
        let mirrored = matrix.determinant() < 0.0;
        let [a, b, c] = if mirrored { [exact[0], exact[2], exact[1]] } else { exact };
        let weights = square_to_triangle(random.square());
        let point = a + (b - a) * f64::from(weights.x) + (c - a) * f64::from(weights.y);
        let off = (shape.position(weights.to_array()).as_dvec3() - point).abs();
        worst = worst.max((off / shape.error.as_dvec3()).max_element());
    }
    assert!((0.02..1.0).contains(&worst), "{worst}");
}

/// Of an edge that two triangles share, one owns each point, whichever it is; what is inside is its triangle's own.
#[test]
fn one_of_two_neighbours_owns_their_edge() {
    let corners =
        [Vec3::new(0.0, 0.0, 1.0), Vec3::new(2.0, 0.0, 0.0), Vec3::new(2.0, 3.0, 0.0), Vec3::new(0.0, 3.0, 1.0)];
    let placement = Placement::new(&Affine3A::IDENTITY);
    let [first, second] = [[0, 1, 2], [0, 2, 3]].map(|t| placement.triangle(t.map(|i| corners[i])).unwrap());
    for step in 1..10 {
        // Along the diagonal, from corner 0 to corner 2.
        let along = step as f32 / 10.0;
        assert!(first.owns([0.0, along]) != second.owns([along, 0.0]), "{along}");
        assert!(first.owns([0.3, 0.05 * step as f32]) && second.owns([0.3, 0.05 * step as f32]));
    }
}
