//! The same bits for any number of threads, any order of the work and of the scene's parts, and any processor.
//!
//! What is held here is equality to the last bit, so every difference counts: `fingerprint` looks at all numbers of a
//! result, `faults` shows that it rejects what a race or a dependence on order would do to them.

mod common;

#[path = "determinism/calls.rs"]
mod calls;
#[path = "determinism/faults.rs"]
mod faults;
#[path = "determinism/fingerprint.rs"]
mod fingerprint;
#[path = "determinism/held.rs"]
mod held;
#[path = "determinism/machines.rs"]
mod machines;
#[path = "determinism/order.rs"]
mod order;
#[path = "determinism/vitrine.rs"]
mod vitrine;

use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, Layout, Lightmap, Progress, bake_lightmap};
use bevy_kiln::scene::Scene;
use common::glb;
use fingerprint::Fingerprint;
use std::num::NonZeroUsize;

/// A bake on so many threads.
fn bake(scene: &Scene, threads: usize, layout: Layout) -> Lightmap {
    let settings = BakeSettings {
        goal: Goal::Samples(32),
        density: 3.0,
        layout,
        threads: NonZeroUsize::new(threads),
        ..BakeSettings::default()
    };
    bake_lightmap(scene, &settings, &(), &CancelToken::default()).unwrap()
}

#[test]
fn another_seed_gives_other_bits() {
    let scene = glb::load("furnace");
    let mut settings = BakeSettings { goal: Goal::Samples(16), density: 2.0, ..BakeSettings::default() };
    let first = bake_lightmap(&scene, &settings, &(), &CancelToken::default()).unwrap();
    settings.transport.seed = 1;
    let second = bake_lightmap(&scene, &settings, &(), &CancelToken::default()).unwrap();
    assert!(Fingerprint::of(&first).same(&Fingerprint::of(&second)).is_err());
}

#[test]
fn cancelled_in_the_middle() {
    let cancel = CancelToken::default();
    let progress = |progress: Progress| {
        if progress.done > 0 {
            cancel.cancel();
        }
    };
    let result = bake_lightmap(&glb::load("furnace"), &BakeSettings::default(), &progress, &cancel);
    assert!(matches!(result, Err(bevy_kiln::bake::BakeError::Cancelled)));
}
