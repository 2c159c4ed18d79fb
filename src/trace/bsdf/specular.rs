//! The microfacet coat of Bevy's material: GGX with Schlick's Fresnel term, and what bounces between its facets.
//!
//! Bevy scales the lobe up to make good for the light that leaves one facet only to hit another, which is not the
//! same both ways. Here that light is a lobe of its own which is (Kulla and Conty 2017), of the colour that light has
//! after two reflections and more: F² E / (1 − F (1 − E)) by averages (Fdez-Agüera 2019).

use super::albedo::{AlbedoTables, RoughnessAlbedo};
use super::fresnel::Schlick;
use super::ggx::{Ggx, half_vector, mirror, mirrored};
use super::{BsdfSample, Density, cosine_pdf, spread};
use crate::math::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// A microfacet lobe with its compensation. Perfectly smooth ones reflect in a single direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Specular<'a> {
    surface: Option<Ggx>,
    fresnel: Schlick,
    albedo: RoughnessAlbedo<'a>,
    /// Colour of what was reflected more than once, over what would be if facets reflected all.
    tint: Vec3,
}

impl<'a> Specular<'a> {
    pub(super) fn new(fresnel: Schlick, perceptual_roughness: f32, tables: &'a AlbedoTables) -> Self {
        let albedo = tables.at(perceptual_roughness);
        let (average, all) = (fresnel.average(), albedo.average().white());
        let tint = average * average * all / (Vec3::ONE - average * (1.0 - all));
        Self { surface: Ggx::new(perceptual_roughness), fresnel, albedo, tint }
    }

    /// Reflected over arriving light, seen at this cosine.
    #[inline]
    pub(super) fn albedo(&self, cos: f32) -> Vec3 {
        let once = self.albedo.at(cos);
        once.of(&self.fresnel) + self.tint * (1.0 - once.white()).max(0.0)
    }

    /// Its cosine-weighted mean.
    #[inline]
    pub(super) fn average_albedo(&self) -> Vec3 {
        let once = self.albedo.average();
        once.of(&self.fresnel) + self.tint * (1.0 - once.white()).max(0.0)
    }

    /// Whether the lobe is spread out.
    #[inline]
    pub(super) fn is_smooth_lobe(&self) -> bool {
        self.surface.is_some()
    }

    #[inline]
    pub(super) fn sample(&self, wo: Vec3, [u, v, u_choice]: [f32; 3]) -> Option<BsdfSample> {
        let Some(surface) = &self.surface else {
            return Some(BsdfSample { wi: mirror(wo), weight: self.fresnel.at(wo.z), density: Density::Delta });
        };
        let wi = if u_choice < self.diffuse_chance(wo) {
            square_to_cosine_hemisphere(Vec2::new(u, v))
        } else {
            mirrored(wo, surface.sample(wo, [u, v]))?
        };
        let pdf = self.pdf(wo, wi);
        let sample = BsdfSample { wi, weight: self.evaluate(wo, wi) / pdf, density: Density::Smooth(pdf) };
        (pdf > 0.0).then_some(sample)
    }

    /// Scattering function times cos θi [1/sr].
    #[inline]
    pub(super) fn evaluate(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let (Some(surface), Some(m)) = (&self.surface, half_vector(wo, wi)) else {
            return Vec3::ZERO;
        };
        let once = self.fresnel.at(wo.dot(m)) * surface.reflection(wo, wi, m);
        once + self.tint * (self.albedo.compensation(wo.z, wi.z) * wi.z)
    }

    /// Density of `wi` [1/sr].
    #[inline]
    pub(super) fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let (Some(surface), Some(m)) = (&self.surface, half_vector(wo, wi)) else {
            return 0.0;
        };
        spread(surface.reflection_pdf(wo, m), cosine_pdf(wi), self.diffuse_chance(wo))
    }

    /// The chance to sample what is reflected more than once.
    #[inline]
    fn diffuse_chance(&self, wo: Vec3) -> f32 {
        let once = self.albedo.at(wo.z);
        let more = self.tint.element_sum() * (1.0 - once.white()).max(0.0);
        let all = once.of(&self.fresnel).element_sum() + more;
        if all > 0.0 { more / all } else { 0.0 }
    }
}
