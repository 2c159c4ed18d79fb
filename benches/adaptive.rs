//! What sampling to an error and the fast mode gain, against long references: paths that the worst tenth of the texels
//! costs with as many paths for all and with as many as each needs, in scenes that are uneven (`uneven.rs`) and in two
//! that are not; processor time of a 2 % bake with all bounces traced and with the lightmap reused, and what the latter
//! is biased by. Prints tables; asserts nothing.
//!
//! `cargo bench --bench adaptive -- [fast | adaptive] [SCENE]`

mod uneven;

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/denoise/scenes.rs"]
#[allow(dead_code, reason = "the denoiser's tests use the rest")]
mod denoise_scenes;

use bevy_kiln::bake::{
    BakeSettings, CancelToken, DARK, Denoise, Goal, LaterBounces, Layout, Lightmap, TexelState, bake_lightmap,
};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::Transport;
use glam::Vec3;

/// Bakes with random numbers of their own that a texel's error is taken over.
const SEEDS: u64 = 4;

/// Paths of each of the two references.
const LONG: u32 = 1 << 12;

struct Case {
    name: &'static str,
    scene: Scene,
    layout: Layout,
    density: f32,
}

fn cases() -> [Case; 5] {
    let shared = |case: denoise_scenes::Case, size| Case {
        name: case.name,
        scene: case.scene,
        layout: Layout::Shared { size },
        density: 1.0,
    };
    let packed = |name, scene, density| Case { name, scene, layout: Layout::Packed, density };
    [
        shared(denoise_scenes::cornell(), 48),
        shared(denoise_scenes::sunlit(), 64),
        packed("shed", uneven::shed(), 6.0),
        packed("closet", uneven::closet(), 6.0),
        packed("underpass", uneven::underpass(), 3.0),
    ]
}

impl Case {
    fn bake(&self, goal: Goal, later_bounces: LaterBounces, seed: u64) -> Lightmap {
        let settings = BakeSettings {
            goal,
            later_bounces,
            layout: self.layout,
            density: self.density,
            transport: Transport { seed, ..Transport::default() },
            denoise: Denoise::Off,
            ..BakeSettings::default()
        };
        bake_lightmap(&self.scene, &settings, &(), &CancelToken::default()).unwrap()
    }
}

/// Luminances of all measured texels.
fn values(lightmap: &Lightmap) -> Vec<f64> {
    let luminance = |value: &Vec3| value.dot(Vec3::new(0.2126, 0.7152, 0.0722)).into();
    let pages = lightmap.pages.iter();
    let texels = pages.flat_map(|page| page.raw.iter().zip(&page.state));
    texels.filter(|(_, state)| **state == TexelState::Measured).map(|(value, _)| luminance(value)).collect()
}

/// Two references of their own random numbers.
struct Truth {
    references: [Vec<f64>; 2],
    mean: f64,
}

impl Truth {
    fn new(case: &Case) -> Self {
        let references = [71, 72].map(|seed| values(&case.bake(Goal::Samples(LONG), LaterBounces::Traced, seed)));
        let mean = references[0].iter().sum::<f64>() / references[0].len() as f64;
        Self { references, mean }
    }

    /// Per texel, the product of how far two estimates are off, each relative to a reference of its own: free of these
    /// references' noise, and of that of the estimates where they are two.
    fn products(&self, [a, b]: [&[f64]; 2]) -> Vec<f64> {
        let [first, second] = &self.references;
        let of = |index: usize| {
            let value = (0.5 * (first[index] + second[index])).max(DARK * self.mean);
            (a[index] - first[index]) * (b[index] - second[index]) / (value * value)
        };
        (0..a.len()).map(of).collect()
    }

    /// Root mean square of the relative error.
    fn error(&self, values: &[f64]) -> f64 {
        root_mean(&self.products([values, values]))
    }

    /// That over all, and over the tenth of the texels where it is worst, of bakes with random numbers of their own:
    /// what a texel is to be off by, not what it happens to be.
    fn errors(&self, bakes: &[Vec<f64>]) -> [f64; 2] {
        let products: Vec<Vec<f64>> = bakes.iter().map(|values| self.products([values, values])).collect();
        let of_texel = |texel: usize| products.iter().map(|bake| bake[texel]).sum::<f64>() / bakes.len() as f64;
        let mut squares: Vec<f64> = (0..products[0].len()).map(of_texel).collect();
        squares.sort_unstable_by(f64::total_cmp);
        [root_mean(&squares), root_mean(&squares[squares.len() * 9 / 10..])]
    }
}

fn root_mean(squares: &[f64]) -> f64 {
    (squares.iter().sum::<f64>() / squares.len() as f64).max(0.0).sqrt()
}

