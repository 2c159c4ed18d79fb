//! The light on a grey sphere at random places of a room, by the volume as Bevy shows it and by the light meter.

use crate::common::glb;
use crate::common::scenes::SceneBuilder;
use crate::common::volume::{Bound, look_up};
use crate::{along_axes, bake, denoise_scenes};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{
    CancelToken, Goal, LaterBounces, MeterPoint, MeterSettings, VolumeBox, VolumeBoxes, VolumeSettings,
    measure_irradiance,
};
use bevy_kiln::math::{AmbientCube, FACES, luminance, square_to_uniform_sphere};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::{Tracer, Transport};
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::PI;

/// Normals over a sphere, and places.
const NORMALS: u32 = 32;
const PLACES: usize = 200;

/// A place is at least this far from any surface [m]: a sphere of half a metre touches nothing.
const CLEARANCE: f32 = 0.25;

fn normals() -> impl Iterator<Item = Vec3> {
    (0..NORMALS).map(|number| {
        let along = (number as f32 + 0.5) / NORMALS as f32;
        square_to_uniform_sphere(Vec2::new((number as f32 * 0.618_034).fract(), along))
    })
}

/// Numbers of a fixed seed in [0, 1).
fn random(seed: u64) -> impl Iterator<Item = f32> {
    let mut state = seed;
    std::iter::repeat_with(move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1_u64 << 24) as f32
    })
}

/// Places in the air.
fn air(scene: &Scene, low: Vec3, high: Vec3) -> Vec<Vec3> {
    let tracer = Tracer::new(scene);
    let is_clear = |place: &Vec3| {
        let around = (0..200).map(|number| {
            square_to_uniform_sphere(Vec2::new((number as f32 * 0.618_034).fract(), (number as f32 + 0.5) / 200.0))
        });
        around.into_iter().all(|direction| {
            tracer
                .closest_hit(*place, direction)
                .is_none_or(|hit| hit.distance > CLEARANCE && hit.normal.dot(direction) < 0.0)
        })
    };
    let mut numbers = random(7);
    let mut next = move || Vec3::from_array(std::array::from_fn(|_| numbers.next().unwrap()));
    std::iter::repeat_with(|| low + (high - low) * next()).filter(is_clear).take(PLACES).collect()
}

/// E/π for all normals at all places, by the meter; without the direct light of lights that are no surfaces.
fn truth(scene: &Scene, places: &[Vec3]) -> Vec<Vec<DVec3>> {
    let points: Vec<MeterPoint> =
        places.iter().flat_map(|&position| normals().map(move |normal| MeterPoint { position, normal })).collect();
    let read = |scene: &Scene, max_bounces: Option<u32>, paths: u32| {
        let transport = Transport { seed: 99, max_bounces, ..Transport::default() };
        let settings = MeterSettings { transport, samples_per_point: paths, threads: None };
        measure_irradiance(scene, &points, &settings, &(), &CancelToken::default()).unwrap().readings
    };
    let mut light: Vec<DVec3> = read(scene, None, 1024).iter().map(|reading| reading.irradiance / PI).collect();
    if !scene.lights.is_empty() {
        let mut lights_alone = scene.clone();
        lights_alone.sky_radiance = Vec3::ZERO;
        assert!(lights_alone.materials.iter().all(|material| material.emitted_radiance == Vec3::ZERO));
        for (light, direct) in light.iter_mut().zip(read(&lights_alone, Some(0), 1024)) {
            *light -= direct.irradiance / PI;
        }
    }
    light.chunks(NORMALS as usize).map(<[DVec3]>::to_vec).collect()
}

/// How far light is from the truth: the mean over all normals, and the root of the mean square, both over the mean.
fn errors(shown: impl Iterator<Item = DVec3>, truth: &[DVec3]) -> [f64; 2] {
    let mean = truth.iter().map(|&value| luminance(value)).sum::<f64>();
    let (mut sum, mut squares) = (0.0, 0.0);
    for (shown, truth) in shown.zip(truth) {
        let off = luminance(shown - *truth);
        sum += off;
        squares += off * off;
    }
    let count = truth.len() as f64;
    [(sum / mean).abs(), (squares / count).sqrt() / (mean / count)]
}

