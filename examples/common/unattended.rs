//! A run without a person, for examples that are too short to have one in them: with `--screenshot FILE.png` it presses
//! the keys that a person would, waits until lightmaps are on the screen, takes a picture of the window and ends.
//! Without that argument it does nothing.

use bevy::pbr::Lightmap;
use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use bevy::time::Real;
use bevy::world_serialization::WorldInstanceReady;
use std::path::PathBuf;

/// What is pressed once the scene is there.
#[derive(Clone, Copy, Debug)]
pub struct Unattended {
    /// What is set before.
    pub prepare: fn(&mut World),
    /// Keys, all in the same frame.
    pub keys: &'static [KeyCode],
    /// Whether there is more to wait for than what is on the screen.
    pub is_busy: fn(&World) -> bool,
}

/// From the last news to the picture: pipelines are compiled in the background, and where the processor draws, slowly.
const SECONDS_TO_SETTLE: f32 = 6.0;
const FRAMES_TO_SETTLE: u32 = 30;

/// Without lightmaps for so long [s], something hangs.
const PATIENCE: f32 = 400.0;

#[derive(Resource)]
struct Run {
    path: PathBuf,
    prepare: fn(&mut World),
    keys: &'static [KeyCode],
    is_busy: fn(&World) -> bool,
    is_there: bool,
    /// Lightmaps at the last look, frames since there were others, and when that was [s].
    shown: usize,
    frames: u32,
    since: f32,
    is_taken: bool,
}

impl Plugin for Unattended {
    fn build(&self, app: &mut App) {
        let mut words = std::env::args().skip_while(|word| word != "--screenshot").skip(1);
        let Some(path) = words.next().map(PathBuf::from) else { return };
        let Self { prepare, keys, is_busy } = *self;
        let (is_there, is_taken, shown, frames, since) = (false, false, 0, 0, 0.0);
        app.insert_resource(Run { path, prepare, keys, is_busy, is_there, shown, frames, since, is_taken })
            .add_systems(PreUpdate, press.after(bevy::input::InputSystems))
            .add_systems(Update, (look, wait).chain())
            .add_observer(|_: On<WorldInstanceReady>, mut run: ResMut<Run>| run.is_there = true);
    }
}

fn press(world: &mut World) {
    let mut run = world.resource_mut::<Run>();
    if !std::mem::take(&mut run.is_there) {
        return;
    }
    let (prepare, keys) = (run.prepare, std::mem::take(&mut run.keys));
    prepare(world);
    let mut keyboard = world.resource_mut::<ButtonInput<KeyCode>>();
    keys.iter().for_each(|key| keyboard.press(*key));
}

/// Whether a bake is going on, which only the example knows.
fn look(world: &mut World) {
    let now = world.resource::<Time<Real>>().elapsed_secs();
    let is_busy = world.resource::<Run>().is_busy;
    if is_busy(world) {
        let mut run = world.resource_mut::<Run>();
        (run.frames, run.since) = (0, now);
    }
}

fn wait(mut run: ResMut<Run>, lightmaps: Query<Ref<Lightmap>>, time: Res<Time<Real>>, mut commands: Commands) {
    let (now, shown) = (time.elapsed_secs(), lightmaps.iter().count());
    run.frames += 1;
    if shown != run.shown || lightmaps.iter().any(|lightmap| lightmap.is_changed()) {
        (run.shown, run.frames, run.since) = (shown, 0, now);
    }
    let is_settled = shown > 0 && run.frames >= FRAMES_TO_SETTLE && now - run.since >= SECONDS_TO_SETTLE;
    if is_settled && !std::mem::replace(&mut run.is_taken, true) {
        commands.spawn(Screenshot::primary_window()).observe(captured);
    }
    if now - run.since > PATIENCE {
        eprintln!("no lightmap has come for {PATIENCE} s");
        commands.write_message(AppExit::error());
    }
}

fn captured(captured: On<ScreenshotCaptured>, run: Res<Run>, mut commands: Commands) {
    let path = &run.path;
    let saved = captured.image.clone().try_into_dynamic().map_err(|error| error.to_string());
    let saved = saved.and_then(|picture| picture.to_rgb8().save(path).map_err(|error| error.to_string()));
    commands.write_message(match saved {
        Ok(()) => AppExit::Success,
        Err(reason) => {
            eprintln!("{} cannot be written ({reason}); choose another place", path.display());
            AppExit::error()
        }
    });
}
