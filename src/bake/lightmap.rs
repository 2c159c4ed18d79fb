//! A lightmap: pages of texels and where each object lies on them, and how they are made.

use super::atlas::Atlas;
use super::baker::{Earlier, Kept, Upcoming};
use super::balance::energy_balance;
use super::endless::refuse_endless_texels;
use super::gather::Estimate;
use super::layout::placements;
use super::live::{PREVIEW_PATHS, nearest_first};
use super::repair::{DisplayedRect, Field, Filtering, Repairs, Surroundings, TexelState, repair, repair_for_preview};
use super::reuse::{FIRST_PATHS, Place};
use super::sites::{Covered, Site, Sites};
use super::survey::{Survey, Surveyed};
use super::tiles::{ErrorTarget, Tile, Until, tiles};
use super::unwrap::{LaidOut, LaidOutMesh};
use super::workers::{Work, Workers};
use super::{
    BakeError, BakeReport, BakeSettings, BakeWarning, CancelToken, Goal, Intervals, LiveSink, ProgressSink, Stage,
};
use crate::artefact::StableId;
use crate::scene::{Fault, Light, Scene};
use crate::trace::{Compiled, Tracer, effect_of};
use glam::{DVec3, Vec2, Vec3};
use std::borrow::Cow;
use std::time::Instant;

/// A finished lightmap bake.
#[derive(Clone, Debug, Default)]
pub struct Lightmap {
    /// The textures.
    pub pages: Vec<Page>,
    /// Where each object lies, ordered by id.
    pub placements: Vec<Placement>,
    /// Meshes that were given a UV1.
    pub meshes: Vec<LaidOutMesh>,
    /// Ids of the lights whose direct light is in the texels.
    pub baked_lights: Vec<StableId>,
    /// What the bake did.
    pub report: BakeReport,
}

/// One texture. All layers are row by row, row 0 at v = 0, `width × height` long.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// Width [texels].
    pub width: u32,
    /// Height [texels].
    pub height: u32,
    /// E/π after all repair, E being the irradiance [cd/m²].
    pub radiance: Vec<Vec3>,
    /// Share of the texel's area that triangles cover, in [0, 1], but for what was found to be out of sight; 0 where
    /// dilated, hidden or empty. The texel's value is the mean over that share.
    pub coverage: Vec<f32>,
    /// E/π as measured, before repair [cd/m²].
    pub raw: Vec<Vec3>,
    /// Standard error of `raw` [cd/m²].
    pub stderr: Vec<Vec3>,
    /// Half the width of the interval around the luminance of `raw` that holds the truth in 95 of 100 cases [cd/m²].
    pub half_width: Vec<f32>,
    /// Paths that started from it.
    pub samples: Vec<u32>,
    /// Rays that these took: what it cost.
    pub rays: Vec<u64>,
    /// What each texel is.
    pub state: Vec<TexelState>,
    /// One more than the number of its chart in the bake; 0 where no triangle covers it.
    pub chart: Vec<u32>,
    /// Texels per metre of the surface that was measured; 0 where none was [1/m].
    pub density: Vec<f32>,
    /// Whether triangles or charts overlap there.
    pub is_overlapped: Vec<bool>,
}

/// Where an object's unit square of UV1 lies on a page.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// The object.
    pub id: StableId,
    /// Index into [`Lightmap::pages`].
    pub page: u32,
    /// Smallest corner in the page's own unit square; v grows downwards.
    pub uv_min: [f32; 2],
    /// Largest corner.
    pub uv_max: [f32; 2],
    /// Index into [`Lightmap::meshes`] of the mesh that takes the place of the object's own; `None` where that keeps
    /// its UV1.
    pub mesh: Option<usize>,
}

/// What was measured, and of what.
pub(super) struct Measured {
    pub(super) sites: Vec<Site>,
    pub(super) tiles: Vec<Tile>,
    /// In the order of the sites.
    pub(super) estimates: Vec<Estimate>,
    /// Of each tile, see [`Kept::drift`].
    pub(super) drift: Vec<f64>,
}

/// Bakes a lightmap of a scene.
///
/// # Errors
///
/// [`BakeError`], by who must act. Faults that leave something to bake are warnings in the report.
pub fn bake_lightmap(
    scene: &Scene,
    settings: &BakeSettings,
    progress: &dyn ProgressSink,
    cancel: &CancelToken,
) -> Result<Lightmap, BakeError> {
    Ok(bake(scene, settings, None, progress, cancel)?.0)
}

