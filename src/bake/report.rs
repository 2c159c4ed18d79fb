//! What a bake did, in numbers.

use super::gather::{Estimate, clamped_share, relative_error};
use super::tiles::{ErrorTarget, Until};
use super::workers::Work;
use super::{BakeWarning, DARK, FirstPass};
use crate::artefact::{Fingerprint, StableId};
use crate::math::luminance;
use crate::trace::{ForcedEffects, Transport};
use std::collections::BTreeMap;
use std::time::Duration;

/// What a bake did, in numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BakeReport {
    /// Measured texels (or points, or pixels).
    pub texels: u64,
    /// Texels that triangles cover and nobody sees, since they lie inside of bodies in the dark.
    pub hidden: u64,
    /// Of them, those that were taken from the bake before, since nothing that changed reaches them; `None` in a bake
    /// from nothing.
    pub kept: Option<u64>,
    /// Paths that started from what was measured, now or in the bake that it is taken from.
    pub samples: u64,
    /// Rays traced for these, shadow rays included.
    pub rays: u64,
    /// Processor time of the baking threads [s].
    pub cpu_seconds: f64,
    /// Time that passed [s].
    pub wall_seconds: f64,
    /// Standard error over value, by luminance.
    pub relative_stderr: RelativeError,
    /// How well texels are known, before repair.
    pub intervals: Intervals,
    /// What the first pass of the fast mode did, which is a part of the sums above; `None` where all bounces were
    /// traced.
    pub first_pass: Option<FirstPass>,
    /// What the denoiser did; `None` where it was off.
    pub denoised: Option<Denoised>,
    /// Absorbed over emitted flux; `None` for a scene from which light escapes, whose sky shines, or whose surfaces
    /// are not all diffuse.
    pub energy_balance: Option<f64>,
    /// Share of the light that a clamp of bright paths took; `None` without one.
    pub clamped_light: Option<f64>,
    /// Effects that were forced on or off.
    pub forced: ForcedEffects,
    /// Textures; 0 where no lightmap was made.
    pub pages: u32,
    /// Share of the textures' area that is covered texels.
    pub fill: f64,
    /// Objects whose mesh got a UV1.
    pub unwrapped: u64,
    /// Texels whose value a texture format could not hold.
    pub clamped: u64,
    /// What was done about seams; `None` where no charts meet on a smooth surface.
    pub seams: Option<SeamReport>,
    /// [`Scene::fingerprints`](crate::scene::Scene::fingerprints) of what was baked.
    pub fingerprints: BTreeMap<StableId, Fingerprint>,
    /// What was left out, and what to do about it.
    pub warnings: Vec<BakeWarning>,
}

/// Standard error over value, by Rec. 709 luminance, over covered texels brighter than 1e-3 of the mean.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RelativeError {
    /// Mean.
    pub mean: f64,
    /// 95th percentile.
    pub p95: f64,
    /// Worst.
    pub max: f64,
}

/// Half the width of the interval of luminance that holds the truth in 95 of 100 cases, over the value or, of what is
/// darker, over a floor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Intervals {
    /// What was asked for, or found to be possible in the time that was asked for; `None` where paths were.
    pub target: Option<f64>,
    /// The floor: [`DARK`](super::DARK) of the mean over all texels [cd/m²].
    pub floor: f64,
    /// Of all texels, dark ones too.
    pub half_width: RelativeError,
    /// Texels that got as many paths as one may have and yet are not known so well.
    pub missed: u64,
}

impl Intervals {
    pub(super) fn of(estimates: &[Estimate], until: Until) -> Self {
        let mean =
            |of: &dyn Fn(&Estimate) -> f64| estimates.iter().map(of).sum::<f64>() / estimates.len().max(1) as f64;
        let target = match until {
            Until::Error(target) => target,
            Until::Samples(_) => {
                ErrorTarget { relative: f64::INFINITY, floor: DARK * mean(&|estimate| luminance(estimate.mean)) }
            }
        };
        let width = |estimate: &Estimate| {
            let value = target.value(estimate);
            if value > 0.0 { estimate.half_width / value } else { 0.0 }
        };
        let missed = estimates.iter().filter(|estimate| !target.is_met(estimate)).count() as u64;
        Self {
            target: target.relative.is_finite().then_some(target.relative),
            floor: target.floor,
            half_width: RelativeError::of(estimates.iter().map(width).collect()),
            missed,
        }
    }
}

impl RelativeError {
    /// Of all errors.
    pub(super) fn of(mut errors: Vec<f64>) -> Self {
        errors.sort_unstable_by(f64::total_cmp);
        let Some(last) = errors.len().checked_sub(1) else { return Self::default() };
        Self { mean: errors.iter().sum::<f64>() / errors.len() as f64, p95: errors[last * 95 / 100], max: errors[last] }
    }
}

/// Standard error over value before and after denoising, as estimated from the texels themselves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Denoised {
    /// Of what was measured.
    pub before: RelativeError,
    /// Of what is shown: the noise that is left. What was blurred is not in it.
    pub after: RelativeError,
}

/// What was done about seams: the edges of charts across which the surface is smooth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeamReport {
    /// Stretches along which two edges meet.
    pub joints: u64,
    /// Points along them at which both sides were compared.
    pub samples: u64,
    /// How far both sides were apart after texels were filled, and before they were moved.
    pub before: Jump,
    /// How far they are apart now.
    pub after: Jump,
}

/// How far two lookups at one point of a joint are apart, bilinear and bicubic ones, over the local value: that of the
/// strongest channel of the mean of both, and at least a fiftieth of the brightest texel that is read, or what such a
/// fiftieth of a brighter place farther along the seams has fallen off to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jump {
    /// 99th percentile.
    pub p99: f64,
    /// Worst.
    pub max: f64,
}

impl Jump {
    /// Of all jumps.
    pub(super) fn of(mut jumps: Vec<f64>) -> Self {
        jumps.sort_unstable_by(f64::total_cmp);
        let at = |place: usize| jumps.get(place).copied().unwrap_or_default();
        let last = jumps.len().saturating_sub(1);
        Self { p99: at(last * 99 / 100), max: at(last) }
    }
}

impl BakeReport {
    /// With a first pass, which counts.
    pub(super) fn with(mut self, first_pass: Option<FirstPass>) -> Self {
        let FirstPass { samples, rays, cpu_seconds, .. } = first_pass.unwrap_or_default();
        self.samples += samples;
        self.rays += rays;
        self.cpu_seconds += cpu_seconds;
        self.first_pass = first_pass;
        self
    }

    /// The report of estimates that took `wall` time.
    pub(super) fn of(
        work: &Work<Estimate>,
        wall: Duration,
        transport: &Transport,
        warnings: impl Iterator<Item = BakeWarning>,
    ) -> Self {
        Self {
            texels: work.results.len() as u64,
            hidden: 0,
            kept: None,
            samples: work.results.iter().map(|estimate| estimate.samples).sum(),
            rays: work.results.iter().map(|estimate| estimate.rays).sum(),
            cpu_seconds: work.cpu.as_secs_f64(),
            wall_seconds: wall.as_secs_f64(),
            relative_stderr: relative_error(&work.results),
            intervals: Intervals::default(),
            first_pass: None,
            denoised: None,
            energy_balance: None,
            clamped_light: clamped_share(&work.results, transport.clamp),
            forced: transport.effects,
            pages: 0,
            fill: 0.0,
            unwrapped: 0,
            clamped: 0,
            seams: None,
            fingerprints: BTreeMap::new(),
            warnings: warnings.chain(BakeWarning::of_paths(&work.results)).collect(),
        }
    }
}
