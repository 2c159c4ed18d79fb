//! What the panel is put together of: rows, a column that scrolls, buttons.

use super::KilnButton;
use bevy::ecs::template::EntityTemplate;
use bevy::feathers::controls::{FeathersButton, FeathersScrollbar};
use bevy::feathers::theme::ThemedText;
use bevy::prelude::*;
use bevy::ui_widgets::{ControlOrientation, ScrollArea};
use bevy_scene::{CommandsSceneExt, bsn, bsn_list};

/// What keeps its height however little room there is.
pub(super) fn fixed(flex_direction: FlexDirection, gap: u16) -> Node {
    Node { flex_direction, row_gap: px(gap), column_gap: px(gap), flex_shrink: 0.0, ..default() }
}

/// A column that takes what room there is and scrolls, by wheel and bar, what does not fit. Returns the column.
pub(super) fn scrolling(commands: &mut Commands, parent: Entity) -> Entity {
    let frame = Node { min_height: px(0), flex_shrink: 1.0, flex_direction: FlexDirection::Column, ..default() };
    let frame = commands.spawn((frame, ChildOf(parent))).id();
    let column = Node {
        min_height: px(0),
        flex_shrink: 1.0,
        flex_direction: FlexDirection::Column,
        row_gap: px(6),
        padding: UiRect::right(px(10)),
        overflow: Overflow::scroll_y(),
        ..default()
    };
    let column = commands.spawn((column, ScrollArea, ChildOf(frame))).id();
    let bar = bsn! {
        @FeathersScrollbar { @target: {EntityTemplate::from(column)}, @orientation: {ControlOrientation::Vertical} }
        Node { position_type: PositionType::Absolute, right: px(0), top: px(0), bottom: px(0), width: px(6) }
    };
    commands.spawn_scene(bar).insert((ScrollbarOf(column), ChildOf(frame)));
    column
}

/// The scroll bar of a column.
#[derive(Component)]
pub(super) struct ScrollbarOf(Entity);

/// Scroll bars are seen where there is anything to scroll.
pub(super) fn show_scrollbars(columns: Query<&ComputedNode>, mut bars: Query<(&ScrollbarOf, &mut Visibility)>) {
    for (of, mut visibility) in &mut bars {
        let overflows = columns.get(of.0).is_ok_and(|column| column.content_size().y > column.size().y + 0.5);
        visibility.set_if_neq(if overflows { Visibility::Inherited } else { Visibility::Hidden });
    }
}

/// A button that fills its share of a row.
pub(super) fn button(commands: &mut Commands, parent: Entity, action: KilnButton, caption: &str) {
    let caption = caption.to_owned();
    let scene = bsn! {
        @FeathersButton { @caption: {bsn_list![(Text(caption) ThemedText)]} }
        Node { flex_grow: 1.0 }
    };
    commands.spawn_scene(scene).insert((action, ChildOf(parent)));
}
