//! Light from all around a point in mid-air, where nothing scatters it: what a probe of an irradiance volume measures.
//! Owns where it comes from; what is made of it is asked for by its direction.
//!
//! The point is a path's first vertex. It is as if it scattered evenly in all directions: a point on a source and the
//! way on, which is uniform over the sphere, are weighted against each other as at any other vertex.

use super::Walk;
use super::light::Departure;
use crate::math::square_to_uniform_sphere;
use crate::trace::bsdf::Density;
use crate::trace::light::LightContext;
use crate::trace::path::Arrived;
use crate::trace::path::vertex::Ray;
use crate::trace::sampler::{Dimensions, Sampler};
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// Density of directions that are uniform over the sphere [1/sr].
const UNIFORM: f32 = 0.25 / PI;

impl<'t, 'p, const K: u32, S: Sampler> Walk<'t, 'p, K, S> {
    /// Radiance averaged over the sphere, by one path, in two parts: straight from a point on a source, and by the way
    /// on.
    pub(in crate::trace::path) fn look_around(mut self, position: Vec3) -> [Arrived; 2] {
        let context = LightContext { position, normal: None };
        let straight = self.straight_from_source(&context);
        let [u, v, u_survive, _] = self.sampler.draw(Dimensions::Scatter { vertex: 0 });
        let direction = square_to_uniform_sphere(Vec2::new(u, v));
        self.is_spread = true;
        let (density, survival) = (Density::Smooth(UNIFORM), Some(u_survive));
        self.follow(Ray { origin: position, direction, context, density, survival });
        [straight, Arrived { direction, radiance: self.radiance }]
    }

    fn straight_from_source(&mut self, context: &LightContext) -> Arrived {
        let sample = if self.samples_sources() { self.draw_source(context) } else { None };
        let Some(sample) = sample else { return Arrived { direction: Vec3::Y, radiance: Vec3::ZERO } };
        let way = Departure {
            origin: context.position,
            absorption: self.absorption,
            scattering: Vec3::splat(UNIFORM),
            scattering_pdf: UNIFORM,
        };
        Arrived { direction: sample.wi, radiance: self.light_from(&sample, context, way) }
    }
}
