//! Scenes by hand, whose light is known in closed form.

use bevy_kiln::artefact::StableId;
use bevy_kiln::scene::{
    Fault, FaultKind, Indices, Instance, Light, LightmapRequest, Material, Mesh, RectLight, Scene, Topology,
};
use glam::{Affine3A, Quat, Vec2, Vec3};

/// A scene that takes one mesh after the other.
#[derive(Default)]
pub struct SceneBuilder {
    scene: Scene,
}

impl SceneBuilder {
    /// Adds a rectangle from a corner along two edges; its front is the side of `edge_u` × `edge_v`.
    pub fn quad(self, name: &str, corner: Vec3, edges: [Vec3; 2], material: Material) -> Self {
        let [u, v] = edges;
        let positions = vec![corner, corner + u, corner + u + v, corner + v];
        let uv1 = vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        self.mesh(name, positions, vec![0, 1, 2, 0, 2, 3], Some(uv1), material)
    }

    /// Adds a mesh in world space.
    pub fn mesh(
        mut self,
        name: &str,
        positions: Vec<Vec3>,
        indices: Vec<u32>,
        uv1: Option<Vec<Vec2>>,
        material: Material,
    ) -> Self {
        self.scene.instances.push(Instance {
            id: StableId::new(name),
            name: name.into(),
            mesh: self.scene.meshes.len(),
            material: self.scene.materials.len(),
            world_from_local: Affine3A::IDENTITY,
            lightmap: uv1.is_some().then(LightmapRequest::default),
        });
        self.scene.materials.push(material);
        self.scene.meshes.push(Mesh {
            name: name.into(),
            topology: Topology::TriangleList,
            indices: Indices::U32(indices),
            positions,
            normals: None,
            uv1,
            ..Mesh::default()
        });
        self
    }

    /// Adds a mesh in world space that asks for a lightmap and has no UV1.
    pub fn receiver(self, name: &str, positions: Vec<Vec3>, indices: Vec<u32>, material: Material) -> Self {
        let mut builder = self.mesh(name, positions, indices, None, material);
        builder.scene.instances.last_mut().expect("just added").lightmap = Some(LightmapRequest::default());
        builder
    }

    /// Adds the inside of a box between two corners, each side with a material of its own: −x, +x, −y, +y, −z, +z.
    pub fn room(self, low: Vec3, high: Vec3, materials: [Material; 6]) -> Self {
        self.sides("", low, high, materials, true)
    }

    /// Adds another one, of one material, whose sides have names that begin with this one.
    pub fn chamber(self, name: &str, low: Vec3, high: Vec3, material: Material) -> Self {
        self.sides(name, low, high, [0; 6].map(|_| material.clone()), true)
    }

    /// Adds a solid block.
    pub fn block(self, name: &str, low: Vec3, high: Vec3, material: Material) -> Self {
        self.sides(name, low, high, [0; 6].map(|_| material.clone()), false)
    }

    fn sides(mut self, prefix: &str, low: Vec3, high: Vec3, materials: [Material; 6], faces_inwards: bool) -> Self {
        let size = high - low;
        let [x, y, z] = [Vec3::X * size, Vec3::Y * size, Vec3::Z * size];
        let sides = [
            ("-x", low, [y, z]),
            ("+x", low + x, [z, y]),
            ("-y", low, [z, x]),
            ("+y", low + y, [x, z]),
            ("-z", low, [x, y]),
            ("+z", low + z, [y, x]),
        ];
        for ((name, corner, [first, second]), material) in sides.into_iter().zip(materials) {
            let edges = if faces_inwards { [first, second] } else { [second, first] };
            self = self.quad(&format!("{prefix}{name}"), corner, edges, material);
        }
        self
    }

    /// Adds a rectangular light that blocks nothing, at `centre`, shining along `direction`.
    pub fn rect_light(mut self, name: &str, centre: Vec3, direction: Vec3, size: Vec2, radiance: Vec3) -> Self {
        let rotation = Quat::from_rotation_arc(Vec3::NEG_Z, direction.normalize());
        self.scene.lights.push(Light::Rect(RectLight {
            id: StableId::new(name),
            name: name.into(),
            world_from_local: Affine3A::from_rotation_translation(rotation, centre),
            width: size.x,
            height: size.y,
            radiance,
            range: None,
        }));
        self
    }

    /// Puts everything under a sky.
    pub fn sky(mut self, radiance: Vec3) -> Self {
        self.scene.sky_radiance = radiance;
        self
    }

    pub fn build(self) -> Scene {
        let is_solved = |fault: &Fault| fault.kind == FaultKind::MissingUv1;
        assert!(self.scene.validate().iter().all(is_solved), "{:?}", self.scene.validate());
        self.scene
    }

    /// A scene that has faults.
    pub fn unchecked(self) -> Scene {
        self.scene
    }
}

/// A grey that reflects and glows.
pub fn glowing(albedo: f32, radiance: f32) -> Material {
    Material {
        name: format!("albedo {albedo}, radiance {radiance}"),
        base_colour: Vec3::splat(albedo).extend(1.0),
        emitted_radiance: Vec3::splat(radiance),
        ..Material::default()
    }
}

/// A grey that only reflects.
pub fn grey(albedo: f32) -> Material {
    Material::diffuse(format!("albedo {albedo}"), Vec3::splat(albedo))
}

/// A closed cube of side 2 around the origin, every side of this albedo and radiance 1: E = π/(1 − ρ) everywhere.
pub fn furnace(albedo: f32) -> Scene {
    let side = || glowing(albedo, 1.0);
    SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, [side(), side(), side(), side(), side(), side()]).build()
}

/// A closed room in which every side has an albedo of its own and glows so that the radiance is `radiance` everywhere
/// and in every direction (Szirmay-Kalos 2001): Le = L·(1 − ρ), E = π·L.
pub fn generalised_furnace(radiance: f32) -> Scene {
    let side = |albedo: f32| glowing(albedo, radiance * (1.0 - albedo));
    let sides = [side(0.1), side(0.9), side(0.5), side(0.8), side(0.0), side(0.7)];
    SceneBuilder::default().room(Vec3::new(-1.0, 0.0, -2.0), Vec3::new(2.0, 1.0, 1.0), sides).build()
}

/// A closed white room, 4 m each way, lit by a rectangular light under its ceiling.
pub fn lit_room(albedo: f32, radiance: f32) -> Scene {
    let side = || grey(albedo);
    SceneBuilder::default()
        .room(Vec3::ZERO, Vec3::splat(4.0), [side(), side(), side(), side(), side(), side()])
        .rect_light("lamp", Vec3::new(2.0, 3.9, 2.0), Vec3::NEG_Y, Vec2::new(1.0, 0.5), Vec3::splat(radiance))
        .build()
}

/// The Cornell box's lamp (Cornell University's measured data, in units of 10 m), alone over a black floor.
pub fn cornell_lamp() -> Scene {
    let floor = [Vec3::Z * 559.2, Vec3::X * 552.8];
    let lamp = [Vec3::X * 130.0, Vec3::Z * 105.0];
    SceneBuilder::default()
        .quad("floor", Vec3::ZERO, floor, grey(0.0))
        .quad("lamp", Vec3::new(213.0, 548.8, 227.0), lamp, glowing(0.0, 1.0))
        .build()
}
