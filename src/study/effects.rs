//! What each effect that is simulated costs, and what light it brings.

use super::StudySettings;
use super::budget::Budget;
use super::technique::Technique;
use crate::bake::{BakeError, Receivers, Sums};
use crate::trace::{Effect, Tracer};
use std::cell::RefCell;
use std::time::Duration;

/// Weight of the effects.
pub(super) const WEIGHT: f64 = 5.0;

/// Most paths: shares are wanted to a percent.
const MOST: u32 = 4096;

/// What an effect costs and brings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectShare {
    /// The effect.
    pub effect: Effect,
    /// Share of the tracing time that would be saved without it, at as many paths; negative if it saves time. The
    /// shares of several effects do not add up: without a light, what it lights costs nothing either.
    pub time: f64,
    /// Share of the mean light that would be missing without it; negative if there would be more.
    pub light: f64,
}

/// One scene: the whole, or without an effect.
struct Variant {
    effect: Option<Effect>,
    /// `None` for the receivers' own.
    tracer: Option<Tracer>,
    sums: Vec<Sums>,
    cpu: Duration,
}

/// Measures them all, in turns, and says which have no share.
pub(super) fn shares(
    receivers: &Receivers<'_>,
    settings: &StudySettings,
    budget: &mut Budget<'_>,
) -> Result<(Vec<EffectShare>, Vec<String>), BakeError> {
    let part = budget.part("effects", WEIGHT, 1.0).at_most(MOST);
    let mut left_out = Vec::new();
    let variant = |effect, tracer| Variant { effect, tracer, sums: receivers.sums(0), cpu: Duration::ZERO };
    let mut variants = vec![variant(None, None)];
    for effect in receivers.effects().iter() {
        match receivers.without(effect) {
            Some(tracer) => variants.push(variant(Some(effect), Some(tracer))),
            None => left_out.push(format!(
                "The share of {effect} is left out: without it light would be kept for ever, and no path would end."
            )),
        }
    }
    let manner = Technique::Mis.manner(settings);
    let variants = RefCell::new(variants);
    part.double(
        |count| {
            for variant in variants.borrow_mut().iter_mut() {
                let tracer = variant.tracer.as_ref().unwrap_or(receivers.tracer());
                variant.cpu += receivers.carry_on(tracer, &manner, &mut variant.sums, count)?;
            }
            Ok::<(), BakeError>(())
        },
        |_| (),
    )?;
    let of = |variant: &Variant| {
        let mean = variant.sums.iter().map(Sums::mean).sum::<f64>();
        (variant.cpu.as_secs_f64(), mean)
    };
    let variants = variants.into_inner();
    let (time, light) = of(&variants[0]);
    let share = |variant: &Variant| {
        let (less_time, less_light) = of(variant);
        let missing = |without: f64, with: f64| if with > 0.0 { 1.0 - without / with } else { 0.0 };
        let (time, light) = (missing(less_time, time), missing(less_light, light));
        variant.effect.map(|effect| EffectShare { effect, time, light })
    };
    Ok((variants.iter().filter_map(share).collect(), left_out))
}
