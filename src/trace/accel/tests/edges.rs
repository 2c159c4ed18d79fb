//! Rays aimed at the edges and the vertices that triangles of closed shapes share: none passes between. Over 16 decades
//! of size and of distance, from inside and from the walls themselves, for both kinds of query.

use crate::math::testing::Random;
use crate::math::{combine, square_to_triangle};
use crate::trace::Tracer;
use crate::trace::accel::Accel;
use crate::trace::testing::{Shape, of_any_size};
use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3, Quat, Vec3};
use rayon::prelude::*;
use std::ops::Add;

/// What was shot and what was lost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Tally {
    shapes: u64,
    /// From within, by both kinds of query.
    inside: u64,
    /// From the walls.
    spawned: u64,
    lost_by_closest: u64,
    lost_by_blocked: u64,
    lost_spawned: u64,
    /// Powers of ten of the largest coordinates.
    decades: [i32; 2],
}

impl Add for Tally {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        if self.shapes == 0 {
            return other;
        }
        if other.shapes == 0 {
            return self;
        }
        Self {
            shapes: self.shapes + other.shapes,
            inside: self.inside + other.inside,
            spawned: self.spawned + other.spawned,
            lost_by_closest: self.lost_by_closest + other.lost_by_closest,
            lost_by_blocked: self.lost_by_blocked + other.lost_by_blocked,
            lost_spawned: self.lost_spawned + other.lost_spawned,
            decades: [self.decades[0].min(other.decades[0]), self.decades[1].max(other.decades[1])],
        }
    }
}

/// A closed shape about the origin that faces inwards and that every point within a tenth of it sees whole.
struct Vessel {
    shape: Shape,
    /// Whether all its corners are right or wider, so that no start on a wall lies beyond the next.
    is_wide: bool,
}

/// Two cones base to base, of triangles `count` times as long as wide.
fn fan(count: u32) -> Shape {
    let rim = (0..count).map(|index| {
        let (sin, cos) = (std::f32::consts::TAU * index as f32 / count as f32).sin_cos();
        Vec3::new(cos, 0.0, sin)
    });
    let positions = rim.chain([Vec3::new(0.0, 1.5, 0.0), Vec3::new(0.0, -1.5, 0.0)]).collect();
    let triangles = (0..count).flat_map(|a| {
        let b = (a + 1) % count;
        [[a, b, count], [b, a, count + 1]]
    });
    Shape { positions, triangles: triangles.collect() }
}

fn vessel(random: &mut Random) -> Vessel {
    let kind = (8.0 * random.unit()) as u32;
    match kind {
        0..=2 => Vessel { shape: Shape::icosphere(kind), is_wide: true },
        3 | 4 => Vessel { shape: Shape::cube().moved(|vertex| 2.0 * vertex - Vec3::ONE), is_wide: true },
        5 => Vessel { shape: fan(16 << (6.0 * random.unit()) as u32), is_wide: true },
        _ => {
            // Every vertex at its own distance: folds of any angle.
            let mut shape = Shape::icosphere(1 + kind % 2);
            shape.positions.iter_mut().for_each(|vertex| *vertex *= 0.6 + 0.9 * random.unit());
            Vessel { shape, is_wide: false }
        }
    }
}

fn vector(random: &mut Random) -> Vec3 {
    2.0 * Vec3::new(random.unit(), random.unit(), random.unit()) - Vec3::ONE
}

/// Shapes turned, mirrored and moved; stretched and sheared if `is_bent`.
struct Bend(bool);

fn placement(random: &mut Random, bend: Bend) -> DAffine3 {
    let turn = DMat3::from_quat(Quat::from_scaled_axis(3.0 * vector(random)).as_dquat().normalize());
    let size = f64::from(of_any_size(random, -8.0, 8.0));
    let mut scale = DVec3::splat(size);
    if random.unit() < 0.5 {
        scale.x = -scale.x;
    }
    let mut matrix = turn * DMat3::from_diagonal(scale);
    if bend.0 {
        let stretch = DVec3::new(1.0, 1.0, f64::from(of_any_size(random, -2.0, 0.0)));
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(f64::from(random.unit()), 1.0, 0.0), DVec3::Z);
        matrix *= DMat3::from_diagonal(stretch) * shear;
    }
    // A tenth of the shapes stand exactly on the axes.
    if random.unit() < 0.1 {
        matrix = DMat3::from_diagonal(scale);
    }
    let distance = size * f64::from(of_any_size(random, -3.0, 3.0));
    DAffine3::from_mat3_translation(matrix, distance * vector(random).as_dvec3())
}

/// A shared vertex, a point on a shared edge, or one inside.
fn target([a, b, c]: [DVec3; 3], random: &mut Random) -> DVec3 {
    let s = f64::from(random.unit());
    match (4.0 * random.unit()) as u32 {
        0 => a,
        1 => a + (b - a) * s,
        2 => b + (c - b) * 0.5,
        _ => {
            let u = square_to_triangle(random.square()).as_dvec2();
            // Next to an edge.
            a + (b - a) * u.x + (c - a) * (u.y * 1e-6)
        }
    }
}

