//! A rough interface of glass: reflection and refraction by facets.
//!
//! Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", with visible normals and the
//! height-correlated masking of both sides. Radiance follows the index squared, as in [`Refraction`]. Light that is
//! refracted or reflected by one facet and would meet another is lost; `docs/albedo.md` says how much.

use super::fresnel::{refract, refract_at};
use super::ggx::{Ggx, half_vector, mirrored};
use super::refraction::reflection_chance;
use super::{Proposal, Refraction, Response};
use glam::Vec3;

/// Relative difference of the indices below which there is no interface: it would reflect 10⁻⁷, and spread what
/// crosses by a thousandth of its own roughness.
const MATCHED_BELOW: f32 = 1e-3;

/// A rough interface. Perfectly smooth ones, and ones between equal indices, have directions but no lobe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dielectric {
    surface: Option<Ggx>,
    smooth: Refraction,
}

impl Dielectric {
    /// From the index on the far side over that on the near one, and the colour of what crosses.
    pub(super) fn new(eta: f32, tint: Vec3, perceptual_roughness: f32) -> Self {
        let matched = (eta - 1.0).abs() < MATCHED_BELOW;
        let surface = if matched { None } else { Ggx::new(perceptual_roughness) };
        Self { surface, smooth: Refraction { eta: if matched { 1.0 } else { eta }, tint } }
    }

    /// Whether the lobes are spread out.
    #[inline]
    pub(super) fn is_smooth_lobe(&self) -> bool {
        self.surface.is_some()
    }

    /// Arriving light that leaves again, as energy, if the facets were level: an estimate.
    #[inline]
    pub(super) fn albedo(&self, wo: Vec3) -> Vec3 {
        self.smooth.albedo(wo)
    }

    #[inline]
    pub(super) fn propose(&self, wo: Vec3, [u, v, u_choice]: [f32; 3]) -> Option<Proposal> {
        let Some(surface) = &self.surface else {
            return self.smooth.sample(wo, u_choice).map(Proposal::Single);
        };
        let m = surface.sample(wo, [u, v]);
        let refracted = refract_at(wo.dot(m), self.smooth.eta);
        let wi = if u_choice < reflection_chance(refracted.reflectance, self.smooth.tint) {
            mirrored(wo, m)
        } else {
            Some(refract(wo, m, self.smooth.eta, refracted)).filter(|wi| wi.z < 0.0)
        };
        wi.map(Proposal::Spread)
    }

    #[inline]
    pub(super) fn respond(&self, wo: Vec3, wi: Vec3) -> Response {
        let Some(surface) = &self.surface else {
            return Response::default();
        };
        let Refraction { eta, tint } = self.smooth;
        if let Some(m) = half_vector(wo, wi) {
            let reflectance = refract_at(wo.dot(m), eta).reflectance;
            let (lobe, pdf) = surface.reflection(wo, wi, m);
            let pdf = reflection_chance(reflectance, tint) * pdf;
            return Response { value: Vec3::splat(reflectance * lobe), pdf };
        }
        let Some(facet) = Facet::new(wo, wi, eta) else {
            return Response::default();
        };
        let reflectance = refract_at(wo.dot(facet.normal), eta).reflectance;
        let lobe = surface.visible(wo, facet.normal) * facet.jacobian;
        let crosses = (1.0 - reflectance) * surface.seen_from_both(wo, wi) / (eta * eta);
        Response { value: tint * (crosses * lobe), pdf: (1.0 - reflection_chance(reflectance, tint)) * lobe }
    }
}

/// The facet that refracts one direction into another.
struct Facet {
    normal: Vec3,
    /// Solid angle of normals over that of `wi`.
    jacobian: f32,
}

impl Facet {
    /// `None` if no facet does.
    #[inline]
    fn new(wo: Vec3, wi: Vec3, eta: f32) -> Option<Self> {
        if !(wo.z > 0.0 && wi.z < 0.0) {
            return None;
        }
        // Along the normal, as Snell's law has the tangential parts cancel; it points to the denser side.
        let sum = wo + eta * wi;
        let square = sum.length_squared();
        let normal = sum.try_normalize()? * if eta > 1.0 { -1.0 } else { 1.0 };
        let cos_i = wi.dot(normal);
        let jacobian = eta * eta * -cos_i / square;
        (normal.z > 0.0 && wo.dot(normal) > 0.0 && cos_i < 0.0).then_some(Self { normal, jacobian })
    }
}
