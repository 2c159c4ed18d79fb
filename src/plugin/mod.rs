//! bevy_kiln inside Bevy: the only part that knows the engine.
//!
//! [`KilnPlugin`] brings all of it. A shipped game needs [`BakedLightmaps`] alone and may leave out the `bake`
//! feature, and with it the tracer.
//!
//! ```no_run
//! # #[cfg(feature = "bake")] {
//! use bevy::prelude::*;
//! use bevy_kiln::prelude::*;
//!
//! fn bake(keys: Res<ButtonInput<KeyCode>>, mut commands: Commands) {
//!     if keys.just_pressed(KeyCode::KeyB) {
//!         commands.trigger(BakeLightmaps::default()); // to 2 %, 16 texels per metre, as displayed
//!     }
//!     if keys.just_pressed(KeyCode::Escape) {
//!         commands.trigger(CancelBake); // the world is again as it was
//!     }
//!     if keys.just_pressed(KeyCode::KeyC) {
//!         commands.trigger(ClearLightmaps); // lightmaps off, lights back
//!     }
//! }
//!
//! App::new()
//!     .add_plugins((DefaultPlugins, KilnPlugin))
//!     .add_systems(Update, bake)
//!     .add_observer(|at: On<BakeProgress>| info!("{:.0} %", 100.0 * at.fraction()))
//!     .add_observer(|done: On<BakeFinished>| info!("{} texels in {:.1} s", done.texels, done.seconds))
//!     .add_observer(|failed: On<BakeFailed>| error!("{}", failed.reason))
//!     .run();
//! # }
//! ```
//!
//! [`BakePlanned`] answers [`PlanBake`]: what a bake would do and cost. [`PauseBake`] and [`ResumeBake`] hold it for a
//! while, to the same bits. [`BakeStatus`] is what a panel shows of all that, and [`KilnControl`] asks from a system
//! and hands back the number of the job. [`KilnShortcuts`] puts it on keys. With the feature `remote` and Bevy's
//! `RemotePlugin`, another process calls `kiln.bake`, `kiln.plan`, `kiln.progress`, `kiln.pause`, `kiln.resume`,
//! `kiln.cancel` and `kiln.clear`, with any of `error`, `spp`, `time` [s] and `density` and what else [`BakeLightmaps`]
//! has; what it leaves out is as [`NextBake`] says, as for the keys. Bind it to the loopback address: whoever reaches
//! the port can do anything with the app.
//!
//! [`KilnOverlays`] draws what a bake knows of its texels on the surfaces ([`KilnOverlay`]) and, beside the frame, a
//! path-traced picture of the same world from the same camera ([`CompareWithTruth`]).
//!
//! What moves is lit by irradiance volumes ([`BakeVolumes`]): they come with the lightmaps where the scene has meshes
//! that take no part in the bake. Boxes are found, or placed as [`ProbeVolume`].
//!
//! Mark what shall receive a lightmap with [`LightmapReceiver`], what only blocks and reflects with [`LightBlocker`]
//! and what moves with [`NotBaked`], on the thing or on anything above it; without a receiver anywhere every mesh
//! receives. An artist marks the same in Blender, by custom properties (docs/blender.md). What a folder of the `kiln`
//! command holds goes on a scene as [`BakedLightmaps`] beside its root.
//!
//! A bake shows itself while it runs ([`BakeView`]): the whole map in coarse first, then finished texels, those near
//! the camera before those far off. Bake again after moving a lamp or adding a chair, and only what that reaches is
//! measured ([`BakeScope`]).
//!
//! What is left out is named. A skinned or morphed mesh takes part only where a mark asks for it: it then blocks light
//! in the pose in which it stands. Things on other render layers than [`SceneSettings::layers`] (0) take no part. Light
//! passes through what has `NotShadowCaster`, which therefore reflects none. Of the levels of detail of an object
//! (`VisibilityRange`) the nearest takes part.
//!
//! Meshes and images that Bevy has handed to the renderer alone (`RenderAssetUsages::RENDER_WORLD`) are read again from
//! their files, before the bake starts and without holding up the game. What was made in code has none: keep it in the
//! main world as well. So keep meshes without a usable second UV set, or their lightmaps cannot be shown.
//!
//! A mesh without a usable second UV set is given one by the bake, which splits it along the borders of its charts.
//! While the bake is shown, the entity's `Mesh3d` holds such a copy; it gets its own mesh back with `ClearLightmaps` or
//! when [`BakedLightmaps`] goes. A game that changes a mesh after its bake sees the change when it is baked again.
//!
//! Lights, materials and skies are read as Bevy shows them; a material of the game's own as the game describes it
//! ([`BakedMaterialApp::add_baked_material`]). What shines from all around is a camera's
//! `EnvironmentMapLight`, or the picture in [`SceneSettings::environment`]. A `RectLight` is baked in any case, but
//! Bevy draws it only with its own feature `area_light_luts`. Bevy's glTF loader gives lights without a range one of 20
//! m, and spot lights their range as their radius; both are taken away again. It also takes their linear colours for
//! sRGB ones, so that a coloured light is more saturated than its file says; that is baked as Bevy shows it.
//!
//! Deferred rendering adds baked lights a second time whatever the flags say (Bevy 0.19); use forward rendering.

