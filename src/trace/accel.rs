//! Finding what a ray meets: the only file that names `obvhs`.
//!
//! The tree is obvhs's; the triangle test is ours and watertight ([`super::triangle`]). Boxes are padded, because
//! the tree's slab test rounds and its inverse directions are clamped: without the padding a ray can miss a box
//! whose triangle it hits. Triangles lie in world space: a static bake needs no instance transforms, and a second
//! rounding on the way down would break watertightness between neighbours.

use super::triangle::{Crossing, ShearedRay};
use glam::Vec3;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh;
use obvhs::ray::{Ray, RayHit};
use obvhs::Boundable;
use std::time::Duration;

/// A tree over world-space triangles.
pub(super) struct Accel {
    tree: Option<CwBvh>,
    /// In the tree's order: each triangle and the number under which the caller knows it.
    triangles: Vec<([Vec3; 3], u32)>,
}

/// What a ray met.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    /// The caller's number of the triangle.
    pub(super) triangle: u32,
    /// Distance, in lengths of the ray's direction.
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
        // The slab test's distances carry a relative error of a few units in the last place, that is, of the
        // distance between origin and box, which `2·reach` bounds. Four such units: with two, rays aimed at
        // vertices of a sphere at ten times its radius from the origin slip by; more only cost speed.
        let padding = 4.0 * f32::EPSILON * reach;
        let boxes: Vec<Padded> = triangles
            .iter()
            .map(|[a, b, c]| {
                let low = a.min(*b).min(*c) - Vec3::splat(padding);
                let high = a.max(*b).max(*c) + Vec3::splat(padding);
                Padded(Aabb::new(low.to_array().into(), high.to_array().into()))
            })
            .collect();
        if boxes.is_empty() {
            return Self { tree: None, triangles: Vec::new() };
        }
        let mut tree = build_cwbvh(&boxes, BvhBuildParams::medium_build(), &mut Duration::default());
        let triangles =
            tree.primitive_indices.iter().map(|&index| (triangles[index as usize], index)).collect();
        tree.primitive_indices = Vec::new();
        Self { tree: Some(tree), triangles }
    }

    /// The nearest triangle that the ray meets before `t_max`, from either side. The direction is a unit vector.
    pub(super) fn closest(&self, origin: Vec3, direction: Vec3, t_max: f32) -> Option<Hit> {
        let tree = self.tree.as_ref()?;
        let sheared = ShearedRay::new(origin, direction);
        let ray = Ray::new(origin.to_array().into(), direction.to_array().into(), 0.0, t_max);
        let mut nearest = RayHit::none();
        let mut winner: Option<Crossing> = None;
        tree.ray_traverse(ray, &mut nearest, |ray, index| match sheared.cross(&self.triangles[index].0) {
            Some(crossing) if crossing.t > crossing.t_error && crossing.t < ray.tmax => {
                winner = Some(crossing);
                crossing.t
            }
            _ => f32::INFINITY,
        });
        winner.map(|crossing| Hit {
            triangle: self.triangles[nearest.primitive_id as usize].1,
            t: crossing.t,
            barycentric: crossing.barycentric,
        })
    }

    /// Whether anything lies on the open segment from `origin` to `target`.
    pub(super) fn is_blocked(&self, origin: Vec3, target: Vec3) -> bool {
        let Some(tree) = &self.tree else {
            return false;
        };
        let offset = target - origin;
        let distance = offset.length();
        if !(distance > 0.0) {
            return false;
        }
        let direction = offset / distance;
        let sheared = ShearedRay::new(origin, direction);
        let ray = Ray::new(origin.to_array().into(), direction.to_array().into(), 0.0, distance);
        let end = distance * (1.0 - 4.0 * f32::EPSILON);
        !tree.ray_traverse_miss(ray, |_, index| match sheared.cross(&self.triangles[index].0) {
            Some(crossing) if crossing.t > crossing.t_error && crossing.t + crossing.t_error < end => crossing.t,
            _ => f32::INFINITY,
        })
    }
}
