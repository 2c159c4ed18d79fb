//! Light from infinitely far away in one direction: a disc in the sky, or a single direction.

use super::{LightContext, brightness};
use crate::math::{Frame, Portable, square_to_uniform_cone};
use crate::scene::DirectionalLight;
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

/// Half angle below which a disc is a single direction [rad]: a tenth of what makes a difference to an `f32` direction
/// would, and the light differs by its square.
const SMALLEST_HALF_ANGLE: f64 = 1e-5;

/// A disc of one radiance in the sky. Its illuminance on a surface that faces it is L·π·sin² of the half angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct DistantDisc {
    /// Unit direction of its centre, seen from the scene.
    axis: DVec3,
    illuminance: Vec3,
    /// sin and cos of the half angle; 0 and 1 for a single direction.
    half_sin: f64,
    half_cos: f64,
    is_delta: bool,
}

/// A direction to a disc.
pub(super) struct DiscSample {
    pub(super) wi: Vec3,
    /// Radiance over density, or the irradiance of a single direction [lx].
    pub(super) value: DVec3,
    /// The disc's solid angle [sr]; `None` for a single direction.
    pub(super) solid_angle: Option<f64>,
}

impl DistantDisc {
    pub(super) fn new(light: &DirectionalLight) -> Self {
        let half = 0.5 * f64::from(light.angular_diameter);
        let is_delta = half < SMALLEST_HALF_ANGLE;
        let (half_sin, half_cos) = if is_delta { (0.0, 1.0) } else { Portable::sin_cos(half) };
        let axis = -light.direction.as_dvec3().normalize_or(DVec3::NEG_Y);
        Self { axis, illuminance: light.illuminance, half_sin, half_cos: half_cos.max(0.0), is_delta }
    }

    /// Whether it is a single direction, which no ray meets.
    pub(super) fn is_delta(&self) -> bool {
        self.is_delta
    }

    /// 1 − cos of the half angle.
    fn height(&self) -> f64 {
        self.half_sin * self.half_sin / (1.0 + self.half_cos)
    }

    /// The irradiance that it gives to a receiver [lx, as brightness], unless something is between: an upper bound,
    /// and 0 only if none of the disc is above the horizon.
    pub(super) fn importance(&self, ctx: &LightContext) -> f64 {
        let Some(normal) = ctx.normal else {
            return brightness(self.illuminance);
        };
        let cosine = normal.as_dvec3().dot(self.axis).clamp(-1.0, 1.0);
        // cos of what the angle to the axis exceeds the half angle by.
        let nearest = if cosine > self.half_cos {
            1.0
        } else {
            cosine * self.half_cos + (1.0 - cosine * cosine).sqrt() * self.half_sin
        };
        if nearest < -1e-6 { 0.0 } else { brightness(self.illuminance) * nearest.max(1e-6) }
    }

    /// A direction to it.
    pub(super) fn sample(&self, u: Vec2) -> DiscSample {
        if self.is_delta {
            return DiscSample { wi: self.axis.as_vec3(), value: self.illuminance.as_dvec3(), solid_angle: None };
        }
        let local = square_to_uniform_cone(u, self.height() as f32);
        // L · solid angle, with L = E / (π sin²).
        let value = self.illuminance.as_dvec3() * (2.0 / (1.0 + self.half_cos));
        let wi = Frame::new(self.axis.as_vec3()).world_from_local(local).normalize();
        DiscSample { wi, value, solid_angle: Some(self.solid_angle()) }
    }

    /// The solid angle that it fills [sr].
    pub(super) fn solid_angle(&self) -> f64 {
        TAU * self.height()
    }

    /// Radiance that arrives against the unit direction `wi` [cd/m²]; black beside the disc, and of a single direction.
    pub(super) fn radiance(&self, wi: Vec3) -> Vec3 {
        if self.is_delta {
            return Vec3::ZERO;
        }
        // |wi − axis|² = 2 (1 − cos), which keeps the digits that the cosine of a small angle loses.
        let is_within = (wi.as_dvec3() - self.axis).length_squared() <= 2.0 * self.height();
        let scale = 1.0 / (PI * self.half_sin * self.half_sin);
        if is_within { (self.illuminance.as_dvec3() * scale).as_vec3() } else { Vec3::ZERO }
    }
}
