//! A bake on threads of its own while the game runs on: asked for by triggers, started from a snapshot at the end
//! of the frame, looked after once per frame. While it runs its texels are shown as they come; when it is stopped or
//! fails, what was shown before comes back.

use super::events::{
    BakeFailed, BakeFinished, BakeLightmaps, BakeProgress, BakeScope, CancelBake, ClearLightmaps, LightmapFormat,
};
use super::extract::extract_scene;
use super::live::LiveView;
use super::write_back::{Finished, clear, show_texels, write_back};
use crate::artefact::StableId;
use crate::bake::{BakeError, Baker, CancelToken, Lightmap, Volume, VolumeBake, bake_lightmap, bake_volumes};
use bevy::prelude::*;
use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// What was asked for and is not done yet, and what the last bake left.
#[derive(Resource, Default)]
pub(super) struct Kiln {
    asked: Option<BakeLightmaps>,
    clear_asked: bool,
    job: Option<Job>,
    /// Remembers the last bake.
    baker: Arc<Mutex<Baker>>,
    /// The last bake that was finished and is on show.
    last: Option<OnShow>,
}

/// A bake, and what it belongs on.
#[derive(Clone)]
struct OnShow {
    lightmap: Arc<Lightmap>,
    /// `None` while they are being baked: what is there stays.
    volumes: Option<Arc<Vec<Volume>>>,
    target: Arc<Target>,
}

/// What a bake's thread brings.
struct Baked {
    lightmap: Lightmap,
    volumes: VolumeBake,
}

/// Whose a bake is, and how it is shown.
struct Target {
    entities: BTreeMap<StableId, Entity>,
    ambient_baked: bool,
    format: LightmapFormat,
}

/// The running bake.
struct Job {
    cancel: CancelToken,
    view: Arc<LiveView>,
    /// Whether anything of it has been shown.
    is_on_show: bool,
    /// In a mutex only because a resource must be shareable.
    result: Mutex<Receiver<Result<Baked, BakeError>>>,
    target: Arc<Target>,
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
    let view = Arc::new(LiveView::new(viewpoint(world), asked.format, asked.view));
    let (sender, receiver) = channel();
    let baker = Arc::clone(&world.resource::<Kiln>().baker);
    let volume_settings = extraction.volume_settings(&asked.bake_settings(), asked.volumes, asked.volume_spacing);
    let (scene, settings, their_view, their_cancel) =
        (extraction.scene, asked.bake_settings(), Arc::clone(&view), cancel.clone());
    let worker = std::thread::Builder::new().name("kiln".into()).spawn(move || {
        let lightmap = match asked.scope {
            BakeScope::Changes => {
                let mut baker = baker.lock().unwrap_or_else(PoisonError::into_inner);
                baker.bake(&scene, &settings, &*their_view, &their_cancel)
            }
            BakeScope::Everything => bake_lightmap(&scene, &settings, &*their_view, &their_cancel),
        };
        let result = lightmap.and_then(|lightmap| {
            let volumes = match &volume_settings {
                Some(settings) => bake_volumes(&scene, settings, &*their_view, &their_cancel)?,
                None => VolumeBake::default(),
            };
            Ok(Baked { lightmap, volumes })
        });
        // Nobody listens any more once the app is gone.
        let _ = sender.send(result);
    });
    if let Err(error) = worker {
        world.trigger(failure(&BakeError::Threads { reason: error.to_string() }, warnings));
        return;
    }
    let target = Target {
        entities: extraction.entities,
        ambient_baked: asked.scene.ambient == super::AmbientMode::Bake,
        format: asked.format,
    };
    world.resource_mut::<Kiln>().job =
        Some(Job { cancel, view, is_on_show: false, result: Mutex::new(receiver), target: Arc::new(target), warnings });
}

/// Where the camera that draws to a window first is, if there is one.
fn viewpoint(world: &mut World) -> Option<Vec3> {
    let mut cameras = world.query_filtered::<(&Camera, &GlobalTransform), With<Camera3d>>();
    let active = cameras.iter(world).filter(|(camera, _)| camera.is_active);
    active.min_by_key(|(camera, _)| camera.order).map(|(_, transform)| transform.translation())
}

