//! One path from a receiver, in two parts: what serves this receiver alone, and what others can use that see where it
//! came from.

use super::{Arrival, Walk};
use crate::trace::bsdf::Look;
use crate::trace::kernel::LAYERED;
use crate::trace::path::PathStart;
use crate::trace::path::sharing::{Found, Shared, Whence};
use crate::trace::path::vertex::Vertex;
use crate::trace::sampler::Sampler;
use crate::trace::transport::Sharing;
use glam::Vec3;

impl<'t, 'p, const K: u32, S: Sampler> Walk<'t, 'p, K, S> {
    /// E/π at a receiver, by one path, in both parts.
    pub(in crate::trace::path) fn find(mut self, start: &PathStart) -> Found<'t> {
        if self.transport.sharing == Sharing::Alone {
            return Found::alone(self.receive(start));
        }
        // A white Lambertian receiver: the density of directions is what it weighs them by, so that no factor is left.
        let Some(ray) = self.leave(&Self::receiver(start)) else { return Found::alone(self.radiance) };
        let arrival = self.arrive(&ray);
        // What is seen through something, or within a body, is another thing from elsewhere.
        let is_own = self.has_passed || self.knows_body;
        match arrival {
            Arrival::At(vertex) => {
                self.go_to_next();
                match self.look_of(&vertex).filter(|_| !is_own) {
                    Some(look) if K & LAYERED == 0 => {
                        let alone = std::mem::take(&mut self.radiance);
                        self.go_on(&vertex);
                        let whence = Whence::of(&vertex, look);
                        Found { alone, shared: Some(Shared { whence, radiance: self.radiance, own: Vec3::ONE }) }
                    }
                    Some(look) => self.part(&vertex, look),
                    None => {
                        self.go_on(&vertex);
                        Found::alone(self.radiance)
                    }
                }
            }
            Arrival::Known(_, radiance) if is_own => Found::alone(self.radiance + radiance),
            // Known is what Lambert's surfaces show.
            Arrival::Known(vertex, radiance) => {
                let whence = Whence::of(&vertex, Look::EVEN);
                Found { alone: self.radiance, shared: Some(Shared { whence, radiance, own: Vec3::ONE }) }
            }
            Arrival::Outside if is_own => {
                self.escape(&ray);
                Found::alone(self.radiance)
            }
            Arrival::Outside => {
                self.meet_distant(&ray);
                let radiance = self.throughput * self.tracer.sky_radiance;
                let whence = Whence::Sky(ray.direction);
                Found { alone: self.radiance, shared: Some(Shared { whence, radiance, own: Vec3::ONE }) }
            }
            Arrival::Ended => Found::alone(self.radiance),
        }
    }

    /// How a vertex's matt part looks; `None` if it has none, or if its frame is another for others.
    #[inline]
    fn look_of(&self, vertex: &Vertex<'t>) -> Option<Look<'t>> {
        if K & LAYERED == 0 {
            return Some(Look::EVEN);
        }
        let surface = self.tracer.surface(self.place.triangle);
        if surface.is_shaded() && vertex.frame.normal == vertex.geometric_normal {
            // Perhaps it stands in for a normal that looks away from this viewer.
            let geometric = vertex.geometric_normal;
            let side = vertex.triangle.map_or(1.0, |shape| if shape.normal == geometric { 1.0 } else { -1.0 });
            if self.tracer.shading_normal(surface, self.place, geometric, side) != geometric {
                return None;
            }
        }
        vertex.bsdf.look()
    }

    /// Goes on from the first vertex and parts what it shows: light of its matt lobe is for others too.
    fn part(mut self, vertex: &Vertex<'t>, look: Look<'t>) -> Found<'t> {
        let own = look.from(vertex.wo.z);
        let mut alone = std::mem::take(&mut self.radiance);
        if own.min_element() <= 0.0 {
            // No path from here says how it looks from elsewhere.
            self.go_on(vertex);
            return Found::alone(alone + self.radiance);
        }
        let mut radiance = Vec3::ZERO;
        let mut deal = |light: Vec3, matt: Vec3| {
            radiance += light * matt;
            // By rounding alone the part may be more than the whole.
            alone += light * (Vec3::ONE - matt * own).max(Vec3::ZERO);
        };
        let context = vertex.context::<K>();
        if let Some(sent) = self.illuminate(vertex, &context) {
            deal(self.throughput * sent.radiance, vertex.bsdf.matt_over(sent.response, sent.wi));
        }
        if let Some((ray, sample)) = self.scatter(vertex, context) {
            self.follow(ray);
            deal(self.radiance, vertex.bsdf.matt_over_sample(sample.weight, sample.density, sample.wi));
        }
        Found { alone, shared: Some(Shared { whence: Whence::of(vertex, look), radiance, own }) }
    }
}