/// The cube that comes nearest to the truth at its normals.
fn best(truth: &[DVec3]) -> AmbientCube {
    let mut moments = [DVec3::ZERO; FACES];
    for (normal, light) in normals().zip(truth) {
        for (axis, cos) in normal.to_array().into_iter().enumerate() {
            moments[2 * axis + usize::from(cos < 0.0)] += *light * f64::from(cos * cos) / truth.len() as f64;
        }
    }
    AmbientCube::fit(&moments)
}

/// How far what is shown is from the truth: errors that 95 of 100 places stay below.
#[derive(Clone, Copy, Debug)]
struct Verdict {
    /// Of the mean over all normals.
    mean: f64,
    /// Of single normals, as the root of the mean square over them.
    normals: f64,
    /// The same against the cube that comes nearest to the truth.
    beside_best: f64,
    /// Share of the places at which the mean is within 5 % and normals within 15 %.
    near: f64,
}

impl Verdict {
    /// What a volume can do: its mean is right, and it comes as near as a cube may.
    fn is_right(self, best: Self) -> bool {
        self.mean <= 0.05 && self.beside_best <= 0.15 && self.normals <= best.normals + 0.02
    }
}

fn judge(truth: &[Vec<DVec3>], shown: impl Fn(usize, Vec3) -> DVec3) -> Verdict {
    let of_place = |(place, truth): (usize, &Vec<DVec3>)| {
        let light = || normals().map(|normal| shown(place, normal));
        let cube = best(truth);
        let of_cube: Vec<DVec3> = normals().map(|normal| cube.at(normal)).collect();
        let [mean, rms] = errors(light(), truth);
        [mean, rms, errors(light(), &of_cube)[1]]
    };
    let all: Vec<[f64; 3]> = truth.iter().enumerate().map(of_place).collect();
    let percentile = |which: usize| {
        let mut values: Vec<f64> = all.iter().map(|errors| errors[which]).collect();
        values.sort_unstable_by(f64::total_cmp);
        values[values.len() * 95 / 100]
    };
    let near = all.iter().filter(|[mean, rms, _]| *mean <= 0.05 && *rms <= 0.15).count() as f64 / all.len() as f64;
    Verdict { mean: percentile(0), normals: percentile(1), beside_best: percentile(2), near }
}

fn check(name: &str, scene: &Scene, low: Vec3, high: Vec3, boxes: VolumeBoxes) {
    let settings = VolumeSettings { boxes, ..VolumeSettings::default() };
    let bake = bake(scene, &settings);
    let places = air(scene, low, high);
    let truth = truth(scene, &places);
    let bound: Vec<Bound> = bake.volumes.iter().map(Bound::new).collect();
    let shown = |place: usize, normal: Vec3| look_up(&bound, places[place], normal).as_dvec3();
    let (verdict, best) = (judge(&truth, shown), judge(&truth, |place, normal| best(&truth[place]).at(normal)));
    let percent = |value: f64| 100.0 * value;
    println!(
        "{name}: {} probes in {} volumes, {:.1} s of processor time, {} paths. 95 % of {PLACES} places: mean within {:.1} %, normals \
         within {:.1} % (the best cube {:.1} %; from it {:.1} %). Mean within 5 % and normals within 15 %: {:.1} % (the best \
         cube {:.1} %)",
        bake.report.texels,
        bake.volumes.len(),
        bake.report.cpu_seconds,
        bake.report.samples,
        percent(verdict.mean),
        percent(verdict.normals),
        percent(best.normals),
        percent(verdict.beside_best),
        percent(verdict.near),
        percent(best.near),
    );
    assert!(verdict.is_right(best), "{name}: {verdict:?}");
    // What the check must find out.
    type Shown<'a> = &'a dyn Fn(usize, Vec3) -> DVec3;
    let faults: [(&str, Shown); 4] = [
        ("6 % more", &|place, normal| 1.06 * shown(place, normal)),
        ("E instead of E/π", &|place, normal| PI * shown(place, normal)),
        ("upside down", &|place, normal| shown(place, normal * Vec3::new(1.0, -1.0, 1.0))),
        ("the next place's", &|place, normal| shown((place + 1) % PLACES, normal)),
    ];
    for (fault, shown) in faults {
        assert!(!judge(&truth, shown).is_right(best), "{name}: {fault} passes");
    }
}

