//! What is compared: the ways of tracing that a study draws a curve for, and which of them a scene gives reason to.

use super::StudySettings;
use crate::bake::{Manner, Numbers, Receivers};
use crate::trace::{Effect, EffectSet, Estimator, Transport};

/// Caps on bounces that are held against roulette.
const CAPS: [u32; 5] = [0, 1, 2, 4, 8];

/// What light sampling can aim at.
const SOURCES: EffectSet = EffectSet::NONE
    .with(Effect::AreaLights)
    .with(Effect::PointLights)
    .with(Effect::DirectionalLights)
    .with(Effect::EnvironmentMap);

/// A way of tracing, or of what is done with its result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Technique {
    /// Directions from the surface only: the path tracing of textbooks. Sobol points, roulette.
    Naive,
    /// Points on the sources only. Sobol points, roulette.
    Light,
    /// Both, by multiple importance sampling, with numbers that are independent: plain Monte Carlo. Roulette.
    Independent,
    /// Both, with Sobol points and roulette, each texel for itself.
    Mis,
    /// The same, with paths that are cut after so many bounces.
    Capped(u32),
    /// The same, with paths that serve a group of texels: a bake of so many paths.
    Shared,
    /// Each texel for itself in the fast mode: paths end on the texels of a first pass.
    Reused,
    /// What a bake does that is asked for an error: as many paths as each texel needs.
    Adaptive,
    /// What a bake does, then denoised and repaired.
    Denoised,
}

impl Technique {
    /// Its name for a person.
    pub fn name(self) -> String {
        match self {
            Self::Naive => "naive path tracing".into(),
            Self::Light => "light sampling".into(),
            Self::Independent => "MIS, independent numbers".into(),
            Self::Mis => "MIS, Sobol".into(),
            Self::Capped(0) => "direct light only".into(),
            Self::Capped(1) => "cut after 1 bounce".into(),
            Self::Capped(cap) => format!("cut after {cap} bounces"),
            Self::Shared => "shared paths (bake --spp)".into(),
            Self::Reused => "fast mode".into(),
            Self::Adaptive => "adaptive (bake --error)".into(),
            Self::Denoised => "denoised (bake)".into(),
        }
    }

    /// Its name in tables for programs.
    pub fn key(self) -> String {
        match self {
            Self::Naive => "naive".into(),
            Self::Light => "light".into(),
            Self::Independent => "independent".into(),
            Self::Mis => "mis".into(),
            Self::Capped(cap) => format!("capped-{cap}"),
            Self::Shared => "shared".into(),
            Self::Reused => "reused".into(),
            Self::Adaptive => "adaptive".into(),
            Self::Denoised => "denoised".into(),
        }
    }

    /// Whether its mean is the truth, so that more paths make it as good as one likes.
    pub fn is_unbiased(self) -> bool {
        match self {
            Self::Naive | Self::Light | Self::Independent | Self::Mis | Self::Shared | Self::Adaptive => true,
            Self::Capped(_) | Self::Reused | Self::Denoised => false,
        }
    }

    /// Its part of the time.
    pub(super) fn weight(self) -> f64 {
        match self {
            Self::Naive | Self::Light | Self::Independent | Self::Reused => 8.0,
            Self::Mis => 10.0,
            Self::Capped(_) => 2.4,
            Self::Shared | Self::Denoised | Self::Adaptive => 14.0,
        }
    }

    /// How receivers are measured by it; as by [`Self::Mis`] for what is done to whole lightmaps.
    pub(super) fn manner(self, settings: &StudySettings) -> Manner {
        let transport = Transport { estimator: Estimator::Mis, ..settings.bake.transport };
        let (transport, numbers) = match self {
            Self::Naive => (Transport { estimator: Estimator::Bsdf, ..transport }, Numbers::Sobol),
            Self::Light => (Transport { estimator: Estimator::Light, ..transport }, Numbers::Sobol),
            Self::Independent => (transport, Numbers::Independent),
            Self::Mis | Self::Shared | Self::Reused | Self::Adaptive | Self::Denoised => (transport, Numbers::Sobol),
            Self::Capped(cap) => (Transport { max_bounces: Some(cap), ..transport }, Numbers::Sobol),
        };
        Manner { transport, numbers }
    }
}

/// Those that receivers are measured by, and a sentence for each that the scene gives no reason to.
pub(super) fn called_for(receivers: &Receivers<'_>, settings: &StudySettings) -> (Vec<Technique>, Vec<String>) {
    let (mut techniques, mut left_out) = (vec![Technique::Mis], Vec::new());
    let effects = receivers.effects();
    let lights = receivers.census().unsized_lights();
    if !effects.has_any(SOURCES) {
        left_out.push(
            "Naive path tracing and light sampling are left out: the only light is a constant sky, which every \
             estimator finds in the same way."
                .into(),
        );
    } else if lights > 0 {
        let lights = if lights == 1 { "1 light has".into() } else { format!("{lights} lights have") };
        left_out.push(format!("Naive path tracing is left out: {lights} no size, so that no ray meets it."));
        techniques.push(Technique::Light);
    } else {
        techniques.extend([Technique::Naive, Technique::Light]);
    }
    techniques.push(Technique::Independent);
    if effects.has(Effect::Interreflection) {
        let most = settings.bake.transport.max_bounces.unwrap_or(u32::MAX);
        techniques.extend(CAPS.into_iter().filter(|&cap| cap < most).map(Technique::Capped));
        if settings.bake.transport.max_bounces.is_none() {
            techniques.push(Technique::Reused);
        } else {
            left_out.push("The fast mode is left out: with a cap on bounces a bake has none.".into());
        }
    } else {
        left_out.push("Caps on bounces are left out: no surface passes light on.".into());
    }
    (techniques, left_out)
}
