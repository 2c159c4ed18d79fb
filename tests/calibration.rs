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
use reference::Known;
use scenes::Case;

/// Bakes with other random numbers each.
const SEEDS: u64 = 32;

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

/// Intervals of texels with so many paths each.
fn assert_intervals(case: &Case, samples: u32, seeds: u64) {
    let seen = calibration(case, Goal::Samples(samples), seeds);
    println!("{}, {samples} paths: {seen}", case.name);
    let faults = judge::faults_of_intervals(&seen);
    assert!(faults.is_empty(), "{}, {samples} paths: {faults:?}", case.name);
}

/// Texels that were sampled to an error.
fn assert_target(case: &Case, target: f64) {
    let seen = calibration(case, Goal::Error(target), SEEDS);
    println!("{}, to {target}: {seen}", case.name);
    let faults = judge::faults_of_target(&seen, target);
    assert!(faults.is_empty(), "{}, to {target}: {faults:?}", case.name);
}

fn assert_case(case: &Case, samples: u32) {
    assert_intervals(case, samples, SEEDS);
    assert_target(case, case.targets[0]);
}

#[test]
fn cornell_box() {
    assert_case(&scenes::cornell(), 256);
}

#[test]
fn room_in_the_sun() {
    assert_case(&scenes::sunlit(), 256);
}

#[test]
fn round_things_under_many_lamps() {
    assert_case(&scenes::lamps(), 256);
}

#[test]
fn garden_under_a_picture_of_the_sky() {
    assert_case(&scenes::garden(), 64);
}

#[test]
fn room_behind_a_slit() {
    assert_case(&scenes::slit(), 256);
}

/// The scenes that the variable ONLY names, or all.
fn chosen() -> impl Iterator<Item = Case> {
    let only = std::env::var("ONLY").unwrap_or_default();
    scenes::all().into_iter().filter(move |case| case.name.contains(&only))
}

/// More paths, and smaller errors.
#[test]
#[ignore = "half an hour of paths"]
fn all_targets() {
    for case in chosen() {
        // The garden's few texels are known as well as that only by twice the bakes.
        assert_intervals(&case, 512, 2 * SEEDS);
        case.targets[1..].iter().for_each(|&target| assert_target(&case, target));
    }
}

/// Who looks after 16, 32, 64 … paths at each texel's own spread and stops at the first that is small.
fn hasty(case: &Case, target: f64, seed: u64) -> Truth {
    let known = reference::load(case.name);
    let rounds: Vec<Lightmap> = (4..11).map(|power| bake(case, Goal::Samples(1 << power), seed)).collect();
    let last = &rounds[rounds.len() - 1];
    // All is grey in there, so that every channel is the luminance.
    let of_round = |round: &Lightmap, known: &Known| {
        let page = &round.pages[0];
        [f64::from(page.raw[known.texel].x), 1.96 * f64::from(page.stderr[known.texel].x)]
    };
    let goal = bake(case, Goal::Error(target), seed);
    Truth::new(&goal, &known).left_at(&known, |known| {
        let is_small = |&[value, half_width]: &[f64; 2]| half_width <= target * value.max(goal.report.intervals.floor);
        rounds.iter().map(|round| of_round(round, known)).find(is_small).unwrap_or_else(|| of_round(last, known))
    })
}

#[test]
fn stopping_at_the_first_small_variance_is_found_out() {
    let case = scenes::slit();
    let target = case.targets[0];
    let bakes: Vec<Truth> = (1..=4).map(|seed| hasty(&case, target, seed)).collect();
    let seen = Calibration::of(&bakes);
    println!("hasty: {seen}");
    let faults = judge::faults_of_target(&seen, target);
    assert!(faults.iter().any(|fault| fault.contains("covered")), "{faults:?}");
}

#[test]
#[ignore = "makes the references: an hour"]
fn make_references() {
    for case in chosen() {
        reference::make(&case);
    }
}
