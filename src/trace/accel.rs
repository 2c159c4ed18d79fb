//! Finding what a ray meets: the only file that names `obvhs`.
//!
//! obvhs builds a binary tree (PLOC with reinsertion); `accel/wide.rs` makes nodes of eight boxes and packets of eight
//! triangles of it, `accel/walk.rs` takes rays through them, with eight numbers at once (`accel/lanes.rs`). The
//! triangle test is watertight ([`super::triangle`]). Boxes are padded, because the slab test rounds: without the
//! padding a ray can miss a box whose triangle it hits. All triangles lie in one frame: a static bake needs no instance
//! transforms, and a second rounding on the way down would break watertightness between neighbours.
//!
//! The triangle test multiplies three coordinates. That these products neither overflow nor vanish, whatever size the
//! scene has, all lengths in here are scaled by a power of two, which rounds nothing, that makes it 2³⁰ units large.
//!
//! # Rays from afar
//!
//! What the triangle test and the slab test round grows with the distance of the ray's origin. So only rays that start
//! within [`NEAR`] of the scene's reach r (its largest coordinate) go to the tree as they are: no coordinate difference
//! is then above 2.5 r < 2^32.4 units and no product of three above 2⁹⁸. Any other ray is first moved along its own
//! line to a cube of 1.25 r, in f64 (`accel/far.rs`), where it may be off by 2⁻⁵² of the distance that it came: less
//! than f32 can tell within the scene up to 2²⁸ reaches away. Farther out nothing overflows, only that error grows with
//! the distance.
//!
//! # Padding
//!
//! A box may be missed only by rays that miss its triangle as [`super::triangle`] computes it. With an origin within
//! 1.5 r, each in u·r, u = 2⁻²⁴:
//!
//! - a slab's plane p comes out as (p − o)·(1/d) with three roundings, which move it by 3·|p − o| ≤ 3·2.5 = 7.5;
//! - where d is so small that 1/d overflows, the plane counts as never met; over the longest way, 2.5·√3 r, the ray
//!   moves by less than 2⁻¹²⁵ r along it: nothing. Where d is 0, nothing is rounded;
//! - the padded plane was itself rounded: 1;
//! - the triangle test moves a vertex as it sees it by u·(|v − o| + 5·|v − o| + …) ≤ 7·2.5 = 17.5.
//!
//! The sum is 26, below 32 or 16 ε·r, by which each box is made larger on every side.
//!
//! # Why a walk of our own
//!
//! Million rays per second of processor time, one thread (`cargo bench --bench rays`: Cornell box of 46 triangles, hall
//! of 250 000), with the same triangle test:
//!
//! | | Cornell, camera | diffuse | hall, camera | diffuse |
//! |---|---:|---:|---:|---:|
//! | obvhs 0.3.3's wide nodes, nearest | 9.5 | 6.1 | 1.8 | 1.1 |
//! | its own, any | 10.4 | 8.3 | 2.2 | 1.9 |
//! | this walk, nearest | 14.8 | 11.6 | 5.3 | 2.7 |
//! | this walk, any | 12.9 | 12.3 | 5.4 | 4.8 |
//!
//! What is left is mostly waiting: in the hall a quarter of the time passes at the first number of a packet of triangles.
//! So what a ray will come to is asked of the memory when its parent is opened: 10 % more rays. Embree 4.4 on the same
//! hall and rays, in one sitting: 1.4 times as many nearest hits of diffuse rays, 1.0 to 1.2 times as many any hits.

mod far;
mod lanes;
mod level;
mod packet;
mod walk;
mod wide;

use super::triangle::{ShearedRay, plane_distance};
use glam::Vec3;
use lanes::Lanes;
use level::{InLanes, Level};
use obvhs::Boundable;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use std::time::Duration;
use walk::{Met, Walk};
use wide::{Binary, Bounds, Source, Tree};

/// Coordinate up to which a ray's origin is used as it is, in reaches of the scene.
const NEAR: f32 = 1.5;

/// How much larger boxes are on every side, in ε times the scene's reach.
const PADDING: f32 = 16.0;

/// A tree over triangles, all in one frame.
pub(super) struct Accel {
    tree: Tree,
    /// How this processor computes with eight numbers at once.
    level: Level,
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

/// [`Walk::nearest`].
struct Nearest<'a, F: Fn(u32)> {
    walk: Walk<'a>,
    end: f32,
    tell: F,
}

impl<F: Fn(u32)> InLanes for Nearest<'_, F> {
    type Output = Option<Met>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Option<Met> {
        self.walk.nearest(lanes, self.end, self.tell)
    }
}

/// [`Walk::any`].
struct Any<'a, F: FnMut(Met) -> bool> {
    walk: Walk<'a>,
    end: Option<(End, f32)>,
    stops: F,
}

