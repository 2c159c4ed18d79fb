//! Words on the screen: the keys, and where things stand.

use super::args::Args;
use super::bake::Status;
use bevy::prelude::*;

const HELP: &str =
    "B  bake     Esc  stop     C  clear     F  filtering     drag or arrow keys  turn     wheel  zoom     H  hide this";

/// All words.
#[derive(Component)]
pub struct Overlay;

#[derive(Component)]
struct StatusLine;

pub fn plugin(app: &mut App) {
    app.add_systems(Startup, spawn).add_systems(Update, (toggle, update.run_if(resource_changed::<Status>)));
}

fn spawn(args: Res<Args>, mut commands: Commands) {
    let column = Node {
        position_type: PositionType::Absolute,
        left: px(12),
        right: px(12),
        bottom: px(10),
        flex_direction: FlexDirection::Column,
        row_gap: px(4),
        ..default()
    };
    let small = TextFont { font_size: FontSize::Px(15.0), ..default() };
    commands.spawn((
        Overlay,
        column,
        children![
            (StatusLine, Text::default(), small.clone()),
            (Text::new(format!("{}{HELP}", args.stage.keys)), small)
        ],
    ));
}

fn toggle(keys: Res<ButtonInput<KeyCode>>, mut overlay: Single<&mut Visibility, With<Overlay>>) {
    if keys.just_pressed(KeyCode::KeyH) {
        overlay.toggle_visible_hidden();
    }
}

fn update(status: Res<Status>, mut line: Single<(&mut Text, &mut TextColor), With<StatusLine>>) {
    let (text, colour) = &mut *line;
    text.0 = status.to_string();
    colour.0 = if matches!(*status, Status::Failed(_)) { Color::srgb(1.0, 0.4, 0.3) } else { Color::WHITE };
}
