//! The kiln on the keyboard, for a game under development. Opt in; a shipped game has no use for it.

use super::baking::KilnControl;
use bevy::prelude::*;

/// Keys that bake, with either Ctrl, or on a Mac with Cmd, held down:
///
/// - Ctrl+B bakes as [`NextBake`](super::NextBake) says, or stops what is running;
/// - Ctrl+Shift+B holds what is running, or lets it go on;
/// - Ctrl+Alt+B takes the lightmaps off again.
///
/// ```no_run
/// use bevy::prelude::*;
/// use bevy_kiln::prelude::*;
///
/// App::new().add_plugins((DefaultPlugins, KilnPlugin, KilnShortcuts)).run();
/// ```
///
/// In an app without a keyboard it does nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct KilnShortcuts;

impl Plugin for KilnShortcuts {
    fn build(&self, app: &mut App) {
        app.add_systems(
            Update,
            heed.run_if(resource_exists::<ButtonInput<KeyCode>>.and_then(resource_exists::<super::NextBake>)),
        );
    }
}

fn heed(keys: Res<ButtonInput<KeyCode>>, mut kiln: KilnControl) {
    // A chord that is over within one slow frame counts as well.
    let is_held = |pair: [KeyCode; 2]| keys.any_pressed(pair) || keys.any_just_released(pair);
    let command = if cfg!(target_os = "macos") {
        [KeyCode::SuperLeft, KeyCode::SuperRight]
    } else {
        [KeyCode::ControlLeft, KeyCode::ControlRight]
    };
    if !keys.just_pressed(KeyCode::KeyB) || !is_held(command) {
        return;
    }
    let shift = is_held([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
    let alt = is_held([KeyCode::AltLeft, KeyCode::AltRight]);
    let is_paused = kiln.status().running().map(|running| running.is_paused);
    match (shift, alt, is_paused) {
        (true, false, Some(true)) => {
            kiln.resume();
        }
        (true, false, Some(false)) => {
            kiln.pause();
        }
        (false, true, _) => kiln.clear(),
        (false, false, Some(_)) => {
            kiln.cancel();
        }
        (false, false, None) => {
            let next = kiln.next_bake().clone();
            // Nothing runs, so nothing refuses it.
            let _ = kiln.bake(next);
        }
        _ => {}
    }
}