impl<F: FnMut(Met) -> bool> InLanes for Any<'_, F> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> bool {
        self.walk.any(lanes, self.end, self.stops)
    }
}

impl Boundable for Bounds {
    fn aabb(&self) -> Aabb {
        Aabb::new(self.low.to_array().into(), self.high.to_array().into())
    }
}

impl Accel {
    /// Builds a tree. All vertices must be finite.
    pub(super) fn new(triangles: &[[Vec3; 3]]) -> Self {
        let reach = triangles.iter().flatten().fold(0.0_f32, |reach, vertex| reach.max(vertex.abs().max_element()));
        let scale = scale_for(reach);
        let reach = reach * scale;
        let triangles: Vec<[Vec3; 3]> = triangles.iter().map(|corners| corners.map(|vertex| vertex * scale)).collect();
        Self { tree: tree_of(&triangles, reach), level: Level::of_this_processor(), scale, reach }
    }

    /// Memory that it holds [bytes].
    pub(super) fn memory_bytes(&self) -> u64 {
        self.tree.memory_bytes()
    }

    /// The nearest triangle that the ray meets before `t_max`, from either side. The direction is a unit vector.
    pub(super) fn closest(&self, origin: Vec3, direction: Vec3, t_max: f32) -> Option<Hit> {
        self.closest_telling(origin, direction, t_max, |_| ())
    }

    /// The same. Tells the number of each triangle on the way that is the nearest so far, so that what belongs to it can
    /// be fetched while the search goes on.
    #[inline]
    pub(super) fn closest_telling(&self, origin: Vec3, direction: Vec3, t_max: f32, tell: impl Fn(u32)) -> Option<Hit> {
        if self.is_far(origin) {
            let (nearer, passed) = self.come_nearer(origin, direction)?;
            let hit = self.closest_from_near(nearer, direction, (f64::from(t_max) - passed) as f32, tell)?;
            return Some(Hit { t: (passed + f64::from(hit.t)) as f32, ..hit });
        }
        self.closest_from_near(origin, direction, t_max, tell)
    }

    #[inline]
    fn closest_from_near(&self, origin: Vec3, direction: Vec3, t_max: f32, tell: impl Fn(u32)) -> Option<Hit> {
        let (origin, end) = (origin * self.scale, t_max * self.scale);
        let ray = ShearedRay::new(origin, direction);
        let walk = Walk { tree: &self.tree, ray: &ray, start: End { position: origin, inwards: direction } };
        self.level.run(Nearest { walk, end, tell }).map(|met| self.hit(met))
    }

    #[inline]
    fn hit(&self, met: Met) -> Hit {
        Hit { triangle: met.triangle, t: met.t / self.scale, barycentric: met.barycentric }
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
        let ray = ShearedRay::new(origin, direction);
        let walk = Walk { tree: &self.tree, ray: &ray, start: End { position: origin, inwards: direction } };
        self.level.run(Any { walk, end, stops: |met| stops(self.hit(met)) })
    }
}

/// The tree of triangles, in its own units.
fn tree_of(triangles: &[[Vec3; 3]], reach: f32) -> Tree {
    let padding = PADDING * f32::EPSILON * reach;
    let around = |[a, b, c]: &[Vec3; 3]| Bounds {
        low: a.min(*b).min(*c) - Vec3::splat(padding),
        high: a.max(*b).max(*c) + Vec3::splat(padding),
    };
    let boxes: Vec<Bounds> = triangles.iter().map(around).collect();
    if boxes.is_empty() {
        return Tree::default();
    }
    let params = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
    let binary = build_bvh2(&boxes, params, &mut Duration::default());
    let node = |number: u32| {
        let node = &binary.nodes[number as usize];
        let bounds = Bounds { low: node.aabb.min.to_array().into(), high: node.aabb.max.to_array().into() };
        Binary { bounds, first: node.first_index, count: node.prim_count }
    };
    let order = &binary.primitive_indices;
    Tree::new(Source { node, node_count: binary.nodes.len(), order, triangles, boxes: &boxes })
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
        t > error || (t >= -error && self.sees(triangle))
    }

    /// Whether a triangle's plane lies on the ray's side.
    #[cold]
    fn sees(&self, triangle: &[Vec3; 3]) -> bool {
        plane_distance(self.position, self.inwards, triangle) > 0.0
    }
}

/// The power of two that makes a scene of this reach about 2³⁰ units large.
fn scale_for(reach: f32) -> f32 {
    // The exponent's bits; limits keep the scale and its reciprocal normal numbers.
    let exponent = (reach.to_bits() >> 23) as i32 - 127;
    2.0_f32.powi((30 - exponent).clamp(-90, 120))
}

#[cfg(test)]
mod tests;
