//! The microfacet coat of Bevy's material: GGX with Schlick's Fresnel term, and what bounces between its facets.
//!
//! Bevy scales the lobe up to make good for the light that leaves one facet only to hit another, which is not the
//! same both ways. Here that light is a lobe of its own which is (Kulla and Conty 2017), of the colour that light has
//! after two reflections and more: F² E / (1 − F (1 − E)) by averages (Fdez-Agüera 2019).

use super::albedo::{AlbedoTables, RoughnessAlbedo};
use super::fresnel::Schlick;
use super::ggx::{Ggx, half_vector, mirror, mirrored};
use super::{Proposal, Response, cosine_pdf, spread};
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

/// What a specular lobe does with light of one cosine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// Reflected over arriving light.
    pub(super) albedo: Vec3,
    /// Share that meets a second facet.
    missing: f32,
}

impl<'a> Specular<'a> {
    pub(super) fn new(fresnel: Schlick, perceptual_roughness: f32, tables: &'a AlbedoTables) -> Self {
        let albedo = tables.at(perceptual_roughness);
        let (average, all) = (fresnel.average(), albedo.average().white());
        let tint = average * average * all / (Vec3::ONE - average * (1.0 - all));
        Self { surface: Ggx::new(perceptual_roughness), fresnel, albedo, tint }
    }

    /// What the lobe does with light of this cosine, in either direction.
    #[inline]
    pub(super) fn seen(&self, cos: f32) -> Seen {
        let once = self.albedo.at(cos);
        let missing = (1.0 - once.white()).max(0.0);
        Seen { albedo: once.of(&self.fresnel) + self.tint * missing, missing }
    }

    /// The cosine-weighted mean of the albedo.
    #[inline]
    pub(super) fn average_albedo(&self) -> Vec3 {
        let once = self.albedo.average();
        once.of(&self.fresnel) + self.tint * (1.0 - once.white()).max(0.0)
    }

    /// Whether the lobe is spread out and not black.
    #[inline]
    pub(super) fn is_smooth_lobe(&self) -> bool {
        self.surface.is_some() && self.fresnel.f90 > 0.0
    }

    #[inline]
    pub(super) fn propose(&self, wo: Vec3, [u, v, u_choice]: [f32; 3], seen_o: &Seen) -> Option<Proposal> {
        let Some(surface) = &self.surface else {
            return Some(Proposal::single(mirror(wo), self.fresnel.at(wo.z)));
        };
        if u_choice < self.chance_of_more(seen_o) {
            return Some(Proposal::Spread(square_to_cosine_hemisphere(Vec2::new(u, v))));
        }
        mirrored(wo, surface.sample(wo, [u, v])).map(Proposal::Spread)
    }

    #[inline]
    pub(super) fn respond(&self, [wo, wi]: [Vec3; 2], [seen_o, seen_i]: [&Seen; 2]) -> Response {
        let (Some(surface), Some(m)) = (&self.surface, half_vector(wo, wi)) else {
            return Response::default();
        };
        let (lobe, pdf) = surface.reflection(wo, wi, m);
        let more = self.albedo.compensation([seen_o.missing, seen_i.missing]) * wi.z;
        Response {
            value: self.fresnel.at(wo.dot(m)) * lobe + self.tint * more,
            pdf: spread(pdf, cosine_pdf(wi), self.chance_of_more(seen_o)),
        }
    }

    /// The chance to sample what is reflected more than once.
    #[inline]
    fn chance_of_more(&self, seen: &Seen) -> f32 {
        let (more, all) = (self.tint.element_sum() * seen.missing, seen.albedo.element_sum());
        if all > 0.0 { more / all } else { 0.0 }
    }
}
