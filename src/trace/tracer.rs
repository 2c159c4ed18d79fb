//! A scene compiled for rays.

use super::accel::Accel;
use super::light::Lights;
use super::surface::TriangleShape;
use glam::{DVec3, Vec3};

/// No emitter.
pub(super) const NOT_EMISSIVE: u32 = u32::MAX;

/// How a surface answers light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    pub(super) diffuse_albedo: Vec3,
    pub(super) emitted_radiance: Vec3,
    pub(super) double_sided: bool,
}

/// A scene compiled for rays. Independent of the order in which the scene lists its parts.
pub struct Tracer {
    pub(super) accel: Accel,
    pub(super) triangles: Vec<TriangleShape>,
    /// Per triangle, index into `surfaces`.
    pub(super) surface_of: Vec<u32>,
    pub(super) surfaces: Vec<Surface>,
    /// Per triangle, index into `lights` or [`NOT_EMISSIVE`].
    pub(super) emitter_of: Vec<u32>,
    pub(super) lights: Lights,
    pub(super) sky_radiance: Vec3,
    /// Length of the diagonal of the scene's bounds [m].
    pub(super) extent: f32,
    pub(super) receivers: Vec<Receiver>,
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
    /// The nearest surface that a ray from `origin` [m] in the unit `direction` meets, from either side.
    pub fn closest_hit(&self, origin: Vec3, direction: Vec3) -> Option<RayHit> {
        let hit = self.accel.closest(origin, direction, f32::INFINITY)?;
        Some(RayHit { distance: hit.t, normal: self.normal(hit.triangle) })
    }

    /// Whether no surface lies between two points [m].
    pub fn is_visible(&self, from: Vec3, to: Vec3) -> bool {
        !self.accel.is_blocked(from, to)
    }

    /// Objects that ask for a lightmap and can have one, ordered by id.
    pub(crate) fn receivers(&self) -> &[Receiver] {
        &self.receivers
    }

    /// Whether anything gives light.
    pub(crate) fn has_light(&self) -> bool {
        !self.lights.is_empty() || self.sky_radiance != Vec3::ZERO
    }

    /// Radiance of the sky [cd/m²].
    pub(crate) fn sky_radiance(&self) -> Vec3 {
        self.sky_radiance
    }

    /// Triangles in the world.
    pub(crate) fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Glowing shapes.
    pub(crate) fn emitter_count(&self) -> usize {
        self.lights.emitter_count()
    }

    /// Diffuse albedo of a triangle.
    pub(crate) fn diffuse_albedo(&self, triangle: u32) -> Vec3 {
        self.surfaces[self.surface_of[triangle as usize] as usize].diffuse_albedo
    }

    /// World vertices of a triangle, counter-clockwise seen from its front [m].
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
}
