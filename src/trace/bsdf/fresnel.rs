//! How much an interface reflects: Schlick's approximation as Bevy has it, and Fresnel's law for glass.
//!
//! Schlick 1994, with Bevy's F90 (`pbr_lighting.wgsl`, `fresnel`). Dielectrics: Born and Wolf 1999, § 1.5.2.

use glam::Vec3;

/// Schlick's reflectance: F0 · (1 − s) + F90 · s with s = (1 − cos)⁵.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Schlick {
    /// Reflectance along the normal.
    pub(super) f0: Vec3,
    /// Reflectance at grazing incidence.
    pub(super) f90: f32,
}

impl Schlick {
    /// From the reflectance along the normal, as Bevy does it: what reflects less than 2 % there reflects less than
    /// all at grazing incidence.
    #[inline]
    pub(super) fn new(f0: Vec3) -> Self {
        Self { f0, f90: (f0.element_sum() * (50.0 * 0.33)).clamp(0.0, 1.0) }
    }

    /// The reflectance at this angle to the normal of the interface.
    #[inline]
    pub(super) fn at(&self, cos: f32) -> Vec3 {
        self.f0.lerp(Vec3::splat(self.f90), schlick_weight(cos))
    }

    /// The mean over cosine-weighted directions: ∫ 2μ (1 − μ)⁵ dμ = 1/21.
    #[inline]
    pub(super) fn average(&self) -> Vec3 {
        self.f0.lerp(Vec3::splat(self.f90), SCHLICK_AVERAGE)
    }
}

/// The cosine-weighted mean of [`schlick_weight`].
pub(super) const SCHLICK_AVERAGE: f32 = 1.0 / 21.0;

/// The share of F90 in Schlick's approximation.
#[inline]
pub(super) fn schlick_weight(cos: f32) -> f32 {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    (m * m) * (m * m) * m
}

/// An interface of glass met at one angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Refracted {
    /// The share of unpolarised light that is reflected.
    pub(super) reflectance: f32,
    /// Cosine of the refracted direction to the normal on its own side; 0 where all is reflected.
    pub(super) cos: f32,
}

/// Fresnel's and Snell's law at `cos` ≥ 0, where `eta` is the index on the far side over that on the near one.
#[inline]
pub(super) fn refract_at(cos: f32, eta: f32) -> Refracted {
    refract_from(cos, (1.0 - cos * cos).max(0.0), eta)
}

/// The same where the square of the sine is known better than from the cosine: out of what is a hundred times as
/// dense, all light comes from within 0.6° of the normal, where that difference has lost most of its digits.
#[inline]
pub(super) fn refract_from(cos: f32, sin2: f32, eta: f32) -> Refracted {
    let sin2 = sin2 / (eta * eta);
    if sin2 >= 1.0 {
        return Refracted { reflectance: 1.0, cos: 0.0 };
    }
    let cos_far = (1.0 - sin2).sqrt();
    let perpendicular = (cos - eta * cos_far) / (cos + eta * cos_far);
    let parallel = (eta * cos - cos_far) / (eta * cos + cos_far);
    let reflectance = 0.5 * (perpendicular * perpendicular + parallel * parallel);
    Refracted { reflectance: reflectance.min(1.0), cos: cos_far }
}

/// The direction on the far side of an interface with this normal, on the side of `wo`.
#[inline]
pub(super) fn refract(wo: Vec3, normal: Vec3, eta: f32, refracted: Refracted) -> Vec3 {
    ((wo.dot(normal) / eta - refracted.cos) * normal - wo / eta).normalize()
}
