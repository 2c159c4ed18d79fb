//! Where rays start: off their own triangle, however large, small, far away or distorted it is, and no farther.

use crate::math::testing::Random;
use crate::math::{Frame, combine, square_to_cosine_hemisphere, square_to_triangle};
use crate::trace::accel::Accel;
use crate::trace::surface::{Placement, TriangleShape};
use crate::trace::testing::{Shape, of_any_size};
use crate::trace::{PathStart, Tracer};
use glam::{Affine3A, Mat3, Quat, Vec2, Vec3};
use rayon::prelude::*;
use std::f32::consts::{FRAC_1_SQRT_2, TAU};
use std::ops::Add;

/// A neighbour this many times as far above a triangle as the ray's start is moved must be seen: 1.35 by the bound, and
/// a rounding of the neighbour's own vertices, 0.05.
const NEIGHBOUR: f32 = 1.4;

/// Rays at a neighbour.
const NEIGHBOUR_RAYS: u64 = 50;

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

/// A random triangle under a random transform; `None` for what rounds to no area or is refused as singular.
fn scene(random: &mut Random) -> Option<Tracer> {
    let place = of_any_size(random, -8.0, 8.0) * vector(random);
    let size = of_any_size(random, -8.0, 8.0);
    let triangle = Shape::triangle([0, 1, 2].map(|_| place + size * vector(random)));
    let decades = if random.unit() < 0.5 { 16.0 } else { 2.0 };
    let tracer = triangle.tracer(any_transform(random, decades));
    (tracer.triangle_count() == 1).then_some(tracer)
}

/// Weights of points inside, on an edge and on a vertex.
fn any_weights(random: &mut Random) -> [f32; 2] {
    let [s, t] = square_to_triangle(random.square()).to_array();
    match (6.0 * random.unit()) as u32 {
        0 => [0.0, t],
        1 => [s, 1.0 - s],
        2 => [1.0, 0.0],
        _ => [s, t],
    }
}

/// A direction on the side of `normal`, as the tracer judges sides; every second one runs along the surface, down to
/// 10⁻⁶ rad, where rounding weighs most.
fn departure(normal: Vec3, index: u32, random: &mut Random) -> Option<Vec3> {
    let local = if index.is_multiple_of(2) {
        square_to_cosine_hemisphere(random.square())
    } else {
        Vec2::from_angle(TAU * random.unit()).extend(of_any_size(random, -6.0, -2.0)).normalize()
    };
    let direction = Frame::new(normal).world_from_local(local);
    (normal.dot(direction) > 0.0).then_some(direction)
}

/// What was shot and what went wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Tally {
    triangles: u64,
    spawned: u64,
    self_hits: u64,
    /// Rays at a neighbour, and those that missed it.
    neighbour: u64,
    missed: u64,
    /// Powers of ten of the largest coordinate and of the longest edge.
    decades: [[i32; 2]; 2],
}

impl Add for Tally {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        if self.triangles == 0 || other.triangles == 0 {
            return if self.triangles == 0 { other } else { self };
        }
        let wider = |a: [i32; 2], b: [i32; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        Self {
            triangles: self.triangles + other.triangles,
            spawned: self.spawned + other.spawned,
            self_hits: self.self_hits + other.self_hits,
            neighbour: self.neighbour + other.neighbour,
            missed: self.missed + other.missed,
            decades: [wider(self.decades[0], other.decades[0]), wider(self.decades[1], other.decades[1])],
        }
    }
}

/// Rays from both sides of one random triangle, `count` in all, and some at a neighbour on each side.
fn shoot_from(start: impl Fn(&Tracer, [f32; 2], Vec3) -> PathStart, random: &mut Random, count: u32) -> Tally {
    let Some(tracer) = scene(random) else {
        return Tally::default();
    };
    let shape = &tracer.triangles[0];
    let coordinate = shape.vertices.iter().fold(0.0_f32, |far, vertex| far.max(vertex.abs().max_element()));
    let decade = |length: f32| [length.log10().floor() as i32; 2];
    let mut tally = Tally { triangles: 1, decades: [decade(coordinate), decade(longest(shape))], ..Tally::default() };
    for side in [1.0, -1.0] {
        let normal = side * shape.normal;
        let mut vertex = start(&tracer, any_weights(random), normal);
        for index in 0..count / 2 {
            if index.is_multiple_of(20) {
                vertex = start(&tracer, any_weights(random), normal);
            }
            if let Some(direction) = departure(normal, index, random) {
                tally.spawned += 1;
                let is_hit = tracer.accel.closest(vertex.origin(), direction, f32::INFINITY).is_some()
                    || tracer.accel.is_blocked_towards(vertex.origin(), direction);
                tally.self_hits += u64::from(is_hit);
            }
        }
        let missed = shoot_at_neighbour(&tracer, &start, normal, random);
        tally.neighbour += missed.map_or(0, |_| NEIGHBOUR_RAYS);
        tally.missed += missed.unwrap_or(0);
    }
    tally
}

