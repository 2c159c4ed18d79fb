//! The first pass of a bake that reuses its own lightmap: every texel measured by a few whole paths, and what comes of
//! it laid out for the paths of the bake proper, which end where they meet it ([`LaterBounces::Reused`]).
//!
//! It is frozen before the bake proper begins, so that neither threads nor the order of the work can matter, and has
//! random numbers of its own, so that a texel's noise never comes back to itself. What the mode is biased by is two
//! things: a texel stands for all places on it, and its noise is the same for all paths that end on it. A texel is not
//! light to be read where it is hidden, where nothing covers it, where it is covered twice, and where a wall cuts it,
//! so that a part of it is not what was measured.

use super::atlas::Atlas;
use super::charts::Charts;
use super::gather::Estimate;
use super::raster::triangle_area;
use super::sites::Site;
use super::workers::Workers;
use super::{BakeError, BakeSettings, CancelToken, LaterBounces, REPLICATES};
use crate::math::combine;
use crate::trace::{Effect, KnownCell, KnownGrid, KnownLight, Sobol, Tracer, Transport, Unfolded};
use cpu_time::ThreadTime;
use std::time::Duration;

/// Paths of the first pass from each texel.
pub(super) const FIRST_PATHS: u32 = 64;

/// How many times as far as a texel is wide a ray must have come from to take it for the place that it met.
const LEAST_TEXELS: f64 = 4.0;

/// Share of a texel's starts that must be possible: of one that a wall cuts, the rest lies in another light.
const LEAST_ACCEPTED: f64 = 0.99;

/// Sets the random numbers apart from those of the bake proper.
const FIRST_PASS: u64 = 0x0066_6972_7374;

/// What the first pass of a bake cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FirstPass {
    /// Texels that paths may end on.
    pub texels: u64,
    /// Paths.
    pub samples: u64,
    /// Rays traced.
    pub rays: u64,
    /// Processor time [s].
    pub cpu_seconds: f64,
}

impl FirstPass {
    /// Processor time of the bake's own, where this one has [`REPLICATES`] paths [s].
    pub(super) fn predicted_seconds(self) -> f64 {
        self.cpu_seconds * f64::from(FIRST_PATHS) / f64::from(REPLICATES)
    }
}

/// What it takes to look at the texels of a bake.
pub(super) struct Place<'a> {
    pub(super) tracer: &'a Tracer,
    pub(super) atlas: &'a Atlas<'a>,
    pub(super) sites: &'a [Site],
}

/// Whether paths end early by these settings: a path that is cut after so many bounces has a light of its own at each,
/// which no texel has.
pub(super) fn is_asked_for(tracer: &Tracer, settings: &BakeSettings) -> bool {
    settings.later_bounces == LaterBounces::Reused
        && settings.transport.max_bounces.is_none()
        && tracer.effects().has(Effect::Interreflection)
}

impl Place<'_> {
    /// Measures every texel by so many paths and tells the tracer, if that is asked for.
    pub(super) fn first_pass(
        &self,
        paths: u32,
        settings: &BakeSettings,
        workers: &Workers<'_>,
    ) -> Result<Option<FirstPass>, BakeError> {
        if !is_asked_for(self.tracer, settings) {
            return Ok(None);
        }
        let (estimates, cpu) = self.measured(paths, &settings.transport, workers)?;
        self.tracer.learn(self.known_light(&estimates));
        Ok(Some(FirstPass {
            texels: self.sites.iter().zip(&estimates).filter(|(site, estimate)| is_light(site, estimate)).count()
                as u64,
            samples: estimates.iter().map(|estimate| estimate.samples).sum(),
            rays: estimates.iter().map(|estimate| estimate.rays).sum(),
            cpu_seconds: cpu.as_secs_f64(),
        }))
    }

    /// Every texel by so many paths, and the processor time that it took.
    fn measured(
        &self,
        paths: u32,
        transport: &Transport,
        workers: &Workers<'_>,
    ) -> Result<(Vec<Estimate>, Duration), BakeError> {
        let of_site = |site: &Site, cancel: &CancelToken| {
            let clock = ThreadTime::now();
            let mut runs = site.runs_with(combine(site.covered.key, FIRST_PASS), transport);
            // All light, whoever draws it: what a path meets here it is to take on.
            runs.extend(paths, Sobol::new, cancel, |sobol, start, tally| {
                let start = site.start(self.tracer, sobol, start)?;
                Some(self.tracer.diffuse_radiance(&start, sobol, transport, tally))
            })?;
            Some((runs.estimate(), clock.elapsed()))
        };
        let (estimates, times): (Vec<Estimate>, Vec<Duration>) =
            workers.prepare(self.sites, of_site)?.into_iter().unzip();
        Ok((estimates, times.into_iter().sum()))
    }

    /// Texels as the tracer reads them.
    fn known_light(&self, estimates: &[Estimate]) -> KnownLight {
        let charts = Charts::new(self.tracer, &self.atlas.charts);
        let mut known = KnownLight {
            unfolded: vec![Unfolded::UNKNOWN; self.tracer.triangle_count()],
            grids: self.atlas.pages.iter().map(|&size| empty_grid(size)).collect(),
        };
        for (site, estimate) in self.sites.iter().zip(estimates) {
            if is_light(site, estimate) {
                let covered = &site.covered;
                known.grids[covered.page as usize].cells[covered.index as usize] =
                    KnownCell { radiance: estimate.mean.as_vec3(), chart: covered.chart };
            }
        }
        for (receiver, rectangle) in self.atlas.charts.iter().enumerate() {
            let origin = rectangle.origin.map(f64::from);
            for triangle in 0..rectangle.triangle_count() {
                let [a, b, c] = rectangle.triangle(triangle);
                let world = rectangle.receiver.first_triangle + triangle;
                let texels = triangle_area(a, b, c);
                if texels == 0.0 {
                    continue;
                }
                known.unfolded[world as usize] = Unfolded {
                    grid: rectangle.page,
                    chart: charts.of(receiver as u32, triangle),
                    corner: (a + glam::DVec2::from(origin)).as_vec2(),
                    edges: [b - a, c - a].map(|edge| edge.as_vec2()),
                    least_distance: (LEAST_TEXELS * (self.tracer.area(world) / texels).sqrt()) as f32,
                };
            }
        }
        known
    }
}

fn empty_grid([width, height]: [u32; 2]) -> KnownGrid {
    KnownGrid { width, cells: vec![KnownCell::UNKNOWN; width as usize * height as usize] }
}

/// Whether an estimate is that of the whole texel, and of nothing else.
fn is_light(site: &Site, estimate: &Estimate) -> bool {
    estimate.accepted >= LEAST_ACCEPTED && estimate.not_light == 0 && !site.covered.is_overlapped
}

#[cfg(test)]
mod tests;
