//! Shapes and placements of triangles: thin, tiny, huge, doubled, cut, turned inside out, and what is no triangle.

mod coplanar;
mod cracks;
mod large;
mod leaks;
mod normals;
mod placed;
mod refused;
mod small;

use crate::case::{Case, Verdict};
use crate::judge::{SameRoom, baked};
use crate::worlds::room;
use bevy_kiln::bake::{BakeSettings, Goal};
use bevy_kiln::scene::Scene;
use glam::Vec3;

pub const CASES: &[&[Case]] = &[
    cracks::CASES,
    leaks::CASES,
    small::CASES,
    coplanar::CASES,
    large::CASES,
    normals::CASES,
    placed::CASES,
    refused::CASES,
];

/// Every texel of a bake, covered or not.
fn raw_texels(scene: &Scene) -> Result<Vec<Vec3>, String> {
    let settings = BakeSettings { goal: Goal::Samples(64), density: 3.3, ..BakeSettings::default() };
    let pages = baked(scene, &settings)?.pages;
    Ok(pages.iter().flat_map(|page| page.raw.clone()).collect())
}

/// The mean of red over texels [cd/m²].
fn mean(texels: &[Vec3]) -> f64 {
    texels.iter().map(|texel| f64::from(texel.x)).sum::<f64>() / texels.len() as f64
}

/// Whether a bake has the room's mean texel to 1e-3.
fn has_the_light_of_the_room(there: &Scene) -> Verdict {
    SameRoom { here: &room(), there, scale: 1.0, density: 3.3, tolerance: 1e-3 }.holds()
}
