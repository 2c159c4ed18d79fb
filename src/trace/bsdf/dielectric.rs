//! A rough interface of glass: reflection and refraction by facets.
//!
//! Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", with visible normals and the
//! height-correlated masking of both sides. Radiance follows the index squared, as in [`Refraction`]. Light that is
//! refracted or reflected by one facet and would meet another is spread over both sides by [`Again`].

use super::again::Again;
use super::albedo::AlbedoTables;
use super::fresnel::{refract, refract_at};
use super::ggx::{Ggx, half_vector, mirrored};
use super::refraction::reflection_chance;
use super::{Proposal, Refraction, Response, spread};
use crate::math::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3};

/// Relative difference of the indices below which there is no interface: it would reflect 10⁻⁷, and spread what
/// crosses by a thousandth of its own roughness.
const MATCHED_BELOW: f32 = 1e-3;

/// A rough interface. Perfectly smooth ones, and ones between equal indices, have directions but no lobe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dielectric<'a> {
    rough: Option<Rough<'a>>,
    smooth: Refraction,
}

/// What makes an interface rough.
#[derive(Clone, Copy, Debug)]
struct Rough<'a> {
    surface: Ggx,
    again: Again<'a>,
}

impl<'a> Dielectric<'a> {
    /// From the index on the far side over that on the near one, and the colour of what crosses.
    pub(super) fn new(eta: f32, tint: Vec3, perceptual_roughness: f32, tables: &'a AlbedoTables) -> Self {
        let matched = (eta - 1.0).abs() < MATCHED_BELOW;
        let surface = if matched { None } else { Ggx::new(perceptual_roughness) };
        let rough =
            surface.map(|surface| Rough { surface, again: Again::new(eta, tint, perceptual_roughness, tables) });
        Self { rough, smooth: Refraction { eta: if matched { 1.0 } else { eta }, tint } }
    }

    /// Whether the lobes are spread out.
    #[inline]
    pub(super) fn is_smooth_lobe(&self) -> bool {
        self.rough.is_some()
    }

    /// By how much radiance is more concentrated behind the interface than before it.
    #[inline]
    pub(super) fn concentration(&self) -> f32 {
        self.smooth.eta * self.smooth.eta
    }

    /// Arriving light that leaves again, as energy: an estimate, but right where nothing is tinted.
    #[inline]
    pub(super) fn albedo(&self, wo: Vec3) -> Vec3 {
        self.rough.as_ref().map_or_else(
            || self.smooth.albedo(wo),
            |rough| self.albedo_of_once(rough, wo).lerp(rough.again.albedo(), rough.again.missing(wo.z)),
        )
    }

    #[inline]
    pub(super) fn propose(&self, wo: Vec3, [u, v, u_choice]: [f32; 3]) -> Option<Proposal> {
        let Some(rough) = &self.rough else {
            return self.smooth.sample(wo, u_choice).map(Proposal::Single);
        };
        let again = self.chance_of_again(rough, wo, rough.again.missing(wo.z));
        if u_choice < again {
            let wi = square_to_cosine_hemisphere(Vec2::new(u, v));
            let stays = u_choice < again * rough.again.near_chance();
            return Some(Proposal::Spread(if stays { wi } else { wi * Vec3::new(1.0, 1.0, -1.0) }));
        }
        let m = rough.surface.sample(wo, [u, v]);
        let refracted = refract_at(wo.dot(m), self.smooth.eta);
        let wi = if u_choice - again < (1.0 - again) * reflection_chance(refracted.reflectance, self.smooth.tint) {
            mirrored(wo, m)
        } else {
            Some(refract(wo, m, self.smooth.eta, refracted)).filter(|wi| wi.z < 0.0)
        };
        wi.map(Proposal::Spread)
    }

    #[inline]
    pub(super) fn respond(&self, wo: Vec3, wi: Vec3) -> Response {
        let Some(rough) = self.rough.as_ref().filter(|_| wo.z > 0.0) else {
            return Response::default();
        };
        let missing = rough.again.missing(wo.z);
        let once = self.respond_once(&rough.surface, wo, wi);
        let chance = self.chance_of_again(rough, wo, missing);
        Response {
            value: once.value + rough.again.evaluate(missing, wi),
            pdf: spread(once.pdf, rough.again.pdf(wi), chance),
        }
    }

    /// Scattering function times |cos θi| [1/sr] of what met one facet.
    #[cfg(test)]
    pub(super) fn once(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        self.rough.as_ref().map_or(Vec3::ZERO, |rough| self.respond_once(&rough.surface, wo, wi).value)
    }

    /// What one facet does.
    #[inline]
    fn respond_once(&self, surface: &Ggx, wo: Vec3, wi: Vec3) -> Response {
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

    /// About what one facet does not absorb, if no other is in the way: facets that lean by about α are met less
    /// steeply than the surface.
    #[inline]
    fn albedo_of_once(&self, rough: &Rough, wo: Vec3) -> Vec3 {
        let cos = rough.surface.slant(wo).min(1.0);
        self.smooth.albedo(Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos))
    }

    /// The chance to sample what met more than one facet: its share of the whole.
    #[inline]
    fn chance_of_again(&self, rough: &Rough, wo: Vec3, missing: f32) -> f32 {
        let once = (1.0 - missing) * self.albedo_of_once(rough, wo).element_sum();
        let again = missing * rough.again.albedo().element_sum();
        if again > 0.0 { again / (once + again) } else { 0.0 }
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
