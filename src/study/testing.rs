//! A scene for the tests of studies.

use super::{Effort, StudySettings};
use crate::artefact::StableId;
use crate::bake::BakeSettings;
use crate::scene::{Indices, Instance, LightmapRequest, Material, Mesh, Scene};
use glam::{Affine3A, Quat, Vec2, Vec3};
use std::f32::consts::FRAC_PI_2;

/// A closed grey box of 2 m with a lamp of 1 m under its ceiling.
pub(super) fn box_of_light() -> Scene {
    let square = Mesh {
        name: "square".into(),
        indices: Indices::U16(vec![0, 2, 1, 0, 3, 2]),
        positions: [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(|[x, z]| Vec3::new(x as f32, -1.0, z as f32)).to_vec(),
        uv1: Some(vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]),
        ..Mesh::default()
    };
    let lamp = Material { emitted_radiance: Vec3::splat(10.0), ..Material::diffuse("lamp", Vec3::ZERO) };
    let around = [0.0, 1.0, 2.0, 3.0].map(|turns| Quat::from_rotation_z(turns * FRAC_PI_2));
    let across = [-1.0, 1.0].map(|turns| Quat::from_rotation_x(turns * FRAC_PI_2));
    let side = |(index, rotation): (usize, Quat)| Instance {
        id: StableId::new(format!("side {index}")),
        name: format!("side {index}"),
        mesh: 0,
        material: 0,
        world_from_local: Affine3A::from_quat(rotation),
        lightmap: Some(LightmapRequest::default()),
    };
    let mut instances: Vec<Instance> = around.into_iter().chain(across).enumerate().map(side).collect();
    instances.push(Instance {
        id: StableId::new("lamp"),
        name: "lamp".into(),
        material: 1,
        world_from_local: Affine3A::from_scale_rotation_translation(
            Vec3::splat(0.5),
            Quat::from_rotation_z(2.0 * FRAC_PI_2),
            Vec3::new(0.0, 0.4, 0.0),
        ),
        lightmap: None,
        ..instances[0].clone()
    });
    Scene {
        meshes: vec![square],
        materials: vec![Material::diffuse("grey", Vec3::splat(0.5)), lamp],
        instances,
        ..Scene::default()
    }
}

/// Up to so many paths, at a few texels per metre.
pub(super) fn settings(paths: u32) -> StudySettings {
    StudySettings { bake: BakeSettings { density: 4.0, ..BakeSettings::default() }, effort: Effort::Paths(paths) }
}
