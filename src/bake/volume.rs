//! Irradiance volumes: the light around everything that moves, on a grid of probes.
//!
//! A volume is a box of cells with a probe in the middle of each. A probe measures what comes from all around (`measure`)
//! and shows it as an ambient cube, which is what Bevy's shader reads: E/π for six directions. The steps, [`bake_volumes`]
//! in a screen:
//!
//! 1. `automatic` finds boxes, unless they are given; `nesting` says which of several counts where they overlap;
//! 2. `stand` moves probes out of bodies, and `rooms` finds which of them see each other;
//! 3. `surfaces` measures a coarse lightmap, at which paths end; `measure` traces paths from each probe until it is known
//!    well enough;
//! 4. `fill` gives a value to those that stand nowhere, and keeps light from shining through thin walls.
//!
//! What a volume holds is what real time lacks. Bevy draws the direct light of point, spot and directional lights on
//! things that move, so that it is left out; that of glowing meshes, of skies and of rectangular lights is in, and so is
//! all that surfaces send on. [`Scene::off_in_real_time`] and [`Scene::indirect_only`] say otherwise for single lights.

mod automatic;
mod fill;
mod grid;
mod measure;
mod nesting;
mod rooms;
mod settings;
mod site;
mod stand;
mod surfaces;

use super::endless::{refuse_endless_paths, spread};
use super::gather::Estimate;
use super::report::Intervals;
use super::tiles::{ErrorTarget, LEAST_PATHS, Until};
use super::unwrap::LaidOut;
use super::workers::{Work, Workers};
use super::{BakeError, BakeReport, BakeWarning, CancelToken, DARK, Goal, Progress, ProgressSink, Stage};
use crate::artefact::StableId;
use crate::math::{FACES, luminance};
use crate::scene::Scene;
use crate::trace::{Compiled, Tracer};
use glam::{Quat, UVec3, Vec3};
use measure::{Moments, Probe};
use site::{Site, survey};
use std::time::{Duration, Instant};

pub use settings::{VolumeBox, VolumeBoxes, VolumeSettings};

/// Volumes that Bevy's shader reads at once: those whose middle is nearest to the camera.
pub const MOST_VOLUMES: usize = 8;

/// A baked volume.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    /// Whose it is; of one that was found, `volume/0` and so on.
    pub id: StableId,
    /// Its middle [m].
    pub centre: Vec3,
    /// From its own axes to the world's.
    pub rotation: Quat,
    /// Its sides [m].
    pub size: Vec3,
    /// Probes along each of its axes.
    pub resolution: UVec3,
    /// Bevy's `LightProbe::falloff`, the same along each axis: 0, or large where a smaller volume lies within, so that
    /// this one counts next to nothing there and fully elsewhere.
    pub falloff: f32,
    /// E/π for the directions +X, −X, +Y, −Y, +Z and −Z of the world [cd/m²], along x first, then y, then z.
    pub cubes: Vec<[Vec3; FACES]>,
    /// What became of each probe.
    pub probes: Vec<ProbeState>,
}

/// What became of a probe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProbeState {
    /// Measured in the middle of its cell.
    Measured,
    /// Measured beside it, out of the body that it lay in.
    Moved,
    /// Inside a body, in a pocket of a few cells or in the dark outside of everything: made of its neighbours.
    Filled,
}

/// Baked volumes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VolumeBake {
    /// In the order of the boxes that were given.
    pub volumes: Vec<Volume>,
    /// What was done; texels are probes that were measured.
    pub report: BakeReport,
}

