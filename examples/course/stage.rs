//! Builds the course's scenes: quads, spheres with smooth normals, upright blocks. Knows nothing of rays.

use bevy_kiln::artefact::StableId;
use bevy_kiln::scene::{Indices, Instance, Light, Material, Mesh, Scene, Texture};
use glam::{Affine3A, Quat, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Steps of a sphere from pole to pole; twice as many around.
const SPHERE_STEPS: u32 = 48;

/// A scene that takes one thing after the other.
#[derive(Default)]
pub struct Stage {
    scene: Scene,
    /// The mesh that all spheres share.
    sphere: Option<usize>,
}

impl Stage {
    /// Adds a rectangle from a corner along two edges; its front is the side of `u` × `v`.
    pub fn quad(self, name: &str, corner: Vec3, [u, v]: [Vec3; 2], material: Material) -> Self {
        let mesh = Mesh {
            name: name.into(),
            indices: Indices::U32(vec![0, 1, 2, 0, 2, 3]),
            positions: vec![corner, corner + u, corner + u + v, corner + v],
            normals: Some(vec![u.cross(v).normalize(); 4]),
            uv0: Some(vec![Vec2::Y, Vec2::ONE, Vec2::X, Vec2::ZERO]),
            ..Mesh::default()
        };
        self.mesh(name, mesh, material)
    }

    /// Adds a mesh that stands in world space.
    pub fn mesh(mut self, name: &str, mesh: Mesh, material: Material) -> Self {
        self.scene.meshes.push(mesh);
        let mesh = self.scene.meshes.len() - 1;
        self.place(name, mesh, Affine3A::IDENTITY, material)
    }

    /// Adds a sphere.
    pub fn sphere(mut self, name: &str, centre: Vec3, radius: f32, material: Material) -> Self {
        let mesh = *self.sphere.get_or_insert_with(|| {
            self.scene.meshes.push(unit_sphere());
            self.scene.meshes.len() - 1
        });
        let world_from_local = Affine3A::from_scale_rotation_translation(Vec3::splat(radius), Quat::IDENTITY, centre);
        self.place(name, mesh, world_from_local, material)
    }

    /// Adds a block without a bottom that stands on y = 0 over four corners (x, z).
    pub fn block(mut self, name: &str, base: [Vec2; 4], height: f32, material: &Material) -> Self {
        let [a, b, c, d] = base.map(|corner| Vec3::new(corner.x, 0.0, corner.y));
        let up = Vec3::Y * height;
        for (side, [from, to]) in [[a, b], [b, c], [c, d], [d, a]].into_iter().enumerate() {
            self = self.quad(&format!("{name} {side}"), from, [to - from, up], material.clone());
        }
        let mesh = Mesh {
            indices: Indices::U32(vec![0, 1, 2, 0, 2, 3]),
            positions: [a, b, c, d].map(|corner| corner + up).to_vec(),
            ..Mesh::default()
        };
        self.mesh(&format!("{name} top"), mesh, material.clone())
    }

    /// Adds the inside of the box between two corners.
    pub fn room(mut self, low: Vec3, high: Vec3, material: &Material) -> Self {
        let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| axis * (high - low));
        let sides =
            [(low, [y, z]), (low + x, [z, y]), (low, [z, x]), (low + y, [x, z]), (low, [x, y]), (low + z, [y, x])];
        for (side, (corner, edges)) in sides.into_iter().enumerate() {
            self = self.quad(&format!("side {side}"), corner, edges, material.clone());
        }
        self
    }

    /// Adds a light that is no mesh.
    pub fn light(mut self, light: Light) -> Self {
        self.scene.lights.push(light);
        self
    }

    /// Adds a picture that materials refer to by its number, counted from 0.
    pub fn texture(mut self, texture: Texture) -> Self {
        self.scene.textures.push(texture);
        self
    }

    /// Puts everything under a sky that is the same in every direction.
    pub fn sky(mut self, radiance: f32) -> Self {
        self.scene.sky_radiance = Vec3::splat(radiance);
        self
    }

    /// The scene, which must be sound.
    pub fn build(self) -> Scene {
        assert!(self.scene.validate().is_empty(), "{:?}", self.scene.validate());
        self.scene
    }

    fn place(mut self, name: &str, mesh: usize, world_from_local: Affine3A, material: Material) -> Self {
        self.scene.instances.push(Instance {
            id: StableId::new(name),
            name: name.into(),
            mesh,
            material: self.scene.materials.len(),
            world_from_local,
            lightmap: None,
        });
        self.scene.materials.push(material);
        self
    }
}

/// A sphere of radius 1 around the origin by longitude and latitude, with smooth normals.
fn unit_sphere() -> Mesh {
    let around = 2 * SPHERE_STEPS;
    let (mut positions, mut uv0, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for row in 0..=SPHERE_STEPS {
        for column in 0..=around {
            let uv = Vec2::new(column as f32 / around as f32, row as f32 / SPHERE_STEPS as f32);
            let (sin_theta, cos_theta) = (uv.y * PI).sin_cos();
            let (sin_phi, cos_phi) = (uv.x * TAU).sin_cos();
            positions.push(Vec3::new(sin_theta * sin_phi, cos_theta, sin_theta * cos_phi).normalize());
            uv0.push(uv);
        }
    }
    for row in 0..SPHERE_STEPS {
        for column in 0..around {
            let above = row * (around + 1) + column;
            let below = above + around + 1;
            // At a pole one of the two triangles has no area.
            if row > 0 {
                indices.extend([above, below, above + 1]);
            }
            if row + 1 < SPHERE_STEPS {
                indices.extend([above + 1, below, below + 1]);
            }
        }
    }
    Mesh {
        name: "sphere".into(),
        indices: Indices::U32(indices),
        normals: Some(positions.clone()),
        positions,
        uv0: Some(uv0),
        ..Mesh::default()
    }
}
