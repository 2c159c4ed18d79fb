//! The parts of a tracer as they come together.

use super::sound::Sound;
use crate::math::square_to_triangle;
use crate::scene::{EnvironmentMap, Instance, Light, Mesh, Scene};
use crate::trace::accel::Accel;
use crate::trace::attributes::{Attributes, Needs};
use crate::trace::bsdf::AlbedoTables;
use crate::trace::kernel::{LAYERED, PASSING, TEXTURED, kernel_for};
use crate::trace::light::{Emitter, EmitterShape, Sources};
use crate::trace::material::{Surface, View};
use crate::trace::sampler::{Dimensions, Sampler, Sobol};
use crate::trace::shade::Place;
use crate::trace::surface::{Placement, TriangleShape};
use crate::trace::texture::Decoded;
use crate::trace::traced::TracedFromWorld;
use crate::trace::tracer::{NO_TRIANGLE, NOT_EMISSIVE, Receiver, Tracer};
use glam::{Vec2, Vec3};
use std::sync::{Arc, OnceLock};

/// Points at which the texture of a glowing triangle is looked up for its brightness.
const GLOW_POINTS: u64 = 64;

/// The least brightness of a glowing triangle, as a share of what it has without its texture: so that a spark between
/// those points is not lost to light sampling.
const LEAST_GLOW: f32 = 1e-3;

/// The parts of a tracer as they come together.
pub(super) struct World {
    view: View,
    tracer: Tracer,
    sources: Sources,
    /// Sources but for those whose direct light is drawn in real time; `None` while there is none of these.
    baked_sources: Option<Sources>,
    shapes: u64,
}

impl World {
    pub(super) fn new(scene: &Scene, sound: &Sound, instances: &[usize], view: View) -> Self {
        let effects = view.effects;
        let surfaces: Vec<Surface> = scene.materials.iter().map(|material| Surface::new(material, effects)).collect();
        let of = |index: &usize| &scene.instances[*index];
        let needs = instances.iter().map(of).fold(Needs::default(), |needs, instance| {
            needs.and(surfaces[instance.material].needs(&scene.meshes[instance.mesh], view))
        });
        // What no surface in use looks up is not decoded.
        let mut textures: Vec<Option<Decoded>> = vec![None; scene.textures.len()];
        for reference in instances.iter().map(of).flat_map(|instance| surfaces[instance.material].textures()) {
            if sound.textures.get(reference.texture) == Some(&true) && textures[reference.texture].is_none() {
                textures[reference.texture] = Some(Decoded::new(&scene.textures[reference.texture]));
            }
        }
        let kernel = kernel_for(effects);
        let tracer = Tracer {
            traced_from_world: TracedFromWorld::default(),
            accel: Arc::new(Accel::new(&[])),
            triangles: Vec::new(),
            surface_of: Vec::new(),
            surfaces,
            textures,
            attributes: Attributes::new(needs),
            albedo_tables: None,
            emitter_of: Vec::new(),
            triangle_of: Vec::new(),
            lights: Sources::default().into_lights(),
            baked_lights: None,
            sky_radiance: Vec3::ZERO,
            extent: 0.0,
            receivers: Vec::new(),
            effects,
            kernel,
            known: OnceLock::new(),
        };
        Self { view, tracer, sources: Sources::default(), baked_sources: None, shapes: 0 }
    }

    pub(super) fn add_instance(&mut self, scene: &Scene, index: usize, has_lightmap: bool) {
        let instance: &Instance = &scene.instances[index];
        let mesh: &Mesh = &scene.meshes[instance.mesh];
        let placement = Placement::new(&instance.world_from_local);
        let tracer = &mut self.tracer;
        let first = tracer.triangles.len();
        let mut vertices = Vec::new();
        for [a, b, c] in mesh.triangles() {
            let Some(shape) = placement.triangle([a, b, c].map(|vertex| mesh.positions[vertex as usize])) else {
                continue;
            };
            tracer.triangles.push(shape);
            vertices.push(if placement.is_mirrored() { [a, c, b] } else { [a, b, c] });
        }
        let needs = tracer.surfaces[instance.material].needs(mesh, self.view);
        tracer.attributes.add(mesh, &placement, &vertices, needs);
        let count = tracer.triangles.len() - first;
        tracer.surface_of.extend(std::iter::repeat_n(instance.material as u32, count));
        if has_lightmap {
            let normals = match &mesh.normals {
                Some(normals) => normals.iter().map(|&normal| placement.normal(normal)).collect(),
                None => vec![Vec3::ZERO; mesh.positions.len()],
            };
            tracer.receivers.push(Receiver { instance: index, first_triangle: first as u32, vertices, normals });
        }
    }

    /// Moves all triangles from the world to the frame in which they are traced, once all instances are there.
    pub(super) fn move_to_traced_frame(&mut self) {
        let tracer = &mut self.tracer;
        let vertices = tracer.triangles.iter().flat_map(|triangle| triangle.vertices);
        let traced_from_world = TracedFromWorld::around(vertices);
        for triangle in &mut tracer.triangles {
            *triangle = triangle.moved(traced_from_world);
        }
        tracer.traced_from_world = traced_from_world;
    }

