//! Irradiance volumes: held against closed forms, against the light meter as a second estimator, and against what Bevy's
//! shader makes of their texture.

#[path = "../common/mod.rs"]
mod common;
#[path = "../denoise/scenes.rs"]
#[allow(dead_code, reason = "one of its scenes is used")]
mod denoise_scenes;

mod accuracy;
mod closed_forms;
mod hard;
mod layout;
mod rooms;
mod walls;

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{
    CancelToken, Goal, LaterBounces, VolumeBake, VolumeBox, VolumeBoxes, VolumeSettings, bake_volumes,
};
use bevy_kiln::scene::Scene;
use glam::{Quat, Vec3};

/// A box along the world's axes.
fn along_axes(low: Vec3, high: Vec3, spacing: f32) -> VolumeBox {
    VolumeBox {
        id: StableId::new("box"),
        centre: 0.5 * (low + high),
        rotation: Quat::IDENTITY,
        size: high - low,
        spacing: Some(spacing),
    }
}

/// Whole paths, so that closed forms hold to their noise.
fn given(boxes: Vec<VolumeBox>, paths: u32) -> VolumeSettings {
    VolumeSettings {
        goal: Goal::Samples(paths),
        later_bounces: LaterBounces::Traced,
        boxes: VolumeBoxes::Given(boxes),
        ..VolumeSettings::default()
    }
}

fn bake(scene: &Scene, settings: &VolumeSettings) -> VolumeBake {
    bake_volumes(scene, settings, &(), &CancelToken::default()).unwrap()
}
