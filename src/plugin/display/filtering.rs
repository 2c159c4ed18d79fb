//! How texels are filtered on the screen, for all lightmaps that the plugin puts on. What was on an entity without it,
//! such as a lightmap of the game's own, keeps its own filtering and gets it back.

use super::attach::refilter;
use bevy::pbr::Lightmap;
use bevy::prelude::*;

/// How the texels of lightmaps are filtered. Both kinds of bake hold for either; nothing need be baked again.
///
/// A change shows after a few frames: Bevy 0.19 does not notice it on an entity that has its lightmap already
/// (bevy#20299), so all lightmaps are taken off for three frames and put on again, and during those frames the world
/// is lit by what was not baked. Best chosen before the level is shown.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub enum LightmapFiltering {
    /// Linear between the four nearest texels: sharper and cheaper.
    #[default]
    Bilinear,
    /// A cubic B-spline over 4 × 4 texels, by four bilinear lookups: rounder where texels are large on the screen.
    Bicubic,
}

impl LightmapFiltering {
    /// What a world asks for.
    pub(super) fn of(world: &World) -> Self {
        world.get_resource::<Self>().copied().unwrap_or_default()
    }

    /// A lightmap with this filtering.
    pub(super) fn apply(self, lightmap: Lightmap) -> Lightmap {
        Lightmap { bicubic_sampling: self == Self::Bicubic, ..lightmap }
    }
}

/// Who says how a lightmap is filtered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FilteredBy {
    /// [`LightmapFiltering`].
    Plugin,
    /// The lightmap itself, which is not the plugin's.
    #[cfg(feature = "bake")]
    Itself,
}

/// On entities whose lightmap is filtered as [`LightmapFiltering`] says.
#[derive(Component, Clone, Copy, Debug)]
pub(super) struct FollowsFiltering;

/// Puts lightmaps on again when the resource has changed.
pub(super) fn follow_filtering(world: &mut World) {
    let filtering = LightmapFiltering::of(world);
    let mut following = world.query_filtered::<Entity, With<FollowsFiltering>>();
    let following: Vec<Entity> = following.iter(world).collect();
    for entity in following {
        let Ok(mut entity) = world.get_entity_mut(entity) else { continue };
        refilter(&mut entity, filtering);
    }
}
