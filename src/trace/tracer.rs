//! A scene compiled for rays.

use super::accel::{Accel, Hit};
use super::attributes::Attributes;
use super::bsdf::AlbedoTables;
use super::effects::{Effect, EffectSet};
use super::kernel::{LAYERED, PASSING, TEXTURED};
use super::known::KnownLight;
use super::light::Lights;
use super::material::Surface;
use super::shade::Place;
use super::surface::TriangleShape;
use super::texture::Decoded;
use super::traced::TracedFromWorld;
use super::transport::Transport;
use glam::{DVec3, Vec3};
use prefetch_index::prefetch_index;
use std::sync::{Arc, OnceLock};

/// No emitter.
pub(super) const NOT_EMISSIVE: u32 = u32::MAX;

/// No triangle.
pub(super) const NO_TRIANGLE: u32 = u32::MAX;

/// A scene compiled for rays. Independent of the order in which the scene lists its parts.
pub struct Tracer {
    /// All below lies in the traced frame.
    pub(super) traced_from_world: TracedFromWorld,
    pub(super) accel: Arc<Accel>,
    pub(super) triangles: Vec<TriangleShape>,
    /// Per triangle, index into `surfaces`.
    pub(super) surface_of: Vec<u32>,
    pub(super) surfaces: Vec<Surface>,
    /// Those that surfaces look up, by the scene's numbers.
    pub(super) textures: Vec<Option<Decoded>>,
    pub(super) attributes: Attributes,
    /// There if the kernel has layered surfaces.
    pub(super) albedo_tables: Option<Arc<AlbedoTables>>,
    /// Per triangle, index into `lights` or [`NOT_EMISSIVE`].
    pub(super) emitter_of: Vec<u32>,
    /// Per emitter, its (first) triangle or [`NO_TRIANGLE`].
    pub(super) triangle_of: Vec<u32>,
    pub(super) lights: Lights,
    /// Those whose direct light counts where paths start, with the same numbers for surfaces; `None` where it is that of
    /// all.
    pub(super) baked_lights: Option<Lights>,
    pub(super) sky_radiance: Vec3,
    /// Length of the diagonal of the scene's bounds [m].
    pub(super) extent: f32,
    pub(super) receivers: Vec<Receiver>,
    /// What is simulated.
    pub(super) effects: EffectSet,
    /// The kernel that does it.
    pub(super) kernel: u32,
    /// Light that paths need not look for.
    pub(super) known: OnceLock<KnownLight>,
}

/// What a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Distance from the ray's origin [m].
    pub distance: f32,
    /// Unit normal of the surface's front.
    pub normal: Vec3,
}

/// A placed mesh that asks for a lightmap.
#[derive(Clone, Debug)]
pub(crate) struct Receiver {
    /// Index into the scene's instances.
    pub(crate) instance: usize,
    /// World number of its first triangle.
    pub(crate) first_triangle: u32,
    /// Per triangle, the mesh's vertices in the order of its world triangle.
    pub(crate) vertices: Vec<[u32; 3]>,
    /// Per mesh vertex, the unit shading normal in the world, or zero where there is none.
    pub(crate) normals: Vec<Vec3>,
}

impl Tracer {
    /// The nearest surface that a ray from `origin` [m] in the unit `direction` meets, from either side. The origin may
    /// be any distance away; what the ray meets is then as sure as an f64 along its way, 2⁻⁵² of that distance.
    pub fn closest_hit(&self, origin: Vec3, direction: Vec3) -> Option<RayHit> {
        let hit = self.nearest(self.traced_from_world.point(origin), direction)?;
        Some(RayHit { distance: hit.t, normal: self.normal(hit.triangle) })
    }

    /// The nearest triangle that a ray meets, in the traced frame. What a path asks of it is on its way from memory.
    #[inline]
    pub(super) fn nearest(&self, origin: Vec3, direction: Vec3) -> Option<Hit> {
        self.accel.closest_telling(origin, direction, f32::INFINITY, |triangle| {
            self.triangles[triangle as usize].prefetch();
            prefetch_index(&self.surface_of, triangle as usize);
        })
    }

    /// Whether no surface lies between two points [m].
    pub fn is_visible(&self, from: Vec3, to: Vec3) -> bool {
        let [from, to] = [from, to].map(|point| self.traced_from_world.point(point));
        !self.accel.is_blocked(from, to)
    }

    /// What is simulated.
    pub(crate) fn effects(&self) -> EffectSet {
        self.effects
    }

    /// Bounces before a path is cut.
    pub(crate) fn max_bounces(&self, transport: &Transport) -> Option<u32> {
        if self.effects.has(Effect::Interreflection) { transport.max_bounces } else { Some(0) }
    }

    /// Whether every surface is Lambert's and blocks what it meets.
    pub(crate) fn is_diffuse(&self) -> bool {
        self.kernel & (LAYERED | PASSING) == 0
    }

    /// Objects that ask for a lightmap and can have one, ordered by id.
    pub(crate) fn receivers(&self) -> &[Receiver] {
        &self.receivers
    }

    /// Whether anything gives light.
    pub(crate) fn has_light(&self) -> bool {
        !self.lights.is_empty() || self.sky_radiance != Vec3::ZERO
    }

    /// Whether the direct light of any source is drawn in real time, so that lightmaps do without it.
    pub(crate) fn leaves_direct_light_to_others(&self) -> bool {
        self.baked_lights.is_some()
    }

    /// Triangles in the world.
    pub(crate) fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Albedo of a diffuse surface at these weights of a triangle's second and third vertex.
    pub(crate) fn diffuse_albedo(&self, triangle: u32, barycentric: [f32; 2]) -> Vec3 {
        let surface = self.surface(triangle);
        if self.kernel & TEXTURED == 0 {
            return self.albedo::<0>(surface, Place { triangle, barycentric });
        }
        self.albedo::<TEXTURED>(surface, Place { triangle, barycentric })
    }

    /// Vertices of a triangle in the traced frame, which is the world but for its origin; counter-clockwise seen from
    /// its front [m].
    pub(crate) fn vertices(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].vertices
    }

    /// Unit normal of a triangle's front.
    pub(crate) fn normal(&self, triangle: u32) -> Vec3 {
        self.triangles[triangle as usize].normal
    }

    /// Area of a triangle [m²].
    pub(crate) fn area(&self, triangle: u32) -> f64 {
        self.triangles[triangle as usize].area()
    }

    /// Flux that all sources give off, per channel [lm]; `None` under a sky, whose flux has no bound, and where a
    /// source's cannot be told.
    pub(crate) fn emitted_flux(&self) -> Option<DVec3> {
        if self.sky_radiance == Vec3::ZERO { self.lights.flux() } else { None }
    }

    /// Flux that all that is somewhere gives off, per channel [lm]; `None` where it cannot be told.
    pub(crate) fn area_light_flux(&self) -> Option<DVec3> {
        self.lights.flux()
    }

    /// Memory that it holds, as far as it grows with the scene [bytes].
    pub(crate) fn memory_bytes(&self) -> u64 {
        // A triangle with the numbers of its surface and its emitter.
        let triangles = (self.triangles.len() * (size_of::<TriangleShape>() + 8)) as u64 + self.accel.memory_bytes();
        let textures: u64 = self.textures.iter().flatten().map(Decoded::memory_bytes).sum();
        let known = self.known.get().map_or(0, KnownLight::memory_bytes);
        triangles + textures + self.attributes.memory_bytes() + known
    }
}
