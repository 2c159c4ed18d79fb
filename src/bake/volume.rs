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
mod stand;
mod surfaces;

use super::endless::{refuse_endless_paths, spread};
use super::gather::Estimate;
use super::report::Intervals;
use super::tiles::{ErrorTarget, LEAST_PATHS, Until};
use super::unwrap::LaidOut;
use super::workers::{Work, Workers};
use super::{
    BakeError, BakeReport, BakeSettings, BakeWarning, CancelToken, DARK, Goal, LaterBounces, Progress, ProgressSink,
    Stage,
};
use crate::artefact::StableId;
use crate::math::{AmbientCube, FACES, luminance};
use crate::scene::Scene;
use crate::trace::{Compiled, Tracer, Transport};
use fill::fill;
use glam::{Quat, UVec3, Vec3};
use grid::Grid;
use measure::{Moments, Probe};
use rooms::Rooms;
use stand::Stand;
use std::num::NonZeroUsize;
use std::time::{Duration, Instant};

/// Volumes that Bevy's shader reads at once: those whose middle is nearest to the camera.
pub const MOST_VOLUMES: usize = 8;

/// What volumes are asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeSettings {
    /// How light is followed.
    pub transport: Transport,
    /// When a probe has been sampled enough: by its error, that of a face of its cube as the root of the mean square
    /// over all six, or by its paths. [`Goal::Time`] is refused.
    pub goal: Goal,
    /// How light is found that has met more than one surface.
    pub later_bounces: LaterBounces,
    /// Texels per metre of the coarse lightmap at which paths end where [`LaterBounces::Reused`] asks for it; fewer in a
    /// large scene.
    pub density: f32,
    /// Where they are.
    pub boxes: VolumeBoxes,
    /// Threads that trace; `None` for all cores.
    pub threads: Option<NonZeroUsize>,
}

impl Default for VolumeSettings {
    fn default() -> Self {
        Self {
            transport: Transport::default(),
            goal: Goal::Error(0.05),
            later_bounces: LaterBounces::Reused,
            density: 4.0,
            boxes: VolumeBoxes::default(),
            threads: None,
        }
    }
}

/// Where volumes are.
#[derive(Clone, Debug, PartialEq)]
pub enum VolumeBoxes {
    /// Around all that receives lightmaps, and three metres up at least; cut into up to [`MOST_VOLUMES`] where walls
    /// part rooms.
    Automatic {
        /// Side of a cell [m]; `None` for 0.25 m, or as much more as keeps it to about 32 768 probes.
        spacing: Option<f32>,
    },
    /// Where somebody put them. Of those that overlap the smallest counts.
    Given(Vec<VolumeBox>),
}

impl Default for VolumeBoxes {
    fn default() -> Self {
        Self::Automatic { spacing: None }
    }
}

/// The box of a volume.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeBox {
    /// Whose it is.
    pub id: StableId,
    /// Its middle [m].
    pub centre: Vec3,
    /// From its own axes to the world's.
    pub rotation: Quat,
    /// Its sides [m].
    pub size: Vec3,
    /// Side of a cell [m]; `None` for a 32nd of the longest side of the box, and 0.25 m at least.
    pub spacing: Option<f32>,
}

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

impl VolumeSettings {
    /// What goes with a lightmap: two and a half times its error, since a probe's is that of six faces and what is lit by
    /// several of them errs less; or four times its paths, since they come from a sphere.
    ///
    /// Paths end at a coarse lightmap in any case: its bias is far below what a cube of six faces is off by.
    pub fn beside(lightmap: &BakeSettings) -> Self {
        let goal = match lightmap.goal {
            Goal::Error(error) => Goal::Error((2.5 * error).min(1.0)),
            Goal::Samples(count) => Goal::Samples(count.saturating_mul(4)),
            Goal::Time(_) => Self::default().goal,
        };
        Self { transport: lightmap.transport, goal, threads: lightmap.threads, ..Self::default() }
    }

    /// Refuses what cannot be met.
    ///
    /// # Errors
    ///
    /// [`BakeError::Settings`].
    pub fn validate(&self) -> Result<(), BakeError> {
        let refuse = |reason: String| Err(BakeError::Settings { setting: "volume", reason });
        self.goal.validate()?;
        if !(self.density > 0.0 && self.density.is_finite()) {
            return refuse(format!("a density of {} texels per metre cannot be; ask for 4 or so", self.density));
        }
        if let Goal::Time(_) = self.goal {
            return refuse("volumes are baked to an error or by paths; ask for one of these".into());
        }
        let is_length = |length: f32| length > 0.0 && length.is_finite();
        match &self.boxes {
            VolumeBoxes::Automatic { spacing: Some(spacing) } if !is_length(*spacing) => {
                refuse(format!("a spacing of {spacing} m cannot be; ask for 0.5 or so"))
            }
            VolumeBoxes::Automatic { .. } => Ok(()),
            VolumeBoxes::Given(boxes) => boxes.iter().try_for_each(|of| {
                let is_box = of.centre.is_finite() && of.size.to_array().into_iter().all(is_length);
                if is_box && of.rotation.is_normalized() && of.spacing.is_none_or(is_length) {
                    return Ok(());
                }
                refuse(format!(
                    "\"{}\" has a size, a place or a spacing that no box can have; give its Transform a scale above 0",
                    of.id
                ))
            }),
        }
    }

