//! Error targets against long references (`tests/data/README.md`): whether 95 % intervals hold the truth in 95 of 100
//! cases, and whether texels that are sampled until they are known well enough are.
//!
//! Each bake is repeated with other random numbers until the shares that are judged are known to a fraction of a
//! percent. The judge must reject who stops at the first small variance.

mod common;
#[path = "denoise/scenes.rs"]
#[allow(dead_code, reason = "the denoiser's tests use the rest")]
mod denoise_scenes;
#[path = "calibration/judge.rs"]
mod judge;
#[path = "calibration/reference.rs"]
mod reference;
#[path = "calibration/scenes.rs"]
mod scenes;

use bevy_kiln::bake::{BakeSettings, CancelToken, Denoise, Goal, Lightmap, bake_lightmap};
use bevy_kiln::trace::Transport;
use judge::{Calibration, Truth};
use scenes::Case;

fn bake(case: &Case, goal: Goal, seed: u64) -> Lightmap {
    let settings = BakeSettings {
        goal,
        layout: case.layout,
        density: case.density,
        transport: Transport { seed, ..Transport::default() },
        denoise: Denoise::Off,
        ..BakeSettings::default()
    };
    bake_lightmap(&case.scene, &settings, &(), &CancelToken::default()).unwrap()
}

/// What comes of a goal with several seeds.
fn calibration(case: &Case, goal: Goal, seeds: u64) -> Calibration {
    let truth = reference::load(case.name);
    let bakes: Vec<Truth> = (1..=seeds).map(|seed| Truth::new(&bake(case, goal, seed), &truth)).collect();
    Calibration::of(&bakes)
}

#[test]
#[ignore = "a table to read: minutes"]
fn table() {
    let only = std::env::var("ONLY").unwrap_or_default();
    for case in scenes::all().into_iter().filter(|case| case.name.contains(&only)) {
        for (goal, seeds) in [
            (Goal::Samples(64), 16),
            (Goal::Samples(256), 16),
            (Goal::Error(0.2), 16),
            (Goal::Error(0.1), 16),
            (Goal::Error(0.05), 8),
            (Goal::Error(0.02), 4),
        ] {
            println!("{} {goal:?}: {}", case.name, calibration(&case, goal, seeds));
        }
    }
}

#[test]
#[ignore = "makes the references: an hour"]
fn make_references() {
    let only = std::env::var("ONLY").unwrap_or_default();
    for case in scenes::all().into_iter().filter(|case| case.name.contains(&only)) {
        reference::make(&case);
    }
}
