//! Following light back from where it is wanted: the path tracer.
//!
//! The quantity is E/π, the irradiance at a point over π: what a white Lambertian surface there would show. With the
//! point as the path's first vertex and throughput β = 1, every vertex adds two samples of the light that reaches it
//! straight from sources (Veach and Guibas 1995): a point on a source, and the direction in which the path goes on.
//! A path ends by Russian roulette (Arvo and Kirk 1990), whose chance of survival is at most 1 and depends on β alone,
//! so that it loses no light; there is no cap on bounces but one that a person asks for. Where nothing is ever
//! absorbed no chance would end it: then [`MAX_VERTICES`] does, which is counted.
//!
//! A surface that is there in part is met or passed at random; a path that passes it has no vertex there, so that the
//! weights of its samples stay those of the vertex before, and a shadow ray is dimmed by the share that passes. In a
//! body of glass light is dimmed by Beer and Lambert's law.
//!
//! All of it is generic over the kernel `K` ([`super::kernel`]).

mod sharing;
mod start;
mod vertex;
mod walk;

use sharing::Found;
pub(crate) use sharing::MOST_RECEIVERS;
pub(crate) use start::PathStart;

use super::kernel::with_kernel;
use super::sampler::Sampler;
use super::tracer::Tracer;
use super::transport::Transport;
use glam::Vec3;
use vertex::Ray;
pub(crate) use walk::MAX_VERTICES;
use walk::Walk;

/// What paths did.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// Rays traced.
    pub(crate) rays: u64,
    /// Paths that were cut at [`MAX_VERTICES`].
    pub(crate) endless: u64,
    /// The number of the material at which the last of those was.
    pub(crate) kept_by: Option<u32>,
    /// Whether any surface had spread that path out, which mirrors and clear glass do not.
    pub(crate) was_spread: bool,
}

/// Light that comes to a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrived {
    /// Unit direction that it comes from.
    pub(crate) direction: Vec3,
    /// How much of it there is [cd/m²].
    pub(crate) radiance: Vec3,
}

impl Tracer {
    /// One sample of E/π at a start [cd/m²]. Adds what it did to `tally`.
    pub(crate) fn diffuse_radiance(
        &self,
        start: &PathStart,
        sampler: &impl Sampler,
        transport: &Transport,
        tally: &mut Tally,
    ) -> Vec3 {
        with_kernel!(self.kernel, K => Walk::<K, _>::new(self, sampler, transport, tally).receive(start))
    }

    /// The same as a lightmap is to hold it: without the direct light of [`Scene::indirect_only`].
    ///
    /// [`Scene::indirect_only`]: crate::scene::Scene::indirect_only
    pub(crate) fn baked_radiance(
        &self,
        start: &PathStart,
        sampler: &impl Sampler,
        transport: &Transport,
        tally: &mut Tally,
    ) -> Vec3 {
        with_kernel!(self.kernel, K => Walk::<K, _>::new(self, sampler, transport, tally).baked().receive(start))
    }

    /// One sample of the radiance that comes to a point in mid-air, averaged over all directions, as irradiance volumes
    /// are to hold it. The point is one of the world [m]; the mean over many samples of the sum of f(direction) ·
    /// radiance is ∫ L(ω) f(ω) dω / 4π for any f.
    pub(crate) fn light_around(
        &self,
        position: Vec3,
        sampler: &impl Sampler,
        transport: &Transport,
        tally: &mut Tally,
    ) -> [Arrived; 2] {
        let position = self.traced_from_world.point(position);
        with_kernel!(self.kernel, K => Walk::<K, _>::new(self, sampler, transport, tally).baked().look_around(position))
    }

    /// The same as [`Self::baked_radiance`], as far as it can serve other receivers apart from what cannot.
    pub(crate) fn find(
        &self,
        start: &PathStart,
        sampler: &impl Sampler,
        transport: &Transport,
        tally: &mut Tally,
    ) -> Found<'_> {
        with_kernel!(self.kernel, K => Walk::<K, _>::new(self, sampler, transport, tally).baked().find(start))
    }

    /// Radiance that arrives against `direction` at `origin`, a point of the world, along a camera's ray [cd/m²].
    /// Lights that are no surfaces are not seen, as in Bevy.
    pub(crate) fn camera_radiance(
        &self,
        origin: Vec3,
        direction: Vec3,
        sampler: &impl Sampler,
        transport: &Transport,
        tally: &mut Tally,
    ) -> Vec3 {
        self.radiance_along(self.traced_from_world.point(origin), direction, sampler, transport, tally)
    }

    /// The same against a ray in the traced frame.
    pub(super) fn radiance_along(
        &self,
        origin: Vec3,
        direction: Vec3,
        sampler: &impl Sampler,
        transport: &Transport,
        tally: &mut Tally,
    ) -> Vec3 {
        let ray = Ray::of_camera(origin, direction);
        with_kernel!(self.kernel, K => Walk::<K, _>::new(self, sampler, transport, tally).look_along(ray))
    }
}

#[cfg(test)]
mod tests;
