//! The panel on the screen, worked by its buttons.

use crate::renderer::{Screen, app_with, show, spawn_camera};
use bevy::light::RectLight;
use bevy::picking::Pickable;
use bevy::prelude::*;
use bevy::ui::UiTargetCamera;
use bevy::ui_widgets::Activate;
use bevy_kiln::plugin::{KilnButton, KilnEnding, KilnPanel, KilnPanelRoot, KilnSelection};
use bevy_kiln::prelude::*;
use std::path::Path;

const SIZE: [u32; 2] = [640, 640];
/// Frames in which a plan or a bake of a few hundred texels must end.
const PATIENCE: usize = 20_000;

fn activate(app: &mut App, wanted: impl Fn(&KilnButton) -> bool) {
    let world = app.world_mut();
    let mut buttons = world.query::<(Entity, &KilnButton)>();
    let entity = buttons.iter(world).find(|(_, button)| wanted(button)).expect("no such button").0;
    world.trigger(Activate { entity });
    world.flush();
}

fn finish(app: &mut App) {
    for _ in 0..PATIENCE {
        app.update();
        if app.world().resource::<BakeStatus>().running().is_none() {
            return show(app);
        }
    }
    panic!("the job does not end");
}

/// Writes what the screen shows where a person can look at it.
fn keep(app: &App, name: &str) {
    let bytes: Vec<u8> = app
        .world()
        .resource::<Screen>()
        .0
        .iter()
        .flat_map(|pixel| {
            let shown = Color::linear_rgb(pixel.x, pixel.y, pixel.z).to_srgba();
            [shown.red, shown.green, shown.blue].map(|value| (255.0 * value.clamp(0.0, 1.0)) as u8)
        })
        .collect();
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    image::save_buffer(&file, &bytes, SIZE[0], SIZE[1], image::ColorType::Rgb8).unwrap();
}

/// How many pixels of the panel's part of the screen are not of its ground.
fn inked(app: &App) -> usize {
    let screen = &app.world().resource::<Screen>().0;
    let row = SIZE[0] as usize;
    let panel = screen.iter().enumerate().filter(|(at, _)| at % row > row - 300 && at / row > 8);
    panel.filter(|(_, pixel)| pixel.min_element() > 0.25).count()
}

#[test]
fn the_panel_plans_bakes_and_selects() {
    let with_panel = |app: &mut App| {
        app.add_plugins(KilnPanel);
    };
    let Some(mut app) = app_with(with_panel) else { return };
    let world = app.world_mut();
    let mesh = Mesh::from(Plane3d::default().mesh().size(2.0, 2.0));
    let uv = mesh.attribute(Mesh::ATTRIBUTE_UV_0).unwrap().clone();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh.with_inserted_attribute(Mesh::ATTRIBUTE_UV_1, uv));
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial::default());
    world.spawn((Name::new("floor"), Mesh3d(mesh), MeshMaterial3d(material)));
    let bare = world.resource_mut::<Assets<Mesh>>().add(Mesh::from(Cuboid::from_length(0.5)));
    let bare = world.spawn((Name::new("bare"), Mesh3d(bare), Transform::from_xyz(-0.5, 0.25, 0.0))).id();
    let down = Transform::from_xyz(0.0, 1.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::X);
    world.spawn((Name::new("lamp"), RectLight { intensity: 10.0, ..default() }, down));
    let place = Transform::from_xyz(0.5, 2.5, 3.0).looking_at(Vec3::new(0.7, 0.0, 0.0), Vec3::Y);
    let camera = spawn_camera(world, SIZE, 0.8, place);
    world.resource_mut::<NextBake>().layout = LightmapLayout::Shared { size: 16 };
    show(&mut app);
    let world = app.world_mut();
    let root = world.query_filtered::<Entity, With<KilnPanelRoot>>().single(world).unwrap();
    world.entity_mut(root).insert((UiTargetCamera(camera), Pickable::IGNORE));
    show(&mut app);
    let empty = inked(&app);
    keep(&app, "panel_empty.png");
    assert!(empty > 300, "the panel's words cover {empty} pixels");

    activate(&mut app, |button| *button == KilnButton::Plan);
    finish(&mut app);
    keep(&app, "panel_planned.png");
    let planned = inked(&app);
    assert!(planned > empty + 1000, "{planned} after the plan, {empty} before");

    activate(&mut app, |button| matches!(button, KilnButton::Price(_)));
    let BakeGoal::Error(error) = app.world().resource::<NextBake>().goal else { panic!("another goal") };
    let plan = app.world().resource::<BakeStatus>().plan().unwrap().clone();
    assert_eq!(plan.predicted[0].error, error);
    app.world_mut().resource_mut::<NextBake>().goal = BakeGoal::Samples(16);
    activate(&mut app, |button| *button == KilnButton::Bake);
    finish(&mut app);
    let outcome = app.world().resource::<BakeStatus>().outcomes().next().unwrap().clone();
    assert!(matches!(outcome.ending, KilnEnding::Baked { entities: 1, .. }), "{outcome:?}");

    activate(&mut app, |button| *button == KilnButton::Select(bare));
    assert_eq!(app.world().resource::<KilnSelection>().0, Some(bare));
    show(&mut app);
    keep(&app, "panel_baked.png");
}
