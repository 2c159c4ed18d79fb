//! What the panel lists: prices and effects of a plan, warnings, the legend of an overlay.

use super::pieces::{button, fixed};
use super::view::Part;
use super::{KilnButton, words};
use crate::bake::BakePlan;
use crate::plugin::{BakeId, BakeStatus, KilnLegend, KilnWarning};
use bevy::feathers::display::{label_dim, label_small};
use bevy::prelude::*;
use bevy_scene::CommandsSceneExt;

/// Warnings that are listed; the rest is counted.
const LISTED: usize = 64;

/// Prices and effects of the last plan, warnings of the last job; anew when a job has ended.
pub(super) fn show_lists(
    status: Res<BakeStatus>,
    lists: Query<(Entity, &Part)>,
    mut shown: Local<Option<Option<BakeId>>>,
    mut commands: Commands,
) {
    let latest = status.outcomes().next();
    let now = latest.map(|outcome| outcome.id);
    if shown.replace(now) == Some(now) {
        return;
    }
    for (list, part) in &lists {
        match part {
            Part::Plan => {
                commands.entity(list).despawn_children();
                if let Some(plan) = status.plan() {
                    show_plan(&mut commands, list, plan);
                }
            }
            Part::Warnings => {
                commands.entity(list).despawn_children();
                show_warnings(&mut commands, list, latest.map_or(&[], |outcome| &outcome.warnings));
            }
            Part::Status | Part::Bar | Part::Legend | Part::Comparison => {}
        }
    }
}

/// What the colours on the surfaces mean.
pub(super) fn show_legend(legend: Res<KilnLegend>, lists: Query<(Entity, &Part)>, mut commands: Commands) {
    if !legend.is_changed() {
        return;
    }
    for (list, _) in lists.iter().filter(|(_, part)| **part == Part::Legend) {
        commands.entity(list).despawn_children();
        if !legend.sentence.is_empty() {
            commands.spawn_scene(label_small(legend.sentence.clone())).insert(ChildOf(list));
        }
        for swatch in &legend.swatches {
            let row = Node { align_items: AlignItems::Center, ..fixed(FlexDirection::Row, 6) };
            let row = commands.spawn((row, ChildOf(list))).id();
            let square = Node { width: px(12), height: px(12), ..default() };
            commands.spawn((square, BackgroundColor(swatch.colour), ChildOf(row)));
            commands.spawn_scene(label_small(swatch.words.clone())).insert(ChildOf(row));
        }
    }
}

fn show_plan(commands: &mut Commands, list: Entity, plan: &BakePlan) {
    commands.spawn_scene(label_dim("Error and time: choose one")).insert(ChildOf(list));
    for offer in &plan.predicted {
        button(commands, list, KilnButton::Price(offer.error), &words::price(offer));
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
