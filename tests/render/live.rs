//! Lightmaps that come, change and go on entities that are being drawn: the pixels say what is really shown. One
//! app for all cases, since starting a renderer is slow.

use crate::skip;
use bevy::app::PluginsState;
use bevy::asset::RenderAssetUsages;
use bevy::camera::{Exposure, Hdr, RenderTarget};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::ecs::system::RunSystemOnce;
use bevy::log::LogPlugin;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::{TextureFormat, TextureUsages};
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use bevy_kiln::prelude::*;
use half::f16;

/// Rows of 32 pixels of 8 bytes need no padding.
const WIDTH: u32 = 32;
const HEIGHT: u32 = 8;

/// Frames after which a change of the world must be on the screen.
const FRAMES_TO_SHOW: usize = 12;

/// Frames in which a bake of a few hundred texels must end.
const PATIENCE: usize = 20_000;

const LEFT: Vec3 = Vec3::new(0.5, 0.5, 0.5);
const RIGHT: Vec3 = Vec3::new(0.8, 0.4, 0.2);

/// The last picture, linear.
#[derive(Resource, Default)]
struct Screen(Vec<Vec3>);

#[derive(Resource, Default)]
struct Heard(usize);

/// Under a sky of one radiance L a floor that sees nothing else gets E = π·L, so its texels are L to the last bit of
/// their format and its pixels L · albedo · exposure.
#[test]
fn lightmaps_come_change_and_go_on_what_is_drawn() {
    let Some(mut app) = app() else { return };
    app.world_mut().run_system_once(spawn).unwrap();
    show(&mut app);
    check(&app, "before the first bake", Vec3::ZERO);

    let first = Vec3::new(1.0, 0.5, 0.25);
    bake(&mut app, first, 4.0);
    check(&app, "baked", first);

    let second = Vec3::new(0.25, 0.75, 1.0);
    bake(&mut app, second, 4.0);
    check(&app, "baked anew, in the same texture", second);

    let third = Vec3::new(0.125, 0.25, 0.75);
    bake(&mut app, third, 7.0);
    check(&app, "baked anew, in a texture of another size", third);

    app.world_mut().trigger(ClearLightmaps);
    show(&mut app);
    check(&app, "cleared", Vec3::ZERO);

    bake(&mut app, first, 7.0);
    check(&app, "baked after all was cleared", first);
}

fn app() -> Option<App> {
    let start = || {
        let mut app = App::new();
        let engine = DefaultPlugins
            .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
            .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
            .set(LogPlugin { filter: "error".to_owned(), ..default() })
            .disable::<WinitPlugin>()
            .disable::<PipelinedRenderingPlugin>();
        app.add_plugins((engine, KilnPlugin));
        app
    };
    // Bevy panics where there is no driver.
    let app = std::panic::catch_unwind(start);
    let Ok(mut app) = app else {
        skip("there is no graphics driver; .ci/install-renderer.sh installs one");
        return None;
    };
    app.init_resource::<Screen>()
        .init_resource::<Heard>()
        .insert_resource(ClearColor(Color::BLACK))
        .insert_resource(GlobalAmbientLight::NONE)
        .add_observer(|_: On<BakeFinished>, mut heard: ResMut<Heard>| heard.0 += 1)
        .add_observer(|failed: On<BakeFailed>| panic!("{}", failed.reason));
    while app.plugins_state() == PluginsState::Adding {
        std::thread::yield_now();
    }
    app.finish();
    app.cleanup();
    Some(app)
}

/// Two squares of floor side by side, and a camera above them.
fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
) {
    let mesh = Mesh::from(Plane3d::default().mesh().size(2.0, 2.0));
    let uv = mesh.attribute(Mesh::ATTRIBUTE_UV_0).unwrap().clone();
    let mesh = meshes.add(mesh.with_inserted_attribute(Mesh::ATTRIBUTE_UV_1, uv));
    for (name, x, albedo) in [("left", -1.0, LEFT), ("right", 1.0, RIGHT)] {
        let base_color = Color::linear_rgb(albedo.x, albedo.y, albedo.z);
        let material = materials.add(StandardMaterial { base_color, reflectance: 0.0, ..default() });
        let place = Transform::from_xyz(x, 0.0, 0.0);
        commands.spawn((Name::new(name), Mesh3d(mesh.clone()), MeshMaterial3d(material), place));
    }
    let mut target = Image::new_target_texture(WIDTH, HEIGHT, TextureFormat::Rgba16Float, None);
    target.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    target.asset_usage = RenderAssetUsages::default();
    let target = images.add(target);
    commands.spawn((
        Camera3d::default(),
        Hdr,
        Msaa::Off,
        Tonemapping::None,
        DebandDither::Disabled,
        Exposure { ev100: 0.0 },
        RenderTarget::Image(target.clone().into()),
        // 0.8 m high and 3.2 m wide on the floor.
        Projection::Perspective(PerspectiveProjection { fov: 2.0 * (0.4f32 / 3.0).atan(), ..default() }),
        Transform::from_xyz(0.0, 3.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z),
    ));
    commands.spawn(Readback::texture(target)).observe(|read: On<ReadbackComplete>, mut screen: ResMut<Screen>| {
        let half = |bytes: &[u8]| f16::from_le_bytes([bytes[0], bytes[1]]).to_f32();
        let pixels = read.data.chunks_exact(8);
        screen.0 = pixels.map(|p| Vec3::new(half(&p[0..]), half(&p[2..]), half(&p[4..]))).collect();
    });
}

fn step(app: &mut App) {
    app.update();
    // What the renderer refuses ends the app.
    assert!(app.should_exit().is_none(), "the renderer has reported an error");
}

fn show(app: &mut App) {
    for _ in 0..FRAMES_TO_SHOW {
        step(app);
    }
}

fn bake(app: &mut App, sky_radiance: Vec3, density: f32) {
    app.world_mut().resource_mut::<Heard>().0 = 0;
    app.world_mut().trigger(BakeLightmaps {
        scene: SceneSettings { sky_radiance, ..default() },
        samples_per_texel: 16,
        density,
        format: LightmapFormat::Rgba16f,
        ..default()
    });
    let mut frames = 0;
    while app.world().resource::<Heard>().0 == 0 {
        frames += 1;
        assert!(frames < PATIENCE, "the bake does not end");
        step(app);
    }
    show(app);
}

fn check(app: &App, when: &str, texel: Vec3) {
    let screen = &app.world().resource::<Screen>().0;
    assert_eq!(screen.len(), (WIDTH * HEIGHT) as usize, "{when}: nothing was read back");
    for (side, x, albedo) in [("left", WIDTH / 4, LEFT), ("right", 3 * WIDTH / 4, RIGHT)] {
        let seen = screen[(HEIGHT / 2 * WIDTH + x) as usize];
        // 1/1.2 is the exposure at EV100 0.
        let expected = texel * albedo / 1.2;
        // Half floats twice, in the lightmap and in the target.
        let error = (seen - expected).abs();
        assert!(error.cmple(expected * 2e-3).all(), "{when}, {side}: {seen} for {expected}");
    }
}
