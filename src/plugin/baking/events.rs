//! What a game says to the baker and hears from it. All are triggered with `commands.trigger(...)` and heard by
//! observers.

use super::extract::extract_scene;
use super::settings::SceneSettings;
use super::status::BakeId;
use super::warning::KilnWarning;
use crate::bake::{
    BakeError, BakePlan, BakeSettings, CancelToken, Denoise, Goal, LaterBounces, Layout, Lightmap, Progress, Stage,
    Volume,
};
use crate::output::{OutputError, OutputFormat, write_bake};
use crate::trace::{Estimator, ForcedEffects, Sharing, Transport};
use bevy::prelude::*;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// Where the texels go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum LightmapLayout {
    /// Each object has a rectangle of its own at the asked density.
    #[default]
    Packed,
    /// UV1 is one atlas for the whole scene, laid out by its artist.
    Shared {
        /// Width and height of the map [texels].
        size: u32,
    },
}

/// When a texel has been sampled enough.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum BakeGoal {
    /// When the truth lies, in 95 of 100 cases, no farther off than this share of its value: 0.02 is 2 %. Dark texels
    /// are held to a share of [`DARK`](crate::bake::DARK) of the mean. Before denoising.
    Error(f64),
    /// When so many paths have started from it.
    Samples(u32),
    /// The smallest error that a short pilot says can be had in this time.
    Time(Duration),
}

impl Default for BakeGoal {
    fn default() -> Self {
        Self::Error(0.02)
    }
}

impl From<BakeGoal> for Goal {
    fn from(goal: BakeGoal) -> Self {
        match goal {
            BakeGoal::Error(error) => Self::Error(error),
            BakeGoal::Samples(paths) => Self::Samples(paths),
            BakeGoal::Time(time) => Self::Time(time),
        }
    }
}

/// How the textures hold their texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum LightmapFormat {
    /// 4 bytes per texel, 9 bits for each channel and a common exponent.
    #[default]
    Rgb9e5,
    /// 8 bytes per texel, half floats.
    Rgba16f,
}

/// How much is measured when a scene is baked once more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum BakeScope {
    /// What changes since the last bake of the same settings reach, to within a quarter of the error that is asked for;
    /// the rest is kept. What is remembered for that takes about as much memory as the bake, until
    /// [`ClearLightmaps`].
    #[default]
    Changes,
    /// Everything: the same bits as from the command line.
    Everything,
}

/// What is seen of a bake while it runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum BakeView {
    /// Its texels as they come: all in coarse first, then those near the camera before those far off.
    #[default]
    Live,
    /// Nothing until it is done.
    WhenDone,
}

/// Which irradiance volumes are baked beside the lightmaps, for what moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum BakeVolumes {
    /// Those in the boxes that are placed as [`ProbeVolume`](super::ProbeVolume); without any, some around the scene if
    /// there are meshes that take no part in the bake.
    #[default]
    WhereCalledFor,
    /// The same, also without such meshes: for what has yet to spawn.
    Always,
    /// None.
    Never,
}

/// Asks for a bake of the world as it is at the end of the frame. The game runs on; when the lightmaps are done
/// they go on the entities, and [`BakeFinished`] is triggered. One bake runs at a time.
#[derive(Event, Clone, Debug, PartialEq, Reflect)]
#[reflect(Event, Default, Debug, PartialEq, Clone)]
pub struct BakeLightmaps {
    /// How the scene is read.
    pub scene: SceneSettings,
    /// When a texel has been sampled enough.
    pub goal: BakeGoal,
    /// How light is found that has met more than one surface: the fast mode is off by default.
    #[reflect(ignore)]
    pub later_bounces: LaterBounces,
    /// Texels per metre of surface where an object asks for nothing else.
    pub density: f32,
    /// Where the texels go.
    pub layout: LightmapLayout,
    /// Largest width and height of a texture, 64 to 4096 [texels].
    pub max_page_size: u32,
    /// Whether noise is taken out of the texels.
    #[reflect(ignore)]
    pub denoise: Denoise,
    /// Bounces before a path is cut, which loses light: `Some(0)` is direct light only. `None` has no cap.
    pub max_bounces: Option<u32>,
    /// Which samples an estimate of light is made of; all have the same mean.
    #[reflect(ignore)]
    pub estimator: Estimator,
    /// Changes every random number, and nothing else.
    pub seed: u64,
    /// The most that one path may bring [cd/m²]: takes out bright specks and, with them, light. `None` takes nothing.
    pub clamp: Option<f32>,
    /// Effects that are simulated, or not, whatever the scene calls for.
    #[reflect(ignore)]
    pub effects: ForcedEffects,
    /// How much is measured when a scene is baked once more.
    pub scope: BakeScope,
    /// What is seen of the bake while it runs.
    pub view: BakeView,
    /// Threads that trace; 0 for all cores.
    pub threads: u32,
    /// How the textures hold their texels.
    pub format: LightmapFormat,
    /// Which irradiance volumes are baked too. Their probes are sampled to two and a half times the error.
    pub volumes: BakeVolumes,
    /// Side of a cell of volumes that nobody has placed [m]; `None` for 0.25 m, or as much more as keeps them to about
    /// 32 768 probes.
    pub volume_spacing: Option<f32>,
}

