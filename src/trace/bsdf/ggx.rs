//! The GGX microsurface: how its normals lie, which of them are seen, and what reflects from them.
//!
//! Distribution: Walter et al. 2007. Masking and shadowing: Smith's, height-correlated (Heitz 2014). Visible normals:
//! Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps". The usual quotients of cosines are
//! multiplied out, so that nothing is divided by a cosine that may vanish.

use crate::math::unit_at;
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, TAU};

/// Roughness α below which a surface counts as perfectly smooth. At this roughness half of the normals lie within
/// 0.06° of the mean.
pub(super) const SMOOTH_BELOW: f32 = 1e-3;

/// An isotropic microsurface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ggx {
    alpha: f32,
}

impl Ggx {
    /// From the square root of α; `None` if the surface counts as perfectly smooth.
    #[inline]
    pub(super) fn new(perceptual_roughness: f32) -> Option<Self> {
        let alpha = (perceptual_roughness * perceptual_roughness).min(1.0);
        (alpha >= SMOOTH_BELOW).then_some(Self { alpha })
    }

    /// Density of normals per projected area: ∫ D(m) m.z dm = 1.
    #[inline]
    pub(super) fn density(&self, m: Vec3) -> f32 {
        let a2 = self.alpha * self.alpha;
        let t = m.x * m.x + m.y * m.y + a2 * m.z * m.z;
        FRAC_1_PI * a2 / (t * t)
    }

    /// cos θ · √(1 + α² tan² θ): the projected area of the microsurface is ½ (cos θ + this).
    #[inline]
    pub(super) fn slant(&self, w: Vec3) -> f32 {
        (w.z * w.z + self.alpha * self.alpha * (w.x * w.x + w.y * w.y)).sqrt()
    }

    /// A normal that is seen from `wo`, with density [`visible`](Self::visible).
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, [u, v]: [f32; 2]) -> Vec3 {
        self.cap_point(wo, unit_at(TAU * u), 1.0 - v)
    }

    /// The visible normal at a point of the unit circle and a height in (0, 1] of the spherical cap.
    #[inline]
    pub(super) fn cap_point(&self, wo: Vec3, around: Vec2, height: f32) -> Vec3 {
        let o = Vec3::new(self.alpha * wo.x, self.alpha * wo.y, wo.z).normalize();
        // The cap's point c has c.z = z − o.z; what is wanted is c + o, and this keeps it from cancellation.
        let z = height * (1.0 + o.z);
        let lower = (o.x * o.x + o.y * o.y) / (1.0 + o.z);
        let sin = ((1.0 + o.z) * (1.0 - height) * (lower + z)).max(0.0).sqrt();
        let x = sin * around.x + o.x;
        let y = sin * around.y + o.y;
        Vec3::new(self.alpha * x, self.alpha * y, z).normalize()
    }

    /// Density of normals seen from `wo` [1/sr].
    #[inline]
    pub(super) fn visible(&self, wo: Vec3, m: Vec3) -> f32 {
        2.0 * wo.dot(m).max(0.0) * self.density(m) / (wo.z + self.slant(wo))
    }

    /// For a surface whose facets reflect all, with `m` the half vector: scattering function times cos θi, and density
    /// of the mirror direction at a visible normal, both [1/sr].
    #[inline]
    pub(super) fn reflection(&self, wo: Vec3, wi: Vec3, m: Vec3) -> (f32, f32) {
        let (half_density, o) = (0.5 * self.density(m), self.slant(wo));
        (half_density * wi.z / (wi.z * o + wo.z * self.slant(wi)), half_density / (wo.z + o))
    }

    /// Of the normals seen from `wo`, the share that is seen from `wi` too: G2 / G1. `wi` may lie on either side.
    #[inline]
    pub(super) fn seen_from_both(&self, wo: Vec3, wi: Vec3) -> f32 {
        let (o, i) = (self.slant(wo), self.slant(wi));
        let z = wi.z.abs();
        z * (wo.z + o) / (z * o + wo.z * i)
    }
}

/// Whether this roughness counts as none, so that light goes in single directions.
pub(in crate::trace) fn is_perfectly_smooth(perceptual_roughness: f32) -> bool {
    Ggx::new(perceptual_roughness).is_none()
}

/// The half vector of two directions on the near side; `None` where there is none.
#[inline]
pub(super) fn half_vector(wo: Vec3, wi: Vec3) -> Option<Vec3> {
    if wo.z > 0.0 && wi.z > 0.0 { (wo + wi).try_normalize() } else { None }
}

/// The mirror direction of `wo` at a facet with this normal; `None` below the surface.
#[inline]
pub(super) fn mirrored(wo: Vec3, m: Vec3) -> Option<Vec3> {
    let wi = (2.0 * wo.dot(m) * m - wo).normalize();
    (wi.z > 0.0).then_some(wi)
}

/// The mirror direction of `wo` at the surface itself.
#[inline]
pub(super) fn mirror(wo: Vec3) -> Vec3 {
    Vec3::new(-wo.x, -wo.y, wo.z)
}