mod display;

#[cfg(feature = "bake")]
mod baking;
#[cfg(feature = "bake")]
mod overlay;
#[cfg(feature = "editor")]
mod panel;
#[cfg(feature = "remote")]
mod remote;
#[cfg(feature = "bake")]
mod shortcuts;
#[cfg(feature = "cli")]
pub mod windowless;

pub use display::{
    AppliedLightmaps, BakedFolder, BakedFolderError, BakedLightmaps, BakedMaterialApp, BakedVolume, KilnId,
    LightBaking, LightmapFiltering, stable_id,
};

#[cfg(feature = "bake")]
use display::StableIds;

#[cfg(feature = "bake")]
pub use baking::{
    AmbientMode, BakeFailed, BakeFinished, BakeGoal, BakeId, BakeLightmaps, BakePlanned, BakeProgress, BakeScope,
    BakeStatus, BakeView, BakeVolumes, CancelBake, ClearLightmaps, EmissiveUnit, Extraction, ExtractionWarning,
    KilnBusy, KilnControl, KilnEnding, KilnOutcome, KilnWarning, KilnWork, LightBlocker, LightmapDensity,
    LightmapFormat, LightmapLayout, LightmapReceiver, NextBake, NotBaked, NotReread, PauseBake, PlanBake, ProbeVolume,
    RangeWindow, ResumeBake, RunningJob, SceneSettings, Unreadable, Unsimulated, extract_scene,
};

#[cfg(feature = "bake")]
pub use overlay::{CompareWithTruth, KilnComparison, KilnLegend, KilnOverlay, KilnOverlays, StopComparing, Swatch};
#[cfg(feature = "editor")]
pub use panel::{KilnButton, KilnPanel, KilnPanelRoot, KilnSelect, KilnSelection};
#[cfg(feature = "bake")]
pub use shortcuts::KilnShortcuts;

use bevy::prelude::*;

/// Baked global illumination: loads and shows lightmaps and, with the feature `bake`, makes them.
#[derive(Clone, Copy, Debug, Default)]
pub struct KilnPlugin;

/// When the plugin works.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KilnSystems {
    /// In `PreUpdate`: lightmaps go on and off, lights are muted and given back. Bevy looks for changed materials
    /// in `PostUpdate`, so nothing of this may be later.
    Display,
    /// In `PostUpdate`, before transforms are propagated: what is marked in a glTF file that has spawned becomes
    /// components.
    Marks,
    /// In `Last`, where every transform is propagated: the snapshot for a bake that was asked for.
    Snapshot,
}

impl Plugin for KilnPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(display::plugin);
        #[cfg(feature = "bake")]
        app.add_plugins(baking::plugin);
    }

    #[cfg(feature = "remote")]
    fn finish(&self, app: &mut App) {
        remote::finish(app);
    }
}
