//! A bake or a plan on threads of its own while the game runs on: asked for at any time, started from a snapshot at the
//! end of the frame, looked after once per frame. While a bake runs its texels are shown as they come; when it is
//! stopped or fails, what was shown before comes back.

use super::control::KilnControl;
use super::events::{
    BakeFailed, BakeFinished, BakeLightmaps, BakePlanned, BakeProgress, BakeScope, BakeView, CancelBake,
    ClearLightmaps, PauseBake, PlanBake, ResumeBake,
};
use super::extract::{Extraction, extract_scene, reread};
use super::live::LiveView;
use super::status::{BakeId, BakeStatus, KilnEnding, KilnOutcome, KilnWork};
use super::warning::{KilnWarning, Names};
use super::write_back::{Finished, clear, show_texels, write_back};
use crate::artefact::StableId;
use crate::bake::{
    BakeError, BakePlan, BakeSettings, Baker, CancelToken, Lightmap, Volume, VolumeBake, VolumeSettings, bake_lightmap,
    bake_volumes,
};
use crate::scene::Scene;
use bevy::prelude::*;
use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// What was asked for and is not done yet, and what the last bake left.
#[derive(Resource, Default)]
pub(super) struct Kiln {
    asked: Option<Request>,
    clear_asked: bool,
    job: Option<Job>,
    /// Remembers the last bake.
    baker: Arc<Mutex<Baker>>,
    /// The last bake that was finished and is on show.
    last: Option<OnShow>,
}

impl Kiln {
    pub(super) fn ask(&mut self, request: Request) {
        self.asked = Some(request);
    }

    pub(super) fn ask_to_clear(&mut self) {
        self.clear_asked = true;
    }

    pub(super) fn is_on_show(&self) -> bool {
        self.last.is_some() || self.job.as_ref().is_some_and(|job| job.is_on_show)
    }

    /// The switch of the job that is under way.
    pub(super) fn token(&self) -> Option<&CancelToken> {
        let asked = self.asked.as_ref().map(|request| &request.cancel);
        asked.or(self.job.as_ref().map(|job| &job.request.cancel))
    }
}

/// A job as it was asked for.
pub(super) struct Request {
    id: BakeId,
    work: KilnWork,
    settings: BakeLightmaps,
    cancel: CancelToken,
}

impl Request {
    pub(super) fn new(id: BakeId, work: KilnWork, settings: BakeLightmaps) -> Self {
        Self { id, work, settings, cancel: CancelToken::default() }
    }
}

/// A bake that was finished and is on show, for whoever looks into it.
#[derive(Clone)]
pub(in crate::plugin) struct LastBake {
    /// What was baked.
    pub(in crate::plugin) lightmap: Arc<Lightmap>,
    target: Arc<Target>,
}

impl LastBake {
    /// The last one, until it is cleared.
    pub(in crate::plugin) fn of(world: &World) -> Option<Self> {
        let OnShow { lightmap, target, .. } = world.get_resource::<Kiln>()?.last.as_ref()?;
        Some(Self { lightmap: Arc::clone(lightmap), target: Arc::clone(target) })
    }

    /// Which job it was.
    pub(in crate::plugin) fn id(&self) -> BakeId {
        self.target.id
    }

    /// What was asked for.
    pub(in crate::plugin) fn settings(&self) -> &BakeLightmaps {
        &self.target.settings
    }

    /// The entity that had this id.
    pub(in crate::plugin) fn entity(&self, id: &StableId) -> Option<Entity> {
        self.target.entities.get(id).copied()
    }
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
    id: BakeId,
    settings: BakeLightmaps,
    entities: BTreeMap<StableId, Entity>,
}

/// What a job makes.
enum Product {
    Baked(Box<Baked>),
    Plan(Arc<BakePlan>),
}

/// The running job.
struct Job {
    request: Request,
    view: Arc<LiveView>,
    /// Whether anything of it has been shown.
    is_on_show: bool,
    /// In a mutex only because a resource must be shareable.
    result: Mutex<Receiver<Result<Product, BakeError>>>,
    target: Arc<Target>,
    names: Names,
    warnings: Vec<KilnWarning>,
}

impl Drop for Job {
    fn drop(&mut self) {
        self.request.cancel.cancel();
    }
}

pub(super) fn ask(asked: On<BakeLightmaps>, mut kiln: KilnControl, mut commands: Commands) {
    if let Err(busy) = kiln.bake(asked.event().clone()) {
        commands.trigger(refusal(kiln.refused(), busy.to_string()));
    }
}

