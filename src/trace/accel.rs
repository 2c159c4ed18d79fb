//! Finding what a ray meets: the only file that names `obvhs`.
//!
//! The tree is obvhs's; the triangle test is ours and watertight ([`super::triangle`]). Boxes are padded, because
//! the tree's slab test rounds and its inverse directions are clamped: without the padding a ray can miss a box
//! whose triangle it hits. All triangles lie in one frame: a static bake needs no instance transforms, and a second
//! rounding on the way down would break watertightness between neighbours.
//!
//! The tree drops every box that a ray leaves within 10⁻⁴ of its origin, a length that knows nothing of the scene: in
//! metres, light would leave a closed room through its corners. All lengths in here are therefore scaled by a power
//! of two, which rounds nothing, that makes the scene 2³⁰ units large. A ray leaves the box of a triangle that it meets
//! no sooner than the padding lets it, 2⁻²⁰ of that or 10³ units: the dropped length is none.
//!
//! # Rays from afar
//!
//! The triangle test multiplies three coordinates, and what it and the slab test round grows with the distance of the
//! ray's origin. So only rays that start within [`NEAR`] of the scene's reach r (its largest coordinate) go to the tree
//! as they are: no coordinate difference is then above 2.5 r < 2^32.4 units and no product of three above 2⁹⁸. Any other
//! ray is first moved along its own line to a cube of 1.25 r, in f64 (`accel/far.rs`), where it may be off by 2⁻⁵² of
//! the distance that it came: less than f32 can tell within the scene up to 2²⁸ reaches away. Farther out nothing
//! overflows, only that error grows with the distance.
//!
//! # Padding
//!
//! A box may be missed only by rays that miss its triangle as [`super::triangle`] computes it. With an origin within
//! 1.5 r, each in u·r, u = 2⁻²⁴:
//!
//! - a slab's plane q·e + p (e a power of two, q ≤ 255) comes out as (q·e + (p − o))/d with five roundings, which move
//!   it by u·(q·e + 2·|p − o| + 2·|q·e + p − o|) ≤ 2 + 4·2.5 = 12;
//! - direction components below ε = 2⁻²³ are taken for ε: over the longest way, 2.5·√3 r, at most ε·4.4 r = 8.7;
//! - the triangle test moves a vertex as it sees it by u·(|v − o| + 5·|v − o| + …) ≤ 7·2.5 = 17.5.
//!
//! The sum is below 40, or 20 ε·r, by which each box is made larger on every side.
//!
//! # Why the eight-way tree
//!
//! Million rays per second of processor time, one thread (`cargo bench`, Cornell box of 46 triangles and hall of
//! 250 000), with the same triangle test in both, obvhs 0.3.3:
//!
//! | | CWBVH, medium build | BVH2, medium build | BVH2, slow build |
//! |---|---|---|---|
//! | Cornell box, closest, camera | 9.1 | 8.2 | 8.6 |
//! | Cornell box, closest, diffuse | 6.0 | 4.9 | 5.5 |
//! | Cornell box, any, camera | 10.5 | 9.0 | 10.7 |
//! | Cornell box, any, diffuse | 8.1 | 6.6 | 7.9 |
//! | hall, closest, camera | 2.0 | 2.0 | 2.0 |
//! | hall, closest, diffuse | 1.15 | 0.84 | 0.86 |
//!
//! Any hit on the hall was not measured for BVH2. Rays of a bake are diffuse, and there the eight-way tree is a third faster on a large scene. BVH2 drops no length, so
//! that it would need no scaling; its slab test rounds alike and needs the same padding.

mod far;

use super::triangle::{Crossing, ShearedRay, plane_distance};
use glam::Vec3;
use obvhs::Boundable;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh;
use obvhs::ray::{Ray, RayHit};
use std::time::Duration;

/// Coordinate up to which a ray's origin is used as it is, in reaches of the scene.
const NEAR: f32 = 1.5;

/// How much larger boxes are on every side, in ε times the scene's reach.
const PADDING: f32 = 20.0;

