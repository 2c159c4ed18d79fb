//! A diffuser: Lambert's law on the other side, f = τ/π, as of paper held against a lamp.

use super::{BsdfSample, Density};
use crate::math::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// An ideal diffuser, which reflects nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct DiffuseTransmission {
    /// Transmitted over arriving light, per channel.
    pub(super) albedo: Vec3,
}

impl DiffuseTransmission {
    /// A direction on the far side by the cosine.
    #[inline]
    pub(super) fn sample(&self, u: Vec2) -> BsdfSample {
        let wi = square_to_cosine_hemisphere(u) * Vec3::new(1.0, 1.0, -1.0);
        BsdfSample { wi, weight: self.albedo, density: Density::Smooth(self.pdf(wi)) }
    }

    /// Scattering function times |cos θi| [1/sr].
    #[inline]
    pub(super) fn evaluate(&self, wi: Vec3) -> Vec3 {
        self.albedo * self.pdf(wi)
    }

    /// Density of `wi` [1/sr].
    #[inline]
    pub(super) fn pdf(&self, wi: Vec3) -> f32 {
        (-wi.z).max(0.0) * FRAC_1_PI
    }
}
