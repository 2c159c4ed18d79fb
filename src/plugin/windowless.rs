//! A scene file in an app without window, GPU or log: what the `kiln` command bakes from, and any other program
//! that bakes on a machine without a screen.

mod error;

pub use error::OpenError;

use super::{ExtractionWarning, KilnPlugin};
use bevy::app::{App, PluginGroup, PluginGroupBuilder, TaskPoolPlugin};
use bevy::asset::{AssetLoadError, AssetPlugin, LoadState, RecursiveDependencyLoadState, UnapprovedPathMode};
use bevy::gltf::{Gltf, GltfLoaderSettings, GltfPlugin};
use bevy::image::{CompressedImageFormatSupport, CompressedImageFormats};
use bevy::prelude::*;
use bevy::window::{ExitCondition, WindowPlugin};
use bevy::world_serialization::{DynamicWorld, DynamicWorldRoot, WorldAssetRoot, WorldSerializationPlugin};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Frames after loading in which a scene is spawned and its transforms and visibility are propagated.
const FRAMES_TO_SETTLE: usize = 3;

/// Longest wait for a file to load.
const PATIENCE: Duration = Duration::from_secs(600);

/// Extensions of glTF that change where light goes and that Bevy's loader does not read.
const UNREAD_EXTENSIONS: [&str; 5] = [
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
];

/// Those of them that the opened scene uses.
#[derive(Resource, Default)]
struct UnreadExtensions(Vec<String>);

/// All of Bevy that a scene needs to be read, and no renderer; to build an app of one's own with
/// [`KilnPlugin`].
#[derive(Clone, Debug, Default)]
pub struct WindowlessPlugins {
    /// Where assets are found.
    pub asset_folder: PathBuf,
}

impl PluginGroup for WindowlessPlugins {
    fn build(self) -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(TaskPoolPlugin::default())
            .add(bevy::diagnostic::FrameCountPlugin)
            .add(bevy::time::TimePlugin)
            .add(TransformPlugin)
            .add(AssetPlugin {
                file_path: self.asset_folder.to_string_lossy().into_owned(),
                // The person who runs the program names the file.
                unapproved_path_mode: UnapprovedPathMode::Allow,
                ..default()
            })
            .add(WorldSerializationPlugin)
            // No window; but cameras listen for what windows do.
            .add(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
            .add(bevy::render::RenderPlugin { render_creation: no_gpu(), ..default() })
            .add(ImagePlugin::default())
            .add(bevy::mesh::MeshPlugin)
            // Lights draw theirs where a game has them.
            .add(bevy::gizmos::GizmoPlugin)
            .add(bevy::camera::CameraPlugin)
            .add(bevy::light::LightPlugin)
            .add(GltfPlugin::default())
            .add(bevy::pbr::PbrPlugin::default())
    }
}

fn no_gpu() -> bevy::render::settings::RenderCreation {
    use bevy::render::settings::{RenderCreation, WgpuSettings};
    RenderCreation::Automatic(Box::new(WgpuSettings { backends: None, ..default() }))
}

/// Opens a scene file in an app of its own, loaded and spawned, with no ambient light; ready for
/// [`extract_scene`](super::extract_scene).
pub fn open_scene(path: &Path) -> Result<App, OpenError> {
    let kind = Kind::of(path)?;
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    if !absolute.is_file() {
        return Err(OpenError::Missing { path: path.to_owned() });
    }
    let (Some(folder), Some(file)) = (absolute.parent(), absolute.file_name()) else {
        return Err(OpenError::Missing { path: path.to_owned() });
    };
    let mut app = App::new();
    // Without a GPU nothing is uploaded, so compressed textures need no format that one supports.
    app.insert_resource(CompressedImageFormatSupport(CompressedImageFormats::all()))
        .add_plugins(WindowlessPlugins { asset_folder: folder.to_owned() })
        .add_plugins(KilnPlugin)
        .insert_resource(GlobalAmbientLight::NONE);
    app.finish();
    app.cleanup();
    let file = bevy::asset::AssetPath::from(PathBuf::from(file));
    match kind {
        Kind::Gltf => {
            let handle =
                app.world().resource::<AssetServer>().load_builder().with_settings(keep_source).load::<Gltf>(file);
            wait(&mut app, handle.id().untyped(), path, OpenError::of_scene)?;
            spawn_gltf(&mut app, &handle, path)?;
        }
        Kind::DynamicWorld => {
            let handle = app.world().resource::<AssetServer>().load::<DynamicWorld>(file);
            wait(&mut app, handle.id().untyped(), path, OpenError::of_scene)?;
            app.world_mut().spawn(DynamicWorldRoot(handle));
        }
    }
    for _ in 0..FRAMES_TO_SETTLE {
        app.update();
    }
    Ok(app)
}

