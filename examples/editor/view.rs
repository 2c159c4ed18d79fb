//! The scene, a camera that flies through it, and light where it has none.

use crate::args::Args;
use bevy::asset::LoadState;
use bevy::camera_controller::free_camera::FreeCamera;
use bevy::prelude::*;
use bevy::world_serialization::WorldInstanceReady;
use bevy_kiln::prelude::*;

const HELP: &str = "W A S D  fly     hold right mouse button  look     Ctrl+B  bake or stop     Ctrl+Shift+B  hold     Ctrl+Alt+B  clear";

/// Texels that a first bake shall have, and the bounds of what follows for their density [1/m].
const TEXELS: f32 = 250_000.0;
const DENSITIES: [f32; 2] = [0.5, 32.0];

#[derive(Resource)]
struct Opened(Handle<WorldAsset>);

#[derive(Component)]
struct Help;

pub fn plugin(app: &mut App) {
    app.add_systems(Startup, open)
        .add_systems(Update, say_what_failed.run_if(resource_exists::<Opened>))
        .add_observer(look)
        .add_observer(light);
}

fn open(args: Res<Args>, assets: Res<AssetServer>, mut commands: Commands) {
    let scene = assets.load(GltfAssetLabel::Scene(0).from_asset(args.file.clone()));
    commands.insert_resource(Opened(scene.clone()));
    commands.spawn((WorldAssetRoot(scene), LightmapReceiver::default()));
    commands.spawn((Camera3d::default(), FreeCamera::default()));
    commands.spawn((
        Help,
        Text::new(HELP),
        TextFont { font_size: FontSize::Px(15.0), ..default() },
        TextShadow::default(),
        Node { position_type: PositionType::Absolute, left: px(12), bottom: px(10), ..default() },
    ));
}

fn say_what_failed(opened: Res<Opened>, assets: Res<AssetServer>, mut help: Single<&mut Text, With<Help>>) {
    if let Some(LoadState::Failed(error)) = assets.get_load_state(&opened.0)
        && help.0 == HELP
    {
        help.0 = error.to_string().lines().next().unwrap_or_default().to_owned();
    }
}

type FileCamera<'a> = (&'a Transform, &'a Projection, &'a mut Camera);
type OwnCamera<'a> = (&'a mut Transform, &'a mut Projection, &'a mut FreeCamera);
type Meshes<'a> = (&'a Mesh3d, &'a GlobalTransform);

/// Looks at the scene as its own camera does, or from outside. How dense a first bake is follows from how large it is.
fn look(
    _: On<WorldInstanceReady>,
    args: Res<Args>,
    things: Query<Meshes>,
    meshes: Res<Assets<Mesh>>,
    mut theirs: Query<FileCamera, (With<Camera3d>, Without<FreeCamera>)>,
    own: Single<OwnCamera>,
    mut next: ResMut<NextBake>,
) {
    let (mut place, mut lens, mut camera) = own.into_inner();
    let (low, high, area) = extent(&things, &meshes);
    let (centre, size) = (0.5 * (low + high), (high - low).length().max(1e-3));
    let direction = Vec3::new(0.7, 0.5, 1.0).normalize();
    *place = Transform::from_translation(centre + 0.9 * size * direction).looking_at(centre, Vec3::Y);
    for (view, its_lens, mut its_camera) in &mut theirs {
        its_camera.is_active = false;
        *place = *view;
        *lens = its_lens.clone();
    }
    if let Projection::Perspective(lens) = &mut *lens {
        (lens.near, lens.far) = (lens.near.min(1e-3 * size), lens.far.max(4.0 * size));
    }
    (camera.walk_speed, camera.run_speed) = (0.15 * size, 0.6 * size);
    next.goal = BakeGoal::Error(args.error);
    next.density = args.density.unwrap_or((TEXELS / area.max(1e-6)).sqrt().clamp(DENSITIES[0], DENSITIES[1]));
}

type Lights = Or<(With<DirectionalLight>, With<PointLight>, With<SpotLight>)>;

/// Lights what has no light of its own.
fn light(
    _: On<WorldInstanceReady>,
    lights: Query<(), Lights>,
    mut suns: Query<&mut DirectionalLight>,
    mut next: ResMut<NextBake>,
    mut commands: Commands,
) {
    suns.iter_mut().for_each(|mut sun| sun.shadow_maps_enabled = true);
    if lights.is_empty() {
        next.scene.sky_radiance = Vec3::new(2000.0, 2500.0, 3500.0);
        let sun = DirectionalLight { illuminance: 20_000.0, shadow_maps_enabled: true, ..default() };
        commands.spawn((sun, Transform::default().looking_to(Vec3::new(-0.5, -1.0, -0.35), Vec3::Y)));
        commands.insert_resource(ClearColor(Color::srgb(0.8, 0.87, 1.0)));
    }
}

/// The box around everything [m], and how much surface is in it [m²].
fn extent(things: &Query<Meshes>, meshes: &Assets<Mesh>) -> (Vec3, Vec3, f32) {
    let triangles =
        things.iter().filter_map(|(mesh, place)| Some((meshes.get(&mesh.0)?, place))).flat_map(|(mesh, place)| {
            let corners = mesh.triangles().into_iter().flatten();
            corners.map(|triangle| triangle.vertices.map(|corner| place.transform_point(corner)))
        });
    let nothing = (Vec3::INFINITY, Vec3::NEG_INFINITY, 0.0);
    let (low, high, area) = triangles.fold(nothing, |(low, high, area), [a, b, c]| {
        let around = (low.min(a.min(b).min(c)), high.max(a.max(b).max(c)));
        (around.0, around.1, area + 0.5 * (b - a).cross(c - a).length())
    });
    if area > 0.0 { (low, high, area) } else { (Vec3::ZERO, Vec3::ONE, 1.0) }
}
