//! Baked global illumination for Bevy, inside the engine: fire the scene in the kiln once, and the game displays the
//! result for free every frame.
//!
//! ```text
//!            Bevy world ──extract──▶ scene ──compile──▶ tracer ──gather──▶ lightmap ──encode──▶ folder
//!  plugin::baking                   scene              trace              bake                 output
//!                Bevy world ◀──────────────── plugin::display ◀──────────────── artefact (kiln.ron, KTX2)
//! ```
//!
//! | folder | owns |
//! |---|---|
//! | [`math`] | frames, maps from the unit square, solid angles, statistics, units |
//! | [`artefact`] | what a bake leaves behind, as plain data: the manifest, stable ids |
//! | `scene` | what exists: meshes, materials, lights, sky; every fault in them by name |
//! | `trace` | how light moves: rays, scattering, light sampling, paths |
//! | `bake` | what is measured: lightmaps, light meters, pictures; progress, plan and report |
//! | `study` | what accuracy costs in time: techniques, their error against a reference, their slope |
//! | `output` | encoders, and writing a whole folder safely |
//! | `plugin` | Bevy: components, extraction, the bake beside the running game, display |
//!
//! Each uses only those above it. Start at `plugin` for a game and at `bake` for the tracer alone.
//!
//! # Features
//!
//! | feature | brings |
//! |---|---|
//! | `bevy` (default) | components and the loader of a baked folder: all that a shipped game needs |
//! | `bake` (default) | the tracer, the baker and the encoders; without `bevy`, a library free of the engine |
//! | `study` | the page of a study as files, with its plots |
//! | `cli` | the `kiln` command: the plugin in an app without a window or a GPU |
//! | `window` | a window and Bevy's renderer, for the examples and the tests that draw |
//!
//! # Conventions
//!
//! Right-handed, Y up, metres, radians, linear Rec. 709. `wo` points back to where a path came from and `wi` is
//! sampled; both leave the surface. A pdf is per solid angle unless its name ends in `_area`. Names say the space
//! (`world_from_local`) and the quantity: radiance [cd/m²], irradiance [lx], intensity [cd], power [lm].
//! `irradiance` never means E/π; a lightmap texel holds E/π in cd/m², which Bevy multiplies by diffuse colour and by
//! the view's exposure, and by nothing else. Texture rows run from v = 0 downwards, as in glTF.

pub mod artefact;
#[cfg(feature = "bake")]
pub mod bake;
pub mod math;
#[cfg(feature = "bake")]
pub mod output;
#[cfg(feature = "bevy")]
pub mod plugin;
#[cfg(feature = "bake")]
pub mod scene;
#[cfg(feature = "bake")]
pub mod study;
#[cfg(feature = "bake")]
pub mod trace;

/// What an app needs by name: `use bevy_kiln::prelude::*`.
#[cfg(feature = "bevy")]
pub mod prelude {
    #[cfg(feature = "bake")]
    pub use crate::plugin::{
        AmbientMode, BakeFailed, BakeFinished, BakeGoal, BakeLightmaps, BakePlanned, BakeProgress, BakeScope,
        BakeStatus, BakeView, BakeVolumes, CancelBake, ClearLightmaps, EmissiveUnit, KilnControl, KilnOverlay,
        KilnOverlays, KilnShortcuts, LightBlocker, LightmapDensity, LightmapFormat, LightmapLayout, LightmapReceiver,
        NextBake, NotBaked, PauseBake, PlanBake, ProbeVolume, RangeWindow, ResumeBake, SceneSettings,
    };
    pub use crate::plugin::{
        BakedFolder, BakedLightmaps, BakedMaterialApp, BakedVolume, KilnId, KilnPlugin, KilnSystems, LightBaking,
        LightmapFiltering,
    };
    #[cfg(feature = "editor")]
    pub use crate::plugin::{KilnPanel, KilnSelect};
}

/// The README's code, so that it stays true.
#[cfg(all(doctest, feature = "bake", feature = "window"))]
#[doc = include_str!("../README.md")]
struct Readme;
