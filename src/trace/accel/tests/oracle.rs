//! What the tree finds, against two other ways to find it: every triangle one by one with the same triangle test
//! (equal to the bit: the tree loses nothing), and with a textbook one in f64 (equal but at edges: the test is right).
//! Also every way to compute with eight numbers at once against the plain one, to the bit.

use crate::math::testing::Random;
use crate::trace::accel::level::Level;
use crate::trace::accel::{Accel, End, Hit};
use crate::trace::testing::of_any_size;
use crate::trace::triangle::ShearedRay;
use glam::{DVec3, Vec3};

type Triangles = Vec<[Vec3; 3]>;

/// A segment, and the ray along it.
#[derive(Clone, Copy, Debug)]
struct Segment {
    from: Vec3,
    to: Vec3,
}

impl Segment {
    fn direction(&self) -> Vec3 {
        // In f64, in which no length of an f32 scene is too small or too large.
        (self.to.as_dvec3() - self.from.as_dvec3()).normalize().as_vec3()
    }
}

/// The bits of a hit's distance, its triangle, the bits of its weights.
fn bits(hit: Option<Hit>) -> Option<(u32, u32, [u32; 2])> {
    hit.map(|hit| (hit.t.to_bits(), hit.triangle, hit.barycentric.map(f32::to_bits)))
}

/// The nearest hit, by testing all; of several at one distance that of the smallest number. `None` for none.
fn nearest_of_all(accel: &Accel, segment: &Segment) -> Option<Hit> {
    let direction = segment.direction();
    let (from, passed) = match accel.is_far(segment.from) {
        true => accel.come_nearer(segment.from, direction)?,
        false => (segment.from, 0.0),
    };
    let origin = from * accel.scale;
    let ray = ShearedRay::new(origin, direction);
    let start = End { position: origin, inwards: direction };
    let hits = accel.tree.triangles().filter_map(|(corners, triangle)| {
        let crossing = ray.cross(&corners)?;
        let hit = Hit { triangle, t: crossing.t, barycentric: crossing.barycentric };
        start.is_behind(crossing.t, crossing.t_error, &corners).then_some(hit)
    });
    let nearest = hits.min_by(|a, b| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)))?;
    Some(Hit { t: (passed + f64::from(nearest.t / accel.scale)) as f32, ..nearest })
}

/// How a line crosses a triangle in f64 (Möller and Trumbore 1997): distance, and the least of the three weights.
fn cross_in_f64(segment: &Segment, triangle: &[Vec3; 3]) -> Option<(f64, f64)> {
    let [a, b, c] = triangle.map(|vertex| vertex.as_dvec3());
    let (from, direction) = (segment.from.as_dvec3(), segment.direction().as_dvec3());
    let (edge_b, edge_c) = (b - a, c - a);
    let p = direction.cross(edge_c);
    let determinant = edge_b.dot(p);
    let offset = from - a;
    let q: DVec3 = offset.cross(edge_b);
    let (u, v) = (offset.dot(p) / determinant, direction.dot(q) / determinant);
    let t = edge_c.dot(q) / determinant;
    // A triangle seen edge-on has no well-conditioned crossing.
    let is_steep = determinant.abs() > 1e-3 * edge_b.length() * edge_c.length();
    (t.is_finite() && is_steep).then_some((t, u.min(v).min(1.0 - u - v)))
}

