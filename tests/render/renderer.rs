//! Bevy's renderer without a window, and its pictures as numbers.

use crate::skip;
use bevy::app::PluginsState;
use bevy::asset::{RenderAssetUsages, UnapprovedPathMode};
use bevy::camera::{Exposure, Hdr, RenderTarget};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
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

/// Frames after which a change of the world must be on the screen.
const FRAMES_TO_SHOW: usize = 12;

/// Frames in which a bake of a few thousand texels must end.
const PATIENCE: usize = 20_000;

/// What the screen shows of a radiance of 1 cd/m² with [`camera`].
pub const EXPOSURE: f64 = 1.0 / 1.2;

/// The last picture, linear, row by row.
#[derive(Resource, Default)]
pub struct Screen(pub Vec<Vec3>);

/// What the last bake has said.
#[derive(Resource, Default)]
struct Heard(Option<BakeFinished>);

/// An app with a black sky and no ambient light; `None` where there is no driver.
pub fn app() -> Option<App> {
    app_with(|_| {})
}

/// The same with more in it.
pub fn app_with(more: impl FnOnce(&mut App)) -> Option<App> {
    let start = || {
        let mut app = App::new();
        let engine = DefaultPlugins
            .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
            .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
            // The tests' folders lie elsewhere.
            .set(AssetPlugin { unapproved_path_mode: UnapprovedPathMode::Allow, ..default() })
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
    more(&mut app);
    app.init_resource::<Screen>()
        .init_resource::<Heard>()
        .insert_resource(ClearColor(Color::BLACK))
        .insert_resource(GlobalAmbientLight::NONE)
        .add_observer(|done: On<BakeFinished>, mut heard: ResMut<Heard>| heard.0 = Some(done.event().clone()))
        .add_observer(|failed: On<BakeFailed>| panic!("{}", failed.reason));
    while app.plugins_state() == PluginsState::Adding {
        std::thread::yield_now();
    }
    app.finish();
    app.cleanup();
    Some(app)
}

/// A camera that shows linear light, of which [`Screen`] gets the picture. Rows of 8 bytes per pixel must fill
/// multiples of 256 bytes.
pub fn spawn_camera(world: &mut World, [width, height]: [u32; 2], vertical_fov: f32, place: Transform) -> Entity {
    let mut target = Image::new_target_texture(width, height, TextureFormat::Rgba16Float, None);
    target.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    target.asset_usage = RenderAssetUsages::default();
    let target = world.resource_mut::<Assets<Image>>().add(target);
    world.spawn(Readback::texture(target.clone())).observe(|read: On<ReadbackComplete>, mut screen: ResMut<Screen>| {
        let half = |bytes: &[u8]| f16::from_le_bytes([bytes[0], bytes[1]]).to_f32();
        let pixels = read.data.chunks_exact(8);
        screen.0 = pixels.map(|p| Vec3::new(half(&p[0..]), half(&p[2..]), half(&p[4..]))).collect();
    });
    let projection = Projection::Perspective(PerspectiveProjection { fov: vertical_fov, ..default() });
    let camera = (
        Camera3d::default(),
        Hdr,
        Msaa::Off,
        Tonemapping::None,
        DebandDither::Disabled,
        Exposure { ev100: 0.0 },
        RenderTarget::Image(target.into()),
        projection,
        place,
    );
    world.spawn(camera).id()
}

fn step(app: &mut App) {
    app.update();
    // What the renderer refuses ends the app.
    assert!(app.should_exit().is_none(), "the renderer has reported an error");
}

/// Runs until what the world is now is on the screen.
pub fn show(app: &mut App) {
    for _ in 0..FRAMES_TO_SHOW {
        step(app);
    }
}

/// Bakes and runs until the result is on the screen.
pub fn bake(app: &mut App, asked: BakeLightmaps) -> BakeFinished {
    app.world_mut().resource_mut::<Heard>().0 = None;
    app.world_mut().trigger(asked);
    let mut frames = 0;
    while app.world().resource::<Heard>().0.is_none() {
        frames += 1;
        assert!(frames < PATIENCE, "the bake does not end");
        step(app);
    }
    show(app);
    app.world_mut().resource_mut::<Heard>().0.take().unwrap()
}
