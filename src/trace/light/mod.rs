//! Sources that can be aimed at: what light sampling chooses from, how densely it finds a direction, and which of them
//! a ray meets that meets nothing else.
//!
//! A source is sampled by the solid angle that it fills, as seen from the receiver (rectangles: Ureña, Fajardo and
//! King 2013; triangles: Arvo 1995; spheres: Wang 1992; discs in the sky: a cone), so that the estimate stays bounded
//! however near the receiver is; where the solid angle is too small or too large for the formula, by area. Points and
//! single directions have no density: they are delta sources, which no ray meets by itself. A picture of the sky is
//! sampled pixel by pixel. Which source is aimed at is chosen by what each can give to the receiver: a tree over those
//! that are somewhere (Conty Estevez and Kulla 2018), estimates of irradiance for those infinitely far away.
//!
//! A sky of one radiance in all directions is no source here: directions from the surface sample it best.

mod bounds;
mod compile;
mod distant;
mod emitter;
mod environment;
mod lights;
mod passed;
mod seen;
mod sphere;
mod tree;

pub(super) use compile::Sources;
pub(super) use emitter::{Emitter, EmitterShape};
pub(super) use lights::Lights;

use crate::math::luminance;
use glam::Vec3;

/// Who receives light.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightContext {
    /// Where [m].
    pub(super) position: Vec3,
    /// Unit normal of the side that light counts on; `None` if light from both sides does.
    pub(super) normal: Option<Vec3>,
}

/// Where a shadow ray ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// At this point [m], moved off its source towards the receiver.
    At(Vec3),
    /// The source touches the receiver: nothing can lie between.
    Here,
    /// Nowhere: it must leave the scene.
    Infinity,
}

/// Which source a sample lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SourceIndex {
    /// One that is somewhere, by its number in [`Lights`].
    Emitter(u32),
    /// One that is infinitely far away.
    Distant,
}

/// A direction to a source, seen from a receiver.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightSample {
    /// Unit direction from the receiver.
    pub(super) wi: Vec3,
    /// Where a shadow ray ends.
    pub(super) end: End,
    /// How far away the source is met [m].
    #[cfg_attr(not(test), allow(dead_code, reason = "for who follows light through what it passes"))]
    pub(super) distance: f32,
    /// What the sample counts for if nothing blocks it [cd/m² sr = lx on a surface that faces it]: the radiance that
    /// arrives over `pdf`; of a delta source, the irradiance on a surface that faces it over the chance of choosing
    /// the source.
    pub(super) value: Vec3,
    /// Density of `wi`, the choice of the source included [1/sr]; `None` for a delta source.
    pub(super) pdf: Option<f32>,
    /// Which source it is.
    #[cfg_attr(not(test), allow(dead_code, reason = "for who looks up the texture of an emission"))]
    pub(super) source: SourceIndex,
}

/// A source that a ray meets because nothing else does: one that blocks nothing, or one infinitely far away.
#[derive(Clone, Copy, Debug)]
pub(super) struct MetSource {
    /// Radiance that arrives from it [cd/m²], not black.
    pub(super) radiance: Vec3,
    /// Density with which [`Lights::sample`] finds this direction on it [1/sr].
    pub(super) pdf: f32,
}

/// What a colour of light weighs where sources compete: any unit, in that unit. The mean of the channels keeps a pure
/// blue lamp, whose luminance is small, from being starved.
fn brightness(colour: Vec3) -> f64 {
    luminance(colour) + colour.as_dvec3().element_sum() / 3.0
}

/// A density as a number that later products and quotients can bear.
fn density(pdf: f64) -> f32 {
    pdf.clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)) as f32
}

#[cfg(test)]
mod tests;
