//! A lightmap: pages of texels and where each object lies on them, and how they are made.

use super::atlas::Atlas;
use super::balance::energy_balance;
use super::dilate::dilate;
use super::endless::refuse_endless_texels;
use super::gather::{Estimate, Paths};
use super::layout::placements;
use super::sites::{Site, sites};
use super::unwrap::{LaidOut, LaidOutMesh};
use super::workers::Workers;
use super::{BakeError, BakeReport, BakeSettings, BakeWarning, CancelToken, ProgressSink, Stage};
use crate::artefact::StableId;
use crate::scene::{Fault, Light, Scene};
use crate::trace::{Compiled, Dimensions, Sampler, Tracer, effect_of};
use glam::{Vec2, Vec3};
use std::time::Instant;

/// A finished lightmap bake.
#[derive(Clone, Debug)]
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
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// Width [texels].
    pub width: u32,
    /// Height [texels].
    pub height: u32,
    /// E/π after all repair, E being the irradiance [cd/m²].
    pub radiance: Vec<Vec3>,
    /// Share of the texel's area that triangles cover, in [0, 1]; 0 where dilated or empty.
    pub coverage: Vec<f32>,
    /// E/π as measured, before repair [cd/m²].
    pub raw: Vec<Vec3>,
    /// Standard error of `raw` [cd/m²].
    pub stderr: Vec<Vec3>,
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
    let clock = Instant::now();
    settings.validate()?;
    let workers = Workers::new(settings.threads, progress, cancel)?;
    workers.announce(Stage::Prepare)?;
    let laid_out = LaidOut::new(scene, settings, &workers)?;
    let scene: &Scene = &laid_out.scene;
    let Compiled { tracer, faults, census } = Compiled::new(scene, &settings.transport);
    let faults = laid_out.without_solved(faults);
    refuse_what_cannot_be_baked(&tracer, &faults)?;
    let atlas = Atlas::new(&laid_out, &tracer, settings);
    let (sites, overlaps) = sites(scene, &tracer, &atlas, settings);
    refuse_endless_texels(scene, &tracer, &settings.transport, &sites)?;
    let work = workers.gather(
        &sites,
        |site, cancel| {
            let paths = Paths { key: site.key, count: settings.samples_per_texel, clamp: settings.transport.clamp };
            Estimate::gather(paths, cancel, |sobol, tally| {
                let [u, v, ..] = sobol.draw(Dimensions::Start);
                let start = site.texel.start(&tracer, Vec2::new(u, v));
                tracer.diffuse_radiance(&start, sobol, &settings.transport, tally)
            })
        },
        Estimate::relative_stderr,
    )?;
    let balance = energy_balance(&tracer, &sites, &work.results, &settings.transport, &workers)?;
    workers.announce(Stage::Repair)?;
    let pages = pages(&atlas, &sites, &work.results);
    let of_transport = BakeWarning::of_transport(&settings.transport, &census);
    let of_layout = laid_out.warnings.iter().chain(&atlas.warnings).cloned();
    let warnings = faults.into_iter().map(BakeWarning::from).chain(of_layout).chain(overlaps).chain(of_transport);
    let report = BakeReport {
        energy_balance: balance,
        pages: atlas.pages.len() as u32,
        fill: atlas.fill(sites.len()),
        unwrapped: laid_out.mesh_of.len() as u64,
        ..BakeReport::of(&work, clock.elapsed(), &settings.transport, warnings)
    };
    let is_baked = |light: &&Light| light.faults().is_empty() && tracer.effects().has(effect_of(light));
    let baked_lights = scene.lights.iter().filter(is_baked).map(|light| light.id().clone());
    let mut baked_lights: Vec<StableId> = baked_lights.collect();
    baked_lights.sort();
    let placements = placements(&laid_out, &atlas);
    Ok(Lightmap { placements, pages, meshes: laid_out.meshes, baked_lights, report })
}

fn pages(atlas: &Atlas<'_>, sites: &[Site], estimates: &[Estimate]) -> Vec<Page> {
    let empty = |&[width, height]: &[u32; 2]| {
        let count = width as usize * height as usize;
        Page {
            width,
            height,
            radiance: Vec::new(),
            coverage: vec![0.0; count],
            raw: vec![Vec3::ZERO; count],
            stderr: vec![Vec3::ZERO; count],
        }
    };
    let mut pages: Vec<Page> = atlas.pages.iter().map(empty).collect();
    for (site, estimate) in sites.iter().zip(estimates) {
        let page = &mut pages[site.page as usize];
        let index = site.index as usize;
        page.coverage[index] = site.texel.coverage.min(1.0) as f32;
        page.raw[index] = estimate.mean.as_vec3();
        page.stderr[index] = estimate.stderr.as_vec3();
    }
    for page in &mut pages {
        page.radiance = page.raw.clone();
        dilate(&mut page.radiance, &page.coverage, [page.width, page.height]);
    }
    pages
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