/// Clears if that was asked for, passes news on, shows texels that have come, and puts a finished bake on its entities.
pub(super) fn look_after(world: &mut World) {
    if std::mem::take(&mut world.resource_mut::<Kiln>().clear_asked) {
        forget(world);
    }
    let Some(job) = &world.resource::<Kiln>().job else { return };
    let news = job.view.progress();
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
    let Some(result) = result else { return show_news(world) };
    let Some(mut job) = world.resource_mut::<Kiln>().job.take() else { return };
    let warnings = std::mem::take(&mut job.warnings);
    match result {
        // It may have been done just before it was stopped; stopped it is, all the same.
        Ok(_) if job.cancel.is_cancelled() => give_up(world, &job, &BakeError::Cancelled, warnings),
        Err(error) => give_up(world, &job, &error, warnings),
        Ok(baked) => finish(world, &job, baked, warnings),
    }
}

/// Shows what has come of the running bake since the last look.
fn show_news(world: &mut World) {
    let mut kiln = world.resource_mut::<Kiln>();
    let Some(job) = kiln.job.as_mut().filter(|job| !job.cancel.is_cancelled()) else { return };
    if let Some(lightmap) = job.view.coarse() {
        job.is_on_show = true;
        let target = Arc::clone(&job.target);
        // What cannot be shown is said once, when the bake is done.
        show(world, &OnShow { lightmap, volumes: None, target });
    } else {
        let due = job.view.due(Instant::now());
        show_texels(world, due);
    }
}

fn show(world: &mut World, on_show: &OnShow) -> super::write_back::Written {
    let OnShow { lightmap, volumes, target } = on_show;
    let Target { entities, ambient_baked, format } = &**target;
    let volumes = volumes.as_ref().map(|volumes| volumes.as_slice());
    write_back(world, &Finished { lightmap, volumes, entities, ambient_baked: *ambient_baked, format: *format })
}

fn finish(world: &mut World, job: &Job, baked: Baked, mut warnings: Vec<String>) {
    let (lightmap, volumes) = (Arc::new(baked.lightmap), Arc::new(baked.volumes.volumes));
    let report = &lightmap.report;
    // What both say of the scene is said once.
    let of_volumes = baked.volumes.report.warnings.iter().filter(|warning| !report.warnings.contains(warning));
    warnings.extend(report.warnings.iter().chain(of_volumes).map(ToString::to_string));
    let (target, shown) = (Arc::clone(&job.target), Some(Arc::clone(&volumes)));
    let on_show = OnShow { lightmap: Arc::clone(&lightmap), volumes: shown, target };
    let written = show(world, &on_show);
    world.resource_mut::<Kiln>().last = Some(on_show);
    warnings.extend(written.warnings);
    world.trigger(BakeFinished {
        texels: report.texels,
        kept: report.kept.unwrap_or(0),
        samples: report.samples,
        seconds: report.wall_seconds,
        entities: written.entities,
        warnings,
        lightmap: Arc::clone(&lightmap),
        volumes,
    });
}

/// Ends a bake without a result: what was shown before it comes back.
fn give_up(world: &mut World, job: &Job, error: &BakeError, warnings: Vec<String>) {
    if job.is_on_show {
        match world.resource::<Kiln>().last.clone() {
            Some(last) => {
                show(world, &last);
            }
            None => clear(world),
        }
    }
    world.trigger(failure(error, warnings));
}

/// Takes off what is shown, and forgets it.
fn forget(world: &mut World) {
    clear(world);
    let mut kiln = world.resource_mut::<Kiln>();
    kiln.last = None;
    // The running bake shows itself again; whoever clears and wants it stopped says so.
    if let Some(job) = &mut kiln.job {
        job.is_on_show = false;
    } else if let Ok(mut baker) = kiln.baker.try_lock() {
        baker.forget();
    }
}

fn failure(error: &BakeError, warnings: Vec<String>) -> BakeFailed {
    BakeFailed { reason: error.to_string(), cancelled: *error == BakeError::Cancelled, warnings }
}
