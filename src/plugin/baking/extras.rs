//! What an artist has written on things for the bake, as the marks of [`markers`](super::markers). A mark that the game
//! itself has put there counts.

use super::markers::{LightBlocker, LightmapDensity, LightmapReceiver, NotBaked, ProbeVolume};
use crate::plugin::display::KilnExtras;
use bevy::prelude::*;

/// Side of the box of an object of scale 1 [m]: Blender draws an Empty of the kind Cube from -1 to 1, and its first
/// cube is as large.
const BOX: f32 = 2.0;

/// Marks what has been read since the last frame.
pub(super) fn mark(mut commands: Commands, read: Query<(Entity, &KilnExtras), Added<KilnExtras>>) {
    for (entity, extras) in &read {
        let mut entity = commands.entity(entity);
        match (extras.receive, extras.block) {
            (Some(true), _) => _ = entity.insert_if_new(LightmapReceiver::default()),
            (_, Some(true)) => _ = entity.insert_if_new(LightBlocker),
            (Some(false), _) => _ = entity.insert_if_new(NotBaked),
            (None, _) => {}
        }
        if let Some(density) = extras.density {
            entity.insert_if_new(LightmapDensity(density));
        }
        if extras.volume == Some(true) {
            let size = Transform::from_scale(Vec3::splat(BOX));
            entity.with_child((Name::new("volume"), ProbeVolume::default(), size));
        }
    }
}
