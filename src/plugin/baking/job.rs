//! A bake on threads of its own while the game runs on: asked for by triggers, started from a snapshot at the end
//! of the frame, looked after once per frame.

use super::events::{
    BakeFailed, BakeFinished, BakeLightmaps, BakeProgress, CancelBake, ClearLightmaps, LightmapFormat,
};
use super::extract::extract_scene;
use super::write_back::{Finished, clear, write_back};
use crate::artefact::StableId;
use crate::bake::{BakeError, CancelToken, Lightmap, Progress, bake_lightmap};
use bevy::prelude::*;
use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// What was asked for and is not done yet.
#[derive(Resource, Default)]
pub(super) struct Kiln {
    asked: Option<BakeLightmaps>,
    clear_asked: bool,
    job: Option<Job>,
}

/// The running bake.
struct Job {
    cancel: CancelToken,
    progress: Arc<Mutex<Option<Progress>>>,
    /// In a mutex only because a resource must be shareable.
    result: Mutex<Receiver<Result<Lightmap, BakeError>>>,
    entities: BTreeMap<StableId, Entity>,
    ambient_baked: bool,
    format: LightmapFormat,
    warnings: Vec<String>,
}

impl Drop for Job {
    fn drop(&mut self) {
        self.cancel.cancel();
    }
}

pub(super) fn ask(asked: On<BakeLightmaps>, mut kiln: ResMut<Kiln>, mut commands: Commands) {
    if kiln.job.is_some() || kiln.asked.is_some() {
        let reason = "a bake is running; wait for it or trigger CancelBake first".to_owned();
        commands.trigger(BakeFailed { reason, cancelled: false, warnings: Vec::new() });
        return;
    }
    kiln.asked = Some(asked.event().clone());
}

pub(super) fn cancel(_: On<CancelBake>, mut kiln: ResMut<Kiln>, mut commands: Commands) {
    if kiln.asked.take().is_some() {
        commands.trigger(failure(&BakeError::Cancelled, Vec::new()));
    }
    if let Some(job) = &kiln.job {
        job.cancel.cancel();
    }
}

pub(super) fn ask_clear(_: On<ClearLightmaps>, mut kiln: ResMut<Kiln>) {
    kiln.clear_asked = true;
}

/// Takes the snapshot of a bake that was asked for and starts it.
pub(super) fn start(world: &mut World) {
    let Some(asked) = world.resource_mut::<Kiln>().asked.take() else { return };
    let extraction = extract_scene(world, &asked.scene);
    let warnings: Vec<String> = extraction.warnings.iter().map(ToString::to_string).collect();
    let cancel = CancelToken::default();
    let progress = Arc::new(Mutex::new(None));
    let (sender, receiver) = channel();
    let settings = asked.bake_settings();
    let (scene, their_cancel, their_progress) = (extraction.scene, cancel.clone(), Arc::clone(&progress));
    let worker = std::thread::Builder::new().name("kiln".into()).spawn(move || {
        let note = |news: Progress| {
            *their_progress.lock().unwrap_or_else(PoisonError::into_inner) = Some(news);
        };
        // Nobody listens any more once the app is gone.
        let _ = sender.send(bake_lightmap(&scene, &settings, &note, &their_cancel));
    });
    if let Err(error) = worker {
        world.trigger(failure(&BakeError::Threads { reason: error.to_string() }, warnings));
        return;
    }
    world.resource_mut::<Kiln>().job = Some(Job {
        cancel,
        progress,
        result: Mutex::new(receiver),
        entities: extraction.entities,
        ambient_baked: asked.scene.ambient == super::AmbientMode::Bake,
        format: asked.format,
        warnings,
    });
}

/// Clears if that was asked for, passes news on, and puts a finished bake on its entities.
pub(super) fn look_after(world: &mut World) {
    if std::mem::take(&mut world.resource_mut::<Kiln>().clear_asked) {
        clear(world);
    }
    let Some(job) = &world.resource::<Kiln>().job else { return };
    let news = job.progress.lock().unwrap_or_else(PoisonError::into_inner).take();
    let result = match job.result.lock().unwrap_or_else(PoisonError::into_inner).try_recv() {
        Ok(result) => Some(result),
        Err(TryRecvError::Empty) => None,
        Err(TryRecvError::Disconnected) => {
            let reason = "the baking thread ended without a result".to_owned();
            Some(Err(BakeError::Threads { reason }))
        }
    };
    if let Some(news) = news {
        world.trigger(BakeProgress::from(news));
    }
    let Some(result) = result else { return };
    let Some(mut job) = world.resource_mut::<Kiln>().job.take() else { return };
    let warnings = std::mem::take(&mut job.warnings);
    match result {
        // It may have been done just before it was stopped; stopped it is, all the same.
        Ok(_) if job.cancel.is_cancelled() => world.trigger(failure(&BakeError::Cancelled, warnings)),
        Err(error) => world.trigger(failure(&error, warnings)),
        Ok(lightmap) => finish(world, &job, Arc::new(lightmap), warnings),
    }
}

fn finish(world: &mut World, job: &Job, lightmap: Arc<Lightmap>, mut warnings: Vec<String>) {
    let report = &lightmap.report;
    warnings.extend(report.warnings.iter().map(ToString::to_string));
    let finished =
        Finished { lightmap: &lightmap, entities: &job.entities, ambient_baked: job.ambient_baked, format: job.format };
    let written = write_back(world, &finished);
    warnings.extend(written.warnings);
    world.trigger(BakeFinished {
        texels: report.texels,
        samples: report.samples,
        seconds: report.wall_seconds,
        entities: written.entities,
        warnings,
        lightmap: Arc::clone(&lightmap),
    });
}

fn failure(error: &BakeError, warnings: Vec<String>) -> BakeFailed {
    BakeFailed { reason: error.to_string(), cancelled: *error == BakeError::Cancelled, warnings }
}
