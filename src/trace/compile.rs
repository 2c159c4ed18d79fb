//! From a scene to a [`Tracer`]: faults left out, the rest in world space and in an order of its own.

use super::accel::Accel;
use super::light::{Emitter, EmitterShape, Sources};
use super::surface::{Placement, TriangleShape};
use super::tracer::{NOT_EMISSIVE, Receiver, Surface, Tracer};
use crate::scene::{Fault, Instance, Light, Material, Mesh, Scattering, Scene, Subject};
use glam::Vec3;
use std::collections::HashSet;

/// A compiled scene and what could not be part of it.
pub(crate) struct Compiled {
    pub(crate) tracer: Tracer,
    /// Faults of the scene; what they name is left out, or has no lightmap.
    pub(crate) faults: Vec<Fault>,
}

impl Compiled {
    /// Compiles what is sound in a scene.
    pub(crate) fn new(scene: &Scene) -> Self {
        let faults = scene.validate();
        let sound = Sound::new(scene, &faults);
        let surfaces = scene
            .materials
            .iter()
            .map(|material| Surface {
                diffuse_albedo: diffuse_albedo(material),
                emitted_radiance: material.emitted_radiance,
                double_sided: material.double_sided,
            })
            .collect();
        let mut world = World { surfaces, ..World::default() };
        let mut instances: Vec<usize> = (0..scene.instances.len()).filter(|&index| sound.instances[index]).collect();
        instances.sort_by(|&a, &b| scene.instances[a].id.cmp(&scene.instances[b].id));
        for index in instances {
            world.add_instance(scene, index, sound.lightmaps[index]);
        }
        let mut lights: Vec<&Light> =
            scene.lights.iter().zip(&sound.lights).filter(|(_, sound)| **sound).map(|(light, _)| light).collect();
        lights.sort_by(|a, b| a.id().cmp(b.id()));
        for light in lights {
            world.sources.add_light(light);
        }
        if let Some(map) = scene.environment.as_ref().filter(|_| sound.environment) {
            world.sources.set_environment(map);
        }
        let sky_radiance = if sound.sky { scene.sky_radiance } else { Vec3::ZERO };
        Self { tracer: world.into_tracer(sky_radiance), faults }
    }
}

impl Tracer {
    /// Compiles what is sound in a scene; [`Scene::validate`] tells what is not.
    pub fn new(scene: &Scene) -> Self {
        Compiled::new(scene).tracer
    }
}

/// Which parts of a scene can be used.
struct Sound {
    instances: Vec<bool>,
    /// Per instance, whether it asks for a lightmap and can have one.
    lightmaps: Vec<bool>,
    lights: Vec<bool>,
    sky: bool,
    environment: bool,
}

impl Sound {
    fn new(scene: &Scene, faults: &[Fault]) -> Self {
        let meshes: Vec<bool> = scene.meshes.iter().map(|mesh| mesh.faults().is_empty()).collect();
        let materials: Vec<bool> = scene.materials.iter().map(|material| material.faults().is_empty()).collect();
        let mut ids = HashSet::new();
        let mut instances = Vec::new();
        let mut lightmaps = Vec::new();
        for instance in &scene.instances {
            let kinds = scene.instance_faults(instance);
            let sound = ids.insert(&instance.id)
                && kinds.iter().all(crate::scene::FaultKind::costs_only_the_lightmap)
                && meshes.get(instance.mesh) == Some(&true)
                && materials.get(instance.material) == Some(&true);
            instances.push(sound);
            lightmaps.push(sound && instance.lightmap.is_some() && kinds.is_empty());
        }
        let mut ids = HashSet::new();
        let lights = scene.lights.iter().map(|light| ids.insert(light.id()) && light.faults().is_empty()).collect();
        let sky = !faults.iter().any(|fault| fault.subject == Subject::Sky);
        let environment = !faults.iter().any(|fault| matches!(fault.subject, Subject::Environment(_)));
        Self { instances, lightmaps, lights, sky, environment }
    }
}

