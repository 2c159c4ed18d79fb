//! A line across the window: left of it the scene as Bevy shows it by itself, right of it in baked light.
//!
//! Left is a second copy of the scene on a render layer of its own, with the sun, its shadow map and what the
//! reflection probe adds as ambient light, but without lamps: the gloss of those was seen on both layers (Bevy 0.19). A
//! second camera sees it. It is there only while a finished bake is shown, so that no bake ever meets it.

use crate::common::room::Orbit;
use bevy::camera::visibility::{NoFrustumCulling, RenderLayers};
use bevy::camera::{Exposure, SubCameraView, Viewport};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::input::mouse::AccumulatedMouseMotion;
use bevy::pbr::Lightmap;
use bevy::prelude::*;
use bevy::window::PrimaryWindow;
use bevy::world_serialization::WorldInstanceReady;
use bevy_kiln::prelude::*;

const LAYER: usize = 1;

/// How near to the line a drag begins [pixels].
const REACH: f32 = 14.0;

/// Where the line is, as a share of the window's width from its left edge.
#[derive(Resource)]
struct Slider {
    share: f32,
    is_held: bool,
}

/// Everything that is there only beside a finished bake.
#[derive(Component)]
struct Before;

#[derive(Component)]
struct BeforeCamera;

#[derive(Component)]
struct Line;

pub fn plugin(app: &mut App) {
    app.insert_resource(Slider { share: 0.32, is_held: false })
        .add_systems(Startup, spawn_overlay_camera)
        .add_systems(PreUpdate, drag.after(bevy::input::InputSystems))
        .add_systems(Update, come_and_go)
        .add_systems(PostUpdate, split.before(TransformSystems::Propagate))
        .add_observer(dress);
}

/// Words and line lie over both halves.
fn spawn_overlay_camera(mut commands: Commands) {
    let camera = Camera { order: 2, clear_color: ClearColorConfig::None, ..default() };
    commands.spawn((Camera2d, camera, IsDefaultUiCamera));
}

fn drag(
    mut slider: ResMut<Slider>,
    mut motion: ResMut<AccumulatedMouseMotion>,
    buttons: Res<ButtonInput<MouseButton>>,
    window: Single<&Window, With<PrimaryWindow>>,
    before: Query<(), With<BeforeCamera>>,
) {
    let Some(cursor) = window.cursor_position().filter(|_| !before.is_empty()) else { return };
    if buttons.just_pressed(MouseButton::Left) {
        slider.is_held = (cursor.x - slider.share * window.width()).abs() < REACH;
    }
    slider.is_held &= buttons.pressed(MouseButton::Left);
    if slider.is_held {
        slider.share = (cursor.x / window.width()).clamp(0.02, 0.98);
        // The view does not turn meanwhile.
        motion.delta = Vec2::ZERO;
    }
}

fn come_and_go(
    status: Res<BakeStatus>,
    lightmaps: Query<(), With<Lightmap>>,
    rooms: Query<&WorldAssetRoot, With<LightmapReceiver>>,
    before: Query<Entity, With<Before>>,
    mut commands: Commands,
) {
    let is_shown = !lightmaps.is_empty() && status.running().is_none();
    match (is_shown, before.is_empty()) {
        (true, true) => {
            let Some(room) = rooms.iter().next() else { return };
            spawn(&mut commands, room.clone());
        }
        (false, false) => before.iter().for_each(|entity| commands.entity(entity).despawn()),
        _ => {}
    }
}

fn spawn(commands: &mut Commands, room: WorldAssetRoot) {
    commands.spawn((Before, room));
    commands.spawn((
        Before,
        BeforeCamera,
        Camera3d::default(),
        Camera { order: 1, clear_color: ClearColorConfig::None, ..default() },
        DebandDither::Disabled,
        RenderLayers::layer(LAYER),
    ));
    let line = Node { position_type: PositionType::Absolute, width: px(2), height: percent(100), ..default() };
    let word = |text: &str, side: fn(&mut Node)| {
        let mut node = Node { position_type: PositionType::Absolute, top: px(10), ..default() };
        side(&mut node);
        (Text::new(text), TextFont { font_size: FontSize::Px(17.0), ..default() }, TextShadow::default(), node)
    };
    commands.spawn((
        Before,
        Line,
        line,
        BackgroundColor(Color::WHITE),
        children![word("before", |node| node.right = px(12)), word("baked", |node| node.left = px(12))],
    ));
}

/// The copy goes on its layer as soon as it is there.
fn dress(
    ready: On<WorldInstanceReady>,
    copies: Query<(), With<Before>>,
    children: Query<&Children>,
    mut cameras: Query<&mut Camera>,
    mut suns: Query<&mut DirectionalLight>,
    mut lamps: Query<&mut PointLight>,
    mut commands: Commands,
) {
    // Both have shadows, or lamps shine through walls.
    suns.iter_mut().for_each(|mut sun| sun.shadow_maps_enabled = true);
    lamps.iter_mut().for_each(|mut lamp| lamp.shadow_maps_enabled = true);
    let is_copy = copies.contains(ready.entity);
    for entity in children.iter_descendants(ready.entity) {
        // Bevy culls by the viewport's shape and forgets that it is a part of a wider view.
        commands.entity(entity).insert(NoFrustumCulling);
        if !is_copy {
            continue;
        }
        commands.entity(entity).insert(RenderLayers::layer(LAYER));
        if lamps.contains(entity) {
            commands.entity(entity).remove::<PointLight>();
        }
        if let Ok(mut camera) = cameras.get_mut(entity) {
            camera.is_active = false;
        }
    }
}

type Looks<'a> = (&'a Transform, &'a Projection, &'a Exposure, &'a Tonemapping);
type IsBaked = (With<Orbit>, Without<BeforeCamera>);
type LooksToo<'a> = (&'a mut Transform, &'a mut Projection, &'a mut Exposure, &'a mut Tonemapping);

/// Each camera draws its part of the same view.
fn split(
    slider: Res<Slider>,
    window: Single<&Window, With<PrimaryWindow>>,
    baked: Single<(&mut Camera, Looks), IsBaked>,
    before: Option<Single<(&mut Camera, LooksToo), With<BeforeCamera>>>,
    line: Option<Single<&mut Node, With<Line>>>,
) {
    let (mut baked, (view, lens, exposure, tonemapping)) = baked.into_inner();
    let full = window.physical_size();
    let Some(before) = before.filter(|_| full.x > 2 && full.y > 0) else {
        (baked.viewport, baked.sub_camera_view) = (None, None);
        return;
    };
    let (mut before, (mut its_view, mut its_lens, mut its_exposure, mut its_tonemapping)) = before.into_inner();
    (*its_view, *its_lens, *its_exposure, *its_tonemapping) = (*view, lens.clone(), *exposure, *tonemapping);
    let cut = ((slider.share * full.x as f32) as u32).clamp(1, full.x - 1);
    for (camera, from, width) in [(&mut *before, 0, cut), (&mut *baked, cut, full.x - cut)] {
        let (offset, size) = (UVec2::new(from, 0), UVec2::new(width, full.y));
        camera.viewport = Some(Viewport { physical_position: offset, physical_size: size, ..default() });
        camera.sub_camera_view = Some(SubCameraView { full_size: full, offset: offset.as_vec2(), size });
    }
    if let Some(mut line) = line {
        line.left = px(slider.share * window.width() - 1.0);
    }
}
