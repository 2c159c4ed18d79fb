//! The kiln's one front: every door (trigger, key, panel, other process) asks here, and no door knows another.

use super::events::BakeLightmaps;
use super::job::{Kiln, Request};
use super::status::{BakeId, BakeStatus, KilnWork};
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

/// What the next bake shall be like, for every door that is not told otherwise: a key, a button, a request that leaves
/// something out. Starts with the defaults.
#[derive(Resource, Clone, Debug, Default, PartialEq, Deref, DerefMut, Reflect)]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct NextBake(pub BakeLightmaps);

/// Why a job was not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum KilnBusy {
    /// Another one is not done.
    #[error("a bake is running (job {0}); wait for it or cancel it first (CancelBake)")]
    Baking(BakeId),
    /// Another one is not done.
    #[error("a plan is running (job {0}); wait for it or cancel it first (CancelBake)")]
    Planning(BakeId),
}

/// Asks the kiln for things, from a system. Triggers do the same; here a job's number comes back at once.
#[derive(SystemParam)]
pub struct KilnControl<'w> {
    kiln: ResMut<'w, Kiln>,
    status: ResMut<'w, BakeStatus>,
    next: ResMut<'w, NextBake>,
}

impl KilnControl<'_> {
    /// Bakes the world as it is at the end of the frame, as [`BakeLightmaps`] does.
    ///
    /// # Errors
    ///
    /// That another job is not done: one runs at a time.
    pub fn bake(&mut self, settings: BakeLightmaps) -> Result<BakeId, KilnBusy> {
        self.take(KilnWork::Bake, settings)
    }

    /// Plans a bake of the world as it is at the end of the frame, as [`PlanBake`](super::PlanBake) does.
    ///
    /// # Errors
    ///
    /// That another job is not done: one runs at a time.
    pub fn plan(&mut self, settings: BakeLightmaps) -> Result<BakeId, KilnBusy> {
        self.take(KilnWork::Plan, settings)
    }

    /// Stops the job that is under way, and says which that is.
    pub fn cancel(&mut self) -> Option<BakeId> {
        let running = self.status.running()?.id;
        self.kiln.token()?.cancel();
        Some(running)
    }

    /// Holds the job that is under way, and says which that is.
    pub fn pause(&mut self) -> Option<BakeId> {
        let running = self.status.running()?.id;
        self.kiln.token()?.pause();
        self.status.held(true);
        Some(running)
    }

    /// Lets it go on.
    pub fn resume(&mut self) -> Option<BakeId> {
        let running = self.status.running()?.id;
        self.kiln.token()?.resume();
        self.status.held(false);
        Some(running)
    }

    /// Takes the lightmaps of the last bake off again at the start of the next frame.
    pub fn clear(&mut self) {
        self.kiln.ask_to_clear();
    }

    /// Whether anything of a bake is on show, which [`clear`](Self::clear) would take off.
    pub fn has_baked(&self) -> bool {
        self.kiln.is_on_show()
    }

    /// What the kiln is at.
    pub fn status(&self) -> &BakeStatus {
        &self.status
    }

    /// What the next bake shall be like.
    pub fn next_bake(&mut self) -> &mut BakeLightmaps {
        &mut self.next.0
    }

    /// The same, to look at.
    pub fn settings(&self) -> &BakeLightmaps {
        &self.next.0
    }

    /// The number of a job that is refused.
    pub(super) fn refused(&mut self) -> BakeId {
        self.status.next_id()
    }

    fn take(&mut self, work: KilnWork, settings: BakeLightmaps) -> Result<BakeId, KilnBusy> {
        match self.status.running().map(|running| (running.work, running.id)) {
            Some((KilnWork::Bake, id)) => return Err(KilnBusy::Baking(id)),
            Some((KilnWork::Plan, id)) => return Err(KilnBusy::Planning(id)),
            None => {}
        }
        let id = self.status.next_id();
        self.status.waiting(id, work);
        self.kiln.ask(Request::new(id, work, settings));
        Ok(id)
    }
}