/// The same with the glowing quad of the Cornell box as a light that is drawn in real time.
fn lamp_apart(mut scene: Scene) -> Scene {
    let radiance = scene.materials.iter().map(|material| material.emitted_radiance).fold(Vec3::ZERO, Vec3::max);
    for material in &mut scene.materials {
        material.emitted_radiance = Vec3::ZERO;
    }
    // Its corners are those of the file: 2.13 to 3.43 m and 2.27 to 3.32 m, at 5.488 m.
    let middle = Vec3::new(2.78, 5.487, 2.795);
    let lamp = SceneBuilder::default().rect_light("lamp", middle, Vec3::NEG_Y, Vec2::new(1.3, 1.05), radiance).build();
    scene.lights = lamp.lights;
    scene.indirect_only.insert(StableId::new("lamp"));
    scene
}

fn one(low: Vec3, high: Vec3, spacing: f32) -> VolumeBoxes {
    VolumeBoxes::Given(vec![VolumeBox { id: StableId::new("volume"), ..along_axes(low, high, spacing) }])
}

#[test]
fn in_the_cornell_box() {
    let scene = lamp_apart(glb::load("cornell"));
    let (low, high) = (Vec3::ZERO, Vec3::new(5.5, 5.48, 5.59));
    check("Cornell box", &scene, low, high, one(low, high, 0.4));
}

#[test]
fn in_a_room_in_the_sun() {
    let scene = denoise_scenes::sunlit().scene;
    let (low, high) = (Vec3::ZERO, Vec3::new(3.5, 2.375, 3.0));
    check("room in the sun", &scene, low, high, VolumeBoxes::default());
}

/// Paths that end at a coarse lightmap bring what whole ones bring: over all probes the means differ by no more than 2 %,
/// noise included.
#[test]
fn paths_that_end_early_bring_the_same() {
    for (name, scene) in [("sun", denoise_scenes::sunlit().scene), ("Cornell", glb::load("cornell"))] {
        let mean = |later_bounces: LaterBounces| {
            let of_seed = |seed: u64| {
                let transport = Transport { seed, ..Transport::default() };
                let boxes = one(Vec3::splat(0.2), Vec3::new(3.3, 2.2, 2.8), 0.6);
                let goal = Goal::Samples(2048);
                let settings = VolumeSettings { transport, goal, boxes, later_bounces, ..VolumeSettings::default() };
                let cubes = bake(&scene, &settings).volumes.remove(0).cubes;
                let sum: Vec3 = cubes.iter().flatten().sum();
                luminance(sum.as_dvec3()) / (6 * cubes.len()) as f64
            };
            let all: Vec<f64> = (0..8).map(of_seed).collect();
            let mean = all.iter().sum::<f64>() / 8.0;
            let squares: f64 = all.iter().map(|value| (value - mean).powi(2)).sum();
            [mean, (squares / (8.0 * 7.0)).sqrt()]
        };
        let [whole, early] = [LaterBounces::Traced, LaterBounces::Reused].map(mean);
        let (off, noise) = (early[0] / whole[0] - 1.0, whole[1].hypot(early[1]) / whole[0]);
        println!("{name}: ending early {:+.2} ± {:.2} %", 100.0 * off, 100.0 * noise);
        assert!(off.abs() + 4.0 * noise <= 0.02, "{name}: {off} ± {noise}");
    }
}
