//! What accuracy costs in time: the error of a scene's lightmap against processor time, for the ways of tracing that a
//! person may choose between or has heard of.
//!
//! [`study`] takes a few hundred texels of the lightmap, spread evenly over all (`bake` measures them as it would in a
//! bake), and follows each [`Technique`] from 16 paths per texel by doublings for its part of the time (`budget`). Then
//! a reference is traced with other random numbers for as long as is left. Errors are root mean squares over the texels
//! against it, over its mean, by luminance, with its own noise taken out (`truth`); a point too near to that noise is
//! marked. A line through each curve gives its slope, and the curve the price of an error (`fit`).
//!
//! Sixteen paths are the least, since a bake deals its paths to sixteen scrambles. Only how far curves go depends on
//! the clock; what is measured after so many paths does not, nor does which texels are measured.
//!
//! It knows no files: `output` makes a page of a [`Study`].

mod bakes;
mod budget;
mod curve;
mod effects;
mod fit;
mod strip;
mod technique;
#[cfg(test)]
mod testing;
mod tracing;
mod truth;
mod view;

pub use curve::{Curve, Floor, Point};
pub use effects::EffectShare;
pub use fit::{Cost, PRICED_ERRORS, Price, Slope};
pub use strip::{PICTURE_SIZE, Strip, StudyPicture};
pub use technique::Technique;
pub use truth::Standing;

use crate::bake::{BakeError, BakeSettings, BakeWarning, CancelToken, LaterBounces, Layout, Receivers, thread_count};
use crate::scene::Scene;
use crate::trace::Sharing;
use bakes::Studied;
use budget::Budget;
use std::time::Duration;

/// How long a study takes that nobody gave a time.
const TIME: Duration = Duration::from_secs(20 * 60);

/// Most texels that are measured, and how many of them for each second of a short study.
const RECEIVERS: usize = 1024;
const RECEIVERS_PER_SECOND: f64 = 4.0;

/// Fewest.
const LEAST_RECEIVERS: usize = 256;

/// Most texels of the lightmap for each second of the study: so many that some whole bakes fit.
const TEXELS_PER_SECOND: f64 = 8.0;

/// Fewest texels that a lightmap is made coarser for.
const LEAST_TEXELS: f64 = 2000.0;

/// Techniques whose curves are made of whole bakes.
const WHOLE: [Technique; 3] = [Technique::Shared, Technique::Adaptive, Technique::Denoised];

/// What a study is asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StudySettings {
    /// The bake that is studied. Its goal, its estimator, its clamp, its mode and whether it denoises do not matter;
    /// its density is lowered where whole bakes would take too long.
    pub bake: BakeSettings,
    /// How much is done.
    pub effort: Effort,
}

/// How much is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Effort {
    /// What fits into this time, about.
    Time(Duration),
    /// Curves of up to so many paths per texel: the same numbers whenever it is asked for, times aside.
    Paths(u32),
}

impl Default for Effort {
    fn default() -> Self {
        Self::Time(TIME)
    }
}

/// How far a study is.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyProgress {
    /// What it is doing.
    pub what: String,
    /// Share of the study that is done, in [0, 1].
    pub done: f64,
    /// Time that is left, where it has a limit [s].
    pub seconds_left: Option<f64>,
}

/// What accuracy costs in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// What was measured, and where.
    pub conditions: Conditions,
    /// What errors are measured against.
    pub reference: Reference,
    /// One for each technique.
    pub curves: Vec<Curve>,
    /// What the effects that are simulated cost.
    pub effects: Vec<EffectShare>,
    /// Pictures after more and more paths.
    pub strip: Strip,
    /// A sentence for all that was not studied.
    pub left_out: Vec<String>,
    /// What is wrong with the scene.
    pub warnings: Vec<BakeWarning>,
}

/// What was measured, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Conditions {
    /// Texels of the lightmap.
    pub texels: u64,
    /// How many of them were measured.
    pub receivers: u64,
    /// Texels per metre; `None` in a layout that an artist made.
    pub density: Option<f32>,
    /// Triangles of the scene.
    pub triangles: u64,
    /// Threads that traced.
    pub threads: usize,
    /// Changes every random number.
    pub seed: u64,
    /// Time that the study took [s].
    pub seconds: f64,
}

/// What errors are measured against: what a bake does, with other random numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Mean luminance of E/π over the receivers [cd/m²].
    pub mean: f64,
    /// Paths from each receiver.
    pub paths: u32,
    /// Its own root mean square error over its mean, from how its runs differ.
    pub error: f64,
    /// Processor time that a whole lightmap of this quality would take [s].
    pub cpu_seconds: f64,
}

impl Study {
    /// The curve of a technique, if it was studied.
    pub fn curve(&self, technique: Technique) -> Option<&Curve> {
        self.curves.iter().find(|curve| curve.technique == technique)
    }

    /// What a bake of so many paths does: they serve groups of texels where the scene has anything to share.
    pub fn of_a_bake(&self) -> Technique {
        if self.curve(Technique::Shared).is_some() { Technique::Shared } else { Technique::Mis }
    }
}

