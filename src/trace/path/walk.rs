//! One path: from a vertex along a ray to the next vertex, and what light it finds on the way.

mod around;
mod find;
mod light;

use super::vertex::{Ray, Vertex};
use super::{PathStart, Tally};
use crate::math::{Frame, Portable};
use crate::trace::accel::Hit;
use crate::trace::bsdf::{Bsdf, BsdfSample, Density, Lambert};
use crate::trace::kernel::{DISTANT, LAYERED, PASSING};
use crate::trace::light::{LightContext, Lights, Way};
use crate::trace::material::Surface;
use crate::trace::mis::power_heuristic;
use crate::trace::sampler::{Dimensions, Sampler};
use crate::trace::shade::Place;
use crate::trace::surface::TriangleShape;
use crate::trace::tracer::Tracer;
use crate::trace::transport::{Estimator, Transport};
use glam::{Vec2, Vec3};

/// Throughput below which roulette begins. Too high, and it ends paths that are worth their time; too low, and paths
/// go on that carry next to nothing. Efficiency, 1 / (mean square relative error × processor seconds), over the
/// light meter's points in the Cornell box and in a furnace of albedo 0.9, in thousands per second: 3.9 and 28 for
/// 0.5, 5.2 and 73 for 0.25, 4.9 and 125 for 0.15, 4.1 and 247 for 0.1. The first is what a room with dark blocks
/// gains, the second a white one; this takes most of both.
pub(super) const ROULETTE_THROUGHPUT: f32 = 0.15;

/// Vertices after which a path is cut, and counted. Where a share ε of what a path carries is lost at each vertex, it
/// lives on with the chance 1 while it carries more than [`ROULETTE_THROUGHPUT`] and then with 1 − ε at each vertex:
/// it reaches this number with a chance of (1 − ε)ⁿ / 0.15, which is below 10⁻¹² from ε = 4.5·10⁻⁴ upwards (and
/// 2·10⁻²⁸ between walls of albedo 0.999). What keeps more has no steady state that a bake would reach.
pub(crate) const MAX_VERTICES: u32 = 1 << 16;

/// The largest chance to pass a surface that is there at all, so that what it shows is not missed.
const MAX_PASSING: f32 = 0.999;

