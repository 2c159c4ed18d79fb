//! How surfaces scatter light.
//!
//! `wo` points back to where the path came from and `wi` to where it goes; both leave the surface. Directions are in
//! the local frame, whose z is the normal on the side of `wo`: wo.z > 0, and wi.z < 0 is transmission. `evaluate` is
//! the scattering function times |cos θi|; a pdf is per solid angle of `wi`. Both leave out what goes in a single
//! direction. Every surface scatters the same way from both of its sides, but for the index of refraction, whose
//! quotient the caller turns. Knows no textures and no world space. What scatters how much: `docs/albedo.md`.

mod again;
mod albedo;
mod clearcoat;
mod dielectric;
mod diffuse_transmission;
mod fresnel;
mod ggx;
mod glass_albedo;
mod lambert;
mod look;
mod mirror;
mod phong;
mod refraction;
mod specular;
mod standard;
mod thin;

pub(super) use albedo::AlbedoTables;
pub(super) use ggx::is_perfectly_smooth;
pub(super) use lambert::Lambert;
pub(super) use look::Look;
pub(super) use mirror::Mirror;
pub(super) use phong::Phong;
pub(super) use refraction::Refraction;
pub(super) use standard::{Standard, StandardParameters};

use glam::{Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// A way to scatter light.
#[allow(clippy::large_enum_variant, reason = "one is made per hit, on the stack; a box would cost more than the bytes")]
#[derive(Clone, Copy, Debug)]
pub(super) enum Bsdf<'a> {
    /// Everything is absorbed.
    None,
    /// The same radiance in every direction.
    Lambert(Lambert),
    /// Bevy's material.
    Standard(Standard<'a>),
    /// A perfect mirror.
    Mirror(Mirror),
    /// Perfectly smooth glass.
    Refraction(Refraction),
    /// The modified Phong model.
    Phong(Phong),
}

/// How densely the directions around a sample are sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Density {
    /// By this much [1/sr].
    Smooth(f32),
    /// It is the only direction of its lobe: no light sample finds it.
    Delta,
}

/// A direction to go on in.
#[derive(Clone, Copy, Debug)]
pub(super) struct BsdfSample {
    /// Where to.
    pub(super) wi: Vec3,
    /// `evaluate` over the pdf; for a single direction, the share of light it takes over the chance to choose it.
    pub(super) weight: Vec3,
    /// Density of `wi`.
    pub(super) density: Density,
}

/// What a lobe proposes.
#[derive(Clone, Copy, Debug)]
enum Proposal {
    /// A direction among many: `respond` says what it is worth.
    Spread(Vec3),
    /// The only direction there is, or one of two; the weight over the chance to choose it.
    Single(BsdfSample),
}

impl Proposal {
    /// The only direction of a lobe that takes this share of light there.
    #[inline]
    fn single(wi: Vec3, weight: Vec3) -> Self {
        Self::Single(BsdfSample { wi, weight, density: Density::Delta })
    }
}

/// Scattering function times |cos θi| and the density of `wi`, both [1/sr].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Response {
    /// Scattering function times |cos θi| [1/sr].
    pub(super) value: Vec3,
    /// Density with which `sample` finds `wi` [1/sr].
    pub(super) pdf: f32,
}

impl Response {
    /// A sample in this direction; `None` if it carries nothing.
    #[inline]
    fn sample(self, wi: Vec3) -> Option<BsdfSample> {
        let density = Density::Smooth(self.pdf);
        (self.pdf > 0.0).then(|| BsdfSample { wi, weight: self.value / self.pdf, density })
    }
}