/// Bakes irradiance volumes.
///
/// # Errors
///
/// [`BakeError::Settings`] for a box or a goal that cannot be, [`BakeError::NothingToBake`] where there is no air for any
/// probe, [`BakeError::NoLight`], [`BakeError::KeepsLight`], [`BakeError::Cancelled`].
pub fn bake_volumes(
    scene: &Scene,
    settings: &VolumeSettings,
    progress: &dyn ProgressSink,
    cancel: &CancelToken,
) -> Result<VolumeBake, BakeError> {
    let clock = Instant::now();
    settings.validate()?;
    let progress = OfProbes(progress);
    let workers = Workers::new(settings.threads, &progress, cancel)?;
    workers.announce(Stage::Prepare)?;
    let (asked, surfaces) = (scene, settings.surfaces(scene));
    let alike = surfaces::all_alike(asked);
    let laid_out = settings.asks_for_surfaces().then(|| LaidOut::new(&alike, &surfaces, &workers)).transpose()?;
    let scene = laid_out.as_ref().map_or(asked, |laid_out| &laid_out.scene);
    let Compiled { tracer, mut faults, census } = Compiled::for_probes(scene, &settings.transport);
    faults.retain(|fault| !fault.kind.costs_only_the_lightmap());
    if !tracer.has_light() {
        let because = faults.first().map_or_else(String::new, |fault| format!(" ({fault})"));
        return Err(BakeError::NoLight { because });
    }
    let mut warnings: Vec<BakeWarning> = faults.into_iter().map(BakeWarning::from).collect();
    warnings.extend(BakeWarning::of_transport(&settings.transport, &census));
    let mut sites = Vec::new();
    for (id, grid, falloff) in settings.grids(scene, &tracer, &workers)? {
        let (stands, rooms) = survey(grid, &tracer, &workers)?;
        if rooms.is_in_air.contains(&true) {
            sites.push(Site { id, grid, falloff, stands, rooms });
        } else {
            warnings.push(BakeWarning::NoAir { volume: id });
        }
    }
    if sites.is_empty() {
        let reason = "no probe of an irradiance volume stands in the air; place a volume where something moves".into();
        return Err(BakeError::NothingToBake { reason });
    }
    if sites.len() > MOST_VOLUMES {
        warnings.push(BakeWarning::TooManyVolumes { volumes: sites.len(), limit: MOST_VOLUMES });
    }
    let points: Vec<Vec3> = sites.iter().flat_map(Site::points).collect();
    refuse_endless_paths(scene, &tracer, &settings.transport, |probe, sobol, tally| {
        if let Some(&point) = spread(&points, probe) {
            tracer.light_around(point, sobol, &settings.transport, tally);
        }
    })?;
    let first_pass = match &laid_out {
        Some(laid_out) => surfaces::teach(&tracer, laid_out, &surfaces, &workers, cancel)?,
        None => None,
    };
    let Measured { mut moments, estimates, until } = Measured::new(&points, settings, &tracer, &workers)?;
    workers.announce(Stage::Repair)?;
    let mut volumes = Vec::new();
    for site in sites {
        let rest = moments.split_off(site.points().count());
        volumes.push(site.volume(std::mem::replace(&mut moments, rest)));
    }
    let intervals = Intervals::of(&estimates.results, until);
    let report = BakeReport::of(&estimates, clock.elapsed(), &settings.transport, warnings.into_iter());
    Ok(VolumeBake { volumes, report: BakeReport { intervals, ..report }.with(first_pass) })
}

/// Tells of texels as of probes.
struct OfProbes<'a>(&'a dyn ProgressSink);

impl ProgressSink for OfProbes<'_> {
    fn report(&self, progress: Progress) {
        let stage = if progress.stage == Stage::Gather { Stage::Probes } else { progress.stage };
        self.0.report(Progress { stage, ..progress });
    }
}

/// What all probes have measured.
struct Measured {
    moments: Vec<Moments>,
    estimates: Work<Estimate>,
    until: Until,
}

impl Measured {
    fn new(points: &[Vec3], settings: &VolumeSettings, tracer: &Tracer, workers: &Workers) -> Result<Self, BakeError> {
        let transport = &settings.transport;
        let first = match settings.goal {
            Goal::Samples(count) => count,
            Goal::Error(_) | Goal::Time(_) => 2 * LEAST_PATHS,
        };
        let begin = |point: &Vec3, cancel: &CancelToken| {
            Probe::new(transport.seed, *point).extend(first, tracer, transport, cancel)
        };
        let error = |probe: &Probe| probe.estimate().relative_stderr();
        let mut work = workers.gather(points, begin, error)?;
        let mut until = Until::Samples(first);
        if let Goal::Error(relative) = settings.goal {
            let levels = work.results.iter().map(|probe| luminance(probe.estimate().mean));
            let floor = DARK * levels.sum::<f64>() / points.len() as f64;
            let target = ErrorTarget { relative, floor };
            until = Until::Error(target);
            let go_on = |probe: &Probe, cancel: &CancelToken| probe.clone().until(target, tracer, transport, cancel);
            let more = workers.gather(&work.results, go_on, error)?;
            work = Work { cpu: work.cpu + more.cpu, ..more };
        }
        let cpu: Duration = work.cpu;
        let estimates = Work { results: work.results.iter().map(Probe::estimate).collect(), cpu };
        Ok(Self { moments: work.results.iter().map(Probe::moments).collect(), estimates, until })
    }
}
