//! The panel on the screen, worked by its buttons.

use crate::overlay::keep;
use crate::renderer::{Screen, app_with, show, spawn_camera};
use bevy::feathers::controls::ButtonVariant;
use bevy::light::RectLight;
use bevy::picking::Pickable;
use bevy::prelude::*;
use bevy::render::gpu_readback::Readback;
use bevy::ui::{InteractionDisabled, UiGlobalTransform, UiTargetCamera};
use bevy::ui_widgets::{Activate, Scrollbar};
use bevy_kiln::plugin::{KilnButton, KilnComparison, KilnEnding, KilnPanel, KilnPanelRoot, KilnSelection};
use bevy_kiln::prelude::*;

/// Rows of 8 bytes per pixel are whole multiples of 256 bytes.
const SIZE: [u32; 2] = [800, 608];
const LARGE: [u32; 2] = [1280, 720];
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

/// How many pixels of the panel's part of the screen are not of its ground.
fn inked(app: &App) -> usize {
    let screen = &app.world().resource::<Screen>().0;
    let row = SIZE[0] as usize;
    let panel = screen.iter().enumerate().filter(|(at, _)| at % row > row - 300 && at / row > 8);
    panel.filter(|(_, pixel)| pixel.min_element() > 0.25).count()
}

/// Buttons that are not grey, by name, but for those of the lists and overlays.
fn acting(app: &mut App) -> Vec<KilnButton> {
    let world = app.world_mut();
    let mut buttons = world.query_filtered::<&KilnButton, Without<InteractionDisabled>>();
    let of_lists =
        |button: &KilnButton| matches!(button, KilnButton::Select(_) | KilnButton::Price(_) | KilnButton::Overlay(_));
    by_name(buttons.iter(world).filter(|button| !of_lists(button)))
}

/// Buttons that stand out, by name.
fn chosen(app: &mut App) -> Vec<KilnButton> {
    let world = app.world_mut();
    let mut buttons = world.query::<(&KilnButton, &ButtonVariant)>();
    let chosen = buttons.iter(world).filter(|(_, variant)| **variant == ButtonVariant::Primary);
    by_name(chosen.map(|(button, _)| button))
}

fn by_name<'a>(buttons: impl Iterator<Item = &'a KilnButton>) -> Vec<KilnButton> {
    let mut buttons: Vec<KilnButton> = buttons.copied().collect();
    buttons.sort_by_key(|button| format!("{button:?}"));
    buttons
}

fn scroll_bar(app: &mut App) -> Visibility {
    let world = app.world_mut();
    *world.query_filtered::<&Visibility, With<Scrollbar>>().single(world).unwrap()
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
    // Each is warned of, so that there is more to list than there is room.
    for number in 1..20 {
        world.spawn((Name::new(format!("bare {number}")), Mesh3d(bare.clone()), Transform::from_xyz(0.0, -9.0, 0.0)));
    }
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
    assert_eq!(acting(&mut app), [KilnButton::Bake, KilnButton::Compare, KilnButton::Plan]);
    assert_eq!(scroll_bar(&mut app), Visibility::Hidden);
    keep(&app, SIZE, "panel_empty.png");
    assert!(empty > 300, "the panel's words cover {empty} pixels");

    activate(&mut app, |button| *button == KilnButton::Plan);
    finish(&mut app);
    keep(&app, SIZE, "panel_planned.png");
    let planned = inked(&app);
    assert!(planned > empty + 1000, "{planned} after the plan, {empty} before");
    assert_eq!(scroll_bar(&mut app), Visibility::Inherited);
    let world = app.world_mut();
    let (node, middle) =
        world.query_filtered::<(&ComputedNode, &UiGlobalTransform), With<KilnPanelRoot>>().single(world).unwrap();
    let bottom = middle.translation.y + 0.5 * node.size().y;
    assert!(bottom < SIZE[1] as f32, "the panel ends at {bottom}");

    activate(&mut app, |button| matches!(button, KilnButton::Price(_)));
    let BakeGoal::Error(error) = app.world().resource::<NextBake>().goal else { panic!("another goal") };
    let plan = app.world().resource::<BakeStatus>().plan().unwrap().clone();
    assert_eq!(plan.predicted[0].error, error);
    show(&mut app);
    assert_eq!(chosen(&mut app), [KilnButton::Bake, KilnButton::Price(error)]);
    app.world_mut().resource_mut::<NextBake>().goal = BakeGoal::Samples(16);
    activate(&mut app, |button| *button == KilnButton::Bake);
    for _ in 0..2 {
        app.update();
    }
    if app.world().resource::<BakeStatus>().running().is_some() {
        let acting = acting(&mut app);
        assert!(acting.contains(&KilnButton::Cancel) && !acting.contains(&KilnButton::Bake), "{acting:?}");
    }
    finish(&mut app);
    let outcome = app.world().resource::<BakeStatus>().outcomes().next().unwrap().clone();
    assert!(matches!(outcome.ending, KilnEnding::Baked { entities: 1, .. }), "{outcome:?}");

    show(&mut app);
    assert_eq!(acting(&mut app), [KilnButton::Bake, KilnButton::Clear, KilnButton::Compare, KilnButton::Plan]);
    assert_eq!(chosen(&mut app), [KilnButton::Bake]);

    activate(&mut app, |button| *button == KilnButton::Select(bare));
    assert_eq!(app.world().resource::<KilnSelection>().0, Some(bare));
    show(&mut app);
    keep(&app, SIZE, "panel_baked.png");

    activate(&mut app, |button| *button == KilnButton::Overlay(KilnOverlay::TexelDensity));
    show(&mut app);
    keep(&app, SIZE, "panel_overlay.png");
    assert_eq!(chosen(&mut app), [KilnButton::Bake, KilnButton::Overlay(KilnOverlay::TexelDensity)]);

    // The same in a larger window: all of the legend, and more of the lists.
    let world = app.world_mut();
    let readers: Vec<Entity> = world.query_filtered::<Entity, With<Readback>>().iter(world).collect();
    for entity in readers.into_iter().chain([camera]) {
        world.despawn(entity);
    }
    let camera = spawn_camera(world, LARGE, 0.8, place);
    world.entity_mut(root).insert(UiTargetCamera(camera));
    activate(&mut app, |button| *button == KilnButton::Compare);
    for _ in 0..PATIENCE {
        app.update();
        if app.world().resource::<KilnComparison>().is_shown {
            break;
        }
    }
    show(&mut app);
    assert_eq!(app.world().resource::<Screen>().0.len(), (LARGE[0] * LARGE[1]) as usize);
    keep(&app, LARGE, "panel_compare.png");
    activate(&mut app, |button| *button == KilnButton::Compare);
    show(&mut app);
    assert!(!app.world().resource::<KilnComparison>().is_on);
}
