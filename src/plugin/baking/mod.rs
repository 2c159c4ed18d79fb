//! Making lightmaps in a running app: reading the world, baking beside it, putting the result on it.

mod control;
mod events;
mod extract;
mod extras;
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
pub use extract::{Extraction, ExtractionWarning, NotReread, Unreadable, Unsimulated, extract_scene};
pub use markers::{LightBlocker, LightmapDensity, LightmapReceiver, NotBaked, ProbeVolume};
pub use settings::{AmbientMode, EmissiveUnit, RangeWindow, SceneSettings};
pub use status::{BakeId, BakeStatus, KilnEnding, KilnOutcome, KilnWork, RunningJob};
pub use warning::KilnWarning;

pub(super) use job::LastBake;

use super::KilnSystems;
use bevy::asset::AssetApp;
use bevy::prelude::*;

pub(super) fn plugin(app: &mut App) {
    app.init_asset::<extract::reread::SecondReading>()
        .register_asset_loader(extract::reread::FileLoader)
        .init_resource::<job::Kiln>()
        .init_resource::<BakeStatus>()
        .init_resource::<NextBake>()
        .register_type::<NextBake>()
        .register_type::<LightmapReceiver>()
        .register_type::<LightBlocker>()
        .register_type::<NotBaked>()
        .register_type::<LightmapDensity>()
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
        .add_systems(PostUpdate, extras::mark.in_set(KilnSystems::Marks).after(super::display::read_extras))
        .add_systems(Last, job::start.in_set(KilnSystems::Snapshot));
}