/// Bakes a lightmap of a scene, of which `earlier` may be another bake, and gives with it what may be remembered: the
/// scene as laid out, how well its texels are known, and all that was measured.
pub(super) fn bake<'a>(
    scene: &'a Scene,
    settings: &BakeSettings,
    earlier: Option<&Earlier>,
    progress: &dyn ProgressSink,
    cancel: &CancelToken,
) -> Result<(Lightmap, Cow<'a, Scene>, Until, Measured), BakeError> {
    let clock = Instant::now();
    settings.validate()?;
    let workers = Workers::new(settings.threads, progress, cancel)?;
    workers.announce(Stage::Prepare)?;
    let laid_out = LaidOut::new(scene, settings, &workers)?;
    let scene: &Scene = &laid_out.scene;
    let Compiled { tracer, faults, census } = Compiled::new(scene, &settings.transport);
    let faults = laid_out.without_solved(faults);
    refuse_what_cannot_be_baked(&tracer, &faults)?;
    let atlas = Atlas::new(&laid_out, &tracer, settings, cancel)?;
    let Sites { seen: sites, hidden, warnings: of_texels } = Sites::new(scene, &tracer, &atlas, settings, &workers)?;
    refuse_endless_texels(scene, &tracer, &settings.transport, &sites)?;
    let first_pass =
        Place { tracer: &tracer, atlas: &atlas, sites: &sites }.first_pass(FIRST_PATHS, settings, &workers)?;
    let tiles = tiles(&sites, tracer.sharing(&settings.transport));
    let coarse = Coarse { laid_out: &laid_out, atlas: &atlas, hidden: &hidden, workers: &workers };
    let to_preview = Upcoming {
        scene,
        settings,
        tracer: &tracer,
        sites: &sites,
        tiles: &tiles,
        until: Until::Samples(PREVIEW_PATHS),
    };
    if earlier.is_none() {
        coarse.preview(&to_preview, &vec![None; tiles.len()])?;
    }
    let surveyed = Surveyed { tiles: &tiles, sites: &sites, tracer: &tracer };
    let until = until(settings, earlier, &surveyed, &workers, clock)?;
    let upcoming = Upcoming { until, ..to_preview };
    let kept = match earlier {
        Some(earlier) => earlier.kept(&upcoming, &workers)?,
        None => vec![None; tiles.len()],
    };
    if earlier.is_some() {
        coarse.preview(&to_preview, &kept)?;
    }
    let work = measure(&upcoming, &kept, workers.live(), &workers)?;
    let balance = energy_balance(&tracer, &sites, &work.results, &settings.transport, &workers)?;
    workers.announce(Stage::Repair)?;
    let mut fields = fields(&atlas, &sites, &work.results, &hidden);
    let place = Surroundings { scene, tracer: &tracer, atlas: &atlas, sites: &sites };
    let Repairs { denoised, seams } = repair(&mut fields, &place, settings, &workers)?;
    let pages = pages(fields, &sites, &work.results);
    let of_transport = BakeWarning::of_transport(&settings.transport, &census);
    let of_layout = laid_out.warnings.iter().chain(&atlas.warnings).cloned();
    let warnings = faults.into_iter().map(BakeWarning::from).chain(of_layout).chain(of_texels).chain(of_transport);
    let is_kept = |(tile, kept): (&Tile, &Option<Kept>)| kept.as_ref().map_or(0, |_| tile.sites.len() as u64);
    let report = BakeReport {
        energy_balance: balance,
        hidden: hidden.len() as u64,
        pages: atlas.pages.len() as u32,
        fill: atlas.fill(sites.len()),
        unwrapped: laid_out.mesh_of.len() as u64,
        denoised,
        seams,
        intervals: Intervals::of(&work.results, until),
        fingerprints: scene.fingerprints.clone(),
        kept: earlier.map(|_| tiles.iter().zip(&kept).map(is_kept).sum()),
        ..BakeReport::of(&work, clock.elapsed(), &settings.transport, warnings).with(first_pass)
    };
    let baked_lights = baked_lights(scene, &tracer);
    let placements = placements(&laid_out, &atlas);
    drop(atlas);
    let drift = kept.iter().map(|kept| kept.as_ref().map_or(0.0, |kept| kept.drift)).collect();
    let measured = Measured { sites, tiles, estimates: work.results, drift };
    Ok((Lightmap { placements, pages, meshes: laid_out.meshes, baked_lights, report }, laid_out.scene, until, measured))
}

