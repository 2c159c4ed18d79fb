//! Boxes that are placed for irradiance volumes.

use super::{Extraction, is_on_layers, is_visible};
use crate::bake::VolumeBox;
use crate::plugin::baking::markers::ProbeVolume;
use crate::plugin::baking::settings::SceneSettings;
use crate::plugin::stable_id;
use crate::scene::unique_ids;
use bevy::prelude::*;

/// Reads them, in the order of their ids.
pub(super) fn extract(world: &mut World, settings: &SceneSettings, out: &mut Extraction) {
    let mut placed = world.query::<(Entity, &ProbeVolume, &GlobalTransform)>();
    let placed: Vec<(Entity, ProbeVolume, GlobalTransform)> =
        placed.iter(world).map(|(entity, volume, transform)| (entity, *volume, *transform)).collect();
    let world = &*world;
    let seen =
        placed.into_iter().filter(|&(entity, ..)| is_visible(world, entity) && is_on_layers(world, entity, settings));
    let mut boxes: Vec<VolumeBox> = seen
        .map(|(entity, volume, transform)| {
            let (size, rotation, centre) = transform.to_scale_rotation_translation();
            VolumeBox { id: stable_id(world, entity), centre, rotation, size: size.abs(), spacing: volume.spacing }
        })
        .collect();
    boxes.sort_by(|a, b| {
        (&a.id, a.centre.to_array().map(f32::to_bits)).cmp(&(&b.id, b.centre.to_array().map(f32::to_bits)))
    });
    let ids = unique_ids(boxes.iter().map(|of| of.id.clone()));
    for (of, id) in boxes.iter_mut().zip(ids) {
        of.id = id;
    }
    out.volumes = boxes;
}
