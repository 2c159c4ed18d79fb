//! Direct light by itself. A bake measures all light at once, so this is a second, coarse bake of the same world that
//! ends at the first surface; what is left of the bake is indirect.

use crate::bake::{BakeError, CancelToken, Goal, Lightmap, Page, bake_lightmap};
use crate::plugin::baking::LastBake;
use crate::plugin::{BakeId, extract_scene};
use bevy::prelude::*;
use glam::Vec3;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// Paths per texel, of which each looks for light once.
pub(super) const PATHS: u32 = 64;

/// Direct light of a bake, once it is there.
pub(super) enum Split {
    /// On its way.
    Running(Running),
    /// Per page and texel [cd/m²].
    Done {
        /// Of which bake.
        of: BakeId,
        /// E/π of direct light, page by page.
        direct: Arc<Vec<Vec<Vec3>>>,
    },
    /// Nothing came of it.
    Failed {
        /// Of which bake.
        of: BakeId,
        /// Why, as a sentence.
        reason: String,
    },
}

/// The thread that bakes it; dropped, it ends.
pub(super) struct Running {
    of: LastBake,
    cancel: CancelToken,
    /// In a mutex only because a resource must be shareable.
    result: Mutex<Receiver<Result<Lightmap, BakeError>>>,
}

impl Drop for Running {
    fn drop(&mut self) {
        self.cancel.cancel();
    }
}

impl Split {
    /// Starts it, with the world as it is; its transforms must have been propagated.
    pub(super) fn start(world: &mut World, of: LastBake) -> Self {
        let scene = extract_scene(world, &of.settings().scene).scene;
        let mut settings = of.settings().bake_settings();
        settings.goal = Goal::Samples(PATHS);
        settings.transport.max_bounces = Some(0);
        let (sender, receiver) = channel();
        let cancel = CancelToken::default();
        let their_cancel = cancel.clone();
        let worker = std::thread::Builder::new().name("kiln direct light".into()).spawn(move || {
            // Nobody listens any more once the overlay is off.
            let _ = sender.send(bake_lightmap(&scene, &settings, &(), &their_cancel));
        });
        match worker {
            Ok(_) => Self::Running(Running { of, cancel, result: Mutex::new(receiver) }),
            Err(error) => Self::Failed { of: of.id(), reason: format!("no thread could be started: {error}") },
        }
    }

    /// Which bake it is of.
    pub(super) fn of(&self) -> BakeId {
        match self {
            Self::Running(running) => running.of.id(),
            Self::Done { of, .. } | Self::Failed { of, .. } => *of,
        }
    }

    /// What has become of it, if it is over.
    pub(super) fn look(&self) -> Option<Self> {
        let Self::Running(Running { of, result, .. }) = self else { return None };
        let result = result.lock().unwrap_or_else(PoisonError::into_inner).try_recv();
        let id = of.id();
        Some(match result {
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => {
                Self::Failed { of: id, reason: "its thread ended without a result".to_owned() }
            }
            Ok(Err(error)) => Self::Failed { of: id, reason: error.to_string() },
            Ok(Ok(direct)) if !is_laid_out_alike(&direct, &of.lightmap) => {
                Self::Failed { of: id, reason: "the world has changed since it was baked; bake it again".to_owned() }
            }
            Ok(Ok(direct)) => {
                let direct = direct.pages.into_iter().map(|page| page.radiance).collect();
                Self::Done { of: id, direct: Arc::new(direct) }
            }
        })
    }
}

/// Whether texels of both stand for the same places.
fn is_laid_out_alike(a: &Lightmap, b: &Lightmap) -> bool {
    let size = |page: &Page| (page.width, page.height);
    a.placements == b.placements && a.pages.iter().map(size).eq(b.pages.iter().map(size))
}

/// What is left of a texel without its direct light; noise may take it below nothing.
pub(super) fn indirect(all: Vec3, direct: Vec3) -> Vec3 {
    (all - direct).max(Vec3::ZERO)
}
