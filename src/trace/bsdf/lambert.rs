//! Lambert's ideal diffuse surface: f = ρ/π, sampled by the cosine, so that every sample weighs ρ.

use super::{BsdfSample, Density};
use crate::math::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// An ideal diffuse surface.
#[derive(Clone, Copy, Debug)]
pub(in crate::trace) struct Lambert {
    /// Reflected over arriving light, per channel.
    pub(in crate::trace) albedo: Vec3,
}

impl Lambert {
    /// A direction by the cosine.
    #[inline]
    pub(in crate::trace) fn sample(&self, u: Vec2) -> BsdfSample {
        let wi = square_to_cosine_hemisphere(u);
        BsdfSample { wi, weight: self.albedo, density: Density::Smooth(self.pdf(wi)) }
    }

    /// Scattering function times cos θi [1/sr].
    #[inline]
    pub(in crate::trace) fn evaluate(&self, wi: Vec3) -> Vec3 {
        self.albedo * self.pdf(wi)
    }

    /// Density of `wi` [1/sr].
    #[inline]
    pub(in crate::trace) fn pdf(&self, wi: Vec3) -> f32 {
        wi.z.max(0.0) * FRAC_1_PI
    }
}
