//! Where the parts of the panel are, and what they show when the kiln's status changes.

use super::pieces::{button, fixed, scrolling};
use super::{KilnButton, words};
use crate::plugin::{BakeGoal, BakeStatus, KilnComparison, KilnControl, KilnOverlay, KilnWork};
use bevy::feathers::containers::{pane, pane_body, pane_header};
use bevy::feathers::controls::ButtonVariant;
use bevy::feathers::display::{label, label_dim, label_small};
use bevy::feathers::theme::ThemeTextColor;
use bevy::feathers::tokens;
use bevy::prelude::*;
use bevy::ui::InteractionDisabled;
use bevy_scene::{CommandsSceneExt, bsn};

const WIDTH: f32 = 300.0;
const COMPARE: &str = "Compare with the truth";
const BAR: Color = Color::srgb(0.25, 0.52, 0.9);
const TROUGH: Color = Color::srgb(0.1, 0.1, 0.12);

/// The panel's outermost node. Its `UiTargetCamera` may be set, and its `Node` placed elsewhere.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct KilnPanelRoot;

/// What changes.
#[derive(Component, Clone, Copy, PartialEq)]
pub(super) enum Part {
    Status,
    Bar,
    Legend,
    Comparison,
    Plan,
    Warnings,
}

pub(super) fn spawn(mut commands: Commands) {
    let place = Node {
        position_type: PositionType::Absolute,
        top: px(8),
        right: px(8),
        width: px(WIDTH),
        // What does not fit scrolls.
        max_height: vh(96),
        flex_direction: FlexDirection::Column,
        ..default()
    };
    let root = commands.spawn((KilnPanelRoot, Name::new("kiln panel"), place)).id();
    let shrinks = || bsn! { Node { min_height: px(0), flex_shrink: 1.0 } };
    let pane = commands.spawn_scene(bsn! { pane() shrinks() }).insert(ChildOf(root)).id();
    let header = commands.spawn_scene(pane_header()).insert(ChildOf(pane)).id();
    // With a font of its own: a text that inherits one keeps the width that it had before.
    let title = bsn! {
        label("Kiln")
        TextFont { font_size: FontSize::Px(16.0) }
        ThemeTextColor(tokens::BUTTON_TEXT)
    };
    commands.spawn_scene(title).insert(ChildOf(header));
    let body = commands.spawn_scene(bsn! { pane_body() shrinks() }).insert(ChildOf(pane)).id();
    for line in [
        &[(KilnButton::Bake, "Bake"), (KilnButton::Plan, "Plan"), (KilnButton::Clear, "Clear")][..],
        &[(KilnButton::Pause, "Pause"), (KilnButton::Cancel, "Cancel")],
    ] {
        let row = commands.spawn((fixed(FlexDirection::Row, 4), ChildOf(body))).id();
        for &(action, caption) in line {
            button(&mut commands, row, action, caption);
        }
    }
    let status = commands.spawn((fixed(FlexDirection::Column, 0), ChildOf(body))).id();
    commands.spawn_scene(label("")).insert((Part::Status, ChildOf(status)));
    let trough = Node { height: px(6), flex_shrink: 0.0, ..default() };
    let trough = commands.spawn((trough, BackgroundColor(TROUGH), ChildOf(body))).id();
    let bar = Node { height: percent(100), width: percent(0), ..default() };
    commands.spawn((bar, BackgroundColor(BAR), Part::Bar, ChildOf(trough)));
    let overlays = commands.spawn((fixed(FlexDirection::Column, 4), ChildOf(body))).id();
    commands.spawn_scene(label_dim("Show")).insert(ChildOf(overlays));
    for line in [
        &[(KilnOverlay::None, "Material"), (KilnOverlay::TexelDensity, "Density"), (KilnOverlay::Charts, "Charts")][..],
        &[
            (KilnOverlay::Error, "Error"),
            (KilnOverlay::Validity, "Validity"),
            (KilnOverlay::DirectOnly, "Direct"),
            (KilnOverlay::IndirectOnly, "Indirect"),
        ],
    ] {
        let row = commands.spawn((fixed(FlexDirection::Row, 4), ChildOf(overlays))).id();
        for &(overlay, caption) in line {
            button(&mut commands, row, KilnButton::Overlay(overlay), caption);
        }
    }
    commands.spawn((fixed(FlexDirection::Column, 3), Part::Legend, ChildOf(overlays)));
    let row = commands.spawn((fixed(FlexDirection::Row, 4), ChildOf(overlays))).id();
    button(&mut commands, row, KilnButton::Compare, COMPARE);
    commands.spawn_scene(label_small("")).insert((Part::Comparison, ChildOf(overlays)));
    let lists = scrolling(&mut commands, body);
    for part in [Part::Plan, Part::Warnings] {
        commands.spawn((fixed(FlexDirection::Column, 3), part, ChildOf(lists)));
    }
}

