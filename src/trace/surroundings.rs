//! What the surfaces around a point in mid-air say about it: whether it lies inside a body, which way leads out, and
//! which other points it sees. For probes of irradiance volumes; traces no light.
//!
//! Surfaces that let light pass straight neither part nor enclose.

use super::accel::Hit;
use super::sampler::{Dimensions, Sampler, Sobol};
use super::tracer::Tracer;
use crate::math::square_to_uniform_sphere;
use glam::{Vec2, Vec3};

/// Directions in which a point looks around.
const DIRECTIONS: u64 = 96;

/// Surfaces that a ray meets within this share of the way are in the same place.
const SAME: f32 = 1e-4;

/// What a point sees.
#[derive(Clone, Debug, Default)]
pub(crate) struct Surroundings {
    /// Share of all directions in which nothing blocks.
    pub(crate) open: f32,
    /// Share of all directions in which the first thing that blocks is the back of a surface that has one.
    pub(crate) backs: f32,
    /// Ways to them from the point [m], shortest first.
    pub(crate) ways_to_backs: Vec<Vec3>,
}

impl Tracer {
    /// Looks around at a point of the world [m].
    pub(crate) fn surroundings(&self, point: Vec3) -> Surroundings {
        let origin = self.traced_from_world.point(point);
        let mut around = Surroundings::default();
        for number in 0..DIRECTIONS {
            let [u, v, ..] = Sobol::new(0, number).draw(Dimensions::Start);
            let direction = square_to_uniform_sphere(Vec2::new(u, v));
            match self.first_block(origin, direction) {
                Some((triangle, distance)) if self.is_back_alone(triangle, origin, direction, distance) => {
                    around.ways_to_backs.push(direction * distance);
                }
                Some(_) => {}
                None => around.open += 1.0 / DIRECTIONS as f32,
            }
        }
        around.backs = around.ways_to_backs.len() as f32 / DIRECTIONS as f32;
        let by_length = |a: &Vec3, b: &Vec3| a.length_squared().total_cmp(&b.length_squared());
        around.ways_to_backs.sort_by(by_length);
        around
    }

    /// Whether no surface that blocks light lies between two points of the world [m].
    pub(crate) fn is_open(&self, from: Vec3, to: Vec3) -> bool {
        let [from, to] = [from, to].map(|point| self.traced_from_world.point(point));
        !self.accel.meets(from, to, |hit| !self.surface(hit.triangle).passes)
    }

    /// How far it is from a point of the world towards another to the first surface that blocks, in their distance;
    /// `None` if there is none.
    pub(crate) fn blocked_after(&self, from: Vec3, to: Vec3) -> Option<f32> {
        let [start, end] = [from, to].map(|point| self.traced_from_world.point(point));
        let distance = (end - start).length();
        let direction = (end - start).try_normalize()?;
        let (_, passed) = self.first_block(start, direction)?;
        (passed < distance).then_some(passed / distance)
    }

    /// Whether a ray that meets a triangle meets a back, and no front at the same place: where two rooms share a wall of no
    /// thickness, both are met at once, and either may be named first.
    fn is_back_alone(&self, triangle: u32, origin: Vec3, direction: Vec3, distance: f32) -> bool {
        let is_back =
            |triangle: u32| !self.surface(triangle).double_sided && self.normal(triangle).dot(direction) > 0.0;
        let [before, behind] = [1.0 - SAME, 1.0 + SAME].map(|share| origin + direction * (distance * share));
        let is_front = |hit: Hit| !self.surface(hit.triangle).passes && !is_back(hit.triangle);
        is_back(triangle) && !self.accel.meets(before, behind, is_front)
    }

    /// The first triangle along a ray that blocks light, and how far away it is [m].
    fn first_block(&self, origin: Vec3, direction: Vec3) -> Option<(u32, f32)> {
        let (mut from, mut passed) = (origin, 0.0);
        loop {
            let hit = self.nearest(from, direction)?;
            passed += hit.t;
            if !self.surface(hit.triangle).passes {
                return Some((hit.triangle, passed));
            }
            let shape = &self.triangles[hit.triangle as usize];
            from = shape.leave(shape.position(hit.barycentric), direction);
        }
    }
}
