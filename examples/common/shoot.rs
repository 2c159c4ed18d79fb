//! A run without a person: bakes or opens a folder, waits until the lightmaps are on the screen, takes its picture,
//! ends.

use super::args::Args;
use super::bake::{Status, start};
use super::overlay::Overlay;
use bevy::pbr::Lightmap;
use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::time::Real;
use bevy::winit::{UpdateMode, WinitSettings};
use std::path::Path;
use std::time::Duration;

/// Frames from the last change of the world to the picture.
const FRAMES_TO_SETTLE: u32 = 12;

/// Without news for this many frames and this long [s], something hangs. Both, since a renderer on the processor
/// draws few frames and a fast one draws thousands while a file loads.
const PATIENCE_FRAMES: u32 = 100;
const PATIENCE_SECONDS: f32 = 120.0;

/// Between frames while the bake runs: nobody looks on, and where the processor draws, frames would slow the bake.
const PAUSE: Duration = Duration::from_millis(500);

/// How far the run is.
#[derive(Resource, Default)]
struct Run {
    step: Step,
    /// Frames since the last news.
    frames: u32,
    /// When that was [s].
    since: f32,
}

#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum Step {
    #[default]
    Open,
    Bake,
    Settle,
    Capture,
}

pub fn plugin(app: &mut App) {
    app.init_resource::<Run>().add_systems(Update, (proceed, pace, give_up).chain());
}

fn pace(run: Res<Run>, mut winit: ResMut<WinitSettings>) {
    let mode = match run.step {
        Step::Bake => UpdateMode::reactive_low_power(PAUSE),
        Step::Open | Step::Settle | Step::Capture => UpdateMode::Continuous,
    };
    *winit = WinitSettings { focused_mode: mode, unfocused_mode: mode };
}

fn proceed(
    mut run: ResMut<Run>,
    mut status: ResMut<Status>,
    args: Res<Args>,
    lightmaps: Query<(), With<Lightmap>>,
    mut overlay: Single<&mut Visibility, With<Overlay>>,
    mut commands: Commands,
) {
    run.frames += 1;
    let next = match (run.step, &*status) {
        (_, Status::Failed(sentence)) => return end(&args, &mut commands, Err(sentence.clone())),
        (Step::Open, Status::Worn { found, of, lightmaps: worn }) if found == of && lightmaps.count() >= *worn => {
            **overlay = Visibility::Hidden;
            Step::Settle
        }
        (Step::Open, Status::Dark) if args.folder.is_none() => {
            start(&args, &mut status, &mut commands);
            Step::Bake
        }
        (Step::Bake, Status::Lit(done)) if lightmaps.count() >= done.entities => {
            **overlay = Visibility::Hidden;
            Step::Settle
        }
        (Step::Settle, _) if run.frames >= FRAMES_TO_SETTLE => {
            commands.spawn(Screenshot::primary_window()).observe(captured);
            Step::Capture
        }
        _ => return,
    };
    run.step = next;
    run.frames = 0;
}

fn give_up(mut run: ResMut<Run>, args: Res<Args>, status: Res<Status>, time: Res<Time<Real>>, mut commands: Commands) {
    if run.frames == 0 || (run.step == Step::Bake && status.is_changed()) {
        (run.frames, run.since) = (0, time.elapsed_secs());
    }
    if run.frames > PATIENCE_FRAMES && time.elapsed_secs() - run.since > PATIENCE_SECONDS {
        let what = match run.step {
            Step::Open => "the scene does not load",
            Step::Bake => "the bake does not go on",
            Step::Settle | Step::Capture => "the window is not drawn",
        };
        end(&args, &mut commands, Err(format!("{what}; nothing has happened for {PATIENCE_SECONDS} s")));
    }
}

fn captured(captured: On<ScreenshotCaptured>, args: Res<Args>, mut commands: Commands) {
    let Some(path) = &args.screenshot else { return };
    end(&args, &mut commands, save(&captured.image, path));
}

fn save(image: &Image, path: &Path) -> Result<(), String> {
    let failed = |reason: String| format!("{} cannot be written ({reason}); choose another place", path.display());
    let picture = image.clone().try_into_dynamic().map_err(|error| failed(error.to_string()))?;
    // Alpha is no part of what a screen shows.
    picture.to_rgb8().save(path).map_err(|error| failed(error.to_string()))
}

fn end(args: &Args, commands: &mut Commands, result: Result<(), String>) {
    let exit = match result {
        Ok(()) => AppExit::Success,
        Err(sentence) => {
            eprintln!("{}: {sentence}", args.stage.name);
            AppExit::error()
        }
    };
    commands.write_message(exit);
}
