//! A panel inside the running game: bake, plan, hold, stop, clear; what it would cost; how far it is; what was left out;
//! what is known of the texels, on the surfaces themselves.
//!
//! Built of Bevy's own editor widgets (feathers). It is one more door: it asks [`KilnControl`], shows [`BakeStatus`](super::BakeStatus) and
//! knows nothing else of the kiln. What it shows is put into words in `words`, laid out in `view`.

mod lists;
mod pieces;
mod select;
mod view;
mod words;

pub use select::{KilnSelect, KilnSelection};
pub use view::KilnPanelRoot;

use super::baking::{BakeGoal, KilnControl};
use super::overlay::{CompareWithTruth, KilnComparison, KilnOverlay, KilnOverlays, StopComparing};
use bevy::feathers::dark_theme::create_dark_theme;
use bevy::feathers::theme::UiTheme;
use bevy::feathers::{FeathersCorePlugin, FeathersPlugins};
use bevy::prelude::*;
use bevy::ui_widgets::Activate;
use bevy_scene::ScenePlugin;

/// The panel, in the upper right corner of the window. Opt in; a shipped game has no use for it.
///
/// A price that is clicked becomes the goal of [`NextBake`](super::NextBake), a warning that is clicked triggers
/// [`KilnSelect`] with its entity, which is framed until the next. What can do nothing now is grey; what has no room
/// scrolls. It brings [`KilnOverlays`] along.
///
/// ```no_run
/// use bevy::prelude::*;
/// use bevy_kiln::prelude::*;
///
/// App::new().add_plugins((DefaultPlugins, KilnPlugin, KilnPanel)).run();
/// ```
///
/// It brings Bevy's `FeathersPlugins` along, with the dark theme, where the app has none.
#[derive(Clone, Copy, Debug, Default)]
pub struct KilnPanel;

impl Plugin for KilnPanel {
    fn build(&self, app: &mut App) {
        if !app.is_plugin_added::<FeathersCorePlugin>() {
            app.add_plugins(FeathersPlugins).insert_resource(UiTheme(create_dark_theme()));
        }
        if !app.is_plugin_added::<ScenePlugin>() {
            app.add_plugins(ScenePlugin);
        }
        if !app.is_plugin_added::<KilnOverlays>() {
            app.add_plugins(KilnOverlays);
        }
        app.init_resource::<KilnSelection>()
            .register_type::<KilnSelect>()
            .add_systems(Startup, view::spawn)
            .add_systems(
                Update,
                (
                    view::show_progress,
                    lists::show_lists,
                    view::show_buttons,
                    pieces::show_scrollbars,
                    lists::show_legend,
                    select::frame,
                ),
            )
            .add_observer(select::select)
            .add_observer(heed);
    }
}

/// What a button of the panel does.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub enum KilnButton {
    /// Bakes as [`NextBake`](super::NextBake) says.
    Bake,
    /// Plans that bake.
    Plan,
    /// Holds what is running, or lets it go on.
    Pause,
    /// Stops what is running.
    Cancel,
    /// Takes the lightmaps off again.
    Clear,
    /// Makes this error the goal of the next bake.
    Price(f64),
    /// Shows this on the surfaces.
    Overlay(KilnOverlay),
    /// Compares the frame with the truth, or stops that.
    Compare,
    /// Selects this entity.
    Select(Entity),
}

fn heed(
    activated: On<Activate>,
    buttons: Query<&KilnButton>,
    comparison: Res<KilnComparison>,
    mut kiln: KilnControl,
    mut commands: Commands,
) {
    let Ok(button) = buttons.get(activated.entity) else { return };
    let next = kiln.next_bake().clone();
    match *button {
        // A click while another job runs does nothing; the panel says that one does.
        KilnButton::Bake => {
            let _ = kiln.bake(next);
        }
        KilnButton::Plan => {
            let _ = kiln.plan(next);
        }
        KilnButton::Pause => {
            let is_paused = kiln.status().running().is_some_and(|running| running.is_paused);
            if is_paused {
                kiln.resume()
            } else {
                kiln.pause()
            };
        }
        KilnButton::Cancel => {
            kiln.cancel();
        }
        KilnButton::Clear => kiln.clear(),
        KilnButton::Price(error) => kiln.next_bake().goal = BakeGoal::Error(error),
        KilnButton::Compare if comparison.is_on => commands.trigger(StopComparing),
        KilnButton::Compare => commands.trigger(CompareWithTruth::default()),
        KilnButton::Overlay(overlay) => commands.trigger(overlay),
        KilnButton::Select(entity) => commands.trigger(KilnSelect { entity }),
    }
}
