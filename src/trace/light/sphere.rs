//! A glowing sphere as one receiver sees it: a cone of directions, sampled uniformly in solid angle (Wang 1992).
//!
//! With sin² of the cone's half angle = (r/d)², the cone's height 1 − cos = sin² / (1 + cos) without cancellation, so
//! that spheres from a nanometre to a thousand kilometres are seen alike; lengths are in f64. A receiver inside the
//! sphere sees it shrunk until it touches the receiver. What of the cone lies below the receiver's horizon is lost.

use crate::math::{Frame, square_to_uniform_cone};
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::TAU;

/// A sphere as a receiver sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeenSphere {
    /// From the receiver to the centre [m].
    offset: DVec3,
    distance: f64,
    /// Its radius, shrunk for a receiver inside [m].
    radius: f64,
    /// 1 − cos of the cone's half angle.
    height: f64,
}

/// A direction to a sphere.
pub(super) struct SphereSample {
    pub(super) wi: Vec3,
    /// How far away the sphere's surface is in that direction [m].
    pub(super) distance: f64,
}

impl SeenSphere {
    /// `None` from the very centre, from where a sphere that shrinks is nowhere.
    pub(super) fn new(centre: Vec3, radius: f32, receiver: Vec3) -> Option<Self> {
        let offset = centre.as_dvec3() - receiver.as_dvec3();
        let distance = offset.length();
        if !(distance > 0.0 && distance.is_finite()) {
            return None;
        }
        let radius = f64::from(radius).min(distance);
        let sine_squared = (radius / distance).powi(2);
        let cosine = ((distance - radius) * (distance + radius)).max(0.0).sqrt() / distance;
        Some(Self { offset, distance, radius, height: sine_squared / (1.0 + cosine) })
    }

    /// The solid angle that it fills [sr], in (0, 2π].
    pub(super) fn solid_angle(&self) -> f64 {
        TAU * self.height
    }

    /// Radiance over intensity [1/m²].
    pub(super) fn radiance_per_intensity(&self) -> f64 {
        1.0 / (std::f64::consts::PI * self.radius * self.radius)
    }

    /// Radiance times solid angle, over intensity [sr/m²]: 2 / (d² (1 + cos)), which no radius is too small for.
    pub(super) fn flux_per_intensity(&self) -> f64 {
        2.0 / (self.distance * self.distance * (2.0 - self.height))
    }

    /// A direction to it.
    pub(super) fn sample(&self, u: Vec2) -> SphereSample {
        let local = square_to_uniform_cone(u, self.height as f32);
        let axis = (self.offset / self.distance).as_vec3();
        let wi = Frame::new(axis).world_from_local(local).normalize();
        let sine_squared = f64::from(local.x).powi(2) + f64::from(local.y).powi(2);
        SphereSample { wi, distance: self.surface(f64::from(local.z) * self.distance, sine_squared) }
    }

    /// Where a ray in the unit `direction` from the receiver meets it [m].
    pub(super) fn intersect(&self, direction: Vec3) -> Option<f64> {
        let direction = direction.as_dvec3();
        let along = direction.dot(self.offset);
        let sine_squared = direction.cross(self.offset).length_squared() / (self.distance * self.distance);
        let is_within = sine_squared <= (self.radius / self.distance).powi(2);
        (along > 0.0 && is_within).then(|| self.surface(along, sine_squared))
    }

    /// Distance of the near surface in a direction that goes `along` towards the centre, by the sine of its angle.
    fn surface(&self, along: f64, sine_squared: f64) -> f64 {
        let half_chord = (self.radius * self.radius - self.distance * self.distance * sine_squared).max(0.0).sqrt();
        let outside = (self.distance - self.radius) * (self.distance + self.radius);
        // (along − half chord) without its cancellation.
        (outside / (along + half_chord)).max(0.0)
    }
}
