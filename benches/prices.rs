//! Whether a price is what is paid: the time that the survey says an error will take, and the time that tracing to it
//! then takes, by all cores. Prints a table; asserts nothing.
//!
//! `cargo bench --bench prices -- [SCENE]`

mod hall;

#[path = "../tests/calibration/scenes.rs"]
#[allow(dead_code, reason = "the calibration uses the rest")]
mod calibration_scenes;
#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/denoise/scenes.rs"]
#[allow(dead_code, reason = "the denoiser's tests use the rest")]
mod denoise_scenes;

use bevy_kiln::bake::{BakePlan, BakeSettings, CancelToken, Denoise, Goal, Layout, Progress, Stage, bake_lightmap};
use bevy_kiln::scene::Scene;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Errors that are priced, in the order of the plan's.
const ERRORS: [f64; 2] = [0.1, 0.05];

/// Size of maps that a scene's objects share [texels].
const SIZE: u32 = 128;

/// The time that tracing takes, without what comes before and after it.
fn tracing(scene: &Scene, settings: &BakeSettings) -> Duration {
    let ends: Mutex<Option<[Instant; 2]>> = Mutex::new(None);
    let hear = |progress: Progress| {
        if progress.stage == Stage::Gather {
            let now = Instant::now();
            let mut ends = ends.lock().unwrap();
            *ends = Some([ends.map_or(now, |[first, _]| first), now]);
        }
    };
    bake_lightmap(scene, settings, &hear, &CancelToken::default()).unwrap();
    let [first, last] = ends.into_inner().unwrap().unwrap();
    last - first
}

fn main() {
    let calibrated = calibration_scenes::all().map(|case| {
        let layout = if case.layout == Layout::Packed { Layout::Packed } else { Layout::Shared { size: SIZE } };
        // The garden takes no time to speak of where it is coarse.
        let finer = if case.name == "garden" { 16.0 } else { 2.0 };
        (case.name, case.scene, layout, finer * case.density)
    });
    let cases = calibrated.into_iter().chain([("hall", hall::hall(), Layout::Packed, 1.0)]);
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    println!("scene        error   predicted   real      predicted / real");
    for (name, scene, layout, density) in
        cases.filter(|case| words.is_empty() || words.iter().any(|word| word == case.0))
    {
        for error in ERRORS {
            let settings = BakeSettings {
                goal: Goal::Error(error),
                layout,
                density,
                denoise: Denoise::Off,
                ..BakeSettings::default()
            };
            let plan = BakePlan::for_scene(&scene, &settings, &(), &CancelToken::default()).unwrap();
            let predicted = plan.predicted.iter().find(|price| price.error == error).unwrap().seconds;
            let real = tracing(&scene, &settings).as_secs_f64();
            println!("{name:12} {:4.0} %  {predicted:8.2} s  {real:8.2} s  {:.2}", 100.0 * error, predicted / real);
        }
    }
}