/// Greys what can do nothing now, and marks what is chosen.
pub(super) fn show_buttons(
    kiln: KilnControl,
    overlay: Res<KilnOverlay>,
    comparison: Res<KilnComparison>,
    mut buttons: Query<(Entity, &KilnButton, &mut ButtonVariant, Has<InteractionDisabled>, &Children)>,
    mut texts: Query<&mut Text>,
    mut commands: Commands,
) {
    let running = kiln.status().running();
    let is_baking = running.is_some_and(|running| running.work == KilnWork::Bake);
    for (entity, button, mut variant, is_grey, captions) in &mut buttons {
        let (can_act, is_marked) = match *button {
            KilnButton::Bake => (running.is_none(), true),
            KilnButton::Plan => (running.is_none(), false),
            KilnButton::Pause | KilnButton::Cancel => (running.is_some(), false),
            KilnButton::Clear => (kiln.has_baked(), false),
            KilnButton::Price(error) => (true, kiln.settings().goal == BakeGoal::Error(error)),
            KilnButton::Compare => (!is_baking, comparison.is_on),
            KilnButton::Overlay(this) => {
                (kiln.has_baked() && !is_baking, *overlay == this && this != KilnOverlay::None)
            }
            KilnButton::Select(_) => (true, false),
        };
        variant.set_if_neq(if is_marked { ButtonVariant::Primary } else { ButtonVariant::Normal });
        match (can_act, is_grey) {
            (true, true) => drop(commands.entity(entity).remove::<InteractionDisabled>()),
            (false, false) => drop(commands.entity(entity).insert(InteractionDisabled)),
            (true, false) | (false, true) => {}
        }
        let caption = match *button {
            KilnButton::Pause if running.is_some_and(|running| running.is_paused) => "Resume",
            KilnButton::Pause => "Pause",
            KilnButton::Compare if comparison.is_on => "Stop comparing",
            KilnButton::Compare => COMPARE,
            _ => continue,
        };
        for &child in captions {
            if let Ok(mut text) = texts.get_mut(child) {
                text.set_if_neq(Text::new(caption));
            }
        }
    }
}

/// The status lines and the bar.
pub(super) fn show_progress(
    status: Res<BakeStatus>,
    comparison: Res<KilnComparison>,
    mut texts: Query<(&Part, &mut Text)>,
    mut bars: Query<(&Part, &mut Node)>,
) {
    for (part, mut text) in &mut texts {
        match part {
            Part::Status => text.set_if_neq(Text(words::status(&status))),
            Part::Comparison => text.set_if_neq(Text(words::comparison(&comparison))),
            Part::Bar | Part::Legend | Part::Plan | Part::Warnings => false,
        };
    }
    let fraction = status.running().map_or(0.0, |running| running.fraction);
    for (_, mut bar) in bars.iter_mut().filter(|(part, _)| **part == Part::Bar) {
        bar.width = percent(100.0 * fraction as f32);
    }
}