/// A tree over triangles, all in one frame.
pub(super) struct Accel {
    tree: Option<CwBvh>,
    /// In the tree's order and units: each triangle and the number under which the caller knows it.
    triangles: Vec<([Vec3; 3], u32)>,
    /// The tree's units per metre: a power of two.
    scale: f32,
    /// Largest coordinate of the scene, in the tree's units.
    reach: f32,
}

/// What a ray met.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    /// The caller's number of the triangle.
    pub(super) triangle: u32,
    /// Distance [m].
    pub(super) t: f32,
    /// Weights of the triangle's second and third vertex.
    pub(super) barycentric: [f32; 2],
}

struct Padded(Aabb);

impl Boundable for Padded {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl Accel {
    /// Builds a tree. All vertices must be finite.
    pub(super) fn new(triangles: &[[Vec3; 3]]) -> Self {
        let reach = triangles.iter().flatten().fold(0.0_f32, |reach, vertex| reach.max(vertex.abs().max_element()));
        let scale = scale_for(reach);
        let reach = reach * scale;
        let padding = PADDING * f32::EPSILON * reach;
        let triangles: Vec<[Vec3; 3]> = triangles.iter().map(|corners| corners.map(|vertex| vertex * scale)).collect();
        let boxes: Vec<Padded> = triangles
            .iter()
            .map(|[a, b, c]| {
                let low = a.min(*b).min(*c) - Vec3::splat(padding);
                let high = a.max(*b).max(*c) + Vec3::splat(padding);
                Padded(Aabb::new(low.to_array().into(), high.to_array().into()))
            })
            .collect();
        if boxes.is_empty() {
            return Self { tree: None, triangles: Vec::new(), scale, reach };
        }
        let mut tree = build_cwbvh(&boxes, BvhBuildParams::medium_build(), &mut Duration::default());
        let triangles = tree.primitive_indices.iter().map(|&index| (triangles[index as usize], index)).collect();
        tree.primitive_indices = Vec::new();
        Self { tree: Some(tree), triangles, scale, reach }
    }

    /// The nearest triangle that the ray meets before `t_max`, from either side. The direction is a unit vector.
    pub(super) fn closest(&self, origin: Vec3, direction: Vec3, t_max: f32) -> Option<Hit> {
        if self.is_far(origin) {
            let (nearer, passed) = self.come_nearer(origin, direction)?;
            let hit = self.closest_from_near(nearer, direction, (f64::from(t_max) - passed) as f32)?;
            return Some(Hit { t: (passed + f64::from(hit.t)) as f32, ..hit });
        }
        self.closest_from_near(origin, direction, t_max)
    }

    #[inline]
    fn closest_from_near(&self, origin: Vec3, direction: Vec3, t_max: f32) -> Option<Hit> {
        let tree = self.tree.as_ref()?;
        let (origin, t_max) = (origin * self.scale, t_max * self.scale);
        let sheared = ShearedRay::new(origin, direction);
        let start = End { position: origin, inwards: direction };
        let ray = tree_ray(origin, direction, t_max);
        let mut nearest = RayHit::none();
        let mut winner: Option<Crossing> = None;
        tree.ray_traverse(ray, &mut nearest, |ray, index| {
            let triangle = &self.triangles[index].0;
            match sheared.cross(triangle) {
                Some(crossing) if crossing.t < ray.tmax && start.is_behind(crossing.t, crossing.t_error, triangle) => {
                    winner = Some(crossing);
                    crossing.t
                }
                _ => f32::INFINITY,
            }
        });
        winner.map(|crossing| Hit {
            triangle: self.triangles[nearest.primitive_id as usize].1,
            t: crossing.t / self.scale,
            barycentric: crossing.barycentric,
        })
    }

    /// Whether anything lies on the open segment from `origin` to `target`.
    pub(super) fn is_blocked(&self, origin: Vec3, target: Vec3) -> bool {
        self.meets(origin, target, |_| true)
    }

    /// Whether anything lies on the ray from `origin` in the unit `direction`.
    pub(super) fn is_blocked_towards(&self, origin: Vec3, direction: Vec3) -> bool {
        self.meets_towards(origin, direction, |_| true)
    }

