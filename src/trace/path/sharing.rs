//! Paths that serve several receivers: the light that one brings is dealt out to all that see where it came from.
//!
//! A path from a receiver first meets a surface or leaves the scene. What comes from there is as good a sample for any
//! other receiver that sees the same place. So a group of receivers traces one path each, and the light of every path
//! goes to all of them (Bekaert, Sbert and Halton 2002, "Accelerating path tracing by re-using paths"). Receiver k would
//! have found the place y with the density pₖ(y) = cos θₖ cos θ_y / (π rₖ²), nothing if it does not see it, and E/π at
//! receiver j is the integral of L(y) pⱼ(y). By the balance heuristic over the group (Veach and Guibas 1995), what a path
//! brings it is
//!
//! L(y) pⱼ(y) / Σₖ pₖ(y),
//!
//! a share of the path's light. The shares of all receivers add up to one, and none is above one, however near to a
//! receiver the place is. A constant sky is shared by directions, pₖ = cos θₖ / π, among receivers that face the same way:
//! it has no noise where nothing hides it, and shares that differ would bring some.
//!
//! Light straight from sources is not shared: it is nearly noiseless by itself, and the weights of what both light
//! sampling and the path find are a receiver's own. Nor is light that looks different from elsewhere: a path whose
//! first surface is not Lambert's, or that passed a surface on its way there, serves its own receiver alone.

use super::Tally;
use super::start::PathStart;
use super::vertex::Vertex;
use crate::trace::effects::Effect;
use crate::trace::tracer::Tracer;
use crate::trace::transport::{Sharing, Transport};
use glam::Vec3;

/// The most receivers that share their paths.
pub(crate) const MOST_RECEIVERS: usize = 16;

/// What one path from a receiver found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    /// What serves its own receiver alone [cd/m²].
    pub(super) alone: Vec3,
    pub(super) shared: Option<Shared>,
}

/// What a path found that can serve others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shared {
    pub(super) whence: Whence,
    /// Radiance from there [cd/m²].
    pub(super) radiance: Vec3,
}

/// Where light came from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Whence {
    /// A point off a surface, where rays from there start [m], and the surface's unit normal on that side.
    Surface { point: Vec3, normal: Vec3 },
    /// Beyond the scene, in this unit direction.
    Sky(Vec3),
}

impl Found {
    /// What serves its own receiver alone.
    pub(super) fn alone(radiance: Vec3) -> Self {
        Self { alone: radiance, shared: None }
    }
}

impl Tracer {
    /// Whom paths serve that start in this scene: where there is nothing to share, their own receivers alone.
    pub(crate) fn sharing(&self, transport: &Transport) -> Sharing {
        let has_any = self.effects.has(Effect::Interreflection) || self.sky_radiance != Vec3::ZERO;
        if has_any && self.is_diffuse() { transport.sharing } else { Sharing::Alone }
    }

    /// Deals out what the path of receiver `own` found: adds the light of each receiver of its group [cd/m²], of which
    /// there are [`MOST_RECEIVERS`] at most.
    pub(crate) fn share(&self, starts: &[PathStart], own: usize, found: &Found, light: &mut [Vec3], tally: &mut Tally) {
        light[own] += found.alone;
        let Some(Shared { whence, radiance }) = found.shared.filter(|shared| shared.radiance != Vec3::ZERO) else {
            return;
        };
        let mut densities = [0.0_f32; MOST_RECEIVERS];
        for (number, (start, density)) in starts.iter().zip(&mut densities).enumerate() {
            *density = if whence.is_for(start, &starts[own]) { whence.density(start) } else { 0.0 };
            if number != own && *density > 0.0 {
                tally.rays += 1;
                if !self.sees(start, whence) {
                    *density = 0.0;
                }
            }
        }
        let sum: f32 = densities.iter().sum();
        // So near that no density is a number, a place is its own receiver's alone.
        if !(sum > 0.0 && sum.is_finite()) {
            light[own] += radiance;
            return;
        }
        for (light, density) in light.iter_mut().zip(densities) {
            *light += radiance * (density / sum);
        }
    }

    fn sees(&self, start: &PathStart, whence: Whence) -> bool {
        match whence {
            Whence::Surface { point, .. } => !self.accel.is_blocked(start.origin, point),
            Whence::Sky(direction) => !self.accel.is_blocked_towards(start.origin, direction),
        }
    }
}

impl From<&Vertex<'_>> for Whence {
    fn from(vertex: &Vertex<'_>) -> Self {
        Self::Surface { point: vertex.origin, normal: vertex.geometric_normal }
    }
}

impl Whence {
    /// Whether a path of `own` can serve another.
    fn is_for(self, start: &PathStart, own: &PathStart) -> bool {
        matches!(self, Self::Surface { .. }) || start.normal == own.normal
    }

    /// How densely directions from a start find it, but for a factor that all starts have.
    fn density(self, start: &PathStart) -> f32 {
        let (direction, falloff) = match self {
            Self::Sky(direction) => (direction, 1.0),
            Self::Surface { point, normal } => {
                let offset = point - start.origin;
                let square = offset.length_squared();
                (offset, -normal.dot(offset) / (square * square))
            }
        };
        let leaves = start.geometric_normal.dot(direction) > 0.0;
        if leaves { (start.normal.dot(direction) * falloff).max(0.0) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests;
