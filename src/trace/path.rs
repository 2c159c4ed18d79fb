//! Following light back from where it is wanted: the path tracer.
//!
//! The quantity is E/π, the irradiance at a point over π: what a white Lambertian surface there would show. With the
//! point as the path's first vertex and throughput β = 1, every vertex adds two samples of the light that reaches it
//! straight from sources (Veach and Guibas 1995): a point on a source, and the direction in which the path goes on.
//! A path ends by Russian roulette (Arvo and Kirk 1990), whose chance of survival is at most 1 and depends on β alone,
//! so that it loses no light; there is no cap on bounces but one that a person asks for.

use super::bsdf::{Bsdf, Lambert};
use super::light::{End, LightContext};
use super::mis::power_heuristic;
use super::sampler::{Dimensions, Sampler};
use super::surface::TriangleShape;
use super::tracer::{NOT_EMISSIVE, Surface, Tracer};
use super::transport::{Estimator, Transport};
use crate::math::Frame;
use glam::{Vec2, Vec3};

/// Throughput below which roulette begins. Too high, and it ends paths that are worth their time; too low, and paths
/// go on that carry next to nothing. Efficiency, 1 / (mean square relative error × processor seconds), over the
/// light meter's points in the Cornell box and in a furnace of albedo 0.9, in thousands per second: 3.9 and 28 for
/// 0.5, 5.2 and 73 for 0.25, 4.9 and 125 for 0.15, 4.1 and 247 for 0.1. The first is what a room with dark blocks
/// gains, the second a white one; this takes most of both.
const ROULETTE_THROUGHPUT: f32 = 0.15;

/// The best chance of survival at any bounce. Ends paths between surfaces that absorb nothing.
const MAX_SURVIVAL: f32 = 0.998;

/// Where paths start, and which way it faces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathStart {
    /// The point itself [m].
    position: Vec3,
    /// The point moved off its surface; where rays start [m].
    origin: Vec3,
    /// Unit normal that receives.
    normal: Vec3,
    /// Unit normal of the flat surface, on the side that receives.
    geometric_normal: Vec3,
}

impl PathStart {
    /// A start on a triangle, on the side of `normal`.
    pub(super) fn new(triangle: &TriangleShape, position: Vec3, normal: Vec3) -> Self {
        let side = if triangle.normal.dot(normal) < 0.0 { -1.0 } else { 1.0 };
        Self { position, origin: triangle.leave(position, normal), normal, geometric_normal: side * triangle.normal }
    }

    /// Where rays start [m].
    pub(super) fn origin(&self) -> Vec3 {
        self.origin
    }

    /// Unit normal that receives.
    pub(super) fn normal(&self) -> Vec3 {
        self.normal
    }

    /// A start in mid-air.
    pub(super) fn free(position: Vec3, normal: Vec3) -> Self {
        Self { position, origin: position, normal, geometric_normal: normal }
    }
}

impl Tracer {
    /// A start of paths on a triangle, at these weights of its second and third vertex, on the side of `normal`, the
    /// unit normal that receives.
    pub(crate) fn start_on_triangle(&self, triangle: u32, barycentric: [f32; 2], normal: Vec3) -> PathStart {
        let shape = &self.triangles[triangle as usize];
        PathStart::new(shape, shape.position(barycentric), normal)
    }

    /// A start of paths at a point of the world. Within 1e-5 of the scene's extent from a surface, on the side that
    /// `normal` points to, the point counts as lying on it.
    pub(crate) fn start_at(&self, position: Vec3, normal: Vec3) -> PathStart {
        let reach = 1e-5 * self.extent;
        let above = position + normal * reach;
        match self.accel.closest(above, -normal, 2.0 * reach) {
            Some(hit) => self.start_on_triangle(hit.triangle, hit.barycentric, normal),
            None => PathStart::free(position, normal),
        }
    }