    /// Makes every glowing triangle a source, once all instances are there; two in a row that make a plain rectangle
    /// become one.
    pub(super) fn add_emitters(&mut self) {
        let count = self.tracer.triangles.len();
        self.tracer.emitter_of = vec![NOT_EMISSIVE; count];
        let mut index = 0;
        while index < count {
            let surface = self.tracer.surface(index as u32);
            if surface.emitted_radiance == Vec3::ZERO {
                index += 1;
                continue;
            }
            let shape = &self.tracer.triangles[index];
            let mut emitter = Emitter::triangle(shape, surface.emitted_radiance, surface.double_sided);
            let is_plain = surface.emission_texture.is_none() && !surface.passes;
            let next = self.tracer.triangles.get(index + 1);
            let next = next.filter(|_| is_plain && self.tracer.surface_of[index] == self.tracer.surface_of[index + 1]);
            let rectangle = next.and_then(|next| rectangle_of(shape, next));
            if let Some((corner, edges)) = rectangle {
                emitter.shape = EmitterShape::Rectangle { corner, edges };
            }
            if !is_plain {
                emitter.mean_strength = self.mean_glow(index as u32);
            }
            let number = self.sources.add_emitter(emitter);
            let covered = if rectangle.is_some() { 2 } else { 1 };
            self.tracer.emitter_of[index..index + covered].fill(number);
            self.tracer.triangle_of.push(index as u32);
            self.shapes += 1;
            index += covered;
        }
    }

    /// Begins to keep those sources apart whose direct light lightmaps hold. Glowing surfaces must be there already.
    pub(super) fn part_baked_sources(&mut self) {
        self.baked_sources = Some(self.sources.clone());
    }

    pub(super) fn add_light(&mut self, light: &Light, is_drawn: bool) {
        self.sources.add_light(light, self.tracer.traced_from_world);
        if let Some(baked) = self.baked_sources.as_mut().filter(|_| !is_drawn) {
            baked.add_light(light, self.tracer.traced_from_world);
        }
        if let Light::Rect(_) = light {
            self.shapes += 1;
        }
    }

    pub(super) fn set_environment(&mut self, map: &EnvironmentMap) {
        self.sources.set_environment(map);
        if let Some(baked) = &mut self.baked_sources {
            baked.set_environment(map);
        }
    }

    /// Shapes that glow.
    pub(super) fn shape_count(&self) -> u64 {
        self.shapes
    }

    /// The tracer; takes the tree of another of the same scene where there is one, and its tables.
    pub(super) fn into_tracer(self, sky_radiance: Vec3, other: Option<&Tracer>) -> Tracer {
        let mut tracer = self.tracer;
        tracer.accel = match other {
            Some(other) => Arc::clone(&other.accel),
            None => {
                let corners: Vec<[Vec3; 3]> = tracer.triangles.iter().map(|triangle| triangle.vertices).collect();
                Arc::new(Accel::new(&corners))
            }
        };
        if tracer.kernel & LAYERED != 0 {
            let tables = other.and_then(|other| other.albedo_tables.clone());
            tracer.albedo_tables = Some(tables.unwrap_or_else(|| Arc::new(AlbedoTables::new())));
        }
        let vertices = tracer.triangles.iter().flat_map(|triangle| triangle.vertices);
        let bounds = vertices.fold(None, |bounds: Option<(Vec3, Vec3)>, vertex| {
            Some(bounds.map_or((vertex, vertex), |(low, high)| (low.min(vertex), high.max(vertex))))
        });
        tracer.extent = bounds.map_or(0.0, |(low, high)| (high - low).length());
        tracer.lights = self.sources.into_lights();
        tracer.baked_lights = self.baked_sources.map(Sources::into_lights);
        tracer.triangle_of.resize(tracer.lights.emitter_count(), NO_TRIANGLE);
        tracer.sky_radiance = sky_radiance;
        tracer
    }

    /// Mean radiance of a glowing triangle with its texture, where it is there [cd/m²].
    fn mean_glow(&self, triangle: u32) -> Vec3 {
        let tracer = &self.tracer;
        let surface = tracer.surface(triangle);
        let point = |index| {
            let [u, v, ..] = Sobol::new(0, index).draw(Dimensions::Start);
            square_to_triangle(Vec2::new(u, v)).to_array()
        };
        let glow = |index| {
            let place = Place { triangle, barycentric: point(index) };
            let is_there = match surface.passes {
                true => tracer.passage::<{ TEXTURED | PASSING }>(surface, place, Vec3::Y).glow,
                false => 1.0,
            };
            is_there * tracer.glow::<TEXTURED>(surface, place)
        };
        let mean = (0..GLOW_POINTS).map(glow).sum::<Vec3>() / GLOW_POINTS as f32;
        mean.max(surface.emitted_radiance * LEAST_GLOW)
    }
}

/// The rectangle that two triangles make, by a corner and the edges from it; `None` if they make none.
fn rectangle_of(first: &TriangleShape, second: &TriangleShape) -> Option<(Vec3, [Vec3; 2])> {
    // Vertices are compared exactly: a shared one was computed twice in the same way.
    let lone = |of: &TriangleShape, other: &TriangleShape| {
        let mut lone = (0..3).filter(|&corner| !other.vertices.contains(&of.vertices[corner]));
        let corner = lone.next()?;
        lone.next().is_none().then_some(corner)
    };
    let corner = lone(first, second)?;
    let opposite = second.vertices[lone(second, first)?];
    let origin = first.vertices[corner];
    let [u, v] = [1, 2].map(|step| first.vertices[(corner + step) % 3] - origin);
    let size = u.length().min(v.length());
    // Off by as much as points on it are; what the world's f32 has bent by more is no rectangle, and to aim at one
    // would miss what rays meet.
    let slack = 16.0 * (first.error + second.error).max_element() + 1e-6 * size;
    let is_parallelogram = (origin + u + v - opposite).length() <= slack;
    let is_right_angled = u.dot(v).abs() <= slack * size;
    let is_one_sided = first.normal.dot(second.normal) > 0.0;
    (is_parallelogram && is_right_angled && is_one_sided).then_some((origin, [u, v]))
}