fn longest(shape: &TriangleShape) -> f32 {
    let [a, b, c] = shape.vertices;
    a.distance(b).max(b.distance(c)).max(c.distance(a))
}

/// How many rays miss a parallel neighbour [`NEIGHBOUR`] bounds away; `None` beside a triangle so narrow that they may
/// pass.
fn shoot_at_neighbour(
    tracer: &Tracer,
    start: &impl Fn(&Tracer, [f32; 2], Vec3) -> PathStart,
    normal: Vec3,
    random: &mut Random,
) -> Option<u64> {
    let shape = &tracer.triangles[0];
    // In a plane through the origin along the axes a start is moved by nothing, and any other distance is enough.
    let step = (NEIGHBOUR * shape.error.dot(normal.abs())).max(1e-12 * longest(shape));
    let neighbour = shape.vertices.map(|vertex| vertex + step * normal);
    if 2.0 * shape.area() / f64::from(longest(shape)) <= f64::from(50.0 * step) {
        return None;
    }
    let accel = Accel::new(&[shape.vertices, neighbour]);
    let mut missed = 0;
    for _ in 0..NEIGHBOUR_RAYS {
        let weights = (Vec2::splat(0.2) + 0.2 * random.square()).to_array();
        let start = start(tracer, weights, normal);
        // Within 45° of the normal.
        let slope = random.unit() * Vec2::from_angle(TAU * random.unit());
        let direction = Frame::new(normal).world_from_local((FRAC_1_SQRT_2 * slope).extend(FRAC_1_SQRT_2).normalize());
        let hit = accel.closest(start.origin(), direction, f32::INFINITY);
        missed += u64::from(hit.map(|hit| hit.triangle) != Some(1));
    }
    Some(missed)
}

/// On all threads, with the same answer for any number of them.
fn shoot(triangles: u64, rays: u32, seed: u64) -> Tally {
    let one = |index| {
        let start = |tracer: &Tracer, weights, normal| tracer.start_on_triangle(0, weights, normal);
        shoot_from(start, &mut Random::new(combine(seed, index)), rays)
    };
    (0..triangles).into_par_iter().map(one).reduce(Tally::default, Tally::add)
}

fn assert_sound(tally: Tally) {
    assert_eq!([tally.self_hits, tally.missed], [0; 2], "{tally:?}");
    assert!(tally.decades.iter().all(|[low, high]| *low <= -8 && *high >= 8), "{tally:?}");
}

#[test]
fn no_ray_meets_the_triangle_that_it_leaves_and_none_misses_a_neighbour() {
    let tally = shoot(4000, 1000, 1);
    assert!(tally.triangles > 2500 && tally.spawned > 2_000_000 && tally.neighbour > 100_000, "{tally:?}");
    assert_sound(tally);
}

/// The same with more than a hundred million rays. Takes minutes, and prints what it counted.
#[test]
#[ignore = "a hundred million rays; minutes"]
#[allow(clippy::print_stdout, reason = "the count is what it is run for")]
fn no_ray_of_a_hundred_million_meets_its_own_triangle() {
    let clock = std::time::Instant::now();
    let tally = shoot(200_000, 1000, 2);
    println!("{tally:?} in {:.0} s", clock.elapsed().as_secs_f64());
    assert!(tally.spawned >= 100_000_000, "{tally:?}");
    assert_sound(tally);
}

/// Planted: without the move, rays meet the triangle that they leave; moved by half as much again, they miss their
/// neighbour.
#[test]
fn starts_on_the_surface_itself_are_rejected() {
    let bare = |tracer: &Tracer, weights, normal| PathStart::free(tracer.triangles[0].position(weights), normal);
    let far = |tracer: &Tracer, weights, normal: Vec3| {
        let shape = &tracer.triangles[0];
        PathStart::free(shape.position(weights) + 1.5 * shape.error.dot(normal.abs()) * normal, normal)
    };
    let random = |index| Random::new(combine(3, index));
    let bare = (0..400).map(|index| shoot_from(bare, &mut random(index), 200)).fold(Tally::default(), Tally::add);
    assert!(bare.self_hits > 1000, "{bare:?}");
    let far = (0..400).map(|index| shoot_from(far, &mut random(index), 200)).fold(Tally::default(), Tally::add);
    assert!(far.self_hits == 0 && far.missed > 1000, "{far:?}");
}

