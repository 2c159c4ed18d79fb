//! The room from its file, what of it takes part in a bake, and a camera that goes around it.

use super::args::Args;
use super::bake::Status;
use bevy::asset::LoadState;
use bevy::camera::Exposure;
use bevy::core_pipeline::tonemapping::DebandDither;
use bevy::input::mouse::{AccumulatedMouseMotion, AccumulatedMouseScroll, MouseScrollUnit};
use bevy::prelude::*;
use bevy::world_serialization::WorldInstanceReady;
use bevy_kiln::prelude::*;
use std::f32::consts::FRAC_PI_2;

/// How fast arrow keys turn the view [rad/s].
const KEY_SPEED: f32 = 1.2;

/// How far a drag turns the view [rad/pixel].
const DRAG_SPEED: f32 = 0.005;

#[derive(Resource)]
struct Room(Handle<WorldAsset>);

/// A camera that looks at a point from a distance.
#[derive(Component)]
pub struct Orbit {
    target: Vec3,
    yaw: f32,
    pitch: f32,
    distance: f32,
}

pub fn plugin(app: &mut App) {
    app
        // Bevy adds 80 cd/m² of its own to everything otherwise.
        .insert_resource(GlobalAmbientLight::NONE)
        .add_systems(Startup, open)
        .add_systems(Update, (notice_failure.run_if(resource_exists::<Room>), orbit))
        .add_observer(mark)
        .add_observer(look);
}

fn open(args: Res<Args>, assets: Res<AssetServer>, mut commands: Commands) {
    let stage = args.stage;
    commands.insert_resource(ClearColor(stage.background));
    let scene = assets.load(GltfAssetLabel::Scene(0).from_asset(stage.file));
    commands.insert_resource(Room(scene.clone()));
    // Everything in the file receives a lightmap, but for what `mark` marks otherwise.
    commands.spawn((WorldAssetRoot(scene), LightmapReceiver::default()));
    commands.spawn((
        Camera3d::default(),
        Exposure { ev100: args.ev100 },
        stage.tonemapping,
        DebandDither::Disabled,
        Orbit { target: Vec3::ZERO, yaw: 0.0, pitch: 0.0, distance: stage.distance },
    ));
}

fn notice_failure(
    room: Res<Room>,
    args: Res<Args>,
    assets: Res<AssetServer>,
    mut status: ResMut<Status>,
    mut commands: Commands,
) {
    let Some(LoadState::Failed(error)) = assets.get_load_state(&room.0) else { return };
    let reason = error.to_string();
    let reason = reason.lines().next().unwrap_or_default();
    *status = Status::Failed(format!("{} cannot be opened ({reason}); run from a whole clone", args.stage.file));
    commands.remove_resource::<Room>();
}

type FileCamera<'a> = (&'a Transform, &'a Projection, &'a mut Camera);
type OwnCamera<'a> = (&'a mut Transform, &'a mut Projection, &'a mut Orbit);

/// The room is there: takes over the view of the file's camera. An example may have scenes of its own besides.
fn look(
    ready: On<WorldInstanceReady>,
    rooms: Query<(), With<LightmapReceiver>>,
    mut theirs: Query<FileCamera, (With<Camera3d>, Without<Orbit>)>,
    own: Single<OwnCamera>,
    mut status: ResMut<Status>,
) {
    if !rooms.contains(ready.entity) {
        return;
    }
    let (mut transform, mut projection, mut orbit) = own.into_inner();
    for (view, lens, mut camera) in &mut theirs {
        camera.is_active = false;
        *transform = *view;
        *projection = lens.clone();
        (orbit.yaw, orbit.pitch, _) = view.rotation.to_euler(EulerRot::YXZ);
        orbit.target = view.translation + view.forward() * orbit.distance;
    }
    *status = Status::Dark;
}

fn mark(
    _: On<WorldInstanceReady>,
    names: Query<(Entity, &Name)>,
    mut suns: Query<&mut DirectionalLight>,
    mut commands: Commands,
) {
    // What stays of a baked sun is its gloss, which would shine through walls.
    for mut sun in &mut suns {
        sun.shadow_maps_enabled = true;
    }
    // The lamp has no UV1, and its light drowns what falls on it.
    for (lamp, _) in names.iter().filter(|(_, name)| name.as_str() == "lamp") {
        commands.entity(lamp).insert(LightBlocker);
    }
}

fn orbit(
    keys: Res<ButtonInput<KeyCode>>,
    buttons: Res<ButtonInput<MouseButton>>,
    motion: Res<AccumulatedMouseMotion>,
    scroll: Res<AccumulatedMouseScroll>,
    time: Res<Time>,
    camera: Single<(&mut Transform, &mut Orbit)>,
) {
    let held = |key| if keys.pressed(key) { KEY_SPEED * time.delta_secs() } else { 0.0 };
    let mut turn = Vec2::new(
        held(KeyCode::ArrowLeft) - held(KeyCode::ArrowRight),
        held(KeyCode::ArrowUp) - held(KeyCode::ArrowDown),
    );
    if buttons.pressed(MouseButton::Left) {
        turn -= motion.delta * DRAG_SPEED;
    }
    let lines = match scroll.unit {
        MouseScrollUnit::Line => scroll.delta.y,
        MouseScrollUnit::Pixel => scroll.delta.y / MouseScrollUnit::SCROLL_UNIT_CONVERSION_FACTOR,
    };
    if turn == Vec2::ZERO && lines == 0.0 {
        return;
    }
    let (mut transform, mut orbit) = camera.into_inner();
    orbit.yaw += turn.x;
    orbit.pitch = (orbit.pitch + turn.y).clamp(0.01 - FRAC_PI_2, FRAC_PI_2 - 0.01);
    orbit.distance = (orbit.distance * (-0.1 * lines).exp()).clamp(0.5, 40.0);
    transform.rotation = Quat::from_euler(EulerRot::YXZ, orbit.yaw, orbit.pitch, 0.0);
    transform.translation = orbit.target - transform.forward() * orbit.distance;
}
