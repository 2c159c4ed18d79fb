//! Marks for what takes part in a bake.

use bevy::prelude::*;

/// What is on or below this entity gets a lightmap. Once anything in the scene has it, what is marked neither so
/// nor as a [`LightBlocker`] is left out of bakes, as a thing that moves should be. The nearest mark above a mesh
/// holds.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Transform, Visibility)]
pub struct LightmapReceiver {
    /// Texels per metre of its surface in the world; `None` for the bake's own.
    pub density: Option<f32>,
}

/// What is on or below this entity blocks and reflects light and gets no lightmap. The nearest mark above a mesh
/// holds. A skinned or morphed mesh takes part only where a mark asks for it, in the pose in which it stands.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Transform, Visibility)]
pub struct LightBlocker;