/// What a preview is made of.
struct Coarse<'a> {
    laid_out: &'a LaidOut<'a>,
    atlas: &'a Atlas<'a>,
    hidden: &'a [Covered],
    workers: &'a Workers<'a>,
}

impl Coarse<'_> {
    /// Shows the map by a few paths, if anybody watches.
    fn preview(&self, upcoming: &Upcoming<'_>, kept: &[Option<Kept>]) -> Result<(), BakeError> {
        let Some(live) = self.workers.live() else { return Ok(()) };
        let Upcoming { scene, settings, tracer, sites, .. } = *upcoming;
        let work = measure(upcoming, kept, None, self.workers)?;
        let mut fields = fields(self.atlas, sites, &work.results, self.hidden);
        repair_for_preview(&mut fields, settings, self.workers)?;
        live.preview(Lightmap {
            pages: pages(fields, sites, &work.results),
            placements: placements(self.laid_out, self.atlas),
            meshes: self.laid_out.meshes.clone(),
            baked_lights: baked_lights(scene, tracer),
            report: BakeReport::default(),
        });
        Ok(())
    }
}

/// Lights whose direct light texels hold, ordered by id.
fn baked_lights(scene: &Scene, tracer: &Tracer) -> Vec<StableId> {
    let is_baked = |light: &&Light| {
        let is_lit_by_texels = light.faults().is_empty() && !scene.indirect_only.contains(light.id());
        is_lit_by_texels && tracer.effects().has(effect_of(light))
    };
    let mut baked: Vec<StableId> = scene.lights.iter().filter(is_baked).map(|light| light.id().clone()).collect();
    baked.sort();
    baked
}

/// What the goal comes down to in this scene. A time comes down to the error of the bake before, if there was one.
fn until(
    settings: &BakeSettings,
    earlier: Option<&Earlier>,
    surveyed: &Surveyed<'_>,
    workers: &Workers<'_>,
    clock: Instant,
) -> Result<Until, BakeError> {
    let target = |survey: &Survey, relative| Until::Error(ErrorTarget { relative, floor: survey.floor() });
    Ok(match (settings.goal, earlier.map(Earlier::until)) {
        (Goal::Samples(count), _) => Until::Samples(count),
        (Goal::Error(error), _) => target(&surveyed.survey(&settings.transport, workers)?, error),
        (Goal::Time(_), Some(Until::Error(before))) => {
            target(&surveyed.survey(&settings.transport, workers)?, before.relative)
        }
        (Goal::Time(time), _) => {
            let survey = surveyed.survey(&settings.transport, workers)?;
            let left = time.saturating_sub(clock.elapsed());
            target(&survey, survey.error_within(left.as_secs_f64()))
        }
    })
}

/// Measures the texels of all tiles but of those that are kept; the results are in the order of the sites.
fn measure(
    upcoming: &Upcoming<'_>,
    kept: &[Option<Kept>],
    live: Option<&dyn LiveSink>,
    workers: &Workers<'_>,
) -> Result<Work<Estimate>, BakeError> {
    let Upcoming { settings, tracer, sites, tiles, until, .. } = *upcoming;
    let mut in_order = vec![Estimate::default(); sites.len()];
    let mut note = |tile: &Tile, estimates: &[Estimate]| {
        tile.sites.iter().zip(estimates).for_each(|(&number, estimate)| in_order[number as usize] = *estimate);
    };
    let mut open: Vec<&Tile> = Vec::with_capacity(tiles.len());
    for (tile, kept) in tiles.iter().zip(kept) {
        match kept {
            Some(kept) => note(tile, &kept.estimates),
            None => open.push(tile),
        }
    }
    let total = open.iter().map(|tile| tile.sites.len()).sum();
    if let Some(viewpoint) = live.and_then(LiveSink::viewpoint) {
        nearest_first(&mut open, sites, viewpoint);
    }
    let of_tile = |tile: &&Tile, cancel: &CancelToken| {
        let estimates = tile.measure(sites, tracer, until, &settings.transport, cancel)?;
        if let Some(live) = live {
            let texel =
                |(&site, estimate): (&u32, &Estimate)| (sites[site as usize].covered.index, estimate.mean.as_vec3());
            let texels: Vec<(u32, Vec3)> = tile.sites.iter().zip(&estimates).map(texel).collect();
            live.measured(sites[tile.sites[0] as usize].covered.page, &texels);
        }
        Some(estimates)
    };
    let Work { results, cpu } = workers.gather_groups(&open, total, of_tile, Estimate::relative_stderr)?;
    let mut rest = results.as_slice();
    for tile in open {
        let (own, others) = rest.split_at(tile.sites.len());
        note(tile, own);
        rest = others;
    }
    Ok(Work { results: in_order, cpu })
}