impl Default for BakeLightmaps {
    fn default() -> Self {
        let core = BakeSettings::default();
        Self {
            scene: SceneSettings::default(),
            goal: BakeGoal::default(),
            later_bounces: core.later_bounces,
            density: core.density,
            layout: LightmapLayout::default(),
            max_page_size: core.max_page_size,
            denoise: core.denoise,
            max_bounces: core.transport.max_bounces,
            estimator: core.transport.estimator,
            seed: core.transport.seed,
            clamp: core.transport.clamp,
            effects: core.transport.effects,
            scope: BakeScope::default(),
            view: BakeView::default(),
            threads: 0,
            format: LightmapFormat::default(),
            volumes: BakeVolumes::default(),
            volume_spacing: None,
        }
    }
}

impl BakeLightmaps {
    /// What this bake would do with the world as it stands, and what it would cost. Traces a pilot on the calling
    /// thread: seconds at most for a scene of ordinary size.
    ///
    /// # Errors
    ///
    /// What would keep the bake from being done.
    pub fn plan(&self, world: &mut World) -> Result<BakePlan, BakeError> {
        let scene = extract_scene(world, &self.scene).scene;
        BakePlan::for_scene(&scene, &self.bake_settings(), &(), &CancelToken::default())
    }

    /// The same in the baker's own words.
    pub fn bake_settings(&self) -> BakeSettings {
        BakeSettings {
            transport: Transport {
                estimator: self.estimator,
                max_bounces: self.max_bounces,
                sharing: Sharing::default(),
                seed: self.seed,
                clamp: self.clamp,
                effects: self.effects,
            },
            goal: self.goal.into(),
            later_bounces: self.later_bounces,
            density: self.density,
            layout: match self.layout {
                LightmapLayout::Packed => Layout::Packed,
                LightmapLayout::Shared { size } => Layout::Shared { size },
            },
            max_page_size: self.max_page_size,
            denoise: self.denoise,
            threads: usize::try_from(self.threads).ok().and_then(NonZeroUsize::new),
        }
    }
}

/// Asks what a bake of the world as it is at the end of the frame would do and cost. The game runs on; then
/// [`BakePlanned`] is triggered. A plan is a job as a bake is: one runs at a time, and it can be paused and cancelled.
#[derive(Event, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Event, Default, Debug, PartialEq, Clone)]
pub struct PlanBake {
    /// The bake.
    pub bake: BakeLightmaps,
}

/// Holds the running bake or plan: its threads end what they are at, which takes a tile's time, and then use no processor.
/// The result is the same to the bit; time that is asked for by [`BakeGoal::Time`] goes on.
#[derive(Event, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Event, Default, Debug, PartialEq, Clone)]
pub struct PauseBake;

/// Lets it go on.
#[derive(Event, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Event, Default, Debug, PartialEq, Clone)]
pub struct ResumeBake;

/// Stops the running bake or plan. What was shown before it comes back, and [`BakeFailed`] says that it was cancelled.
#[derive(Event, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Event, Default, Debug, PartialEq, Clone)]
pub struct CancelBake;