pub(super) fn ask_plan(asked: On<PlanBake>, mut kiln: KilnControl, mut commands: Commands) {
    if let Err(busy) = kiln.plan(asked.bake.clone()) {
        commands.trigger(refusal(kiln.refused(), busy.to_string()));
    }
}

pub(super) fn cancel(_: On<CancelBake>, mut kiln: KilnControl) {
    kiln.cancel();
}

pub(super) fn pause(_: On<PauseBake>, mut kiln: KilnControl) {
    kiln.pause();
}

pub(super) fn resume(_: On<ResumeBake>, mut kiln: KilnControl) {
    kiln.resume();
}

pub(super) fn ask_clear(_: On<ClearLightmaps>, mut kiln: KilnControl) {
    kiln.clear();
}

/// Takes the snapshot of a job that was asked for and starts it; in a later frame if files must be read again for it.
pub(super) fn start(world: &mut World) {
    let Some(request) = world.resource_mut::<Kiln>().asked.take() else { return };
    if request.cancel.is_cancelled() {
        reread::forget(world);
        return fail(world, request.id, &BakeError::Cancelled, Vec::new());
    }
    if reread::is_reading(world) {
        return world.resource_mut::<Kiln>().ask(request);
    }
    let extraction = extract_scene(world, &request.settings.scene);
    if reread::ask(world, &extraction) {
        return world.resource_mut::<Kiln>().ask(request);
    }
    reread::forget(world);
    let names = Names::new(world, &extraction);
    let view = match request.work {
        KilnWork::Plan => BakeView::WhenDone,
        KilnWork::Bake => request.settings.view,
    };
    let view = Arc::new(LiveView::new(viewpoint(world), request.settings.format, view));
    let (sender, receiver) = channel();
    let baker = Arc::clone(&world.resource::<Kiln>().baker);
    let (work, scope, settings) = (request.work, request.settings.scope, request.settings.bake_settings());
    let volumes = extraction.volume_settings(&settings, request.settings.volumes, request.settings.volume_spacing);
    let Extraction { scene, warnings, entities, .. } = extraction;
    let warnings = warnings.iter().map(|warning| names.warning(warning)).collect();
    let (their_view, their_cancel) = (Arc::clone(&view), request.cancel.clone());
    let worker = std::thread::Builder::new().name("kiln".into()).spawn(move || {
        let result = match work {
            KilnWork::Plan => BakePlan::for_scene(&scene, &settings, &*their_view, &their_cancel)
                .map(|plan| Product::Plan(Arc::new(plan))),
            // What cannot be is refused before anything is traced.
            KilnWork::Bake => volumes
                .as_ref()
                .map_or(Ok(()), VolumeSettings::validate)
                .and_then(|()| bake(&baker, scope, &scene, &settings, &their_view, &their_cancel))
                .and_then(|lightmap| with_volumes(lightmap, volumes, &scene, &their_view, &their_cancel)),
        };
        // Nobody listens any more once the app is gone.
        let _ = sender.send(result);
    });
    if let Err(error) = worker {
        return fail(world, request.id, &BakeError::Threads { reason: error.to_string() }, warnings);
    }
    let target = Arc::new(Target { id: request.id, settings: request.settings.clone(), entities });
    world.resource_mut::<BakeStatus>().started();
    world.resource_mut::<Kiln>().job =
        Some(Job { request, view, is_on_show: false, result: Mutex::new(receiver), target, names, warnings });
}

fn bake(
    baker: &Mutex<Baker>,
    scope: BakeScope,
    scene: &Scene,
    settings: &BakeSettings,
    view: &LiveView,
    cancel: &CancelToken,
) -> Result<Lightmap, BakeError> {
    match scope {
        BakeScope::Changes => {
            let mut baker = baker.lock().unwrap_or_else(PoisonError::into_inner);
            baker.bake(scene, settings, view, cancel)
        }
        BakeScope::Everything => bake_lightmap(scene, settings, view, cancel),
    }
}