fn diffuse_albedo(material: &Material) -> Vec3 {
    match &material.scattering {
        Scattering::None => Vec3::ZERO,
        _ => material.base_colour.truncate(),
    }
}

/// The parts of a tracer as they come together.
#[derive(Default)]
struct World {
    triangles: Vec<TriangleShape>,
    surface_of: Vec<u32>,
    surfaces: Vec<Surface>,
    emitter_of: Vec<u32>,
    sources: Sources,
    receivers: Vec<Receiver>,
}

impl World {
    fn add_instance(&mut self, scene: &Scene, index: usize, has_lightmap: bool) {
        let instance: &Instance = &scene.instances[index];
        let mesh: &Mesh = &scene.meshes[instance.mesh];
        let placement = Placement::new(&instance.world_from_local);
        let first = self.triangles.len();
        let mut vertices = Vec::new();
        for [a, b, c] in mesh.triangles() {
            let Some(shape) = placement.triangle([a, b, c].map(|vertex| mesh.positions[vertex as usize])) else {
                continue;
            };
            self.triangles.push(shape);
            vertices.push(if placement.is_mirrored() { [a, c, b] } else { [a, b, c] });
        }
        let count = self.triangles.len() - first;
        self.surface_of.extend(std::iter::repeat_n(instance.material as u32, count));
        self.emitter_of.extend(std::iter::repeat_n(NOT_EMISSIVE, count));
        if self.surfaces[instance.material].emitted_radiance != Vec3::ZERO {
            self.add_emitters(first, self.surfaces[instance.material]);
        }
        if has_lightmap {
            let normals = match &mesh.normals {
                Some(normals) => normals.iter().map(|&normal| placement.normal(normal)).collect(),
                None => vec![Vec3::ZERO; mesh.positions.len()],
            };
            self.receivers.push(Receiver { instance: index, first_triangle: first as u32, vertices, normals });
        }
    }

    /// Makes every triangle from `first` on a source; two in a row that make a rectangle become one.
    fn add_emitters(&mut self, first: usize, surface: Surface) {
        let mut index = first;
        while index < self.triangles.len() {
            let mut emitter = Emitter::triangle(&self.triangles[index], surface.emitted_radiance, surface.double_sided);
            let mut covered = 1;
            if let Some(next) = self.triangles.get(index + 1)
                && let Some((corner, edges)) = rectangle_of(&self.triangles[index], next)
            {
                emitter.shape = EmitterShape::Rectangle { corner, edges };
                covered = 2;
            }
            let number = self.sources.add_emitter(emitter);
            self.emitter_of[index..index + covered].fill(number);
            index += covered;
        }
    }

    fn into_tracer(self, sky_radiance: Vec3) -> Tracer {
        let corners: Vec<[Vec3; 3]> = self.triangles.iter().map(|triangle| triangle.vertices).collect();
        let bounds = corners.iter().flatten().fold(None, |bounds: Option<(Vec3, Vec3)>, &vertex| {
            Some(bounds.map_or((vertex, vertex), |(low, high)| (low.min(vertex), high.max(vertex))))
        });
        Tracer {
            accel: Accel::new(&corners),
            triangles: self.triangles,
            surface_of: self.surface_of,
            surfaces: self.surfaces,
            emitter_of: self.emitter_of,
            lights: self.sources.into_lights(),
            sky_radiance,
            extent: bounds.map_or(0.0, |(low, high)| (high - low).length()),
            receivers: self.receivers,
        }
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
    // Off by as much as f32 vertices must be; a hundredth of that would still show in no image.
    let slack = 16.0 * (first.error + second.error).max_element() + 1e-6 * size;
    let is_parallelogram = (origin + u + v - opposite).length() <= slack;
    let is_right_angled = u.dot(v).abs() <= slack * size;
    let is_one_sided = first.normal.dot(second.normal) > 0.0;
    (is_parallelogram && is_right_angled && is_one_sided).then_some((origin, [u, v]))
}
