//! Whether a price is what is paid: the time that the survey says an error will take, and the time that tracing to it
//! then takes, by all cores. Prints a table; asserts nothing.

mod hall;

#[path = "../tests/common/glb.rs"]
mod glb;
#[path = "../tests/common/scenes.rs"]
#[allow(dead_code, reason = "the tests use the rest")]
mod scenes;

use bevy_kiln::bake::{BakePlan, BakeSettings, CancelToken, Denoise, Goal, Layout, Progress, Stage, bake_lightmap};
use bevy_kiln::scene::Scene;
use glam::Vec3;
use scenes::{SceneBuilder, furnace, grey};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Errors that are priced, in the order of the plan's.
const ERRORS: [f64; 2] = [0.1, 0.05];

/// A grey room under a bright sky that enters by a slit in one wall.
fn slit() -> Scene {
    let (x, y, z) = (Vec3::X * 2.0, Vec3::Y * 2.0, Vec3::Z * 2.0);
    SceneBuilder::default()
        .quad("floor", Vec3::ZERO, [z, x], grey(0.6))
        .quad("ceiling", y, [x, z], grey(0.6))
        .quad("back", Vec3::ZERO, [x, y], grey(0.6))
        .quad("left", Vec3::ZERO, [y, z], grey(0.6))
        .quad("right", x, [z, y], grey(0.6))
        .quad("front low", z, [y * 0.6, x], grey(0.6))
        .quad("front high", z + y * 0.9, [y * 0.1, x], grey(0.6))
        .sky(Vec3::splat(10.0))
        .build()
}

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
    let cases: [(&str, Scene, Layout, f32); 5] = [
        ("cornell", glb::load("cornell"), Layout::Shared { size: 128 }, 1.0),
        ("furnace 0.9", furnace(0.9), Layout::Packed, 24.0),
        ("slit", slit(), Layout::Packed, 6.0),
        ("hall", hall::hall(), Layout::Packed, 1.0),
        ("punctual", glb::load("punctual"), Layout::Shared { size: 128 }, 1.0),
    ];
    println!("scene        error   predicted   real      predicted / real");
    for (name, scene, layout, density) in cases {
        for error in ERRORS {
            let settings = BakeSettings {
                goal: Goal::Error(error),
                layout,
                density,
                denoise: Denoise::Off,
                ..BakeSettings::default()
            };
            let plan = BakePlan::for_scene(&scene, &settings).unwrap();
            let predicted = plan.predicted.iter().find(|price| price.error == error).unwrap().seconds;
            let real = tracing(&scene, &settings).as_secs_f64();
            println!("{name:12} {:4.0} %  {predicted:8.2} s  {real:8.2} s  {:.2}", 100.0 * error, predicted / real);
        }
    }
}
