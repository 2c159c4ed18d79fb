//! The entity that a person looks at: chosen by a warning, framed on the screen.

use bevy::camera::primitives::Aabb;
use bevy::color::palettes::tailwind::AMBER_400;
use bevy::prelude::*;

/// An entity was chosen in the panel. An app with a selection of its own listens for this.
#[derive(Event, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Debug, PartialEq, Clone)]
pub struct KilnSelect {
    /// Which.
    pub entity: Entity,
}

/// The entity that is framed, if there is one.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KilnSelection(pub Option<Entity>);

pub(super) fn select(selected: On<KilnSelect>, mut selection: ResMut<KilnSelection>) {
    selection.0 = Some(selected.entity);
}

/// Draws the box of the selected entity; a small one around what has no extent, such as a light.
pub(super) fn frame(
    selection: Res<KilnSelection>,
    things: Query<(&GlobalTransform, Option<&Aabb>)>,
    mut gizmos: Gizmos,
) {
    let Some((place, extent)) = selection.0.and_then(|entity| things.get(entity).ok()) else { return };
    let (centre, size) = extent.map_or((Vec3::ZERO, Vec3::splat(0.2)), |extent| {
        (Vec3::from(extent.center), 2.0 * Vec3::from(extent.half_extents))
    });
    let frame = *place * Transform::from_translation(centre).with_scale(size);
    gizmos.cube(frame, AMBER_400);
}
