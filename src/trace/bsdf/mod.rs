//! How surfaces scatter light.
//!
//! `wo` points back to where the path came from and `wi` to where it goes; both leave the surface. Directions are in
//! the local frame, whose z is the normal on the side of `wo`. `evaluate` is the scattering function times cos θi;
//! a pdf is per solid angle of `wi`. Every surface scatters the same way from both of its sides.

mod lambert;

pub(super) use lambert::Lambert;

use glam::{Vec2, Vec3};

/// A way to scatter light.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bsdf {
    /// The same radiance in every direction.
    Lambert(Lambert),
}

/// A direction to go on in.
#[derive(Clone, Copy, Debug)]
pub(super) struct BsdfSample {
    /// Where to.
    pub(super) wi: Vec3,
    /// `evaluate` over the pdf.
    pub(super) weight: Vec3,
    /// Density of `wi` [1/sr].
    pub(super) pdf: f32,
}

impl Bsdf {
    /// A direction with density `pdf`.
    #[inline]
    pub(super) fn sample(&self, u: Vec2) -> BsdfSample {
        match self {
            Self::Lambert(lambert) => lambert.sample(u),
        }
    }

    /// Scattering function times cos θi [1/sr].
    #[inline]
    pub(super) fn evaluate(&self, wi: Vec3) -> Vec3 {
        match self {
            Self::Lambert(lambert) => lambert.evaluate(wi),
        }
    }

    /// Density with which `sample` finds `wi` [1/sr].
    #[inline]
    pub(super) fn pdf(&self, wi: Vec3) -> f32 {
        match self {
            Self::Lambert(lambert) => lambert.pdf(wi),
        }
    }
}

#[cfg(test)]
mod tests;
