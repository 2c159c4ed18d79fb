//! The sweeps' scenes. Lengths in metres, radiance in cd/m².

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::math::{combine, seed32};
use bevy_kiln::scene::{Indices, Instance, Light, LightmapRequest, Material, Mesh, Scene};
use glam::{Affine3A, DAffine3, DVec3, Quat, Vec2, Vec3};

/// Adds things to a scene that stand in the world through one transform.
#[derive(Default)]
pub struct Stage {
    scene: Scene,
}

impl Stage {
    /// Adds a rectangle from a corner along two edges, placed by `world`; its front is the side of `u` × `v`. Its UV1
    /// fills the unit square.
    pub fn quad(self, name: &str, world: Affine3A, corner: Vec3, edges: [Vec3; 2], material: Material) -> Self {
        let [u, v] = edges;
        let mesh = Mesh {
            name: name.into(),
            indices: Indices::U32(vec![0, 1, 2, 0, 2, 3]),
            positions: vec![corner, corner + u, corner + u + v, corner + v],
            uv1: Some(vec![Vec2::Y, Vec2::ONE, Vec2::X, Vec2::ZERO]),
            ..Mesh::default()
        };
        self.mesh(name, world, mesh, material)
    }

    /// Adds a mesh.
    pub fn mesh(mut self, name: &str, world_from_local: Affine3A, mesh: Mesh, material: Material) -> Self {
        self.scene.instances.push(Instance {
            id: StableId::new(name),
            name: name.into(),
            mesh: self.scene.meshes.len(),
            material: self.scene.materials.len(),
            world_from_local,
            lightmap: None,
        });
        self.scene.meshes.push(mesh);
        self.scene.materials.push(material);
        self
    }

    /// Lets the last thing ask for a lightmap.
    pub fn with_lightmap(mut self) -> Self {
        let last = self.scene.instances.last_mut().expect("something to bake");
        last.lightmap = Some(LightmapRequest::default());
        self
    }

    /// Adds a light.
    pub fn light(mut self, light: Light) -> Self {
        self.scene.lights.push(light);
        self
    }

    /// Puts everything under a sky of radiance 1.
    pub fn white_sky(mut self) -> Self {
        self.scene.sky_radiance = Vec3::ONE;
        self
    }

    /// The scene, which must be sound.
    pub fn build(self) -> Scene {
        assert_eq!(self.scene.validate(), []);
        self.scene
    }
}

/// A turn under which no face is parallel to an axis, so that every coordinate rounds.
pub fn askew() -> Quat {
    Quat::from_axis_angle(Vec3::new(0.3, 0.9, 0.4).normalize(), 0.7)
}

/// Corner and edges of the six sides of the cube from −½ to ½, fronts inwards.
pub fn cube_sides() -> [(Vec3, [Vec3; 2]); 6] {
    let ([x, y, z], low) = (Vec3::AXES, Vec3::splat(-0.5));
    [(low, [y, z]), (low + x, [z, y]), (low, [z, x]), (low + y, [x, z]), (low, [x, y]), (low + z, [y, x])]
}

/// A furnace: the inside of the cube from −½ to ½, placed by `world`, that reflects `albedo` and glows with 1. Every
/// point in it and on its walls receives π / (1 − albedo), whatever becomes of its shape in rounding.
pub fn furnace(world: Affine3A, albedo: f32) -> Scene {
    let material = Material { emitted_radiance: Vec3::ONE, ..Material::diffuse("wall", Vec3::splat(albedo)) };
    let corner = |index: usize| Vec3::new((index & 1) as f32, (index >> 1 & 1) as f32, (index >> 2) as f32) - 0.5;
    let index_of = |point: Vec3| (0..8_u32).find(|&index| corner(index as usize) == point).expect("a corner");
    let quads = cube_sides().map(|(low, [u, v])| [low, low + u, low + u + v, low + v].map(index_of));
    let mesh = Mesh {
        name: "cube".into(),
        indices: Indices::U32(quads.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect()),
        positions: (0..8).map(corner).collect(),
        ..Mesh::default()
    };
    Stage::default().mesh("furnace", world, mesh, material).build()
}

/// A number in [0, 1) that belongs to a key.
pub fn unit(key: u64) -> f64 {
    f64::from(seed32(key)) / 4_294_967_296.0
}

/// Points on the walls of the cube from −½ to ½, placed by `world`, as many on each; each rounded to `f32` once.
pub fn points_on_walls(world: DAffine3, per_wall: u64, seed: u64) -> Vec<MeterPoint> {
    let sides = cube_sides();
    let point = |index: u64| {
        let (corner, [u, v]) = sides[(index % 6) as usize];
        let [a, b] = [0, 1].map(|axis| unit(combine(combine(seed, index), axis)));
        let local = corner.as_dvec3() + u.as_dvec3() * a + v.as_dvec3() * b;
        let normal = world.transform_vector3(u.cross(v).as_dvec3()).normalize();
        MeterPoint { position: world.transform_point3(local).as_vec3(), normal: normal.as_vec3() }
    };
    (0..6 * per_wall).map(point).collect()
}

/// A transform in `f64`.
pub fn in_f64(world: Affine3A) -> DAffine3 {
    let axis = |axis: glam::Vec3A| Vec3::from(axis).as_dvec3();
    DAffine3::from_cols(
        axis(world.matrix3.x_axis),
        axis(world.matrix3.y_axis),
        axis(world.matrix3.z_axis),
        axis(world.translation),
    )
}

/// A point that faces a direction.
pub fn facing(position: DVec3, normal: Vec3) -> MeterPoint {
    MeterPoint { position: position.as_vec3(), normal }
}
