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
//! Of what a surface shows, its matt part is shared (`bsdf/look.rs`): what is below all coats looks the same from
//! everywhere, but for a factor l(ωo) that each receiver has of its own. What the coats themselves reflect is the
//! receiver's alone, as is all that a mirror or clear glass shows. The two parts of a path add up to what it would bring
//! if none were shared. A place is another's only if it shows others the same frame: where a shading normal looks away
//! from a receiver, that one sees the flat surface, finds the place for itself and gets nothing of it from others.
//!
//! What is seen through a surface that lets light pass is a receiver's alone too: such a surface hides a place from all
//! others, so that no density has to know what it would leave. So is what lies in a body of glass, which dims it.
//!
//! Light straight from sources is not shared: it is nearly noiseless by itself, and the weights of what both light
//! sampling and the path find are a receiver's own.

use super::Tally;
use super::start::PathStart;
use super::vertex::Vertex;
use crate::trace::bsdf::Look;
use crate::trace::effects::Effect;
use crate::trace::tracer::Tracer;
use crate::trace::transport::{Sharing, Transport};
use glam::Vec3;

/// The most receivers that share their paths.
pub(crate) const MOST_RECEIVERS: usize = 16;

/// What one path from a receiver found.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found<'t> {
    /// What serves its own receiver alone [cd/m²].
    pub(super) alone: Vec3,
    pub(super) shared: Option<Shared<'t>>,
}

/// What a path found that can serve others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shared<'t> {
    pub(super) whence: Whence<'t>,
    /// Radiance from there, over how it looks [cd/m²].
    pub(super) radiance: Vec3,
    /// How it looks to its own receiver.
    pub(super) own: Vec3,
}

/// Where light came from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Whence<'t> {
    /// A place on a surface.
    Surface {
        /// A point off it, where rays from there start [m].
        point: Vec3,
        /// The surface's unit normal on that side.
        normal: Vec3,
        /// The unit normal around which it scatters.
        shading: Vec3,
        /// How it looks.
        look: Look<'t>,
    },
    /// Beyond the scene, in this unit direction.
    Sky(Vec3),
}

impl Found<'_> {
    /// What serves its own receiver alone.
    pub(super) fn alone(radiance: Vec3) -> Self {
        Self { alone: radiance, shared: None }
    }
}

impl Tracer {
    /// Whom paths serve that start in this scene: where there is nothing to share, their own receivers alone.
    pub(crate) fn sharing(&self, transport: &Transport) -> Sharing {
        let has_any = self.effects.has(Effect::Interreflection) || self.sky_radiance != Vec3::ZERO;
        if has_any { transport.sharing } else { Sharing::Alone }
    }

    /// Deals out what the path of receiver `own` found: adds the light of each receiver of its group [cd/m²], of which
    /// there are [`MOST_RECEIVERS`] at most.
    pub(crate) fn share(&self, starts: &[PathStart], own: usize, found: &Found, light: &mut [Vec3], tally: &mut Tally) {
        light[own] += found.alone;
        let Some(Shared { whence, radiance, own: own_look }) =
            found.shared.filter(|shared| shared.radiance != Vec3::ZERO)
        else {
            return;
        };
        // A path that has lost its number is to cost nobody else one.
        if !radiance.is_finite() {
            light[own] += radiance;
            return;
        }
        let (mut densities, mut looks) = ([0.0_f32; MOST_RECEIVERS], [Vec3::ONE; MOST_RECEIVERS]);
        for (number, start) in starts.iter().enumerate() {
            if !whence.is_for(start, &starts[own]) {
                continue;
            }
            let (density, look) = (whence.density(start), if number == own { own_look } else { whence.look(start) });
            // One who sees nothing of a channel finds none of it for others either.
            if density > 0.0 && look.min_element() > 0.0 {
                if number != own {
                    tally.rays += 1;
                    if !self.sees(start, whence) {
                        continue;
                    }
                }
                (densities[number], looks[number]) = (density, look);
            }
        }
        let sum: f32 = densities.iter().sum();
        // So near that no density is a number, a place is its own receiver's alone.
        if !(sum > 0.0 && sum.is_finite()) {
            light[own] += radiance * own_look;
            return;
        }
        for ((light, density), look) in light.iter_mut().zip(densities).zip(looks) {
            *light += radiance * look * (density / sum);
        }
    }

    /// Whether nothing is in between, not even what lets light pass.
    fn sees(&self, start: &PathStart, whence: Whence) -> bool {
        match whence {
            Whence::Surface { point, .. } => !self.accel.is_blocked(start.origin, point),
            Whence::Sky(direction) => !self.accel.is_blocked_towards(start.origin, direction),
        }
    }
}

impl<'t> Whence<'t> {
    /// From a vertex that looks like this.
    pub(super) fn of(vertex: &Vertex<'_>, look: Look<'t>) -> Self {
        let (normal, shading) = (vertex.geometric_normal, vertex.frame.normal);
        Self::Surface { point: vertex.origin, normal, shading, look }
    }

    /// Whether a path of `own` can serve another.
    fn is_for(self, start: &PathStart, own: &PathStart) -> bool {
        matches!(self, Self::Surface { .. }) || start.normal == own.normal
    }

    /// How densely directions from a start find it, but for a factor that all starts have.
    fn density(self, start: &PathStart) -> f32 {
        let (direction, falloff) = match self {
            Self::Sky(direction) => (direction, 1.0),
            Self::Surface { point, normal, .. } => {
                let offset = point - start.origin;
                let square = offset.length_squared();
                (offset, -normal.dot(offset) / (square * square))
            }
        };
        let leaves = start.geometric_normal.dot(direction) > 0.0;
        if leaves { (start.normal.dot(direction) * falloff).max(0.0) } else { 0.0 }
    }

    /// How it looks from a start; zero where that sees another frame.
    fn look(self, start: &PathStart) -> Vec3 {
        match self {
            Self::Sky(_) => Vec3::ONE,
            // The density has asked on which side the start is.
            Self::Surface { normal, shading, look, .. } if look.is_even() && shading == normal => Vec3::ONE,
            Self::Surface { point, shading, look, .. } => {
                let offset = start.origin - point;
                let cos = shading.dot(offset) / offset.length();
                if cos > 0.0 { look.from(cos) } else { Vec3::ZERO }
            }
        }
    }
}

#[cfg(test)]
mod tests;
