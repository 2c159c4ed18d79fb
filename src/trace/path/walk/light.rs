//! One point on a source, seen from where a path is: what it gives, and what of that gets through.

use super::{Walk, dimming};
use crate::trace::accel::Hit;
use crate::trace::kernel::{LAYERED, PASSING, TEXTURED};
use crate::trace::light::{End, LightContext, LightSample};
use crate::trace::mis::power_heuristic;
use crate::trace::path::vertex::Vertex;
use crate::trace::sampler::{Dimensions, Sampler};
use crate::trace::transport::Estimator;
use glam::{Vec2, Vec3};

/// Light from one point on a source that a vertex sends on.
pub(super) struct Sent {
    /// That light [cd/m²].
    pub(super) radiance: Vec3,
    /// Where it came from, in the vertex's frame.
    pub(super) wi: Vec3,
    /// Scattering function times |cos θi| for it [1/sr].
    pub(super) response: Vec3,
}

/// How a shadow ray leaves.
pub(super) struct Departure {
    /// Where it starts [m].
    pub(super) origin: Vec3,
    /// How much the body that it goes through absorbs [1/m].
    pub(super) absorption: Vec3,
    /// What is sent on of the light from there [1/sr].
    pub(super) scattering: Vec3,
    /// How densely the way on finds its direction [1/sr].
    pub(super) scattering_pdf: f32,
}

impl<'t, 'p, const K: u32, S: Sampler> Walk<'t, 'p, K, S> {
    /// Light that a vertex sends on straight from sources.
    #[inline]
    pub(super) fn illuminate(&mut self, vertex: &Vertex<'t>, context: &LightContext) -> Option<Sent> {
        if self.samples_sources() && (K & LAYERED == 0 || vertex.bsdf.has_smooth()) {
            return self.light_sample(vertex, context);
        }
        None
    }

    /// Whether points on sources are looked for where the path is.
    #[inline]
    pub(super) fn samples_sources(&self) -> bool {
        match self.transport.estimator {
            // A source without extent is met by no ray, so that light sampling has to find it in any case.
            Estimator::Bsdf => self.lights.has_delta(),
            _ => !self.lights.is_empty(),
        }
    }

    /// Light that a vertex sends on from one point on a source.
    #[inline]
    fn light_sample(&mut self, vertex: &Vertex<'t>, context: &LightContext) -> Option<Sent> {
        let sample = self.draw_source(context)?;
        let wi = vertex.frame.local_from_world(sample.wi);
        let (scattering, scattering_pdf) = if K & LAYERED == 0 {
            (vertex.lambert.evaluate(wi), vertex.lambert.pdf(wi))
        } else {
            let response = vertex.bsdf.respond(vertex.wo, wi);
            (response.value, response.pdf)
        };
        if scattering == Vec3::ZERO {
            return None;
        }
        let origin = vertex.origin_towards::<K>(wi, sample.wi)?;
        let absorption = match vertex.beyond {
            Some(absorption) if wi.z < 0.0 => absorption,
            _ => self.absorption,
        };
        let way = Departure { origin, absorption, scattering, scattering_pdf };
        Some(Sent { radiance: self.light_from(&sample, context, way), wi, response: scattering })
    }

    /// A point on a source; none that the way on finds if that is to find all that it can.
    #[inline]
    pub(super) fn draw_source(&mut self, context: &LightContext) -> Option<LightSample> {
        let [u, v, u_choice, _] = self.sampler.draw(Dimensions::Light { vertex: self.number });
        let sample = self.lights.sample(context, Vec2::new(u, v), u_choice)?;
        let is_met = self.transport.estimator == Estimator::Bsdf && sample.pdf.is_some();
        (!is_met).then_some(sample)
    }

    /// What of the light from a point on a source is sent on [cd/m²].
    #[inline]
    pub(super) fn light_from(&mut self, sample: &LightSample, context: &LightContext, way: Departure) -> Vec3 {
        let mut value = way.scattering * sample.value;
        if K & (TEXTURED | PASSING) != 0 {
            value *= self.tracer.glow_share::<K>(sample, context);
        }
        self.tally.rays += 1;
        value *= self.visibility(way.origin, sample.wi, sample.end);
        if K & LAYERED != 0 && value != Vec3::ZERO {
            value *= dimming(way.absorption, sample.distance);
        }
        match (self.transport.estimator, sample.pdf) {
            (Estimator::Mis, Some(pdf)) => value * power_heuristic(pdf, way.scattering_pdf),
            _ => value,
        }
    }

    /// Share of the light that gets through on the way to a source.
    #[inline]
    fn visibility(&self, origin: Vec3, direction: Vec3, end: End) -> Vec3 {
        let tracer = self.tracer;
        let mut share = Vec3::ONE;
        if K & PASSING == 0 {
            let is_blocked = match end {
                End::At(target) => tracer.accel.is_blocked(origin, target),
                End::Here => false,
                End::Infinity => tracer.accel.is_blocked_towards(origin, direction),
            };
            return if is_blocked { Vec3::ZERO } else { share };
        }
        let stops = |hit: Hit| {
            let surface = tracer.surface(hit.triangle);
            if !surface.passes {
                return true;
            }
            // On the edge between two triangles a ray meets both; only one of them is to dim it.
            if !tracer.triangles[hit.triangle as usize].owns(hit.barycentric) {
                return false;
            }
            share *= tracer.passage::<K>(surface, hit.place(), direction).transmittance;
            share == Vec3::ZERO
        };
        let is_blocked = match end {
            End::At(target) => tracer.accel.meets(origin, target, stops),
            End::Here => false,
            End::Infinity => tracer.accel.meets_towards(origin, direction, stops),
        };
        if is_blocked { Vec3::ZERO } else { share }
    }
}