/// Where a ray comes to.
enum Arrival<'t> {
    At(Vertex<'t>),
    /// A place of which it is known what it shows, and what that adds to the path [cd/m²].
    Known(Vertex<'t>, Vec3),
    /// Out of the scene; what shines there is still to be added.
    Outside,
    /// The path is at its end.
    Ended,
}

/// A path in the making.
pub(super) struct Walk<'t, 'p, const K: u32, S> {
    tracer: &'t Tracer,
    sampler: &'p S,
    transport: &'p Transport,
    tally: &'p mut Tally,
    /// Whose direct light counts where the path is.
    lights: &'t Lights,
    radiance: Vec3,
    throughput: Vec3,
    max_bounces: Option<u32>,
    /// Number of the vertex that the path is at or has left.
    number: u32,
    /// How much the body that the path is in absorbs [1/m]; zero outside.
    absorption: Vec3,
    /// Whether it is known what the path is in: one that starts in a body learns it where it meets that from behind.
    knows_body: bool,
    /// How much radiance is concentrated where the path began, over where it is: the index squared, which comes back
    /// on the way out and is no loss.
    concentration: f32,
    /// Where it is.
    place: Place,
    /// Whether it went straight through any surface.
    has_passed: bool,
    /// Whether a surface has spread it out, so that it might have gone elsewhere.
    is_spread: bool,
}

impl<'t, 'p, const K: u32, S: Sampler> Walk<'t, 'p, K, S> {
    pub(super) fn new(tracer: &'t Tracer, sampler: &'p S, transport: &'p Transport, tally: &'p mut Tally) -> Self {
        let (radiance, throughput, absorption) = (Vec3::ZERO, Vec3::ONE, Vec3::ZERO);
        let max_bounces = tracer.max_bounces(transport);
        Self {
            tracer,
            sampler,
            transport,
            tally,
            lights: &tracer.lights,
            radiance,
            throughput,
            max_bounces,
            number: 0,
            absorption,
            knows_body: false,
            concentration: 1.0,
            place: Place { triangle: 0, barycentric: [0.0; 2] },
            has_passed: false,
            is_spread: false,
        }
    }

    /// The same without direct light, where it starts, that is drawn in real time.
    pub(super) fn baked(self) -> Self {
        Self { lights: self.tracer.baked_lights.as_ref().unwrap_or(&self.tracer.lights), ..self }
    }

    /// E/π at a receiver, by one path.
    pub(super) fn receive(mut self, start: &PathStart) -> Vec3 {
        self.go_on(&Self::receiver(start));
        self.radiance
    }

    /// A receiver as a path's first vertex.
    fn receiver(start: &PathStart) -> Vertex<'t> {
        let lambert = Lambert { albedo: Vec3::ONE };
        Vertex {
            position: start.position,
            origin: start.origin,
            geometric_normal: start.geometric_normal,
            frame: Frame::new(start.normal),
            wo: Vec3::Z,
            lambert,
            bsdf: Bsdf::Lambert(lambert),
            triangle: None,
            beyond: None,
        }
    }

    /// Radiance that arrives against a camera's ray, by one path.
    pub(super) fn look_along(mut self, ray: Ray) -> Vec3 {
        match self.arrive(&ray) {
            Arrival::At(vertex) => self.go_on(&vertex),
            Arrival::Known(_, light) => self.radiance += light,
            Arrival::Outside => self.escape(&ray),
            Arrival::Ended => {}
        }
        self.radiance
    }

    fn go_on(&mut self, vertex: &Vertex<'t>) {
        if let Some(ray) = self.leave(vertex) {
            self.follow(ray);
        }
    }

    /// Follows a path to its end.
    fn follow(&mut self, mut ray: Ray) {
        loop {
            let vertex = match self.arrive(&ray) {
                Arrival::At(vertex) => vertex,
                Arrival::Known(_, light) => return self.radiance += light,
                Arrival::Outside => return self.escape(&ray),
                Arrival::Ended => return,
            };
            self.go_to_next();
            if self.number >= MAX_VERTICES {
                self.tally.endless += 1;
                self.tally.kept_by = Some(self.tracer.surface_of[self.place.triangle as usize]);
                self.tally.was_spread = self.is_spread;
                return;
            }
            match self.leave(&vertex) {
                Some(next) => ray = next,
                None => return,
            }
        }
    }

    /// Notes that the path is at another vertex, where all light counts.
    #[inline]
    fn go_to_next(&mut self) {
        self.number += 1;
        self.lights = &self.tracer.lights;
    }

    /// Adds the light that a vertex gets straight from a source and chooses the way on.
    #[inline]
    fn leave(&mut self, vertex: &Vertex<'t>) -> Option<Ray> {
        let context = vertex.context::<K>();
        if let Some(sent) = self.illuminate(vertex, &context) {
            self.radiance += self.throughput * sent.radiance;
        }
        self.scatter(vertex, context).map(|(ray, _)| ray)
    }

    /// Chooses the way on.
    #[inline]
    fn scatter(&mut self, vertex: &Vertex<'t>, context: LightContext) -> Option<(Ray, BsdfSample)> {
        let [u, v, u_survive, u_lobe] = self.sampler.draw(Dimensions::Scatter { vertex: self.number });
        let sample = if K & LAYERED == 0 {
            vertex.lambert.sample(Vec2::new(u, v))
        } else {
            vertex.bsdf.sample(vertex.wo, [u, v, u_lobe])?
        };
        let direction = vertex.frame.world_from_local(sample.wi);
        let origin = vertex.origin_towards::<K>(sample.wi, direction)?;
        if K & LAYERED != 0
            && sample.wi.z < 0.0
            && let Some(absorption) = vertex.beyond
        {
            self.absorption = absorption;
            self.knows_body = true;
            self.concentration *= vertex.bsdf.concentration();
        }
        self.throughput *= sample.weight;
        self.is_spread |= matches!(sample.density, Density::Smooth(_));
        Some((Ray { origin, direction, context, density: sample.density, survival: Some(u_survive) }, sample))
    }

    /// Follows a ray to the next vertex; adds what light it meets within the scene.
    #[inline]
    fn arrive(&mut self, ray: &Ray) -> Arrival<'t> {
        let tracer = self.tracer;
        let mut origin = ray.origin;
        // Straight through surfaces that were passed.
        let mut passed = 0.0;
        let mut u_pass = match (K & PASSING, ray.survival) {
            (0, _) => 0.0,
            // Not the number of the ray after it, which leaves the same vertex.
            (_, None) => self.sampler.draw(Dimensions::Start)[3],
            (_, Some(_)) => self.sampler.draw(Dimensions::Light { vertex: self.number })[3],
        };
        let (hit, surface) = loop {
            self.tally.rays += 1;
            let hit = tracer.nearest(origin, ray.direction);
            let end = hit.map_or(f32::INFINITY, |hit| hit.t);
            if ray.survival.is_some() && self.lights.has_passable() {
                self.meet_sources(ray, origin, passed, end);
            }
            let Some(hit) = hit else {
                return Arrival::Outside;
            };
            let surface = tracer.surface(hit.triangle);
            if K & LAYERED != 0 && !self.knows_body {
                self.learn_body(hit, surface, ray.direction);
            }
            self.absorb(hit.t);
            if K & PASSING == 0 || !surface.passes {
                break (hit, surface);
            }
            let passage = tracer.passage::<K>(surface, hit.place(), ray.direction);
            let chance = passage.transmittance.max_element();
            if passage.presence > 0.0 {
                let chance = chance.min(MAX_PASSING);
                if u_pass >= chance {
                    self.throughput *= passage.presence / (1.0 - chance);
                    break (hit, surface);
                }
                u_pass /= chance;
                self.throughput *= passage.transmittance / chance;
            } else if chance > 0.0 {
                self.radiance += passage.glow * self.glow_met(ray, hit, surface, passed);
                self.throughput *= passage.transmittance;
            } else {
                return Arrival::Ended;
            }
            let shape = &tracer.triangles[hit.triangle as usize];
            origin = shape.leave(shape.position(hit.barycentric), ray.direction);
            passed += hit.t;
            self.has_passed = true;
        };
        let shape = &tracer.triangles[hit.triangle as usize];
        let place = hit.place();
        self.radiance += self.glow_met(ray, hit, surface, passed);
        if ray.survival.is_some() && self.max_bounces.is_some_and(|cap| self.number >= cap) {
            return Arrival::Ended;
        }
        let vertex = self.vertex(shape, place, ray);
        let albedo = if K & LAYERED == 0 { vertex.lambert.albedo } else { vertex.bsdf.albedo(vertex.wo) };
        let carried = (self.throughput * albedo).max_element();
        let carried = if K & LAYERED == 0 { carried } else { carried * self.concentration };
        if !carried.is_finite() {
            // A path that has lost its number is given up as a whole, and counted where it is added up.
            self.radiance = Vec3::NAN;
            return Arrival::Ended;
        }
        if carried <= 0.0 {
            return Arrival::Ended;
        }
        if let Some(u_survive) = ray.survival {
            if let Some(known) = tracer.known_light::<K>(hit, ray.direction, passed + hit.t) {
                return Arrival::Known(vertex, self.throughput * albedo * known);
            }
            let survival = survival_probability(carried);
            if u_survive >= survival {
                return Arrival::Ended;
            }
            self.throughput /= survival;
        }
        self.place = place;
        Arrival::At(vertex)
    }

    /// What the glow of a surface adds that a ray meets, after what it passed.
    #[inline]
    fn glow_met(&self, ray: &Ray, hit: Hit, surface: &Surface, passed: f32) -> Vec3 {
        let tracer = self.tracer;
        if !surface.shines(&tracer.triangles[hit.triangle as usize], ray.direction) {
            return Vec3::ZERO;
        }
        let source = tracer.emitter_of[hit.triangle as usize];
        let weight = self.weight_of_met(ray, |context| self.lights.pdf(source, context, ray.direction, passed + hit.t));
        self.throughput * tracer.glow::<K>(surface, hit.place()) * weight
    }

    /// What a ray finds where it meets a triangle.
    #[inline]
    fn vertex(&self, shape: &'t TriangleShape, place: Place, ray: &Ray) -> Vertex<'t> {
        let tracer = self.tracer;
        let direction = ray.direction;
        let surface = tracer.surface(place.triangle);
        let start = PathStart::new(shape, shape.position(place.barycentric), -direction);
        if K & LAYERED == 0 {
            let lambert = Lambert { albedo: tracer.albedo::<K>(surface, place) };
            return Vertex {
                position: start.position,
                origin: start.origin,
                geometric_normal: start.geometric_normal,
                frame: match ray.survival {
                    Some(_) => Frame::new(start.geometric_normal),
                    None => tracer.seen_frame(place, start.geometric_normal, -direction),
                },
                wo: Vec3::Z,
                lambert,
                bsdf: Bsdf::None,
                triangle: None,
                beyond: None,
            };
        }
        let side = if shape.normal.dot(direction) < 0.0 { 1.0 } else { -1.0 };
        let frame = if surface.is_shaded() {
            tracer.shading_frame(surface, place, start.geometric_normal, -direction, side)
        } else if ray.survival.is_none() {
            tracer.seen_frame(place, start.geometric_normal, -direction)
        } else {
            Frame::new(start.geometric_normal)
        };
        Vertex {
            position: start.position,
            origin: start.origin,
            geometric_normal: start.geometric_normal,
            frame,
            wo: frame.local_from_world(-direction),
            lambert: Lambert { albedo: Vec3::ZERO },
            bsdf: tracer.bsdf::<K>(surface, place, side),
            triangle: Some(shape),
            beyond: surface.body.map(|absorption| if side > 0.0 { absorption } else { Vec3::ZERO }),
        }
    }

    /// Adds the sources that block nothing and that a ray crosses before `end`.
    #[inline]
    fn meet_sources(&mut self, ray: &Ray, origin: Vec3, passed: f32, end: f32) {
        let way = Way { origin, direction: ray.direction, end, passed };
        let lights = self.lights;
        for met in lights.passed(&ray.context, way) {
            let weight = self.weight_of_met(ray, |_| met.pdf);
            let dimming = if K & LAYERED == 0 { Vec3::ONE } else { dimming(self.absorption, met.distance) };
            self.radiance += self.throughput * met.radiance * dimming * weight;
        }
    }

    /// Adds what shines from infinitely far away along a ray.
    #[inline]
    fn escape(&mut self, ray: &Ray) {
        // Nothing of a body that has no end gets out.
        self.absorb(f32::INFINITY);
        self.radiance += self.throughput * self.tracer.sky_radiance;
        self.meet_distant(ray);
    }

    /// The same, of all but a constant sky.
    #[inline]
    fn meet_distant(&mut self, ray: &Ray) {
        if K & DISTANT == 0 {
            return;
        }
        if ray.survival.is_none() {
            self.radiance += self.throughput * self.lights.sky_picture(ray.direction);
            return;
        }
        let lights = self.lights;
        for met in lights.distant(&ray.context, ray.direction) {
            let weight = self.weight_of_met(ray, |_| met.pdf);
            self.radiance += self.throughput * met.radiance * weight;
        }
    }

    /// A path that meets a body from behind before it has crossed any surface has been in it from its start.
    fn learn_body(&mut self, hit: Hit, surface: &Surface, direction: Vec3) {
        if let Some(absorption) = surface.body
            && self.tracer.triangles[hit.triangle as usize].normal.dot(direction) > 0.0
        {
            self.absorption = absorption;
            self.knows_body = true;
        }
    }

    fn absorb(&mut self, distance: f32) {
        if K & LAYERED != 0 {
            self.throughput *= dimming(self.absorption, distance);
        }
    }

    /// Weight of light that the path met by itself, where light sampling would have found it with density `pdf`.
    #[inline]
    fn weight_of_met(&self, ray: &Ray, pdf: impl FnOnce(&LightContext) -> f32) -> f32 {
        match (ray.density, self.transport.estimator) {
            (Density::Delta, _) | (_, Estimator::Bsdf) => 1.0,
            (_, Estimator::Light) => 0.0,
            (Density::Smooth(own), Estimator::Mis) => power_heuristic(own, pdf(&ray.context)),
        }
    }
}

/// What is left of light after a way through what absorbs.
#[inline]
fn dimming(absorption: Vec3, distance: f32) -> Vec3 {
    if absorption == Vec3::ZERO {
        return Vec3::ONE;
    }
    // Zero times an infinite way is no dimming.
    let channel = |absorption: f32| if absorption == 0.0 { 1.0 } else { Portable::exp(-absorption * distance) };
    Vec3::from_array(absorption.to_array().map(channel))
}

/// Chance that a path goes on that carries this much in its strongest channel, index squared aside, never above 1:
/// above it the division by the chance would lose the light that the survivors should stand for. Nor is 1 lowered to make sure of an end: a
/// path that is worth its while would be ended for nothing, and those that are left would weigh more at each vertex.
/// With a best chance of 0.998 the efficiency was 0.66 of this one in furnaces of albedo 0.9, 0.20 in 0.99 and 0.018
/// in 0.999 (5063 rays for each path); with one of 0.95, 0.23, 0.008 and none at all.
pub(super) fn survival_probability(carried: f32) -> f32 {
    (carried / ROULETTE_THROUGHPUT).min(1.0)
}
