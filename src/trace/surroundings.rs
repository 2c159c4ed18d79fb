//! What the surfaces around a point in mid-air say about it: whether it lies inside a body, which way leads out, and
//! which other points it sees. For probes of irradiance volumes; traces no light.
//!
//! Surfaces that let light pass straight neither part nor enclose.

use super::sampler::{Dimensions, Sampler, Sobol};
use super::tracer::Tracer;
use crate::math::square_to_uniform_sphere;
use glam::{Vec2, Vec3};
use std::cmp::Ordering;

/// Directions in which a point looks around.
const DIRECTIONS: u64 = 96;

/// What a point sees of the backs of surfaces.
#[derive(Clone, Debug, Default)]
pub(crate) struct Surroundings {
    /// Share of all directions in which the first thing that blocks is the back of a surface that has one.
    pub(crate) backs: f32,
    /// Ways to them from the point [m], shortest first.
    pub(crate) ways_to_backs: Vec<Vec3>,
}

impl Tracer {
    /// Looks around at a point of the world [m].
    pub(crate) fn surroundings(&self, point: Vec3) -> Surroundings {
        let origin = self.traced_from_world.point(point);
        let mut ways: Vec<Vec3> = (0..DIRECTIONS).filter_map(|number| self.way_to_back(origin, number)).collect();
        ways.sort_by(|a, b| a.length_squared().partial_cmp(&b.length_squared()).unwrap_or(Ordering::Equal));
        Surroundings { backs: ways.len() as f32 / DIRECTIONS as f32, ways_to_backs: ways }
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

    fn way_to_back(&self, origin: Vec3, number: u64) -> Option<Vec3> {
        let [u, v, ..] = Sobol::new(0, number).draw(Dimensions::Start);
        let direction = square_to_uniform_sphere(Vec2::new(u, v));
        let (triangle, distance) = self.first_block(origin, direction)?;
        let has_back = !self.surface(triangle).double_sided;
        (has_back && self.normal(triangle).dot(direction) > 0.0).then_some(direction * distance)
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