    /// Whether `stops` says so of anything that lies on the open segment from `origin` to `target`. Asks for each
    /// triangle once at most, in no order.
    #[inline]
    pub(super) fn meets(&self, origin: Vec3, target: Vec3, mut stops: impl FnMut(Hit) -> bool) -> bool {
        if self.is_far(origin) || self.is_too_far(target) {
            return self.part_within(origin, target).is_some_and(|(from, to, passed)| {
                self.meets_between(from, to, |hit| stops(Hit { t: (passed + f64::from(hit.t)) as f32, ..hit }))
            });
        }
        self.meets_between(origin, target, stops)
    }

    #[inline]
    fn meets_between(&self, origin: Vec3, target: Vec3, stops: impl FnMut(Hit) -> bool) -> bool {
        let (origin, target) = (origin * self.scale, target * self.scale);
        let offset = target - origin;
        let distance = offset.length();
        if distance.is_nan() || distance == 0.0 {
            return false;
        }
        let direction = offset / distance;
        let end = End { position: target, inwards: -direction };
        self.search(origin, direction, Some((end, distance)), stops)
    }

    /// The same for a ray without an end, in a unit direction.
    #[inline]
    pub(super) fn meets_towards(&self, origin: Vec3, direction: Vec3, mut stops: impl FnMut(Hit) -> bool) -> bool {
        if self.is_far(origin) {
            return self.come_nearer(origin, direction).is_some_and(|(nearer, passed)| {
                self.search(nearer * self.scale, direction, None, |hit| {
                    stops(Hit { t: (passed + f64::from(hit.t)) as f32, ..hit })
                })
            });
        }
        self.search(origin * self.scale, direction, None, stops)
    }

    /// The search itself, in the tree's units.
    #[inline]
    fn search(
        &self,
        origin: Vec3,
        direction: Vec3,
        end: Option<(End, f32)>,
        mut stops: impl FnMut(Hit) -> bool,
    ) -> bool {
        let Some(tree) = &self.tree else {
            return false;
        };
        let sheared = ShearedRay::new(origin, direction);
        let distance = end.map_or(f32::INFINITY, |(_, distance)| distance);
        let ray = tree_ray(origin, direction, distance);
        let start = End { position: origin, inwards: direction };
        !tree.ray_traverse_miss(ray, |_, index| {
            let (corners, triangle) = &self.triangles[index];
            let Some(Crossing { t, t_error, barycentric }) = sheared.cross(corners) else {
                return f32::INFINITY;
            };
            let is_before_end = end.is_none_or(|(end, distance)| {
                end.is_behind(distance - t, t_error + 4.0 * f32::EPSILON * distance, corners)
            });
            let is_between = start.is_behind(t, t_error, corners) && is_before_end;
            if is_between && stops(Hit { triangle: *triangle, t: t / self.scale, barycentric }) {
                // The tree asks for a distance below the ray's end, which rounding could deny.
                t.min(0.5 * distance)
            } else {
                f32::INFINITY
            }
        })
    }
}

/// A ray's one end, and the unit direction from there along the ray.
#[derive(Clone, Copy)]
struct End {
    position: Vec3,
    inwards: Vec3,
}

impl End {
    /// Whether something that is computed to lie `t` from this end, give or take `error`, lies on the ray's side.
    #[inline]
    fn is_behind(&self, t: f32, error: f32, triangle: &[Vec3; 3]) -> bool {
        t > error || (t >= -error && plane_distance(self.position, self.inwards, triangle) > 0.0)
    }
}

/// The power of two that makes a scene of this reach about 2³⁰ units large.
fn scale_for(reach: f32) -> f32 {
    // The exponent's bits; limits keep the scale and its reciprocal normal numbers.
    let exponent = (reach.to_bits() >> 23) as i32 - 127;
    2.0_f32.powi((30 - exponent).clamp(-90, 120))
}

/// A ray as the tree wants it.
#[inline]
fn tree_ray(origin: Vec3, direction: Vec3, t_max: f32) -> Ray {
    // The tree takes −0 for negative when it inverts and for positive when it picks near planes, and then misses
    // everything; −0 + 0 is +0.
    let direction = direction + Vec3::ZERO;
    Ray::new(origin.to_array().into(), direction.to_array().into(), 0.0, t_max)
}

#[cfg(test)]
mod tests;
