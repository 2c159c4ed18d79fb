//! Paths that serve several receivers: the light that one brings is dealt among all that see where it came from.
//!
//! A path from a receiver first meets a surface or leaves the scene. What comes from there is as good a sample for any
//! other receiver that sees the same place: so receivers trace one path each, and every path's light goes to all of them
//! (Bekaert, Sbert and Halton 2002, "Accelerating path tracing by re-using paths"). With the balance heuristic over the
//! densities pₖ with which each receiver would have found the place, receiver j gets of path i
//!
//! L fⱼ / Σₖ pₖ, where fⱼ / pⱼ is E/π's integrand over its density: 1 for directions by the cosine.
//!
//! That is the share pⱼ / Σₖ pₖ of the path's radiance L, the shares of all receivers add up to one, and none is above
//! one however near the place is. All densities contain the same cosine at the place, which cancels; what is left is
//! cos θₖ / rₖ² for those that see it. Light straight from sources is no part of this: it is nearly noiseless by itself.
//!
//! It asks that the radiance be the same in all directions: after passed surfaces and on others than Lambert's a path
//! serves its own receiver alone.

use super::start::PathStart;
use crate::trace::tracer::Tracer;
use glam::Vec3;

/// What one path from a receiver found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    /// What serves its own receiver alone [cd/m²].
    pub(super) alone: Vec3,
    /// Where the rest came from.
    pub(super) place: Whence,
    /// The rest: radiance over the density of the path's first direction, for a receiver of albedo 1 [cd/m²].
    pub(super) radiance: Vec3,
}

/// Where light came from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Whence {
    Nowhere,
    /// A point off a surface, where rays from there start [m], and the surface's unit normal.
    Surface(Vec3, Vec3),
    /// A direction that leaves the scene.
    Distance(Vec3),
}

impl Found {
    /// A path that serves its own receiver alone.
    pub(super) fn alone(radiance: Vec3) -> Self {
        Self { alone: radiance, place: Whence::Nowhere, radiance: Vec3::ZERO }
    }
}

impl Tracer {
    /// Deals what the paths of receivers found, one each, among them; adds to the light of each [cd/m²] and returns how
    /// many rays that took.
    pub(crate) fn deal(&self, starts: &[PathStart], found: &[Found], light: &mut [Vec3]) -> u64 {
        let mut rays = 0;
        let mut densities = [0.0_f32; MOST_RECEIVERS];
        for (own, path) in found.iter().enumerate() {
            light[own] += path.alone;
            if path.radiance == Vec3::ZERO {
                continue;
            }
            let mut sum = 0.0;
            for (number, start) in starts.iter().enumerate() {
                let density = self.density(start, path.place);
                rays += u64::from(number != own && density > 0.0);
                let is_seen = number == own || density > 0.0 && self.sees(start, path.place);
                densities[number] = if is_seen { density } else { 0.0 };
                sum += densities[number];
            }
            if sum > 0.0 && sum.is_finite() {
                for (light, density) in light.iter_mut().zip(densities) {
                    *light += path.radiance * (density / sum);
                }
            } else {
                light[own] += path.radiance;
            }
        }
        rays
    }

    /// How densely directions from a start find a place, but for what is the same for all starts.
    fn density(&self, start: &PathStart, place: Whence) -> f32 {
        let (direction, falloff) = match place {
            Whence::Nowhere => return 0.0,
            Whence::Distance(direction) => (direction, 1.0),
            Whence::Surface(point, normal) => {
                let offset = point - start.origin;
                let square = offset.length_squared();
                (offset, -normal.dot(offset) / (square * square))
            }
        };
        if start.geometric_normal.dot(direction) <= 0.0 {
            return 0.0;
        }
        (start.normal.dot(direction) * falloff).max(0.0)
    }

    fn sees(&self, start: &PathStart, place: Whence) -> bool {
        match place {
            Whence::Nowhere => false,
            Whence::Surface(point, _) => !self.accel.is_blocked(start.origin, point),
            Whence::Distance(direction) => !self.accel.is_blocked_towards(start.origin, direction),
        }
    }
}

/// The most receivers that share their paths.
pub(crate) const MOST_RECEIVERS: usize = 32;
