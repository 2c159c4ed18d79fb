//! Pictures that come in and go out: skies, textures, and what a file's format can hold.

mod files;
mod glows;
mod skies;
mod textures;

use crate::case::Case;
use crate::common::scenes::{SceneBuilder, grey};
use crate::things::level;
use bevy_kiln::scene::{EnvironmentMap, Scene};
use glam::{Quat, Vec3};

pub const CASES: &[&[Case]] = &[skies::CASES, glows::CASES, textures::CASES, files::CASES];

const SPREADS: &str = "one NaN that spreads over every texel that sees the sky";

/// A picture of the sky.
fn sky([width, height]: [u32; 2], radiance: impl Fn(u32, u32) -> f32) -> EnvironmentMap {
    let pixels = (0..width * height).map(|index| Vec3::splat(radiance(index % width, index / width)));
    EnvironmentMap { name: "sky".into(), width, height, radiance: pixels.collect(), world_from_map: Quat::IDENTITY }
}

/// A black square on the ground under a picture of the sky.
fn under_map(map: EnvironmentMap) -> Scene {
    let mut scene = level(SceneBuilder::default(), "ground", 0.0, [1.0, 1.0], grey(0.0)).build();
    scene.environment = Some(map);
    scene
}
