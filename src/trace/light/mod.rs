//! Sources that can be aimed at: what light sampling chooses from, and how densely it finds a direction.
//!
//! A source is sampled by the solid angle that it fills, as seen from the receiver (rectangles: Ureña, Fajardo and
//! King 2013; triangles: Arvo 1995), so that the estimate stays bounded however near the receiver is. Where the
//! solid angle is too small or too large for the formula, by area.

mod choice;
mod shape;

pub(super) use choice::Emitters;
pub(super) use shape::{Emitter, EmitterShape};

use glam::Vec3;

/// A point on a source, seen from a receiver.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightSample {
    /// The point, moved off its source towards the receiver so that a shadow ray ends before it.
    pub(super) target: Vec3,
    /// Unit direction from the receiver.
    pub(super) wi: Vec3,
    /// Radiance that arrives if nothing blocks it [cd/m²].
    pub(super) radiance: Vec3,
    /// Density of `wi` [1/sr].
    pub(super) pdf: f32,
}

#[cfg(test)]
mod tests;
