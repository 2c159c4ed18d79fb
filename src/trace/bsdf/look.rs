//! The matt part of a surface: what looks the same from everywhere, but for a factor of how far its coats let it be
//! seen.
//!
//! A surface's response is split in two, f(ωo, ωi) cos θi = l(ωo) m(ωi) + rest, where m is of what lies lowest, Lambert's
//! lobe or a diffuser's, and the rest is that of all other lobes and never below zero. Under a microfacet coat l = 1 − E
//! (Kelemen and Szirmay-Kalos 2001, whose product of both ways is what makes the two part). A clear coat leaves the
//! lesser of 1 − cEᵢ and 1 − cEₒ, which does not part; their product, which is no greater, counts as matt and what is
//! left as rest. So light m(ωi) L(ωi) found by one who looks from ωo serves others too, times their own l.

use super::clearcoat::Clearcoat;
use super::specular::Specular;
use super::{Bsdf, Density};
use glam::Vec3;

/// The least of a matt part over all else that a surface scatters, to be worth a ray to every other receiver. Efficiency
/// over that of receivers alone, 1 / (mean square relative error × processor seconds), in Cornell boxes whose walls are
/// metal by 0.3, 0.4, 0.5 and 0.9, of which about 0.6, 0.46, 0.35 and 0.04 is matt: 1.4, 1.1, 0.96 and 0.68; at a
/// roughness of 0.9 instead of 0.5, by 0.5 and 0.7, 1.7 and 1.0.
const LEAST: f32 = 0.5;

/// How the matt part looks from different sides: l. By the coats above it; alike from everywhere if there are none.
#[derive(Clone, Copy, Debug)]
pub(in crate::trace) struct Look<'a>(Option<(Specular<'a>, Clearcoat<'a>)>);

impl<'a> Look<'a> {
    /// Alike from everywhere.
    pub(in crate::trace) const EVEN: Self = Self(None);

    /// Under two coats.
    #[inline]
    pub(super) fn under(specular: Specular<'a>, coat: Clearcoat<'a>) -> Self {
        Self(Some((specular, coat)))
    }

    /// Whether it is the same from everywhere.
    #[inline]
    pub(in crate::trace) fn is_even(&self) -> bool {
        self.0.is_none()
    }

    /// The factor from a direction of this cosine to the normal, per channel.
    #[inline]
    pub(in crate::trace) fn from(&self, cos: f32) -> Vec3 {
        self.0.map_or(Vec3::ONE, |(specular, coat)| {
            (Vec3::ONE - specular.seen(cos).albedo).max(Vec3::ZERO) * (1.0 - coat.albedo(cos))
        })
    }
}

impl<'a> Bsdf<'a> {
    /// How its matt part looks; `None` if it has none that is worth to be told apart.
    #[inline]
    pub(in crate::trace) fn look(&self) -> Option<Look<'a>> {
        match self {
            Self::None | Self::Mirror(_) | Self::Refraction(_) => None,
            Self::Lambert(_) => Some(Look::EVEN),
            Self::Standard(standard) => standard.look(),
            Self::Phong(phong) => is_worth(phong.diffuse, phong.specular).then_some(Look::EVEN),
        }
    }

    /// The matt part m over a response of [`Self::evaluate`], per channel, where that is not zero: times the look it is
    /// a share.
    #[inline]
    pub(in crate::trace) fn matt_over(&self, response: Vec3, wi: Vec3) -> Vec3 {
        let matt = match self {
            Self::None | Self::Mirror(_) | Self::Refraction(_) => return Vec3::ZERO,
            Self::Lambert(_) => return Vec3::ONE,
            Self::Standard(standard) => standard.matt(wi),
            Self::Phong(phong) => phong.matt(wi),
        };
        Vec3::select(response.cmpgt(Vec3::ZERO), matt / response, Vec3::ZERO)
    }

    /// The same over the weight of a sample.
    #[inline]
    pub(in crate::trace) fn matt_over_sample(&self, weight: Vec3, density: Density, wi: Vec3) -> Vec3 {
        match density {
            Density::Smooth(pdf) => self.matt_over(weight * pdf, wi),
            Density::Delta => Vec3::ZERO,
        }
    }
}

/// Whether a surface's matt part is worth to be told apart from the rest, by their albedos.
#[inline]
pub(super) fn is_worth(matt: Vec3, rest: Vec3) -> bool {
    matt != Vec3::ZERO && matt.element_sum() >= LEAST * rest.element_sum()
}
