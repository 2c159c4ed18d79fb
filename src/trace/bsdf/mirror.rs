//! A perfect mirror: the law of reflection, and a reflectance that no angle changes.

use super::ggx::mirror;
use super::{BsdfSample, Density};
use glam::Vec3;

/// A perfect mirror.
#[derive(Clone, Copy, Debug)]
pub(in crate::trace) struct Mirror {
    /// Reflected over arriving light, per channel.
    pub(in crate::trace) reflectance: Vec3,
}

impl Mirror {
    /// The one direction there is; `None` if the mirror is black.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3) -> Option<BsdfSample> {
        let sample = BsdfSample { wi: mirror(wo), weight: self.reflectance, density: Density::Delta };
        (self.reflectance != Vec3::ZERO && wo.z > 0.0).then_some(sample)
    }
}
