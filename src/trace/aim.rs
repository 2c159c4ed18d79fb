//! The one thing about a scene's lights that may be asked from outside, as rays may: where to look for light.

use super::light::LightContext;
use super::tracer::Tracer;
use glam::{Vec2, Vec3};

/// A direction to a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    /// Unit direction from the receiver.
    pub direction: Vec3,
    /// Density with which it is found, the choice of the light included [1/sr]; `None` where it is the only direction
    /// to that light: a point's, or that of a sun without a diameter.
    pub pdf: Option<f32>,
}

impl Tracer {
    /// A direction from `position` [m] to one of the lights and glowing surfaces that may shine on a surface of this
    /// unit normal. `choice` in [0, 1) says which, `u` in [0, 1)² where on it. `None` if that one does not shine here.
    /// What lies between is not asked.
    pub fn aim(&self, position: Vec3, normal: Vec3, choice: f32, u: Vec2) -> Option<Aim> {
        let position = self.traced_from_world.point(position);
        let ctx = LightContext { position, normal: Some(normal) };
        let sample = self.lights.sample(&ctx, u, choice)?;
        Some(Aim { direction: sample.wi, pdf: sample.pdf })
    }
}