/// Takes the lightmaps of the last bake off again and gives lights, ambient light and earlier lightmaps back as
/// they were.
#[derive(Event, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Event, Default, Debug, PartialEq, Clone)]
pub struct ClearLightmaps;

/// How far the running bake is. Triggered at most once per frame, and only when there is news.
#[derive(Event, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Event, Debug, PartialEq, Clone)]
pub struct BakeProgress {
    /// Which job.
    pub job: BakeId,
    /// What it is doing.
    #[reflect(ignore, default = "first_stage")]
    pub stage: Stage,
    /// Finished parts of the stage.
    pub done: u64,
    /// All parts of the stage.
    pub total: u64,
    /// Mean relative standard error of what is done, once known.
    pub relative_stderr: Option<f64>,
}

impl BakeProgress {
    pub(super) fn new(job: BakeId, progress: Progress) -> Self {
        let Progress { stage, done, total, relative_stderr } = progress;
        Self { job, stage, done, total, relative_stderr }
    }

    /// Share of the stage that is done, in [0, 1].
    pub fn fraction(&self) -> f64 {
        if self.total == 0 { 0.0 } else { self.done as f64 / self.total as f64 }
    }
}

/// The lightmaps are done and on their entities.
#[derive(Event, Clone, Debug, Reflect)]
#[reflect(from_reflect = false)]
#[reflect(Debug, Clone)]
pub struct BakeFinished {
    /// Which job.
    pub job: BakeId,
    /// Covered texels.
    pub texels: u64,
    /// Of these, those that were kept from the bake before, since no change reaches them.
    pub kept: u64,
    /// Paths that started from them.
    pub samples: u64,
    /// Time that passed [s].
    pub seconds: f64,
    /// How many entities got a lightmap.
    pub entities: usize,
    /// What was left out or changed.
    pub warnings: Vec<KilnWarning>,
    /// The whole result with its report.
    #[reflect(ignore)]
    pub lightmap: Arc<Lightmap>,
    /// The irradiance volumes.
    #[reflect(ignore)]
    pub volumes: Arc<Vec<Volume>>,
}

impl BakeFinished {
    /// Writes the bake into this folder, which a shipped game shows with
    /// [`BakedLightmaps`](crate::plugin::BakedLightmaps), in textures of [`OutputFormat::Rgb9e5`]. The folder is made if
    /// it is missing; a relative path starts where the program was started. [`write_bake`] has other formats.
    ///
    /// ```no_run
    /// # use bevy::prelude::*;
    /// # use bevy_kiln::prelude::*;
    /// # let mut app = App::new();
    /// app.add_observer(|done: On<BakeFinished>| {
    ///     if let Err(why) = done.save("assets/baked/level") {
    ///         error!("{why}");
    ///     }
    /// });
    /// ```
    ///
    /// # Errors
    ///
    /// What keeps the folder from being written; it stays as it was.
    pub fn save(&self, folder: impl AsRef<Path>) -> Result<(), OutputError> {
        let folder = folder.as_ref();
        let scene = folder.file_name().unwrap_or_default().to_string_lossy();
        write_bake(&self.lightmap, &self.volumes, &scene, folder, OutputFormat::Rgb9e5)?;
        Ok(())
    }
}

/// A plan is made. The world is as it was.
#[derive(Event, Clone, Debug, Reflect)]
#[reflect(from_reflect = false)]
#[reflect(Debug, Clone)]
pub struct BakePlanned {
    /// Which job.
    pub job: BakeId,
    /// What the bake would do, its prices and its memory.
    #[reflect(ignore)]
    pub plan: Arc<BakePlan>,
    /// What would be left out or changed.
    pub warnings: Vec<KilnWarning>,
}

/// There are no new lightmaps, or no plan; the world is as it was.
#[derive(Event, Clone, Debug, PartialEq, Eq, Reflect)]
#[reflect(Event, Debug, PartialEq, Clone)]
pub struct BakeFailed {
    /// Which job; one that was refused has a number as well.
    pub job: BakeId,
    /// Why, as a sentence that says what to do.
    pub reason: String,
    /// Whether a person stopped it.
    pub cancelled: bool,
    /// What had been left out by then.
    pub warnings: Vec<KilnWarning>,
}

fn first_stage() -> Stage {
    Stage::Prepare
}
