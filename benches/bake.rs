//! Receiver samples per second of processor time on one thread, a receiver sample being one path from one texel, for
//! each estimator; and, at the end, what matters: efficiency, 1 / (relative RMSE² × processor seconds), the relative
//! RMSE being the root of the mean square error over the mean, against the reference lightmap of the Cornell box.

mod hall;

#[path = "../tests/common/glb.rs"]
mod glb;

use bevy_kiln::bake::{BakeSettings, CancelToken, Denoise, Goal, Layout, Lightmap, bake_lightmap};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::{Estimator, Transport};
use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use std::f64::consts::PI;
use std::num::NonZeroUsize;
use std::path::Path;
use std::time::Duration;

const ESTIMATORS: [(&str, Estimator); 3] =
    [("mis", Estimator::Mis), ("light", Estimator::Light), ("bsdf", Estimator::Bsdf)];

/// Width and height of the reference [texels].
const REFERENCE_SIZE: u32 = 256;

/// Paths per texel of the bakes that are held against the reference.
const REFERENCE_SAMPLES: u32 = 256;

fn settings(estimator: Estimator, layout: Layout, samples_per_texel: u32) -> BakeSettings {
    BakeSettings {
        transport: Transport { estimator, ..Transport::default() },
        goal: Goal::Samples(samples_per_texel),
        density: 1.5,
        layout,
        denoise: Denoise::Off,
        threads: NonZeroUsize::new(1),
        ..BakeSettings::default()
    }
}

fn bake(scene: &Scene, settings: &BakeSettings) -> Lightmap {
    bake_lightmap(scene, settings, &(), &CancelToken::default()).expect("a sound scene")
}

fn receiver_samples(criterion: &mut Criterion) {
    let scenes =
        [("cornell", glb::load("cornell"), Layout::Shared { size: 64 }), ("hall", hall::hall(), Layout::Packed)];
    for (name, scene, layout) in scenes {
        let mut group = criterion.benchmark_group(format!("bake/{name}"));
        group.sample_size(10).sampling_mode(SamplingMode::Flat);
        group.warm_up_time(Duration::from_millis(1)).measurement_time(Duration::from_secs(5));
        for (name, estimator) in ESTIMATORS {
            let settings = settings(estimator, layout, 16);
            let samples = bake(&scene, &settings).report.samples;
            group.throughput(Throughput::Elements(samples));
            // Tracing alone, in processor time: neither building the tree nor who else uses the machine.
            let tracing = || Duration::from_secs_f64(bake(&scene, &settings).report.cpu_seconds);
            group.bench_function(name, |bencher| bencher.iter_custom(|count| (0..count).map(|_| tracing()).sum()));
        }
    }
}

/// A texel of the reference: green irradiance and its standard error [lx].
struct Reference {
    texels: Vec<(f64, f64)>,
}

impl Reference {
    fn load() -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/cornell_256_irradiance.exr");
        let image =
            read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
        let image = image.from_file(path).expect("the reference lightmap");
        let channel = |name: &str| -> Vec<f64> {
            let channels = &image.layer_data.channel_data.list;
            let channel = channels.iter().find(|channel| channel.name.eq(name)).expect("a channel of the reference");
            match &channel.sample_data {
                FlatSamples::F32(values) => values.iter().map(|&value| f64::from(value)).collect(),
                _ => panic!("channel {name} is not f32"),
            }
        };
        let covered = channel("A");
        let values = channel("G").into_iter().zip(channel("stderr.G"));
        // Black, and so left out, where the centre is not covered.
        let texels = values.zip(covered).map(|(value, covered)| if covered > 0.5 { value } else { (0.0, 0.0) });
        Self { texels: texels.collect() }
    }

    /// Mean square error of a lightmap over the square of the mean, and the number of texels that it was taken over:
    /// all but those that are buried.
    fn error(&self, lightmap: &Lightmap) -> (f64, usize) {
        let page = &lightmap.pages[0];
        let mean = self.texels.iter().map(|texel| texel.0).sum::<f64>() / self.texels.len() as f64;
        let lit = |(index, (value, stderr)): (usize, &(f64, f64))| {
            // The reference's own error, known on average, is taken off.
            let off = PI * f64::from(page.raw[index].y) - value;
            let is_lit = *value > 1e-3 * mean && page.coverage[index] > 0.99;
            is_lit.then_some([off * off - stderr * stderr, *value])
        };
        let lit: Vec<[f64; 2]> = self.texels.iter().enumerate().filter_map(lit).collect();
        let mean = |of: usize| lit.iter().map(|texel| texel[of]).sum::<f64>() / lit.len() as f64;
        (mean(0) / mean(1).powi(2), lit.len())
    }
}

fn efficiency(_: &mut Criterion) {
    let (scene, reference) = (glb::load("cornell"), Reference::load());
    eprintln!(
        "\nCornell box, {REFERENCE_SIZE}², {REFERENCE_SAMPLES} paths per texel, one thread, against the reference"
    );
    eprintln!("estimator   relative RMSE   processor [s]   efficiency [1/s]");
    for (name, estimator) in ESTIMATORS.into_iter().take(1) {
        let layout = Layout::Shared { size: REFERENCE_SIZE };
        let lightmap = bake(&scene, &settings(estimator, layout, REFERENCE_SAMPLES));
        let (error, texels) = reference.error(&lightmap);
        assert!(texels > 20_000, "only {texels} texels are compared");
        let seconds = lightmap.report.cpu_seconds;
        eprintln!("{name:9}   {:13.4}   {seconds:13.2}   {:16.1}", error.sqrt(), 1.0 / (error * seconds));
    }
}

criterion_group!(benches, receiver_samples, efficiency);
criterion_main!(benches);