/// Holds what the tree finds against both oracles; returns how many rays hit and how many are blocked.
fn compare(triangles: &Triangles, segments: &[Segment]) -> [usize; 2] {
    let accel = Accel::new(triangles);
    let baseline = Accel { level: Level::Baseline, ..Accel::new(triangles) };
    let mut counts = [0; 2];
    for segment in segments {
        let (direction, distance) = (segment.direction(), segment.to.as_dvec3().distance(segment.from.as_dvec3()));
        let hit = accel.closest(segment.from, direction, f32::INFINITY);
        assert_eq!(bits(hit), bits(nearest_of_all(&accel, segment)), "{segment:?}");
        assert_eq!(bits(hit), bits(baseline.closest(segment.from, direction, f32::INFINITY)), "{segment:?}");
        let blocked = accel.is_blocked(segment.from, segment.to);
        assert_eq!(blocked, baseline.is_blocked(segment.from, segment.to), "{segment:?}");
        if let Some(hit) = hit {
            // The tree's own number leads to the caller's triangle.
            let (t, margin) = cross_in_f64(segment, &triangles[hit.triangle as usize]).unwrap_or((hit.t.into(), 0.0));
            assert!(margin > -1e-3, "{segment:?} {hit:?} misses by {margin}");
            assert!((t - f64::from(hit.t)).abs() < 1e-3 * distance + 1e-6 * t, "{segment:?} {hit:?} but at {t}");
            if f64::from(hit.t) < 0.999 * distance {
                assert!(blocked, "{segment:?} {hit:?} but not blocked");
            }
        } else {
            assert!(!blocked, "{segment:?} is blocked by nothing");
        }
        for triangle in triangles {
            let Some((t, margin)) = cross_in_f64(segment, triangle) else {
                continue;
            };
            if margin > 1e-3 && t > 1e-3 * distance {
                let found = hit.map_or(f64::INFINITY, |hit| hit.t.into());
                assert!(found < t + 1e-3 * distance + 1e-6 * t, "{segment:?}: {triangle:?} at {t} but {found}");
            }
        }
        counts[0] += usize::from(hit.is_some());
        counts[1] += usize::from(blocked);
    }
    counts
}

fn point(random: &mut Random) -> Vec3 {
    2.0 * Vec3::new(random.unit(), random.unit(), random.unit()) - Vec3::ONE
}

fn segments(random: &mut Random, count: usize, size: f32) -> Vec<Segment> {
    let mut segment = |index: usize| {
        let (from, mut to) = (1.5 * size * point(random), 1.5 * size * point(random));
        // Some along an axis, some in a plane of two.
        if index.is_multiple_of(5) {
            to[index / 5 % 3] = from[index / 5 % 3];
            if index.is_multiple_of(2) {
                to[(index / 5 + 1) % 3] = from[(index / 5 + 1) % 3];
            }
        }
        Segment { from, to }
    };
    (0..count).map(&mut segment).collect()
}

/// A soup of triangles of edge length about `edge` in a cube of half-width `size`.
fn soup(random: &mut Random, count: usize, edge: f32, size: f32) -> Triangles {
    let mut triangle = || {
        let centre = point(random);
        [0, 1, 2].map(|_| size * (centre + edge * point(random)))
    };
    (0..count).map(|_| triangle()).collect()
}

#[test]
fn random_soups() {
    for (seed, count, edge) in [(1, 1, 1.0), (2, 2, 1.0), (3, 9, 0.7), (4, 100, 0.3), (5, 1000, 0.1), (6, 300, 2.0)] {
        let mut random = Random::new(seed);
        let triangles = soup(&mut random, count, edge, 1.0);
        let [hits, blocked] = compare(&triangles, &segments(&mut random, 1000, 1.0));
        assert!(hits >= blocked && blocked > 5, "{count} triangles: {hits} hits, {blocked} blocked");
    }
}

#[test]
fn nothing() {
    assert_eq!(compare(&Vec::new(), &segments(&mut Random::new(1), 100, 1.0)), [0, 0]);
}

#[test]
fn a_thousand_times_the_same_triangle() {
    let mut random = Random::new(3);
    let triangles = vec![soup(&mut random, 1, 1.0, 1.0)[0]; 1000];
    let [hits, _] = compare(&triangles, &segments(&mut random, 1000, 1.0));
    assert!(hits > 50, "{hits}");
}

