//! Making lightmaps in a running app: reading the world, baking beside it, putting the result on it.

mod events;
mod extract;
mod job;
mod live;
mod markers;
mod settings;
mod write_back;

pub use events::{
    BakeFailed, BakeFinished, BakeGoal, BakeLightmaps, BakeProgress, BakeScope, BakeView, BakeVolumes, CancelBake,
    ClearLightmaps, LightmapFormat, LightmapLayout,
};
pub use extract::{Extraction, ExtractionWarning, Unreadable, Unsimulated, extract_scene};
pub use markers::{LightBlocker, LightmapReceiver, ProbeVolume};
pub use settings::{AmbientMode, EmissiveUnit, RangeWindow, SceneSettings};

use super::KilnSystems;
use bevy::prelude::*;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<job::Kiln>()
        .register_type::<LightmapReceiver>()
        .register_type::<LightBlocker>()
        .register_type::<ProbeVolume>()
        .register_type::<BakeLightmaps>()
        .register_type::<CancelBake>()
        .register_type::<ClearLightmaps>()
        .add_observer(job::ask)
        .add_observer(job::cancel)
        .add_observer(job::ask_clear)
        .add_systems(PreUpdate, job::look_after.in_set(KilnSystems::Display))
        .add_systems(Last, job::start.in_set(KilnSystems::Snapshot));
}
