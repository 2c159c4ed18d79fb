//! A clear coat of varnish: GGX of F0 = 0.04 on top of everything else.
//!
//! What lies below gets what the coat leaves. At μo and μi this is the lesser of 1 − c E(μo) and 1 − c E(μi), for the
//! strength c: the same both ways, never more in all than arrived whatever lies below, and nothing is lost over a
//! mirror. (The product of the two, for in and out, forgets what the coat sends down again.) What bounces between the
//! coat's own facets goes below.

use super::albedo::{AlbedoTables, RoughnessAlbedo};
use super::fresnel::Schlick;
use super::ggx::{Ggx, half_vector, mirror, mirrored};
use super::{BsdfSample, Density};
use glam::Vec3;

/// The coat's reflectance along the normal and at grazing incidence, as in Bevy and glTF.
const VARNISH: Schlick = Schlick { f0: Vec3::splat(0.04), f90: 1.0 };

/// A coat. Without strength it is not there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clearcoat<'a> {
    surface: Option<Ggx>,
    strength: f32,
    albedo: RoughnessAlbedo<'a>,
}

impl<'a> Clearcoat<'a> {
    pub(super) fn new(strength: f32, perceptual_roughness: f32, tables: &'a AlbedoTables) -> Self {
        Self { surface: Ggx::new(perceptual_roughness), strength, albedo: tables.at(perceptual_roughness) }
    }

    /// Reflected over arriving light, seen at this cosine.
    #[inline]
    pub(super) fn albedo(&self, cos: f32) -> f32 {
        if self.strength > 0.0 { self.strength * self.albedo.at(cos).of(&VARNISH).x } else { 0.0 }
    }

    /// What is left for what lies below, between these two cosines.
    #[inline]
    pub(super) fn leaves(&self, cos_o: f32, cos_i: f32) -> f32 {
        1.0 - self.albedo(cos_o).max(self.albedo(cos_i))
    }

    /// Whether there is a coat and its lobe is spread out.
    #[inline]
    pub(super) fn is_smooth_lobe(&self) -> bool {
        self.strength > 0.0 && self.surface.is_some()
    }

    #[inline]
    pub(super) fn sample(&self, wo: Vec3, [u, v, _]: [f32; 3]) -> Option<BsdfSample> {
        let Some(surface) = &self.surface else {
            let weight = self.strength * VARNISH.at(wo.z);
            return Some(BsdfSample { wi: mirror(wo), weight, density: Density::Delta });
        };
        let wi = mirrored(wo, surface.sample(wo, [u, v]))?;
        let pdf = self.pdf(wo, wi);
        let sample = BsdfSample { wi, weight: self.evaluate(wo, wi) / pdf, density: Density::Smooth(pdf) };
        (pdf > 0.0).then_some(sample)
    }

    /// Scattering function times cos θi [1/sr].
    #[inline]
    pub(super) fn evaluate(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let (true, Some(surface), Some(m)) = (self.strength > 0.0, &self.surface, half_vector(wo, wi)) else {
            return Vec3::ZERO;
        };
        VARNISH.at(wo.dot(m)) * (self.strength * surface.reflection(wo, wi, m))
    }

    /// Density of `wi` [1/sr].
    #[inline]
    pub(super) fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match (&self.surface, half_vector(wo, wi)) {
            (Some(surface), Some(m)) => surface.reflection_pdf(wo, m),
            _ => 0.0,
        }
    }
}
