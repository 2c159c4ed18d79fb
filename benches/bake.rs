//! Receiver samples per second of processor time on one thread, a receiver sample being one path from one texel, for
//! each estimator; and, at the end, what matters: efficiency, 1 / (relative RMSE² × processor seconds), the relative
//! RMSE being the root of the mean square error over the mean, against the reference lightmap of the Cornell box; and the
//! same of texels that share their paths over texels that do not, in boxes of other materials.

mod hall;

#[path = "../tests/common/glb.rs"]
mod glb;

use bevy_kiln::bake::{BakeSettings, CancelToken, Denoise, Goal, Layout, Lightmap, bake_lightmap};
use bevy_kiln::scene::{Alpha, Material, Scattering, Scene, Standard};
use bevy_kiln::trace::{Estimator, Sharing, Transport};
use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use glam::Vec3;
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

/// Paths per texel of the bakes of other materials, and their side [texels].
const OTHER_SAMPLES: u32 = 64;
const OTHER_SIZE: u32 = 96;

/// The Cornell box of other materials.
fn boxes() -> Vec<(&'static str, Scene)> {
    let of = |change: &dyn Fn(&mut Scene)| {
        let mut scene = glb::load("cornell");
        change(&mut scene);
        scene
    };
    let standard = |standard: Standard| {
        of(&move |scene| {
            let walls = scene.materials.iter_mut().filter(|material| material.emitted_radiance == Vec3::ZERO);
            walls.for_each(|material| material.scattering = Scattering::Standard(Box::new(standard.clone())));
        })
    };
    let metal = |metallic: f32| standard(Standard { metallic, ..Standard::default() });
    let (varnish, smooth) = (
        Standard { clearcoat: 1.0, ..Standard::default() },
        Standard { perceptual_roughness: 0.0, ..Standard::default() },
    );
    let block = |change: fn(&mut Material)| {
        of(&move |scene| {
            let block = scene.instances.iter().position(|instance| instance.name == "tall_block").expect("a block");
            let mut material = scene.materials[scene.instances[block].material].clone();
            change(&mut material);
            scene.instances[block].material = scene.materials.len();
            scene.materials.push(material);
        })
    };
    let mirror = |material: &mut Material| material.scattering = Scattering::Mirror;
    let gauze = |material: &mut Material| {
        (material.alpha, material.base_colour.w) = (Alpha::Blend, 0.5);
    };
    vec![
        ("matt", of(&|_| ())),
        ("plastic", standard(Standard::default())),
        ("polished", standard(smooth)),
        ("varnished", standard(varnish)),
        ("half metal", metal(0.5)),
        ("metal by 0.9", metal(0.9)),
        ("metal", metal(1.0)),
        ("a mirror block", block(mirror)),
        ("a gauze block", block(gauze)),
    ]
}

/// Mean square difference of two bakes of different seeds over twice the square of the mean, which is the error of one;
/// and the processor time of one [s].
fn error_of_one(scene: &Scene, sharing: Sharing, pair: u64) -> [f64; 2] {
    let bakes = [0, 1].map(|half| {
        let mut settings = settings(Estimator::Mis, Layout::Shared { size: OTHER_SIZE }, OTHER_SAMPLES);
        (settings.transport.sharing, settings.transport.seed) = (sharing, 2 * pair + half);
        bake(scene, &settings)
    });
    let [a, b] = &bakes;
    let covered = (0..a.pages[0].raw.len()).filter(|&index| a.pages[0].coverage[index] > 0.99);
    let of_one = |index: usize| [a, b].map(|bake| f64::from(bake.pages[0].raw[index].y));
    let sums = covered.map(of_one).fold([0.0; 3], |[squares, light, count], [a, b]| {
        [squares + 0.5 * (a - b).powi(2), light + 0.5 * (a + b), count + 1.0]
    });
    let seconds = 0.5 * bakes.iter().map(|bake| bake.report.cpu_seconds).sum::<f64>();
    [sums[0] / sums[2] / (sums[1] / sums[2]).powi(2), seconds]
}

fn sharing(_: &mut Criterion) {
    eprintln!("\nCornell boxes, {OTHER_SIZE}², {OTHER_SAMPLES} paths per texel, one thread, pairs of seeds");
    eprintln!("box              RMSE alone   shared   seconds alone   shared   gain in efficiency, pair by pair");
    for (name, scene) in boxes() {
        let pairs: Vec<[[f64; 2]; 2]> = (0..3)
            .map(|pair| [Sharing::Alone, Sharing::Group].map(|sharing| error_of_one(&scene, sharing, pair)))
            .collect();
        let mean = |of: usize, what: usize| pairs.iter().map(|pair| pair[of][what]).sum::<f64>() / pairs.len() as f64;
        let gain = |[alone, shared]: &[[f64; 2]; 2]| format!("{:.2}", alone[0] * alone[1] / (shared[0] * shared[1]));
        let gains: Vec<String> = pairs.iter().map(gain).collect();
        let [alone, shared] = [0, 1].map(|of| [mean(of, 0).sqrt(), mean(of, 1)]);
        eprintln!(
            "{name:14}   {:10.4}   {:6.4}   {:13.2}   {:6.2}   {}",
            alone[0],
            shared[0],
            alone[1],
            shared[1],
            gains.join(" ")
        );
    }
}

criterion_group!(benches, receiver_samples, efficiency, sharing);
criterion_main!(benches);