/// Studies what accuracy costs for a scene.
///
/// # Errors
///
/// What a bake would refuse; [`BakeError::NoLight`] where none arrives at the texels that are measured.
pub fn study(
    scene: &Scene,
    settings: &StudySettings,
    progress: &dyn Fn(&StudyProgress),
    cancel: &CancelToken,
) -> Result<Study, BakeError> {
    let mut left_out = Vec::new();
    let mut settings = settings.clone();
    settings.bake.later_bounces = LaterBounces::Traced;
    if settings.bake.transport.clamp.take().is_some() {
        left_out.push("The clamp is left out: it takes light, and errors are measured with all of it.".into());
    }
    // What the layout takes is a part of the time.
    let start = std::time::Instant::now();
    progress(&StudyProgress { what: "layout".into(), done: 0.0, seconds_left: None });
    let receivers = receivers(scene, &mut settings, &mut left_out, cancel)?;
    let (techniques, sentences) = technique::called_for(&receivers, &settings);
    left_out.extend(sentences);
    let weights = techniques.iter().map(|technique| technique.weight()).sum::<f64>()
        + WHOLE.iter().map(|technique| technique.weight()).sum::<f64>()
        + effects::WEIGHT
        + strip::WEIGHT
        + tracing::REFERENCE_WEIGHT;
    let mut budget = Budget::new(settings.effort, weights, start, progress);
    let mut trails = Vec::new();
    for technique in techniques {
        let part = budget.part(technique.name(), technique.weight(), 1.0);
        if technique == Technique::Reused {
            // The same receivers with a tracer that knows the first pass.
            let bake = BakeSettings { later_bounces: LaterBounces::Reused, ..settings.bake.clone() };
            let reused = Receivers::new(scene, &bake, receivers.count(), cancel)?;
            trails.push(tracing::trace(&reused, technique, &settings, &part)?);
        } else {
            trails.push(tracing::trace(&receivers, technique, &settings, &part)?);
        }
    }
    let is_shared = receivers.tracer().sharing(&settings.bake.transport) == Sharing::Group;
    for technique in WHOLE.into_iter().filter(|&technique| is_shared || technique != Technique::Shared) {
        let part = budget.part(bakes::name(technique), technique.weight(), 1.0);
        trails.push(bakes::bakes(&Studied { scene, receivers: &receivers }, technique, &settings, &part, cancel)?);
    }
    let (effects, sentences) = effects::shares(&receivers, &settings, &mut budget)?;
    left_out.extend(sentences);
    let (truth, reference) = tracing::reference(&receivers, &settings, &mut budget)?;
    let (strip, sentences) = strip::strip(scene, receivers.tracer(), &settings, &mut budget, cancel)?;
    left_out.extend(sentences);
    if cancel.is_cancelled() {
        return Err(BakeError::Cancelled);
    }
    if reference.mean.is_nan() || reference.mean <= 0.0 {
        return Err(BakeError::NoLight { because: " that reaches a texel".into() });
    }
    let curves = trails.iter().map(|trail| trail.curve(&truth)).collect();
    let density = (settings.bake.layout == Layout::Packed).then_some(settings.bake.density);
    let conditions = Conditions {
        texels: receivers.texels(),
        receivers: receivers.count() as u64,
        density,
        triangles: receivers.tracer().triangle_count() as u64,
        threads: thread_count(settings.bake.threads),
        seed: settings.bake.transport.seed,
        seconds: start.elapsed().as_secs_f64(),
    };
    let warnings = receivers.warnings().to_vec();
    Ok(Study { conditions, reference, curves, effects, strip, left_out, warnings })
}

/// The texels that are measured, of a lightmap of which whole bakes fit into the time.
fn receivers<'a>(
    scene: &Scene,
    settings: &mut StudySettings,
    left_out: &mut Vec<String>,
    cancel: &'a CancelToken,
) -> Result<Receivers<'a>, BakeError> {
    let (count, most) = match settings.effort {
        Effort::Paths(_) => (RECEIVERS, f64::INFINITY),
        Effort::Time(time) => {
            let seconds = time.as_secs_f64();
            let count = (RECEIVERS_PER_SECOND * seconds) as usize;
            (count.clamp(LEAST_RECEIVERS, RECEIVERS), (TEXELS_PER_SECOND * seconds).max(LEAST_TEXELS))
        }
    };
    let receivers = Receivers::new(scene, &settings.bake, count, cancel)?;
    let texels = receivers.texels() as f64;
    if texels <= most || settings.bake.layout != Layout::Packed {
        return Ok(receivers);
    }
    let density = settings.bake.density * (most / texels).sqrt() as f32;
    left_out.push(format!(
        "The {} texels of {} per metre are left out for fewer, at {density:.2} per metre, of which whole bakes fit into \
         the time. Errors per texel are about the same for both; times grow with the texels.",
        receivers.texels(),
        settings.bake.density
    ));
    settings.bake.density = density;
    Receivers::new(scene, &settings.bake, count, cancel)
}