/// Rays from within.
fn from_within(random: &mut Random, rays: u64) -> Tally {
    let Vessel { shape, .. } = vessel(random);
    let world_from_local = placement(random, Bend(true));
    let corners: Vec<[DVec3; 3]> = shape
        .corners()
        .iter()
        .map(|corners| corners.map(|v| world_from_local.transform_point3(v.as_dvec3())))
        .collect();
    let rounded: Vec<[Vec3; 3]> = corners.iter().map(|corners| corners.map(|vertex| vertex.as_vec3())).collect();
    let accel = Accel::new(&rounded);
    let reach = rounded.iter().flatten().fold(0.0_f32, |reach, vertex| reach.max(vertex.abs().max_element()));
    let decade = reach.log10().floor() as i32;
    let mut tally = Tally { shapes: 1, decades: [decade; 2], inside: rays, ..Tally::default() };
    for index in 0..rays {
        let local = if index.is_multiple_of(4) { Vec3::ZERO } else { 0.1 * random.unit() * random.direction() };
        let from = world_from_local.transform_point3(local.as_dvec3()).as_vec3();
        let triangle = (random.unit() * rounded.len() as f32) as usize % rounded.len();
        let target = target(rounded[triangle].map(Vec3::as_dvec3), random);
        let offset = target - from.as_dvec3();
        let direction = offset.normalize().as_vec3();
        tally.lost_by_closest += u64::from(accel.closest(from, direction, f32::INFINITY).is_none());
        // Beyond the farthest wall.
        let beyond = (from.as_dvec3() + offset * 40.0).as_vec3();
        tally.lost_by_blocked += u64::from(!accel.is_blocked(from, beyond));
    }
    tally
}

/// Rays from the walls.
fn from_walls(random: &mut Random, rays: u64) -> Tally {
    let Vessel { shape, is_wide } = vessel(random);
    let world_from_local = placement(random, Bend(false));
    let matrix = Mat3::from_cols_array(&world_from_local.matrix3.to_cols_array().map(|x| x as f32));
    let tracer: Tracer = shape.tracer(Affine3A::from_mat3_translation(matrix, world_from_local.translation.as_vec3()));
    let count = tracer.triangle_count();
    if count != shape.triangles.len() {
        return Tally::default();
    }
    let reach = tracer.triangles.iter().flat_map(|triangle| triangle.vertices);
    let decade = reach.fold(0.0_f32, |reach, vertex| reach.max(vertex.abs().max_element())).log10().floor() as i32;
    let mut tally = Tally { shapes: 1, decades: [decade; 2], ..Tally::default() };
    while tally.spawned < rays {
        let [from, to] = [0, 1].map(|_| (random.unit() * count as f32) as u32 % count as u32);
        let mut weights = square_to_triangle(random.square());
        if !is_wide {
            weights = 0.2 + 0.4 * weights;
        } else if random.unit() < 0.3 {
            // On an edge or next to it.
            weights.y *= if random.unit() < 0.5 { 0.0 } else { of_any_size(random, -9.0, -3.0) };
        }
        let normal = tracer.normal(from);
        let start = tracer.start_on_triangle(from, weights.to_array(), normal);
        let target = target(tracer.vertices(to).map(Vec3::as_dvec3), random);
        let direction = (target - start.origin().as_dvec3()).normalize_or_zero().as_vec3();
        if normal.dot(direction) <= 0.0 {
            // Into the wall, or along it.
            continue;
        }
        tally.spawned += 1;
        let is_lost = tracer.accel.closest(start.origin(), direction, f32::INFINITY).is_none()
            || !tracer.accel.is_blocked_towards(start.origin(), direction);
        tally.lost_spawned += u64::from(is_lost);
    }
    tally
}

/// Shoots `rays` of each kind at each of `shapes` shapes; on all threads, with the same answer for any number of them.
fn shoot(shapes: u64, rays: u64, seed: u64) -> Tally {
    let one = |index| {
        let mut random = Random::new(combine(seed, index));
        from_within(&mut random, rays) + from_walls(&mut random, rays)
    };
    (0..shapes).into_par_iter().map(one).reduce(Tally::default, Tally::add)
}

fn assert_none_lost(tally: Tally) {
    assert_eq!([tally.lost_by_closest, tally.lost_by_blocked, tally.lost_spawned], [0; 3], "{tally:?}");
    assert!(tally.decades[0] <= -8 && tally.decades[1] >= 8, "{tally:?}");
}

#[test]
fn no_ray_passes_between() {
    let tally = shoot(2000, 150, 1);
    assert!(tally.inside > 200_000 && tally.spawned > 200_000, "{tally:?}");
    assert_none_lost(tally);
}

/// The same with a hundred million rays of each kind. Takes minutes, and prints what it counted.
#[test]
#[ignore = "a hundred million rays; minutes"]
#[allow(clippy::print_stdout, reason = "the count is what it is run for")]
fn no_ray_of_a_hundred_million_passes_between() {
    let clock = std::time::Instant::now();
    let tally = shoot(110_000, 1000, 2);
    println!("{tally:?} in {:.0} s", clock.elapsed().as_secs_f64());
    assert!(tally.inside >= 100_000_000 && tally.spawned >= 100_000_000, "{tally:?}");
    assert_none_lost(tally);
}
