//! Where the parts of the panel are, and what they show when the kiln's status changes.

use super::{KilnButton, words};
use crate::bake::BakePlan;
use crate::plugin::{BakeGoal, BakeId, BakeStatus, KilnWarning, NextBake};
use bevy::feathers::containers::{pane, pane_body, pane_header};
use bevy::feathers::controls::{ButtonVariant, FeathersButton};
use bevy::feathers::display::{label, label_dim, label_small};
use bevy::feathers::theme::ThemedText;
use bevy::prelude::*;
use bevy_scene::{CommandsSceneExt, bsn, bsn_list};

const WIDTH: f32 = 300.0;
/// Warnings that are listed; the rest is counted.
const LISTED: usize = 8;
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
    Plan,
    Warnings,
}

pub(super) fn spawn(mut commands: Commands) {
    let place = Node {
        position_type: PositionType::Absolute,
        top: px(8),
        right: px(8),
        width: px(WIDTH),
        flex_direction: FlexDirection::Column,
        ..default()
    };
    let root = commands.spawn((KilnPanelRoot, Name::new("kiln panel"), place)).id();
    let pane = commands.spawn_scene(pane()).insert(ChildOf(root)).id();
    let header = commands.spawn_scene(pane_header()).insert(ChildOf(pane)).id();
    commands.spawn_scene(bsn! { Text("Kiln") ThemedText }).insert(ChildOf(header));
    let body = commands.spawn_scene(pane_body()).insert(ChildOf(pane)).id();
    for line in [
        &[(KilnButton::Bake, "Bake"), (KilnButton::Plan, "Plan"), (KilnButton::Clear, "Clear")][..],
        &[(KilnButton::Pause, "Pause / resume"), (KilnButton::Cancel, "Cancel")],
    ] {
        let row = commands.spawn((Node { column_gap: px(4), ..default() }, ChildOf(body))).id();
        for &(action, caption) in line {
            button(&mut commands, row, action, caption);
        }
    }
    commands.spawn_scene(label("")).insert((Part::Status, ChildOf(body)));
    let trough = Node { height: px(6), ..default() };
    let trough = commands.spawn((trough, BackgroundColor(TROUGH), ChildOf(body))).id();
    let bar = Node { height: percent(100), width: percent(0), ..default() };
    commands.spawn((bar, BackgroundColor(BAR), Part::Bar, ChildOf(trough)));
    for part in [Part::Plan, Part::Warnings] {
        let list = Node { flex_direction: FlexDirection::Column, row_gap: px(3), ..default() };
        commands.spawn((list, part, ChildOf(body)));
    }
}

fn button(commands: &mut Commands, parent: Entity, action: KilnButton, caption: &str) {
    let caption = caption.to_owned();
    let variant = if action == KilnButton::Bake { ButtonVariant::Primary } else { ButtonVariant::Normal };
    let scene = bsn! {
        @FeathersButton {
            @caption: {bsn_list![(Text(caption) ThemedText)]},
            @variant: {variant},
        }
        Node { flex_grow: 1.0 }
    };
    commands.spawn_scene(scene).insert((action, ChildOf(parent)));
}

/// The status line and the bar.
pub(super) fn show_progress(
    status: Res<BakeStatus>,
    mut texts: Query<(&Part, &mut Text)>,
    mut bars: Query<(&Part, &mut Node)>,
) {
    for (_, mut text) in texts.iter_mut().filter(|(part, _)| **part == Part::Status) {
        text.set_if_neq(Text(words::status(&status)));
    }
    let fraction = status.running().map_or(0.0, |running| running.fraction);
    for (_, mut bar) in bars.iter_mut().filter(|(part, _)| **part == Part::Bar) {
        bar.width = percent(100.0 * fraction as f32);
    }
}

/// Prices and effects of the last plan, warnings of the last job; anew when a job has ended or another price is chosen.
pub(super) fn show_lists(
    status: Res<BakeStatus>,
    next: Res<NextBake>,
    lists: Query<(Entity, &Part)>,
    mut shown: Local<Option<(Option<BakeId>, BakeGoal)>>,
    mut commands: Commands,
) {
    let latest = status.outcomes().next();
    let now = (latest.map(|outcome| outcome.id), next.goal);
    if shown.replace(now) == Some(now) {
        return;
    }
    for (list, part) in &lists {
        match part {
            Part::Plan => {
                commands.entity(list).despawn_children();
                if let Some(plan) = status.plan() {
                    show_plan(&mut commands, list, plan, next.goal);
                }
            }
            Part::Warnings => {
                commands.entity(list).despawn_children();
                show_warnings(&mut commands, list, latest.map_or(&[], |outcome| &outcome.warnings));
            }
            Part::Status | Part::Bar => {}
        }
    }
}

fn show_plan(commands: &mut Commands, list: Entity, plan: &BakePlan, goal: BakeGoal) {
    commands.spawn_scene(label_dim("Error and time: choose one")).insert(ChildOf(list));
    for offer in &plan.predicted {
        button(commands, list, KilnButton::Price(offer.error), &words::price(offer, goal));
    }
    commands.spawn_scene(label_dim("Simulated, and share of the time")).insert(ChildOf(list));
    commands.spawn_scene(label_small(words::effects(plan))).insert(ChildOf(list));
}

/// Each in its words; a button below it where there is something to select.
fn show_warnings(commands: &mut Commands, list: Entity, warnings: &[KilnWarning]) {
    if warnings.is_empty() {
        return;
    }
    commands.spawn_scene(label_dim("Warnings")).insert(ChildOf(list));
    for warning in warnings.iter().take(LISTED) {
        commands.spawn_scene(label_small(warning.sentence.clone())).insert(ChildOf(list));
        if let Some(entity) = warning.entity {
            button(commands, list, KilnButton::Select(entity), "Select");
        }
    }
    if let Some(more) = warnings.len().checked_sub(LISTED).filter(|&more| more > 0) {
        commands.spawn_scene(label_dim(format!("and {more} more"))).insert(ChildOf(list));
    }
}
