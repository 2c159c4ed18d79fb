//! Marks for what takes part in a bake.

use bevy::prelude::*;

/// What is on or below this entity gets a lightmap. Once anything in the scene has it, what is marked neither so
/// nor as a [`LightBlocker`] is left out of bakes, as a thing that moves should be. The nearest mark above a mesh
/// holds.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Transform, Visibility)]
pub struct LightmapReceiver {
    /// Texels per metre of its surface in the world; `None` for that of the nearest [`LightmapDensity`], or else for
    /// the bake's own.
    pub density: Option<f32>,
}

/// What is on or below this entity blocks and reflects light and gets no lightmap. The nearest mark above a mesh
/// holds. A skinned or morphed mesh takes part only where a mark asks for it, in the pose in which it stands.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Transform, Visibility)]
pub struct LightBlocker;

/// What is on or below this entity takes no part in bakes, as a thing that moves should not. The nearest mark above a
/// mesh holds.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Transform, Visibility)]
pub struct NotBaked;

/// Texels per metre of surface in the world, for what on or below this entity gets a lightmap. The nearest one holds.
/// Other than [`LightmapReceiver`] it says nothing of what takes part.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Debug, PartialEq, Clone)]
pub struct LightmapDensity(pub f32);

/// The box of an irradiance volume: a cube of side 1 under this entity's transform, so that its scale is the size of
/// the box [m]. Where any is placed, volumes are baked there and nowhere else. Of boxes that overlap the smallest
/// counts.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(Transform, Visibility)]
pub struct ProbeVolume {
    /// Side of a cell [m]; `None` for a 32nd of the longest side of the box, and 0.25 m at least.
    pub spacing: Option<f32>,
}