    /// The grids of all boxes, with their names and falloffs.
    fn grids(
        &self,
        scene: &Scene,
        tracer: &Tracer,
        workers: &Workers,
    ) -> Result<Vec<(StableId, Grid, f32)>, BakeError> {
        match &self.boxes {
            VolumeBoxes::Automatic { spacing } => {
                let found = automatic::boxes(scene, *spacing, tracer, workers)?.into_iter().enumerate();
                Ok(found.map(|(number, grid)| (StableId::new(format!("volume/{number}")), grid, 0.0)).collect())
            }
            VolumeBoxes::Given(boxes) => {
                let grids: Vec<Grid> = boxes.iter().map(VolumeBox::grid).collect();
                let falloffs = nesting::falloffs(&grids);
                let named = boxes.iter().map(|of| of.id.clone()).zip(grids).zip(falloffs);
                Ok(named.map(|((id, grid), falloff)| (id, grid, falloff)).collect())
            }
        }
    }
}

impl VolumeBox {
    fn grid(&self) -> Grid {
        let spacing = self.spacing.unwrap_or((self.size.max_element() / 32.0).max(0.25));
        Grid::new(self.centre, self.rotation, self.size, spacing)
    }
}

/// Tells of texels as of probes.
struct OfProbes<'a>(&'a dyn ProgressSink);

impl ProgressSink for OfProbes<'_> {
    fn report(&self, progress: Progress) {
        let stage = if progress.stage == Stage::Gather { Stage::Probes } else { progress.stage };
        self.0.report(Progress { stage, ..progress });
    }
}

/// A volume before it is measured.
struct Site {
    id: StableId,
    grid: Grid,
    falloff: f32,
    stands: Vec<Stand>,
    rooms: Rooms,
}

impl Site {
    /// Where its probes stand that count.
    fn points(&self) -> impl Iterator<Item = Vec3> {
        let in_air = self.stands.iter().zip(&self.rooms.is_in_air).filter(|(_, is_in_air)| **is_in_air);
        in_air.filter_map(|(stand, _)| stand.point())
    }

    /// The volume for what these probes have measured, in their order.
    fn volume(mut self, moments: Vec<Moments>) -> Volume {
        let mut moments = moments.into_iter();
        let of_probe = |&is_in_air: &bool| if is_in_air { moments.next() } else { None };
        let measured: Vec<Option<Moments>> = self.rooms.is_in_air.iter().map(of_probe).collect();
        self.leave_the_void(&measured);
        let shown = fill(&self.grid, &self.rooms, &measured);
        let state = |(stand, is_in_air): (&Stand, &bool)| match (is_in_air, stand) {
            (true, Stand::Air { is_moved: false, .. }) => ProbeState::Measured,
            (true, Stand::Air { is_moved: true, .. }) => ProbeState::Moved,
            _ => ProbeState::Filled,
        };
        let Grid { centre, rotation, size, resolution } = self.grid;
        Volume {
            id: self.id,
            centre,
            rotation,
            size,
            resolution,
            falloff: self.falloff,
            cubes: shown.iter().map(|moments| AmbientCube::fit(&moments.0).faces.map(|face| face.as_vec3())).collect(),
            probes: self.stands.iter().zip(&self.rooms.is_in_air).map(state).collect(),
        }
    }
}

impl Site {
    /// Takes probes out of the air that no light reaches and around which much is nothing at all. That is the void outside
    /// of a level, where nobody goes; its dark would count as a dark room's beside the walls around the level.
    fn leave_the_void(&mut self, measured: &[Option<Moments>]) {
        let is_void = |index: usize| {
            let is_black = measured[index].as_ref().is_some_and(|moments| moments.luminance() == 0.0);
            is_black && matches!(self.stands[index], Stand::Air { is_open: true, .. })
        };
        let void: Vec<usize> = (0..self.stands.len()).filter(|&index| is_void(index)).collect();
        if void.len() < measured.iter().flatten().count() {
            for index in void {
                self.rooms.leave_out(index);
            }
        }
    }
}

/// Where the probes of a grid stand, and which of them share a room.
fn survey(grid: Grid, tracer: &Tracer, workers: &Workers) -> Result<(Vec<Stand>, Rooms), BakeError> {
    let all: Vec<usize> = (0..grid.len()).collect();
    let stands = workers.gather_quietly(&all, |&index, _| Some(Stand::new(tracer, &grid, index)))?;
    let links = workers.gather_quietly(&all, |&index, _| Some(Rooms::half_links(tracer, &grid, &stands, index)))?;
    let rooms = Rooms::new(grid, &stands, Rooms::both_ways(&grid, links));
    Ok((stands, rooms))
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
