//! A clear coat of varnish: GGX of F0 = 0.04 on top of everything else.
//!
//! What lies below gets what the coat leaves. At μo and μi this is the lesser of 1 − c E(μo) and 1 − c E(μi), for the
//! strength c: the same both ways, never more in all than arrived whatever lies below, and nothing is lost over a
//! mirror. (The product of the two, for in and out, forgets what the coat sends down again.) What bounces between the
//! coat's own facets goes below.

use super::albedo::{AlbedoTables, RoughnessAlbedo};
use super::fresnel::Schlick;
use super::ggx::{Ggx, half_vector, mirror, mirrored};
use super::{Proposal, Response};
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

    /// What is left for what lies below, between directions of these two albedos.
    #[inline]
    pub(super) fn leaves(albedo_o: f32, albedo_i: f32) -> f32 {
        1.0 - albedo_o.max(albedo_i)
    }

    /// Whether there is a coat and its lobe is spread out.
    #[inline]
    pub(super) fn is_smooth_lobe(&self) -> bool {
        self.strength > 0.0 && self.surface.is_some()
    }

    #[inline]
    pub(super) fn propose(&self, wo: Vec3, [u, v, _]: [f32; 3]) -> Option<Proposal> {
        match &self.surface {
            Some(surface) => mirrored(wo, surface.sample(wo, [u, v])).map(Proposal::Spread),
            None => Some(Proposal::single(mirror(wo), self.strength * VARNISH.at(wo.z))),
        }
    }

    #[inline]
    pub(super) fn respond(&self, wo: Vec3, wi: Vec3) -> Response {
        let (true, Some(surface), Some(m)) = (self.strength > 0.0, &self.surface, half_vector(wo, wi)) else {
            return Response::default();
        };
        let (lobe, pdf) = surface.reflection(wo, wi, m);
        Response { value: VARNISH.at(wo.dot(m)) * (self.strength * lobe), pdf }
    }
}