/// The bound on interpolation, 10.1 of 32 units: a point computed from weights lies off the exact one by no more on any
/// axis, and comes near it.
#[test]
fn points_lie_within_the_bound() {
    let mut random = Random::new(4);
    let mut worst = 0.0_f64;
    for _ in 0..200_000 {
        let place = of_any_size(&mut random, -4.0, 4.0) * vector(&mut random);
        let Some(shape) =
            Placement::new(&any_transform(&mut random, 8.0)).triangle([0, 1, 2].map(|_| place + vector(&mut random)))
        else {
            continue;
        };
        let [a, b, c] = shape.vertices.map(Vec3::as_dvec3);
        let weights = any_weights(&mut random);
        let point = a + (b - a) * f64::from(weights[0]) + (c - a) * f64::from(weights[1]);
        let off = (shape.interpolate(weights).as_dvec3() - point).abs();
        worst = worst.max((off / shape.error.as_dvec3()).max_element());
    }
    assert!((0.05..10.1 / 32.0).contains(&worst), "{worst}");
}

/// Off the edges by the width of the rim, or by an eighth of the triangle, and nowhere moved by more than it.
#[test]
fn points_keep_off_the_edges() {
    let mut random = Random::new(6);
    let (mut kept, mut moved) = (0, 0);
    for _ in 0..20_000 {
        let place = of_any_size(&mut random, -1.0, 5.0) * vector(&mut random);
        let vertices = [0, 1, 2].map(|_| place + vector(&mut random));
        let Some(shape) = Placement::new(&Affine3A::IDENTITY).triangle(vertices) else {
            continue;
        };
        let [s, t] = any_weights(&mut random);
        let weights = [1.0 - s - t, s, t];
        if (0..3).all(|vertex| weights[vertex] >= shape.rim[vertex]) {
            assert_eq!(shape.position([s, t]), shape.interpolate([s, t]));
            kept += 1;
            continue;
        }
        moved += 1;
        let [s, t] = shape.off_the_edges(weights);
        let inside = [1.0 - s - t, s, t];
        for vertex in 0..3 {
            assert!(inside[vertex] >= 0.999 * shape.rim[vertex] - 2e-7, "{inside:?} {:?}", shape.rim);
            assert!((inside[vertex] - weights[vertex]).abs() <= 0.2501, "{inside:?} {weights:?}");
        }
        let distance = 2.0 * shape.error.max_element();
        let [a, b, c] = shape.vertices;
        let height = 2.0 * shape.area() as f32 / (c - b).length();
        if shape.rim[0] < 0.12 {
            assert!((shape.rim[0] * height / distance - 1.0).abs() < 1e-3, "{a} {b} {c}");
        }
    }
    assert!(kept > 1000 && moved > 1000, "{kept} {moved}");
}

/// The bound on the height at which a ray starts, between 0.65 and 1.35 of the move, in f64 of the rounded vertices.
#[test]
fn starts_lie_at_the_stated_height() {
    let mut random = Random::new(5);
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    for _ in 0..100_000 {
        let place = of_any_size(&mut random, -4.0, 4.0) * vector(&mut random);
        let Some(shape) =
            Placement::new(&any_transform(&mut random, 4.0)).triangle([0, 1, 2].map(|_| place + vector(&mut random)))
        else {
            continue;
        };
        let [a, b, c] = shape.vertices.map(Vec3::as_dvec3);
        let Some(normal) = (b - a).cross(c - a).try_normalize() else {
            continue;
        };
        let moved = shape.leave(shape.position(any_weights(&mut random)), shape.normal).as_dvec3();
        // A normal of f64 is off by more where its triangle is a needle.
        if shape.area() > 1e-6 * f64::from(longest(&shape)).powi(2) {
            let largest = a.abs().max(b.abs()).max(c.abs());
            let share = normal.dot(moved - a) / (16.0 * f64::from(f32::EPSILON) * largest.dot(normal.abs()));
            (low, high) = (low.min(share), high.max(share));
        }
    }
    assert!(low > 0.65 && high < 1.35 && low < 0.99 && high > 1.01, "{low} {high}");
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
