//! The modified Phong model, which reflects alike both ways and never more than all: a diffuse lobe and one of
//! cosⁿ α around the mirror direction.
//!
//! Lafortune and Willems 1994, "Using the Modified Phong Reflectance Model for Physically Based Rendering". What the
//! glossy lobe sends below the surface is lost.

use super::ggx::mirror;
use super::{BsdfSample, Density, Lambert, spread};
use crate::math::{Frame, Portable};
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// A diffuse and a glossy lobe.
#[derive(Clone, Copy, Debug)]
pub(in crate::trace) struct Phong {
    /// Albedo of the diffuse lobe.
    pub(in crate::trace) diffuse: Vec3,
    /// Largest albedo of the glossy lobe.
    pub(in crate::trace) specular: Vec3,
    /// Exponent n of the glossy lobe, at least 0.
    pub(in crate::trace) exponent: f32,
}

impl Phong {
    /// A direction of either lobe.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, [u, v, u_choice]: [f32; 3]) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let wi = if u_choice < self.glossy_chance() {
            // The cosine is v^(1 / (n + 1)); its sine does not come from the difference to 1.
            let log = Portable::ln(v) / (self.exponent + 1.0);
            let (cos, sin) = (Portable::exp(log), (-Portable::exp_m1(2.0 * log)).sqrt());
            let (y, x) = Portable::sin_cos(TAU * u);
            Frame::new(mirror(wo)).world_from_local(Vec3::new(sin * x, sin * y, cos)).normalize()
        } else {
            self.lambert().sample(Vec2::new(u, v)).wi
        };
        let pdf = self.pdf(wo, wi);
        let sample = BsdfSample { wi, weight: self.evaluate(wo, wi) / pdf, density: Density::Smooth(pdf) };
        (wi.z > 0.0 && pdf > 0.0).then_some(sample)
    }

    /// Scattering function times cos θi [1/sr].
    #[inline]
    pub(super) fn evaluate(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return Vec3::ZERO;
        }
        let glossy = (self.exponent + 2.0) / TAU * self.lobe(wo, wi) * wi.z;
        self.lambert().evaluate(wi) + self.specular * glossy
    }

    /// The same of the diffuse lobe.
    #[inline]
    pub(super) fn matt(&self, wi: Vec3) -> Vec3 {
        self.lambert().evaluate(wi)
    }

    /// Density of `wi` [1/sr].
    #[inline]
    pub(super) fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return 0.0;
        }
        let chance = self.glossy_chance();
        let glossy = if chance > 0.0 { (self.exponent + 1.0) / TAU * self.lobe(wo, wi) } else { 0.0 };
        spread(self.lambert().pdf(wi), glossy, chance)
    }

    /// An upper bound of what leaves again.
    #[inline]
    pub(super) fn albedo(&self) -> Vec3 {
        self.diffuse + self.specular
    }

    /// cosⁿ α, where α is the angle to the mirror direction. By the distance between the two, since a cosine near 1
    /// has lost the digits that a large exponent needs.
    #[inline]
    fn lobe(&self, wo: Vec3, wi: Vec3) -> f32 {
        let lack = 0.5 * (mirror(wo) - wi).length_squared();
        if lack < 1.0 { Portable::exp(self.exponent * Portable::ln_1p(-lack)) } else { 0.0 }
    }

    #[inline]
    fn lambert(&self) -> Lambert {
        Lambert { albedo: self.diffuse }
    }

    #[inline]
    fn glossy_chance(&self) -> f32 {
        let [diffuse, specular] = [self.diffuse, self.specular].map(Vec3::element_sum);
        if diffuse + specular > 0.0 { specular / (diffuse + specular) } else { 0.0 }
    }
}
