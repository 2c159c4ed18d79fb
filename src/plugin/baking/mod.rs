//! Making lightmaps in a running app: reading the world, baking beside it, putting the result on it.

mod control;
mod events;
mod extract;
mod job;
mod live;
mod markers;
mod settings;
mod status;
mod stopwatch;
mod warning;
mod write_back;

pub use control::{KilnBusy, KilnControl, NextBake};
pub use events::{
    BakeFailed, BakeFinished, BakeGoal, BakeLightmaps, BakePlanned, BakeProgress, BakeScope, BakeView, BakeVolumes,
    CancelBake, ClearLightmaps, LightmapFormat, LightmapLayout, PauseBake, PlanBake, ResumeBake,
};
pub use extract::{Extraction, ExtractionWarning, Unreadable, Unsimulated, extract_scene};
pub use markers::{LightBlocker, LightmapReceiver, ProbeVolume};
pub use settings::{AmbientMode, EmissiveUnit, RangeWindow, SceneSettings};
pub use status::{BakeId, BakeStatus, KilnEnding, KilnOutcome, KilnWork, RunningJob};
pub use warning::KilnWarning;

pub(super) use job::LastBake;

use super::KilnSystems;
use bevy::prelude::*;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<job::Kiln>()
        .init_resource::<BakeStatus>()
        .init_resource::<NextBake>()
        .register_type::<NextBake>()
        .register_type::<LightmapReceiver>()
        .register_type::<LightBlocker>()
        .register_type::<ProbeVolume>()
        .register_type::<BakeLightmaps>()
        .register_type::<PlanBake>()
        .register_type::<PauseBake>()
        .register_type::<ResumeBake>()
        .register_type::<CancelBake>()
        .register_type::<ClearLightmaps>()
        .register_type::<BakeProgress>()
        .register_type::<BakeFailed>()
        .add_observer(job::ask)
        .add_observer(job::ask_plan)
        .add_observer(job::pause)
        .add_observer(job::resume)
        .add_observer(job::cancel)
        .add_observer(job::ask_clear)
        .add_systems(PreUpdate, job::look_after.in_set(KilnSystems::Display))
        .add_systems(Last, job::start.in_set(KilnSystems::Snapshot));
}