    /// One sample of E/π at a start [cd/m²]. Adds the rays that it traced to `rays`.
    pub(crate) fn diffuse_radiance(
        &self,
        start: &PathStart,
        sampler: &impl Sampler,
        transport: &Transport,
        rays: &mut u64,
    ) -> Vec3 {
        let mut vertex = *start;
        let mut albedo = Vec3::ONE;
        let mut throughput = Vec3::ONE;
        let mut radiance = Vec3::ZERO;
        let mut number = 0;
        loop {
            let bsdf = Bsdf::Lambert(Lambert { albedo });
            let frame = Frame::new(vertex.normal);
            let ctx = LightContext { position: vertex.position, normal: Some(vertex.normal) };
            if !self.lights.is_empty() {
                let u = sampler.draw(Dimensions::Light { vertex: number });
                radiance += throughput * self.light_sample(&vertex, &frame, &bsdf, u, transport.estimator, rays);
            }
            let [u, v, u_survive, _] = sampler.draw(Dimensions::Scatter { vertex: number });
            let scattered = bsdf.sample(Vec2::new(u, v));
            let wi = frame.world_from_local(scattered.wi);
            // A shading normal can send a direction below the flat surface, which blocks it.
            if vertex.geometric_normal.dot(wi) <= 0.0 {
                return radiance;
            }
            throughput *= scattered.weight;
            *rays += 1;
            let hit = self.accel.closest(vertex.origin, wi, f32::INFINITY);
            let weigh = |pdf| emission_weight(transport.estimator, scattered.pdf, pdf);
            let end = hit.map_or(f32::INFINITY, |hit| hit.t);
            for met in self.lights.passed(&ctx, vertex.origin, wi, end) {
                radiance += throughput * met.radiance * weigh(met.pdf);
            }
            let Some(hit) = hit else {
                for met in self.lights.distant(&ctx, wi) {
                    radiance += throughput * met.radiance * weigh(met.pdf);
                }
                return radiance + throughput * self.sky_radiance;
            };
            let triangle = &self.triangles[hit.triangle as usize];
            let surface = &self.surfaces[self.surface_of[hit.triangle as usize] as usize];
            let emitted = surface.emission(triangle, wi);
            if emitted != Vec3::ZERO {
                let emitter = self.emitter_of[hit.triangle as usize];
                debug_assert_ne!(emitter, NOT_EMISSIVE);
                radiance += throughput * emitted * weigh(self.lights.pdf(emitter, &ctx, wi, hit.t));
            }
            if transport.max_bounces.is_some_and(|cap| number >= cap) {
                return radiance;
            }
            albedo = surface.diffuse_albedo;
            let survival = survival_probability(throughput * albedo);
            if u_survive >= survival {
                return radiance;
            }
            throughput /= survival;
            vertex = PathStart::new(triangle, triangle.position(hit.barycentric), -wi);
            vertex.normal = vertex.geometric_normal;
            number += 1;
        }
    }

    /// Radiance that arrives against `direction` at `origin`, along a camera's ray [cd/m²]. Lights that are no
    /// surfaces are not seen, as in Bevy.
    pub(crate) fn camera_radiance(
        &self,
        origin: Vec3,
        direction: Vec3,
        sampler: &impl Sampler,
        transport: &Transport,
        rays: &mut u64,
    ) -> Vec3 {
        *rays += 1;
        let Some(hit) = self.accel.closest(origin, direction, f32::INFINITY) else {
            return self.sky_radiance + self.lights.sky_picture(direction);
        };
        let triangle = &self.triangles[hit.triangle as usize];
        let surface = &self.surfaces[self.surface_of[hit.triangle as usize] as usize];
        let emitted = surface.emission(triangle, direction);
        if surface.diffuse_albedo == Vec3::ZERO {
            return emitted;
        }
        let mut start = PathStart::new(triangle, triangle.position(hit.barycentric), -direction);
        start.normal = start.geometric_normal;
        emitted + surface.diffuse_albedo * self.diffuse_radiance(&start, sampler, transport, rays)
    }

    /// Radiance that a vertex sends on from one point on a source.
    fn light_sample(
        &self,
        vertex: &PathStart,
        frame: &Frame,
        bsdf: &Bsdf,
        [u, v, u_choice, _]: [f32; 4],
        estimator: Estimator,
        rays: &mut u64,
    ) -> Vec3 {
        let ctx = LightContext { position: vertex.position, normal: Some(vertex.normal) };
        let Some(sample) = self.lights.sample(&ctx, Vec2::new(u, v), u_choice) else {
            return Vec3::ZERO;
        };
        let wi = frame.local_from_world(sample.wi);
        let scattering = bsdf.evaluate(wi);
        if scattering == Vec3::ZERO || vertex.geometric_normal.dot(sample.wi) <= 0.0 {
            return Vec3::ZERO;
        }
        let weight = match (estimator, sample.pdf) {
            (_, None) | (Estimator::Light, _) => 1.0,
            (Estimator::Mis, Some(pdf)) => power_heuristic(pdf, bsdf.pdf(wi)),
            (Estimator::Bsdf, Some(_)) => return Vec3::ZERO,
        };
        let is_blocked = match sample.end {
            End::At(target) => self.accel.is_blocked(vertex.origin, target),
            End::Here => false,
            End::Infinity => self.accel.closest(vertex.origin, sample.wi, f32::INFINITY).is_some(),
        };
        *rays += 1;
        if is_blocked { Vec3::ZERO } else { scattering * sample.value * weight }
    }
}

/// Weight of a source's light that the path met by itself with density `own`, and light sampling finds with `other`.
fn emission_weight(estimator: Estimator, own: f32, other: f32) -> f32 {
    match estimator {
        Estimator::Bsdf => 1.0,
        Estimator::Light => 0.0,
        Estimator::Mis => power_heuristic(own, other),
    }
}

impl Surface {
    /// Radiance given off against `direction`, a ray that arrives [cd/m²].
    fn emission(&self, triangle: &TriangleShape, direction: Vec3) -> Vec3 {
        if self.double_sided || triangle.normal.dot(direction) < 0.0 { self.emitted_radiance } else { Vec3::ZERO }
    }
}

/// Chance that a path goes on with this throughput, never above 1: above it the division by the chance would lose
/// the light that the survivors should stand for.
fn survival_probability(throughput: Vec3) -> f32 {
    (throughput.max_element() / ROULETTE_THROUGHPUT).min(MAX_SURVIVAL)
}

#[cfg(test)]
mod tests;