/// The pages as measured.
fn fields(atlas: &Atlas<'_>, sites: &[Site], estimates: &[Estimate], hidden: &[Covered]) -> Vec<Field> {
    let mut fields: Vec<Field> = atlas.pages.iter().map(|&size| Field::empty(size)).collect();
    for (site, estimate) in sites.iter().zip(estimates) {
        fields[site.covered.page as usize].set_measured(site, estimate);
    }
    for covered in hidden {
        fields[covered.page as usize].set_hidden(covered);
    }
    fields
}

/// The pages as repaired.
fn pages(fields: Vec<Field>, sites: &[Site], estimates: &[Estimate]) -> Vec<Page> {
    let page = |field: Field| {
        let count = field.value.len();
        let chart = |(state, chart): (&TexelState, u32)| if *state == TexelState::Empty { 0 } else { chart + 1 };
        Page {
            width: field.size[0],
            height: field.size[1],
            radiance: field.value,
            coverage: vec![0.0; count],
            raw: vec![Vec3::ZERO; count],
            stderr: field.stderr,
            half_width: vec![0.0; count],
            samples: vec![0; count],
            rays: vec![0; count],
            density: vec![0.0; count],
            is_overlapped: vec![false; count],
            chart: field.state.iter().zip(field.chart).map(chart).collect(),
            state: field.state,
        }
    };
    let mut pages: Vec<Page> = fields.into_iter().map(page).collect();
    for (Site { covered, .. }, estimate) in sites.iter().zip(estimates) {
        let page = &mut pages[covered.page as usize];
        page.coverage[covered.index as usize] = (covered.texel.coverage.min(1.0) * estimate.accepted) as f32;
        page.raw[covered.index as usize] = estimate.mean.as_vec3();
        page.half_width[covered.index as usize] = estimate.half_width as f32;
        page.samples[covered.index as usize] = estimate.samples.try_into().unwrap_or(u32::MAX);
        page.rays[covered.index as usize] = estimate.rays;
        page.density[covered.index as usize] = covered.texel.density();
        page.is_overlapped[covered.index as usize] = covered.is_overlapped;
    }
    pages
}

impl Lightmap {
    /// E/π as displayed at a point of an object's UV1 [cd/m²]: what a texture unit reads of its page, by the rectangle
    /// as Bevy keeps it, in 16 bits per coordinate. Black for a page that is not there.
    pub fn sample(&self, placement: &Placement, uv1: Vec2, filtering: Filtering) -> Vec3 {
        let Some(page) = self.pages.get(placement.page as usize).filter(|page| !page.radiance.is_empty()) else {
            return Vec3::ZERO;
        };
        let size = [page.width, page.height];
        let rect = DisplayedRect::new(placement.uv_min, placement.uv_max, size);
        let taps = filtering.taps(size, rect.point(uv1.as_dvec2()));
        taps.iter().map(|(texel, weight)| page.radiance[texel].as_dvec3() * weight).sum::<DVec3>().as_vec3()
    }
}

/// Refuses a scene in which a bake would have nothing to do.
pub(super) fn refuse_what_cannot_be_baked(tracer: &Tracer, faults: &[Fault]) -> Result<(), BakeError> {
    let first_fault = || faults.first().map_or_else(String::new, |fault| format!(" ({fault})"));
    if tracer.receivers().is_empty() {
        let reason = if faults.is_empty() {
            "there is no mesh in it, or none is marked as a receiver".to_owned()
        } else {
            faults.iter().map(Fault::to_string).collect::<Vec<_>>().join("; ")
        };
        return Err(BakeError::NothingToBake { reason });
    }
    if !tracer.has_light() {
        return Err(BakeError::NoLight { because: first_fault() });
    }
    Ok(())
}
