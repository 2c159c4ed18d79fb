//! What the surfaces around a point say about it: whether one can go from there to another point close by, and
//! whether it lies inside a body. Owns the two questions that tell which points of a lightmap can be measured and
//! which of them belong together; traces no light.
//!
//! Surfaces that let light pass straight ([`Surface::passes`](super::material::Surface)) neither part nor enclose.

use super::path::PathStart;
use super::tracer::Tracer;
use crate::math::{Frame, square_to_uniform_hemisphere};
use glam::{DVec2, Vec2, Vec3};

/// Directions in which it is looked whether a point lies inside a body.
const DIRECTIONS: usize = 16;

/// How many of them are looked at first: a point that sees a back in none of these is taken for free.
const FIRST_DIRECTIONS: usize = 4;

/// Height of the second way over what stands between two points, in their distance: what is lower parts nothing.
const STEP: f32 = 0.5;

impl Tracer {
    /// Whether one can go from one start to another close by, along the surface that they lie on, without passing
    /// through a surface. The way is the shorter two sides of a triangle over what lies between: as high as the tangent
    /// planes of a convex surface meet, and, where that is blocked, half the points' distance higher.
    pub(crate) fn is_open_between(&self, from: &PathStart, to: &PathStart) -> bool {
        let (a, b) = (from.origin(), to.origin());
        let offset = b - a;
        if offset == Vec3::ZERO {
            return true;
        }
        let drop = (-offset.dot(from.geometric_normal())).max(0.0) + offset.dot(to.geometric_normal()).max(0.0);
        let up = (from.geometric_normal() + to.geometric_normal()).normalize_or_zero();
        let distance = offset.length();
        let height = 0.5 * drop;
        // Over a plane the way is straight.
        if height <= 1e-4 * distance {
            return !self.is_parted(a, b) || self.is_open_over(a, b, up * (STEP * distance));
        }
        self.is_open_over(a, b, up * height) || self.is_open_over(a, b, up * (height + STEP * distance))
    }

    fn is_open_over(&self, a: Vec3, b: Vec3, rise: Vec3) -> bool {
        let top = a + 0.5 * (b - a) + rise;
        !self.is_parted(a, top) && !self.is_parted(top, b)
    }

    /// Whether a surface that blocks light lies on the open segment between two points of the traced frame.
    fn is_parted(&self, a: Vec3, b: Vec3) -> bool {
        self.accel.meets(a, b, |hit| !self.surface(hit.triangle).passes)
    }

    /// Whether a start seems to lie inside a body. In most of [`DIRECTIONS`] over its surface the first thing that a
    /// ray meets is then the back of a surface, also where the body is open on the side that it stands on; or, where
    /// another body reaches into it, the ray leaves bodies once more than it enters any (the winding number of
    /// Jacobson, Kavan and Sorkine-Hornung 2013). Beside a wall that has a front only it may seem so too, which whoever
    /// asks has to tell apart by the light that gets there.
    pub(crate) fn is_enclosed(&self, start: &PathStart) -> bool {
        let frame = Frame::new(start.geometric_normal());
        let direction = |index: usize| {
            // The plastic number's sequence (Roberts 2018): spread evenly however many are taken.
            let place = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_2) * (index as f64 + 0.5);
            let place = (place - place.floor()).as_vec2().min(Vec2::splat(1.0 - f32::EPSILON));
            frame.world_from_local(square_to_uniform_hemisphere(place))
        };
        if !(0..FIRST_DIRECTIONS).any(|index| self.meets_a_back(start.origin(), direction(index))) {
            return false;
        }
        let is_inside = |direction: &Vec3| {
            self.meets_a_back(start.origin(), *direction) || self.bodies_left(start.origin(), *direction) > 0
        };
        2 * (0..DIRECTIONS).map(direction).filter(is_inside).count() > DIRECTIONS
    }

    /// Whether the first thing that a ray meets is the back of a surface.
    fn meets_a_back(&self, origin: Vec3, direction: Vec3) -> bool {
        let hit = self.accel.closest(origin, direction, f32::INFINITY);
        hit.is_some_and(|hit| {
            let is_back = self.triangles[hit.triangle as usize].normal.dot(direction) > 0.0;
            is_back && !self.surface(hit.triangle).passes
        })
    }

    /// How many more bodies a ray leaves than it enters.
    fn bodies_left(&self, origin: Vec3, direction: Vec3) -> i32 {
        let mut left = 0;
        self.accel.meets_towards(origin, direction, |hit| {
            if !self.surface(hit.triangle).passes {
                let is_back = self.triangles[hit.triangle as usize].normal.dot(direction) > 0.0;
                left += if is_back { 1 } else { -1 };
            }
            false
        });
        left
    }
}

#[cfg(test)]
mod tests;
