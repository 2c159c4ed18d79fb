//! Baked global illumination for Bevy, inside the engine.

pub mod artefact;
#[cfg(feature = "bake")]
pub mod bake;
#[cfg(feature = "bake")]
pub mod output;
#[cfg(feature = "bake")]
pub mod scene;
#[cfg(feature = "bake")]
pub mod trace;