/// Bakes the volumes that go with a lightmap.
fn with_volumes(
    lightmap: Lightmap,
    settings: Option<VolumeSettings>,
    scene: &Scene,
    view: &LiveView,
    cancel: &CancelToken,
) -> Result<Product, BakeError> {
    let volumes = match settings {
        Some(settings) => bake_volumes(scene, &settings, view, cancel)?,
        None => VolumeBake::default(),
    };
    Ok(Product::Baked(Box::new(Baked { lightmap, volumes })))
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
    let (id, news) = (job.request.id, job.view.progress());
    let result = match job.result.lock().unwrap_or_else(PoisonError::into_inner).try_recv() {
        Ok(result) => Some(result),
        Err(TryRecvError::Empty) => None,
        Err(TryRecvError::Disconnected) => {
            let reason = "the baking thread ended without a result".to_owned();
            Some(Err(BakeError::Threads { reason }))
        }
    };
    world.resource_mut::<BakeStatus>().heard(news);
    if let Some(news) = news {
        world.trigger(BakeProgress::new(id, news));
    }
    let Some(result) = result else { return show_news(world) };
    let Some(mut job) = world.resource_mut::<Kiln>().job.take() else { return };
    let warnings = std::mem::take(&mut job.warnings);
    match result {
        // It may have been done just before it was stopped; stopped it is, all the same.
        Ok(_) if job.request.cancel.is_cancelled() => give_up(world, &job, &BakeError::Cancelled, warnings),
        Err(error) => give_up(world, &job, &error, warnings),
        Ok(Product::Baked(baked)) => finish(world, &job, *baked, warnings),
        Ok(Product::Plan(plan)) => hand_over(world, &job, plan, warnings),
    }
}

/// Shows what has come of the running bake since the last look.
fn show_news(world: &mut World) {
    let mut kiln = world.resource_mut::<Kiln>();
    let Some(job) = kiln.job.as_mut().filter(|job| !job.request.cancel.is_cancelled()) else { return };
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
    let Target { settings, entities, .. } = &**target;
    let ambient_baked = settings.scene.ambient == super::AmbientMode::Bake;
    let volumes = volumes.as_ref().map(|volumes| volumes.as_slice());
    write_back(world, &Finished { lightmap, volumes, entities, ambient_baked, format: settings.format })
}

fn finish(world: &mut World, job: &Job, baked: Baked, mut warnings: Vec<KilnWarning>) {
    let (lightmap, volumes) = (Arc::new(baked.lightmap), Arc::new(baked.volumes.volumes));
    let report = &lightmap.report;
    // What both say of the scene is said once.
    let of_volumes = baked.volumes.report.warnings.iter().filter(|warning| !report.warnings.contains(warning));
    warnings.extend(report.warnings.iter().chain(of_volumes).map(|warning| job.names.warning(warning)));
    let (target, shown) = (Arc::clone(&job.target), Some(Arc::clone(&volumes)));
    let on_show = OnShow { lightmap: Arc::clone(&lightmap), volumes: shown, target };
    let written = show(world, &on_show);
    world.resource_mut::<Kiln>().last = Some(on_show);
    warnings.extend(written.warnings.iter().map(|warning| job.names.warning(warning)));
    let (texels, kept, samples) = (report.texels, report.kept.unwrap_or(0), report.samples);
    let (seconds, entities) = (report.wall_seconds, written.entities);
    let ending = KilnEnding::Baked { texels, kept, samples, seconds, entities };
    remember(world, job.request.id, ending, warnings.clone());
    let job = job.request.id;
    world.trigger(BakeFinished { job, texels, kept, samples, seconds, entities, warnings, lightmap, volumes });
}

fn hand_over(world: &mut World, job: &Job, plan: Arc<BakePlan>, mut warnings: Vec<KilnWarning>) {
    warnings.extend(plan.warnings.iter().map(|warning| job.names.warning(warning)));
    remember(world, job.request.id, KilnEnding::Planned(Arc::clone(&plan)), warnings.clone());
    world.trigger(BakePlanned { job: job.request.id, plan, warnings });
}

/// Ends a job without a result: what was shown before it comes back.
fn give_up(world: &mut World, job: &Job, error: &BakeError, warnings: Vec<KilnWarning>) {
    if job.is_on_show {
        match world.resource::<Kiln>().last.clone() {
            Some(last) => {
                show(world, &last);
            }
            None => clear(world),
        }
    }
    fail(world, job.request.id, error, warnings);
}

fn fail(world: &mut World, job: BakeId, error: &BakeError, warnings: Vec<KilnWarning>) {
    let (reason, cancelled) = (error.to_string(), *error == BakeError::Cancelled);
    let ending = KilnEnding::Failed { reason: reason.clone(), cancelled };
    remember(world, job, ending, warnings.clone());
    world.trigger(BakeFailed { job, reason, cancelled, warnings });
}

fn remember(world: &mut World, id: BakeId, ending: KilnEnding, warnings: Vec<KilnWarning>) {
    world.resource_mut::<BakeStatus>().ended(KilnOutcome { id, ending, warnings });
}

fn refusal(job: BakeId, reason: String) -> BakeFailed {
    BakeFailed { job, reason, cancelled: false, warnings: Vec::new() }
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
