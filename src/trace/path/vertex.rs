//! The two ends of a step: where a path scatters, and the ray on which it goes on.

use crate::math::Frame;
use crate::trace::bsdf::{Bsdf, Density, Lambert};
use crate::trace::kernel::LAYERED;
use crate::trace::light::LightContext;
use crate::trace::surface::TriangleShape;
use glam::Vec3;

/// Where a path scatters.
pub(super) struct Vertex<'t> {
    pub(super) position: Vec3,
    /// Where rays start that leave on the side of `geometric_normal` [m].
    pub(super) origin: Vec3,
    pub(super) geometric_normal: Vec3,
    pub(super) frame: Frame,
    /// Back to where the path came from, in the frame.
    pub(super) wo: Vec3,
    /// What is there if the kernel knows Lambert's surface only.
    pub(super) lambert: Lambert,
    /// What is there if it knows others.
    pub(super) bsdf: Bsdf<'t>,
    /// What rays leave on the other side; for kernels that know such.
    pub(super) triangle: Option<&'t TriangleShape>,
    /// What they find there: the absorption of a body [1/m], or of the outside.
    pub(super) beyond: Option<Vec3>,
}

/// Where a path goes on.
pub(super) struct Ray {
    pub(super) origin: Vec3,
    pub(super) direction: Vec3,
    /// The vertex that it left.
    pub(super) context: LightContext,
    /// How densely its direction was found.
    pub(super) density: Density,
    /// Number that decides whether the path survives the next vertex; `None` for a camera's ray, which always does.
    pub(super) survival: Option<f32>,
}

impl Vertex<'_> {
    /// What light sampling must know of it.
    #[inline]
    pub(super) fn context<const K: u32>(&self) -> LightContext {
        let is_one_sided = K & LAYERED == 0 || !self.bsdf.transmits();
        LightContext { position: self.position, normal: is_one_sided.then_some(self.frame.normal) }
    }

    /// Where a ray in a direction starts; `None` where a shading normal sends it to the wrong side of the surface.
    #[inline]
    pub(super) fn origin_towards<const K: u32>(&self, local: Vec3, direction: Vec3) -> Option<Vec3> {
        let is_before = self.geometric_normal.dot(direction) > 0.0;
        if K & LAYERED != 0 && local.z < 0.0 {
            let triangle = self.triangle.filter(|_| self.geometric_normal.dot(direction) < 0.0)?;
            return Some(triangle.leave(self.position, direction));
        }
        is_before.then_some(self.origin)
    }
}

impl Ray {
    pub(super) fn of_camera(origin: Vec3, direction: Vec3) -> Self {
        let context = LightContext { position: origin, normal: None };
        Self { origin, direction, context, density: Density::Delta, survival: None }
    }
}
