//! The light on a grey sphere at random places of a room, by the volume as Bevy shows it and by the light meter; beside
//! the best that an ambient cube can do there.

use crate::common::volume::{Bound, look_up};
use bevy_kiln::bake::{CancelToken, MeterPoint, MeterSettings, VolumeSettings, bake_volumes, measure_irradiance};
use bevy_kiln::math::{AmbientCube, FACES, luminance, square_to_uniform_sphere};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::{Tracer, Transport};
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::PI;

/// Normals over a sphere.
const NORMALS: u32 = 32;

/// Places in a room.
pub const PLACES: usize = 200;

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

/// So many places in the air of a closed room.
pub fn air(scene: &Scene, low: Vec3, high: Vec3, count: usize) -> Vec<Vec3> {
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
    std::iter::repeat_with(|| low + (high - low) * next()).filter(is_clear).take(count).collect()
}

/// E/π for all normals at all places, by the meter; without the direct light of lights that are no surfaces.
fn truth(scene: &Scene, places: &[Vec3], paths: u32) -> Vec<Vec<DVec3>> {
    let points: Vec<MeterPoint> =
        places.iter().flat_map(|&position| normals().map(move |normal| MeterPoint { position, normal })).collect();
    let read = |scene: &Scene, max_bounces: Option<u32>| {
        let transport = Transport { seed: 99, max_bounces, ..Transport::default() };
        let settings = MeterSettings { transport, samples_per_point: paths, threads: None };
        measure_irradiance(scene, &points, &settings, &(), &CancelToken::default()).unwrap().readings
    };
    let mut light: Vec<DVec3> = read(scene, None).iter().map(|reading| reading.irradiance / PI).collect();
    if !scene.lights.is_empty() {
        let mut lights_alone = scene.clone();
        lights_alone.sky_radiance = Vec3::ZERO;
        assert!(lights_alone.materials.iter().all(|material| material.emitted_radiance == Vec3::ZERO));
        for (light, direct) in light.iter_mut().zip(read(&lights_alone, Some(0))) {
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

/// Bakes the volumes and looks at the light that they show at the places, where `paths` tell the truth for each normal.
pub fn check(name: &str, scene: &Scene, places: &[Vec3], paths: u32, settings: &VolumeSettings) {
    let bake = bake_volumes(scene, settings, &(), &CancelToken::default()).unwrap();
    let truth = truth(scene, places, paths);
    let bound: Vec<Bound> = bake.volumes.iter().map(Bound::new).collect();
    let shown = |place: usize, normal: Vec3| look_up(&bound, places[place], normal).as_dvec3();
    let (verdict, best) = (judge(&truth, shown), judge(&truth, |place, normal| best(&truth[place]).at(normal)));
    let percent = |value: f64| 100.0 * value;
    println!(
        "{name}: {} probes in {} volumes, {:.1} s of processor time, {} paths. 95 % of {} places: mean within {:.1} %, normals \
         within {:.1} % (the best cube {:.1} %; from it {:.1} %). Mean within 5 % and normals within 15 %: {:.1} % (the best \
         cube {:.1} %)",
        bake.report.texels,
        bake.volumes.len(),
        bake.report.cpu_seconds,
        bake.report.samples,
        places.len(),
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
        ("the next place's", &|place, normal| shown((place + 1) % places.len(), normal)),
    ];
    for (fault, shown) in faults {
        assert!(!judge(&truth, shown).is_right(best), "{name}: {fault} passes");
    }
}
