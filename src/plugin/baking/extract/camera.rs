//! `Camera3d` with its `Projection` into cameras.

use super::{Extraction, ExtractionWarning};
use crate::plugin::stable_id;
use crate::scene::Camera;
use bevy::math::Affine3A;
use bevy::prelude::*;

pub(super) fn extract(world: &mut World, out: &mut Extraction) {
    let mut query = world.query_filtered::<Entity, With<Camera3d>>();
    let found: Vec<Entity> = query.iter(world).collect();
    let world = &*world;
    let mut found: Vec<(String, Entity)> =
        found.into_iter().map(|entity| (stable_id(world, entity).as_str().to_owned(), entity)).collect();
    found.sort();
    for (id, entity) in found {
        let name = world.get::<Name>(entity).map_or(id, |name| name.as_str().to_owned());
        let Some(Projection::Perspective(projection)) = world.get::<Projection>(entity) else {
            out.warnings.push(ExtractionWarning::NoPerspective { name });
            continue;
        };
        let transform = world.get::<GlobalTransform>(entity).copied().unwrap_or_default();
        let (_, rotation, translation) = transform.to_scale_rotation_translation();
        out.scene.cameras.push(Camera {
            name,
            world_from_camera: Affine3A::from_rotation_translation(rotation, translation),
            vertical_fov: projection.fov,
        });
    }
}