impl Bsdf<'_> {
    /// A direction to go on in: two variates for it, one for the choice of lobe. `None` where the path ends, which
    /// then carries nothing.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<BsdfSample> {
        match self {
            Self::None => None,
            Self::Lambert(lambert) => Some(lambert.sample(Vec2::new(u[0], u[1]))),
            Self::Standard(standard) => standard.sample(wo, u),
            Self::Mirror(mirror) => mirror.sample(wo),
            Self::Refraction(refraction) => refraction.sample(wo, u[2]),
            Self::Phong(phong) => phong.sample(wo, u),
        }
    }

    /// Scattering function times |cos θi| [1/sr], without single directions.
    #[inline]
    pub(super) fn evaluate(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        match self {
            Self::None | Self::Mirror(_) | Self::Refraction(_) => Vec3::ZERO,
            Self::Lambert(lambert) => lambert.evaluate(wi),
            Self::Standard(standard) => standard.respond(wo, wi).value,
            Self::Phong(phong) => phong.evaluate(wo, wi),
        }
    }

    /// Density with which `sample` finds `wi` [1/sr], the chance of its lobe included, without single directions.
    #[inline]
    pub(super) fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        match self {
            Self::None | Self::Mirror(_) | Self::Refraction(_) => 0.0,
            Self::Lambert(lambert) => lambert.pdf(wi),
            Self::Standard(standard) => standard.respond(wo, wi).pdf,
            Self::Phong(phong) => phong.pdf(wo, wi),
        }
    }

    /// `evaluate` and `pdf` at once, for little more than either alone.
    #[inline]
    pub(super) fn respond(&self, wo: Vec3, wi: Vec3) -> Response {
        match self {
            Self::Standard(standard) => standard.respond(wo, wi),
            _ => Response { value: self.evaluate(wo, wi), pdf: self.pdf(wo, wi) },
        }
    }

    /// Whether `evaluate` is above zero anywhere, so that light samples can pay.
    #[inline]
    pub(super) fn has_smooth(&self) -> bool {
        match self {
            Self::None | Self::Mirror(_) | Self::Refraction(_) => false,
            Self::Lambert(lambert) => lambert.albedo != Vec3::ZERO,
            Self::Standard(standard) => standard.has_smooth(),
            Self::Phong(phong) => phong.albedo() != Vec3::ZERO,
        }
    }

    /// Whether `evaluate` is above zero anywhere on the far side.
    #[inline]
    pub(super) fn transmits(&self) -> bool {
        match self {
            Self::None | Self::Lambert(_) | Self::Mirror(_) | Self::Refraction(_) | Self::Phong(_) => false,
            Self::Standard(standard) => standard.transmits(),
        }
    }

    /// The share of light that crosses the surface unscattered, at this cosine to the normal. It is no part of
    /// `sample`, `evaluate` and `albedo`: the surface has a hole by this much.
    #[inline]
    pub(super) fn straight(&self, cos: f32) -> Vec3 {
        match self {
            Self::None | Self::Lambert(_) | Self::Mirror(_) | Self::Refraction(_) | Self::Phong(_) => Vec3::ZERO,
            Self::Standard(standard) => standard.straight(cos),
        }
    }

    /// By how much radiance is more concentrated behind the surface than before it: the index squared.
    #[inline]
    pub(super) fn concentration(&self) -> f32 {
        match self {
            Self::None | Self::Lambert(_) | Self::Mirror(_) | Self::Phong(_) => 1.0,
            Self::Refraction(refraction) => refraction.eta * refraction.eta,
            Self::Standard(standard) => standard.concentration(),
        }
    }

    /// About what is scattered over what arrives, as energy, where the light goes to or comes from `wo`.
    #[inline]
    pub(super) fn albedo(&self, wo: Vec3) -> Vec3 {
        match self {
            Self::None => Vec3::ZERO,
            Self::Lambert(lambert) => lambert.albedo,
            Self::Standard(standard) => standard.albedo(wo),
            Self::Mirror(mirror) => mirror.reflectance,
            Self::Refraction(refraction) => refraction.albedo(wo),
            Self::Phong(phong) => phong.albedo(),
        }
    }
}

/// Density of the cosine-weighted hemisphere on the near side [1/sr].
#[inline]
fn cosine_pdf(wi: Vec3) -> f32 {
    wi.z.max(0.0) * FRAC_1_PI
}

/// The density of a mix: of the first with the chance left, of the second with `chance`.
#[inline]
fn spread(first: f32, second: f32, chance: f32) -> f32 {
    (1.0 - chance) * first + chance * second
}

#[cfg(test)]
mod tests;