/// Where a curve of (cost, error) passes an error, on logarithmic axes.
fn cost_of(curve: &[[f64; 2]], error: f64) -> f64 {
    let at = curve.windows(2).position(|pair| pair[1][1] <= error).unwrap_or(curve.len() - 2);
    let [[c0, e0], [c1, e1]] = [curve[at], curve[at + 1]].map(|point| point.map(f64::ln));
    (c0 + (error.ln() - e0) / (e1 - e0) * (c1 - c0)).exp()
}

fn adaptive(case: &Case, truth: &Truth) {
    let of = |goal, seed| {
        let bakes = (0..SEEDS).map(|turn| case.bake(goal, LaterBounces::Traced, seed + turn));
        let bakes: Vec<(Vec<f64>, u64)> = bakes.map(|lightmap| (values(&lightmap), lightmap.report.samples)).collect();
        let (bakes, samples): (Vec<Vec<f64>>, Vec<u64>) = bakes.into_iter().unzip();
        let [rms, worst] = truth.errors(&bakes);
        ([samples.iter().sum::<u64>() as f64 / (SEEDS as usize * bakes[0].len()) as f64, worst], rms)
    };
    let uniform: Vec<([f64; 2], f64)> = (6..10).map(|power| of(Goal::Samples(1 << power), 3)).collect();
    let curve: Vec<[f64; 2]> = uniform.iter().map(|(point, _)| *point).collect();
    let by_rms: Vec<[f64; 2]> = uniform.iter().map(|([paths, _], rms)| [*paths, *rms]).collect();
    for ([paths, worst], rms) in &uniform {
        println!(
            "{:10} uniform          {paths:8.0} paths  rms {:6.2} %  worst tenth {:6.2} %",
            case.name,
            100.0 * rms,
            100.0 * worst
        );
    }
    for error in [0.4, 0.2, 0.1] {
        let ([paths, worst], rms) = of(Goal::Error(error), 103);
        println!(
            "{:10} to {:4.1} %        {paths:8.0} paths  rms {:6.2} %  worst tenth {:6.2} %  uniform takes {:5.2} times as \
             many, by rms {:5.2}",
            case.name,
            100.0 * error,
            100.0 * rms,
            100.0 * worst,
            cost_of(&curve, worst) / paths,
            cost_of(&by_rms, rms) / paths,
        );
    }
}

fn fast(case: &Case, truth: &Truth) {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let long = [81, 82].map(|seed| values(&case.bake(Goal::Samples(LONG / 2), LaterBounces::Reused, seed)));
    let bias = mean(&truth.products([&long[0], &long[1]]));
    let frozen = long.iter().map(|values| truth.error(values));
    let off =
        mean(&long.each_ref().map(|values| mean(values))) / mean(&truth.references.each_ref().map(|v| mean(v))) - 1.0;
    println!(
        "{:10} fast: mean {:+.3} %, per texel {:.2} % rms, with all noise of one {:.2} %",
        case.name,
        100.0 * off,
        100.0 * bias.max(0.0).sqrt(),
        100.0 * frozen.sum::<f64>() / 2.0,
    );
    let mut curves = Vec::new();
    for later_bounces in [LaterBounces::Traced, LaterBounces::Reused] {
        let mut curve = Vec::new();
        for power in 6..14 {
            let lightmap = case.bake(Goal::Samples(1 << power), later_bounces, 5);
            let rms = truth.error(&values(&lightmap));
            let seconds = lightmap.report.cpu_seconds;
            let first = lightmap.report.first_pass.unwrap_or_default().cpu_seconds;
            println!(
                "{:10} {later_bounces:?} {:6} paths {seconds:7.2} s (first pass {first:5.2} s) rms {:6.2} %",
                case.name,
                1 << power,
                100.0 * rms
            );
            curve.push([seconds, rms]);
        }
        curves.push(curve);
    }
    for error in [0.05, 0.02, 0.01] {
        let [traced, reused] = [0, 1].map(|of| cost_of(&curves[of], error));
        println!(
            "{:10} {:4.1} % rms: traced {traced:7.2} s, reused {reused:7.2} s: {:.2}",
            case.name,
            100.0 * error,
            reused / traced
        );
    }
    for error in [0.1, 0.05] {
        let [traced, reused] = [LaterBounces::Traced, LaterBounces::Reused]
            .map(|later_bounces| case.bake(Goal::Error(error), later_bounces, 6).report.cpu_seconds);
        println!(
            "{:10} to {:4.1} %: traced {traced:7.2} s, reused {reused:7.2} s: {:.2}",
            case.name,
            100.0 * error,
            reused / traced
        );
    }
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let only = |what: &str| words.iter().any(|word| word == what);
    for case in cases()
        .iter()
        .filter(|case| !words.iter().any(|word| cases().iter().any(|other| other.name == *word)) || only(case.name))
    {
        let truth = Truth::new(case);
        println!("{:10} {} texels", case.name, truth.references[0].len());
        if !only("adaptive") {
            fast(case, &truth);
        }
        if !only("fast") {
            adaptive(case, &truth);
        }
    }
}