/// Triangles in planes along the axes, whose boxes have no thickness, and rays within those planes.
#[test]
fn flat_boxes() {
    let mut random = Random::new(4);
    let mut triangles = soup(&mut random, 300, 0.4, 1.0);
    for (index, triangle) in triangles.iter_mut().enumerate() {
        let height = (index % 7) as f32 - 3.0;
        triangle.iter_mut().for_each(|vertex| vertex[index % 3] = 0.25 * height);
    }
    let mut rays = segments(&mut random, 1000, 1.0);
    for (index, ray) in rays.iter_mut().enumerate().filter(|(index, _)| index % 3 == 0) {
        ray.from[index / 3 % 3] = 0.25;
        ray.to[index / 3 % 3] = if index % 2 == 0 { 0.25 } else { ray.to[index / 3 % 3] };
    }
    let [hits, _] = compare(&triangles, &rays);
    assert!(hits > 300, "{hits}");
}

#[test]
fn scenes_of_any_size_far_from_the_origin_too() {
    let mut random = Random::new(5);
    for size in [1e-30, 1e-20, 1e-6, 1e6, 1e20, 1e30] {
        let triangles = soup(&mut random, 100, 0.5, size);
        let [hits, _] = compare(&triangles, &segments(&mut random, 300, size));
        assert!(hits > 100, "{size}: {hits}");
    }
    // Big and small at once.
    let mut triangles = soup(&mut random, 30, 0.5, 1e4);
    triangles.extend(soup(&mut random, 200, 0.5, 1.0));
    let [hits, _] = compare(&triangles, &segments(&mut random, 500, 1.0));
    assert!(hits > 300, "{hits}");
}

/// Slivers, a million times longer than wide: the two oracles' margins are wide enough for them.
#[test]
fn slivers() {
    let mut random = Random::new(6);
    let mut triangles = soup(&mut random, 200, 0.5, 1.0);
    for triangle in &mut triangles {
        let width = of_any_size(&mut random, -6.0, -3.0);
        triangle[2] = triangle[1] + width * point(&mut random);
    }
    let accel = Accel::new(&triangles);
    let mut hits = 0;
    for (index, triangle) in triangles.iter().enumerate() {
        let from = 3.0 * random.direction();
        let segment = Segment { from, to: (triangle[0] + triangle[1] + triangle[2]) / 3.0 };
        let hit = accel.closest(segment.from, segment.direction(), f32::INFINITY);
        assert_eq!(bits(hit), bits(nearest_of_all(&accel, &segment)), "{index}");
        hits += usize::from(hit.is_some());
    }
    assert!(hits > 100, "{hits}");
}

/// A ray's end cuts off what lies behind it.
#[test]
fn nothing_beyond_the_end() {
    let accel = Accel::new(&[[Vec3::new(-9.0, -9.0, 2.0), Vec3::new(9.0, -9.0, 2.0), Vec3::new(0.0, 9.0, 2.0)]]);
    assert!(accel.closest(Vec3::ZERO, Vec3::Z, 1.99).is_none());
    assert!(accel.closest(Vec3::ZERO, Vec3::Z, 2.01).is_some());
    assert!(accel.closest(Vec3::ZERO, Vec3::NEG_Z, f32::INFINITY).is_none());
    assert!(!accel.is_blocked(Vec3::ZERO, Vec3::new(0.0, 0.0, 1.999)));
    assert!(accel.is_blocked(Vec3::ZERO, Vec3::new(0.0, 0.0, 2.001)));
    assert!(!accel.is_blocked(Vec3::ZERO, Vec3::ZERO));
}

/// A segment that ends one step of f32 behind a wall is blocked, one that ends a step before it is not.
#[test]
fn an_end_next_to_a_wall() {
    let accel = Accel::new(&[[Vec3::new(-9.0, -9.0, 0.3), Vec3::new(9.0, -9.0, 0.3), Vec3::new(0.0, 9.0, 0.3)]]);
    let mut random = Random::new(7);
    for _ in 0..20_000 {
        let from = point(&mut random).with_z(0.4 + random.unit());
        let to = point(&mut random);
        assert!(accel.is_blocked(from, to.with_z(0.3_f32.next_down())), "{from} {to}");
        assert!(!accel.is_blocked(from, to.with_z(0.3_f32.next_up())), "{from} {to}");
    }
}
