//! The frame in which rays are traced: the world's axes about an origin near the scene. Owns what is called *traced*
//! below `trace`, as opposed to *world*; knows no scene.
//!
//! A number of a metre costs as many bits a kilometre away from the origin as it does at home, but those bits then say
//! where the scene is and no longer what it looks like: points on its walls, which must be computed, round to a grid
//! of 0.06 mm there, and of 8 mm at 100 km. Vertices lie on that grid anyway, as the world's f32 has them; what is
//! computed from them need not. So rays, lights and all that they meet live in a frame of their own, which differs
//! from the world by a translation that rounds no vertex:
//!
//! - On an axis on which all vertices have the same sign and the farthest is at most twice as far as the nearest, the
//!   nearest is subtracted. For y/2 ≤ x ≤ 2y the difference x − y of two floating-point numbers is exact (Sterbenz
//!   1974, theorem 4.3.1; Higham 2002, theorem 2.5).
//! - On any other axis nothing is subtracted. The scene then is at least half as large there as it is far, so that
//!   its coordinates lose one bit at most; and a scene about the origin keeps every bit as it is.
//!
//! Whatever else comes in (meter points, cameras, lights) is moved along and rounded once, by at most half a unit in
//! the last place of its traced coordinate, which is less than what its world coordinate was rounded by if it lies
//! near the scene. A plain f32 subtraction is that single rounding.

use glam::{DVec3, Vec3};

/// World to the traced frame: a translation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct TracedFromWorld {
    /// The traced frame's origin in the world [m].
    origin: Vec3,
}

impl TracedFromWorld {
    /// The frame of a scene with these vertices [m, world].
    pub(super) fn around(vertices: impl Iterator<Item = Vec3>) -> Self {
        let bounds = vertices.fold(None, |bounds: Option<[Vec3; 2]>, vertex| {
            Some(bounds.map_or([vertex; 2], |[low, high]| [low.min(vertex), high.max(vertex)]))
        });
        let Some([low, high]) = bounds else {
            return Self::default();
        };
        let nearest = |axis| {
            let (low, high): (f32, f32) = (low[axis], high[axis]);
            // Halves, since a double might be infinite; a half that is no normal number is no distance either.
            match (low > 0.0 && 0.5 * high <= low, high < 0.0 && 0.5 * low >= high) {
                (true, _) => low,
                (_, true) => high,
                _ => 0.0,
            }
        };
        Self { origin: Vec3::from_array([0, 1, 2].map(nearest)) }
    }

    /// The traced frame's origin in the world [m].
    pub(super) fn origin(self) -> DVec3 {
        self.origin.as_dvec3()
    }

    /// A point of the world in the traced frame.
    #[inline]
    pub(super) fn point(self, world: Vec3) -> Vec3 {
        world - self.origin
    }

    /// By how much each coordinate of a point of the world may be off because it is an f32 [m]: half a unit in the last
    /// place. Zero on axes that are not moved, where this is no more than what the tracer's own numbers are off by.
    pub(super) fn rounding(self, world: Vec3) -> Vec3 {
        let half_step = |coordinate: f32| 0.5 * (coordinate.abs().next_up() - coordinate.abs());
        Vec3::select(self.origin.cmpne(Vec3::ZERO), world.map(half_step), Vec3::ZERO)
    }
}

#[cfg(test)]
mod tests;
