//! A hall of about a quarter of a million triangles, made by arithmetic, for the benches: a cobbled floor, a vault,
//! two rows of fluted columns and two end walls. The long sides are open to the sky, and two lamps hang in it.
//!
//! Every surface is a grid over the unit square, which is also its UV1, so that it can be baked.

use bevy_kiln::artefact::StableId;
use bevy_kiln::math::combine;
use bevy_kiln::scene::{Indices, Instance, Light, LightmapRequest, Material, Mesh, RectLight, Scene, Topology};
use glam::{Affine3A, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

const WIDTH: f32 = 12.0;
const LENGTH: f32 = 48.0;
const HEIGHT: f32 = 7.0;
const COLUMNS_PER_SIDE: usize = 12;

/// The hall.
pub fn hall() -> Scene {
    let mut scene = Scene {
        materials: vec![
            Material::diffuse("stone", Vec3::new(0.55, 0.5, 0.42)),
            Material::diffuse("plaster", Vec3::new(0.75, 0.73, 0.7)),
        ],
        sky_radiance: Vec3::new(300.0, 380.0, 500.0),
        ..Scene::default()
    };
    let across = |u: f32| (u - 0.5) * WIDTH;
    let along = |v: f32| (v - 0.5) * LENGTH;
    add(&mut scene, "floor", 0, [160, 320], |u, v| Vec3::new(across(u), 0.03 * roughness(1, u, v), along(v)));
    add(&mut scene, "vault", 1, [320, 120], |u, v| {
        // Barrels across the hall, one per pair of columns; it faces down.
        let arch = (COLUMNS_PER_SIDE as f32 * PI * u).sin().abs() + 0.6 * (PI * v).sin();
        Vec3::new(across(v), HEIGHT + arch, along(u))
    });
    for end in [0.0, 1.0] {
        let side = if end == 0.0 { 1.0 } else { -1.0 };
        add(&mut scene, &format!("wall {end}"), 1, [32, 32], |u, v| {
            Vec3::new(side * across(1.0 - u), 9.0 * v, along(end) + 0.02 * roughness(2, u, v))
        });
    }
    for column in 0..2 * COLUMNS_PER_SIDE {
        let x = if column % 2 == 0 { -0.46 } else { 0.46 } * WIDTH;
        let z = along(((column / 2) as f32 + 0.5) / COLUMNS_PER_SIDE as f32);
        add(&mut scene, &format!("column {column}"), 0, [56, 24], |u, v| {
            let radius = 0.35 * (1.0 - 0.15 * v) * (1.0 + 0.06 * (16.0 * TAU * u).cos());
            let (sin, cos) = (-TAU * u).sin_cos();
            Vec3::new(x + radius * cos, HEIGHT * 1.1 * v, z + radius * sin)
        });
    }
    for (index, z) in [-0.25, 0.25].into_iter().enumerate() {
        let down = Affine3A::from_translation(Vec3::new(0.0, 5.0, z * LENGTH)) * Affine3A::from_rotation_x(-0.5 * PI);
        let name = format!("lamp {index}");
        let radiance = Vec3::new(9000.0, 7000.0, 4500.0);
        scene.lights.push(Light::Rect(RectLight {
            id: StableId::new(name.clone()),
            name,
            world_from_local: down,
            width: 1.5,
            height: 0.6,
            radiance,
            range: None,
        }));
    }
    scene
}

/// Adds a grid of quads of which `position` gives the point for u and v.
fn add(scene: &mut Scene, name: &str, material: usize, [columns, rows]: [u32; 2], position: impl Fn(f32, f32) -> Vec3) {
    let vertices = (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j)));
    let uv1: Vec<Vec2> = vertices.map(|(i, j)| Vec2::new(i as f32 / columns as f32, j as f32 / rows as f32)).collect();
    let quad = |i: u32, j: u32| {
        let a = j * (columns + 1) + i;
        let [b, c, d] = [a + 1, a + columns + 2, a + columns + 1];
        [a, c, b, a, d, c]
    };
    let indices = (0..rows).flat_map(|j| (0..columns).flat_map(move |i| quad(i, j))).collect();
    scene.instances.push(Instance {
        id: StableId::new(name),
        name: name.to_owned(),
        mesh: scene.meshes.len(),
        material,
        world_from_local: Affine3A::IDENTITY,
        lightmap: Some(LightmapRequest::default()),
    });
    scene.meshes.push(Mesh {
        name: name.to_owned(),
        topology: Topology::TriangleList,
        indices: Indices::U32(indices),
        positions: uv1.iter().map(|uv| position(uv.x, uv.y)).collect(),
        uv1: Some(uv1),
        ..Mesh::default()
    });
}

/// A rough surface: a number in [-1, 1] that belongs to the place.
fn roughness(seed: u64, u: f32, v: f32) -> f32 {
    let place = u64::from(u.to_bits()) << 32 | u64::from(v.to_bits());
    (combine(seed, place) >> 40) as f32 / 8_388_608.0 - 1.0
}
