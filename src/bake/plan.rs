//! What a bake would do, and what it would cost, before it is done.

mod price;
mod reasons;

use super::atlas::Atlas;
use super::endless::refuse_endless_texels;
use super::lightmap::refuse_what_cannot_be_baked;
use super::reuse::{FirstPass, Place};
use super::sites::{Site, Sites};
use super::survey::Surveyed;
use super::tiles::tiles;
use super::unwrap::LaidOut;
use super::workers::Workers;
use super::{BakeError, BakeSettings, BakeWarning, CancelToken, ProgressSink, REPLICATES};
use crate::scene::Scene;
use crate::trace::{Compiled, Effect, Tracer};
use price::Pilot;

/// Whether an effect is simulated, why, and at what price.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedEffect {
    /// The effect.
    pub effect: Effect,
    /// Whether it is simulated.
    pub on: bool,
    /// Why, in words and numbers.
    pub reason: String,
    /// Share of the predicted time that the bake would save without it at as many paths, as a short pilot measured
    /// it; `None` for an effect that is off, and for one without which light would be kept for ever. The shares do not
    /// add up to 1: without a light, for instance, what it lights costs nothing either.
    pub cost_share: Option<f64>,
}

/// The price of an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    /// The error of every texel, as [`Goal::Error`](super::Goal::Error) has it.
    pub error: f64,
    /// Time that tracing to it would take, the first pass of the fast mode included [s].
    pub seconds: f64,
}

/// What a bake would do.
#[derive(Clone, Debug, PartialEq)]
pub struct BakePlan {
    /// Every effect that this baker knows, on or off.
    pub effects: Vec<PlannedEffect>,
    /// Covered texels.
    pub texels: u64,
    /// Textures.
    pub pages: u32,
    /// Memory that the bake would hold at once [bytes].
    pub memory_bytes: u64,
    /// Prices of a few errors, from a short pilot.
    pub predicted: Vec<Prediction>,
    /// What would be left out.
    pub warnings: Vec<BakeWarning>,
}

impl BakePlan {
    /// Plans the bake of a scene. Lays out the texels and traces a few of them: seconds at most for a scene of
    /// ordinary size.
    ///
    /// # Errors
    ///
    /// What [`bake_lightmap`](super::bake_lightmap) would refuse.
    pub fn for_scene(
        scene: &Scene,
        settings: &BakeSettings,
        progress: &dyn ProgressSink,
        cancel: &CancelToken,
    ) -> Result<Self, BakeError> {
        settings.validate()?;
        let workers = Workers::new(settings.threads, progress, cancel)?;
        let laid_out = LaidOut::new(scene, settings, &workers)?;
        let scene: &Scene = &laid_out.scene;
        let Compiled { tracer, faults, census } = Compiled::new(scene, &settings.transport);
        let faults = laid_out.without_solved(faults);
        refuse_what_cannot_be_baked(&tracer, &faults)?;
        let atlas = Atlas::new(&laid_out, &tracer, settings, cancel)?;
        let Sites { seen: sites, warnings: of_texels, .. } = Sites::new(scene, &tracer, &atlas, settings, &workers)?;
        refuse_endless_texels(scene, &tracer, &settings.transport, &sites)?;
        let mut warnings: Vec<BakeWarning> = faults.into_iter().map(BakeWarning::from).collect();
        warnings.extend(laid_out.warnings.iter().chain(&atlas.warnings).cloned());
        warnings.extend(of_texels);
        warnings.extend(BakeWarning::of_transport(&settings.transport, &census));
        let pilot = Pilot::new(&sites, settings, &workers);
        let shares = pilot.cost_shares(scene, &tracer)?;
        // As many paths as there are runs: enough to tell what paths cost that end on them.
        let first_pass = Place { tracer: &tracer, atlas: &atlas, sites: &sites };
        let first_pass = first_pass.first_pass(REPLICATES, settings, &workers)?;
        let tiles = tiles(&sites, tracer.sharing(&settings.transport));
        let surveyed = Surveyed { tiles: &tiles, sites: &sites, tracer: &tracer };
        let survey = surveyed.survey(&settings.transport, &workers)?;
        let plan_effect = |effect| PlannedEffect {
            effect,
            on: tracer.effects().has(effect),
            reason: reasons::reason(effect, &census, &settings.transport, &tracer),
            cost_share: shares.iter().find(|(known, _)| *known == effect).map(|(_, share)| *share),
        };
        Ok(Self {
            effects: Effect::ALL.into_iter().map(plan_effect).collect(),
            texels: sites.len() as u64,
            pages: atlas.pages.len() as u32,
            memory_bytes: memory_bytes(&tracer, &atlas, &sites),
            predicted: survey.prices(first_pass.map_or(0.0, FirstPass::predicted_seconds)),
            warnings,
        })
    }
}

fn memory_bytes(tracer: &Tracer, atlas: &Atlas<'_>, sites: &[Site]) -> u64 {
    // A page's layers, while they are repaired and after; the scene as the tracer holds it; texels and their work.
    let layers: u64 = atlas.pages.iter().map(|[width, height]| u64::from(*width) * u64::from(*height) * 123).sum();
    let texels: usize = sites.iter().map(Site::memory_bytes).sum();
    layers + tracer.memory_bytes() + texels as u64
}
