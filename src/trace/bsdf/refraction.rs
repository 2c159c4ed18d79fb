//! A perfectly smooth interface of glass: Snell's and Fresnel's laws.
//!
//! What crosses is radiance, which is concentrated where the index is higher: L/n² is what stays the same (Nicodemus
//! 1963). A path that goes on into a medium `eta` times as dense finds light that weighs 1/eta² here.

use super::fresnel::{Refracted, refract, refract_from};
use super::ggx::mirror;
use super::{BsdfSample, Density};
use glam::Vec3;

/// A smooth interface.
#[derive(Clone, Copy, Debug)]
pub(in crate::trace) struct Refraction {
    /// Index of refraction on the far side over that on the near one.
    pub(in crate::trace) eta: f32,
    /// Multiplies what crosses.
    pub(in crate::trace) tint: Vec3,
}

impl Refraction {
    /// One of the two directions, by how much light goes there.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, u: f32) -> Option<BsdfSample> {
        if wo.z <= 0.0 {
            return None;
        }
        let refracted = self.refracted(wo);
        let chance = reflection_chance(refracted.reflectance, self.tint);
        if u < chance {
            let weight = Vec3::splat(refracted.reflectance / chance);
            return Some(BsdfSample { wi: mirror(wo), weight, density: Density::Delta });
        }
        let crosses = (1.0 - refracted.reflectance) / (1.0 - chance);
        let weight = self.tint * (crosses / (self.eta * self.eta));
        let wi = refract(wo, Vec3::Z, self.eta, refracted);
        (weight != Vec3::ZERO && wi.z < 0.0).then_some(BsdfSample { wi, weight, density: Density::Delta })
    }

    #[inline]
    fn refracted(&self, wo: Vec3) -> Refracted {
        refract_from(wo.z, wo.x * wo.x + wo.y * wo.y, self.eta)
    }

    /// Arriving light that leaves again, as energy: without the factor that follows the index.
    #[inline]
    pub(super) fn albedo(&self, wo: Vec3) -> Vec3 {
        let reflectance = self.refracted(wo).reflectance;
        Vec3::splat(reflectance) + self.tint * (1.0 - reflectance)
    }
}

/// The chance to reflect where this share is reflected and the rest tinted.
#[inline]
pub(super) fn reflection_chance(reflectance: f32, tint: Vec3) -> f32 {
    let crosses = (1.0 - reflectance) * tint.element_sum() * (1.0 / 3.0);
    if reflectance + crosses > 0.0 { reflectance / (reflectance + crosses) } else { 1.0 }
}
