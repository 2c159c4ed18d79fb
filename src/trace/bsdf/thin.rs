//! A pane without thickness: light crosses it unbent, roughness spreads what crosses as it spreads what is reflected.
//!
//! Facets reflect by Schlick's term, as Bevy displays them, and let the rest through to the mirrored direction on the
//! other side, tinted (the thin-walled surface of glTF's KHR_materials_transmission). Light that bounces between
//! facets comes out on either side by the average reflectance, so that a clear pane loses nothing. A perfectly smooth
//! pane scatters only what it reflects: what goes straight on is a matter of [`straight`](Pane::straight).

use super::albedo::{AlbedoTables, RoughnessAlbedo};
use super::fresnel::Schlick;
use super::ggx::{Ggx, half_vector, mirror, mirrored};
use super::refraction::reflection_chance;
use super::{Proposal, Response, cosine_pdf, spread};
use crate::math::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// Turns the far side into the near one.
const FLIP: Vec3 = Vec3::new(1.0, 1.0, -1.0);

/// A pane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pane<'a> {
    surface: Option<Ggx>,
    fresnel: Schlick,
    /// Multiplies what crosses.
    tint: Vec3,
    albedo: RoughnessAlbedo<'a>,
}

impl<'a> Pane<'a> {
    pub(super) fn new(fresnel: Schlick, tint: Vec3, perceptual_roughness: f32, tables: &'a AlbedoTables) -> Self {
        Self { surface: Ggx::new(perceptual_roughness), fresnel, tint, albedo: tables.at(perceptual_roughness) }
    }

    /// Whether the lobes are spread out.
    #[inline]
    pub(super) fn is_smooth_lobe(&self) -> bool {
        self.surface.is_some()
    }

    /// Scattered over arriving light: without what goes straight on.
    #[inline]
    pub(super) fn albedo(&self, cos: f32) -> Vec3 {
        if self.surface.is_none() {
            return self.fresnel.at(cos);
        }
        let (once, average) = (self.albedo.at(cos), self.fresnel.average());
        let more = (1.0 - once.white()).max(0.0);
        let reflected = once.of(&self.fresnel);
        reflected
            + self.tint * (Vec3::splat(once.white()) - reflected)
            + (average + self.tint * (Vec3::ONE - average)) * more
    }

    /// The share that crosses unscattered.
    #[inline]
    pub(super) fn straight(&self, cos: f32) -> Vec3 {
        if self.surface.is_some() { Vec3::ZERO } else { self.tint * (Vec3::ONE - self.fresnel.at(cos)) }
    }

    #[inline]
    pub(super) fn propose(&self, wo: Vec3, [u, v, u_choice]: [f32; 3]) -> Option<Proposal> {
        let Some(surface) = &self.surface else {
            return Some(Proposal::single(mirror(wo), self.fresnel.at(wo.z)));
        };
        let more = self.albedo.missing(wo.z);
        let (wi, chance, u_side) = if u_choice < more {
            let wi = square_to_cosine_hemisphere(Vec2::new(u, v));
            (wi, self.near_chance(self.fresnel.average()), u_choice / more)
        } else {
            let m = surface.sample(wo, [u, v]);
            let chance = self.near_chance(self.fresnel.at(wo.dot(m)));
            (mirrored(wo, m)?, chance, (u_choice - more) / (1.0 - more))
        };
        Some(Proposal::Spread(if u_side < chance { wi } else { wi * FLIP }))
    }

    #[inline]
    pub(super) fn respond(&self, wo: Vec3, wi: Vec3) -> Response {
        let crosses = wi.z < 0.0;
        let near = if crosses { wi * FLIP } else { wi };
        let (Some(surface), Some(m)) = (&self.surface, half_vector(wo, near)) else {
            return Response::default();
        };
        let missing = [wo.z, near.z].map(|cos| self.albedo.missing(cos));
        let (lobe, pdf) = surface.reflection(wo, near, m);
        let more = self.albedo.compensation(missing) * near.z;
        let (reflectance, average) = (self.fresnel.at(wo.dot(m)), self.fresnel.average());
        let chances = [reflectance, average].map(|reflectance| self.near_chance(reflectance));
        let (value, [once, again]) = if crosses {
            let value = (Vec3::ONE - reflectance) * lobe + (Vec3::ONE - average) * more;
            (self.tint * value, chances.map(|chance| 1.0 - chance))
        } else {
            (reflectance * lobe + average * more, chances)
        };
        Response { value, pdf: spread(once * pdf, again * cosine_pdf(near), missing[0]) }
    }

    /// The chance to stay on the near side.
    #[inline]
    fn near_chance(&self, reflectance: Vec3) -> f32 {
        reflection_chance(reflectance.element_sum() * (1.0 / 3.0), self.tint)
    }
}
