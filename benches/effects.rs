//! The prices of effects on the Cornell box. First of what is switched on although nothing calls for it, and so what
//! its absence saves: traced by the kernel that the plan asks for, by that of each effect alone besides, and by the one
//! of all; the light must be the same. Then of what the box is changed to call for: a sun, gloss on every wall, a short
//! block of glass.
//!
//! Processor time of one thread, in turns, so that whatever else the machine does falls on all alike; the median over
//! the rounds of the ratio to the first line in the same round.

#[path = "effects/boxes.rs"]
mod boxes;
#[path = "../tests/common/glb.rs"]
mod glb;

use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, Layout, Lightmap, bake_lightmap};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::{Effect, EffectSet, ForcedEffects, Transport};
use std::num::NonZeroUsize;

/// How often each kernel runs.
const ROUNDS: usize = 7;

const SAMPLES_PER_TEXEL: u32 = 32;

/// A line of a table.
struct Case {
    name: String,
    scene: Scene,
    on: EffectSet,
}

/// What was measured of it.
#[derive(Clone, Default)]
struct Price {
    seconds: Vec<f64>,
    /// Mean E/π of the green channel over covered texels [cd/m²].
    mean: f64,
}

fn bake(case: &Case) -> Lightmap {
    let effects = ForcedEffects { on: case.on, ..ForcedEffects::default() };
    let settings = BakeSettings {
        transport: Transport { effects, ..Transport::default() },
        goal: Goal::Samples(SAMPLES_PER_TEXEL),
        layout: Layout::Shared { size: 96 },
        threads: NonZeroUsize::new(1),
        ..BakeSettings::default()
    };
    bake_lightmap(&case.scene, &settings, &(), &CancelToken::default()).expect("a sound scene")
}

fn mean(lightmap: &Lightmap) -> f64 {
    let texels = lightmap.pages.iter().flat_map(|page| page.raw.iter().zip(&page.coverage));
    let covered: Vec<f64> = texels.filter(|(_, coverage)| **coverage > 0.0).map(|(raw, _)| f64::from(raw.y)).collect();
    covered.iter().sum::<f64>() / covered.len() as f64
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Measures all cases in turns and prints them against the first.
fn measure(title: &str, cases: &[Case]) -> Vec<Price> {
    let mut prices = vec![Price::default(); cases.len()];
    for _ in 0..ROUNDS {
        for (price, case) in prices.iter_mut().zip(cases) {
            let lightmap = bake(case);
            price.seconds.push(lightmap.report.cpu_seconds);
            price.mean = mean(&lightmap);
        }
    }
    println!("{title:24}{:>10}{:>14}{:>16}", "cpu s", "of the first", "mean E/π");
    for (price, case) in prices.iter().zip(cases) {
        let ratios = price.seconds.iter().zip(&prices[0].seconds).map(|(own, first)| own / first);
        let (seconds, ratio) = (median(price.seconds.clone()), 100.0 * median(ratios.collect()));
        println!("{:24}{seconds:10.3}{ratio:13.0} %{:16.6}", case.name, price.mean);
    }
    println!();
    prices
}

fn main() {
    println!("Cornell box, {SAMPLES_PER_TEXEL} paths per texel, one thread, {ROUNDS} rounds\n");
    let case = |name: &str, on| Case { name: name.to_owned(), scene: glb::load("cornell"), on };
    let alone = Effect::ALL.map(|effect| case(effect.name(), EffectSet::NONE.with(effect)));
    let all = case("all of them", Effect::ALL.into_iter().collect());
    let forced: Vec<Case> = [case("as planned", EffectSet::NONE)].into_iter().chain(alone).chain([all]).collect();
    let prices = measure("forced on", &forced);
    for (price, case) in prices.iter().zip(&forced) {
        let off = price.mean / prices[0].mean - 1.0;
        assert!(off.abs() < 1e-4, "{} changes the light by {off}", case.name);
    }
    let changed = boxes::changed(&glb::load("cornell"));
    let called = changed.into_iter().map(|(name, scene)| Case { name: name.to_owned(), scene, on: EffectSet::NONE });
    measure("called for", &[case("as it is", EffectSet::NONE)].into_iter().chain(called).collect::<Vec<_>>());
}