/// What of the file behind an app of [`open_scene`] Bevy's loader has not read.
pub fn unread_parts(app: &App) -> Vec<ExtractionWarning> {
    let unread = app.world().get_resource::<UnreadExtensions>();
    let names = unread.map(|unread| unread.0.clone()).unwrap_or_default();
    names.into_iter().map(|extension| ExtractionWarning::ExtensionNotRead { extension }).collect()
}

/// Loads an equirectangular picture of the sky, for [`SceneSettings::environment`](super::SceneSettings).
pub fn load_environment(app: &mut App, path: &Path) -> Result<Handle<Image>, OpenError> {
    let name = path.file_name().map(|name| name.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    if !(name.ends_with(".hdr") || name.ends_with(".exr")) {
        return Err(OpenError::UnknownPicture { path: path.to_owned() });
    }
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    if !absolute.is_file() {
        return Err(OpenError::Missing { path: path.to_owned() });
    }
    let handle = app.world().resource::<AssetServer>().load::<Image>(bevy::asset::AssetPath::from(absolute));
    wait(app, handle.id().untyped(), path, OpenError::of_picture)?;
    Ok(handle)
}

enum Kind {
    Gltf,
    DynamicWorld,
}

impl Kind {
    fn of(path: &Path) -> Result<Self, OpenError> {
        let name = path.file_name().map(|name| name.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        if name.ends_with(".glb") || name.ends_with(".gltf") {
            Ok(Self::Gltf)
        } else if name.ends_with(".scn.ron") {
            Ok(Self::DynamicWorld)
        } else {
            Err(OpenError::UnknownKind { path: path.to_owned() })
        }
    }
}

fn spawn_gltf(app: &mut App, handle: &Handle<Gltf>, path: &Path) -> Result<(), OpenError> {
    let gltf = app.world().resource::<Assets<Gltf>>().get(handle);
    let scene = gltf.and_then(|gltf| gltf.default_scene.clone().or_else(|| gltf.scenes.first().cloned()));
    let Some(scene) = scene else { return Err(OpenError::NoScene { path: path.to_owned() }) };
    let unread = unread_extensions(app, handle);
    app.insert_resource(UnreadExtensions(unread));
    app.world_mut().spawn(WorldAssetRoot(scene));
    Ok(())
}

/// Has the loader keep what it read the scene from, for [`unread_extensions`].
fn keep_source(settings: &mut GltfLoaderSettings) {
    settings.include_source = true;
}

/// The extensions that a file uses and its loader does not read; lets go of what the loader kept.
fn unread_extensions(app: &mut App, handle: &Handle<Gltf>) -> Vec<String> {
    let mut files = app.world_mut().resource_mut::<Assets<Gltf>>();
    let Some(source) = files.get_mut(handle).and_then(|mut gltf| gltf.source.take()) else { return Vec::new() };
    let used = source.extensions_used().filter(|used| UNREAD_EXTENSIONS.contains(used));
    used.map(ToOwned::to_owned).collect()
}

/// Runs the app until an asset is loaded with all that it refers to.
fn wait(
    app: &mut App,
    id: bevy::asset::UntypedAssetId,
    path: &Path,
    broken: fn(&Path, &AssetLoadError) -> OpenError,
) -> Result<(), OpenError> {
    let start = Instant::now();
    loop {
        app.update();
        let server = app.world().resource::<AssetServer>();
        match (server.load_state(id), server.recursive_dependency_load_state(id)) {
            (LoadState::Failed(error), _) => return Err(broken(path, &error)),
            (_, RecursiveDependencyLoadState::Failed(error)) => return Err(broken(path, &error)),
            (LoadState::Loaded, RecursiveDependencyLoadState::Loaded) => return Ok(()),
            _ if start.elapsed() > PATIENCE => return Err(OpenError::TooSlow { path: path.to_owned() }),
            _ => std::thread::sleep(Duration::from_millis(1)),
        }
    }
}
