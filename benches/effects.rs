//! What an effect costs that is switched on although nothing calls for it, and so what its absence saves: the Cornell
//! box traced by the kernel that its plan asks for, by that of each effect alone besides, and by the one of all.
//!
//! Processor time of one thread, in turns, so that whatever else the machine does falls on all alike; the median over
//! the rounds of the ratio to the planned kernel in the same round. The light must be the same.

#[path = "../tests/common/glb.rs"]
mod glb;

use bevy_kiln::bake::{BakeSettings, CancelToken, Layout, Lightmap, bake_lightmap};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::{Effect, EffectSet, ForcedEffects, Transport};
use std::num::NonZeroUsize;

/// How often each kernel runs.
const ROUNDS: usize = 9;

const SAMPLES_PER_TEXEL: u32 = 32;

fn bake(scene: &Scene, on: EffectSet) -> Lightmap {
    let settings = BakeSettings {
        transport: Transport { effects: ForcedEffects { on, ..ForcedEffects::default() }, ..Transport::default() },
        samples_per_texel: SAMPLES_PER_TEXEL,
        layout: Layout::Shared { size: 96 },
        threads: NonZeroUsize::new(1),
        ..BakeSettings::default()
    };
    bake_lightmap(scene, &settings, &(), &CancelToken::default()).expect("a sound scene")
}

/// Mean of the green channel over covered texels.
fn mean(lightmap: &Lightmap) -> f64 {
    let texels = lightmap.pages.iter().flat_map(|page| page.raw.iter().zip(&page.coverage));
    let covered: Vec<f64> = texels.filter(|(_, coverage)| **coverage > 0.0).map(|(raw, _)| f64::from(raw.y)).collect();
    covered.iter().sum::<f64>() / covered.len() as f64
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    let scene = glb::load("cornell");
    let none = ("as planned".to_owned(), EffectSet::NONE);
    let alone = Effect::ALL.map(|effect| (effect.name().to_owned(), EffectSet::NONE.with(effect)));
    let all = ("all of them".to_owned(), Effect::ALL.into_iter().collect());
    let cases: Vec<(String, EffectSet)> = [none].into_iter().chain(alone).chain([all]).collect();
    let mut seconds = vec![Vec::new(); cases.len()];
    let mut means = vec![0.0; cases.len()];
    for _ in 0..ROUNDS {
        for (index, (_, on)) in cases.iter().enumerate() {
            let lightmap = bake(&scene, *on);
            seconds[index].push(lightmap.report.cpu_seconds);
            means[index] = mean(&lightmap);
        }
    }
    println!("Cornell box, {SAMPLES_PER_TEXEL} paths per texel, one thread, {ROUNDS} rounds");
    println!("{:24}{:>10}{:>12}{:>14}", "forced on", "cpu s", "of planned", "mean E/π off");
    for (index, (name, _)) in cases.iter().enumerate() {
        let ratio = median(seconds[index].iter().zip(&seconds[0]).map(|(own, planned)| own / planned).collect());
        let off = means[index] / means[0] - 1.0;
        println!("{name:24}{:10.3}{:11.0} %{:13.5} %", median(seconds[index].clone()), 100.0 * ratio, 100.0 * off);
        assert!(off.abs() < 1e-4, "{name} changes the light by {off}");
    }
}
