//! Who lights what: how much of a light a bake holds, and what of it is left to real time. The four modes and their names
//! are those of Bevy's example `mixed_lighting`.

use bevy::prelude::*;

/// How much of a light goes into the lightmaps. On a light or on anything above it; the nearest holds.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub enum LightBaking {
    /// All of it, and it lights nothing in real time: what has no lightmap gets its light from an irradiance volume or
    /// not at all.
    Baked,
    /// All of it. In real time it lights what has no lightmap, as things that move. A `RectLight` cannot: Bevy 0.19 has no
    /// flag for it, so it is as `Baked`.
    #[default]
    MixedDirect,
    /// What surfaces send on of it. Its direct light is drawn in real time, on everything, with shadows from Bevy's own
    /// shadow maps.
    MixedIndirect,
    /// Nothing.
    RealTime,
}

impl LightBaking {
    /// The mode of a light.
    pub(crate) fn of(world: &World, light: Entity) -> Self {
        let mut next = Some(light);
        while let Some(entity) = next {
            if let Some(mode) = world.get::<Self>(entity) {
                return *mode;
            }
            next = world.get::<ChildOf>(entity).map(ChildOf::parent);
        }
        Self::default()
    }
}
