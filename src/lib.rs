//! Baked global illumination for Bevy, inside the engine.

pub mod artefact;
#[cfg(feature = "bake")]
pub mod bake;
pub mod math;
#[cfg(feature = "bake")]
pub mod output;
#[cfg(feature = "bake")]
pub mod scene;
#[cfg(feature = "bake")]
pub mod trace;
#[cfg(feature = "bevy")]
pub mod plugin;

/// What an app needs by name: `use bevy_kiln::prelude::*`.
#[cfg(feature = "bevy")]
pub mod prelude {
    pub use crate::plugin::{BakedFolder, BakedLightmaps, KilnId, KilnPlugin, KilnSystems};
    #[cfg(feature = "bake")]
    pub use crate::plugin::{
        AmbientMode, BakeFailed, BakeFinished, BakeLightmaps, BakeProgress, CancelBake, ClearLightmaps, EmissiveUnit,
        LightBlocker, LightmapFormat, LightmapLayout, LightmapReceiver, RangeWindow, SceneSettings,
    };
}
