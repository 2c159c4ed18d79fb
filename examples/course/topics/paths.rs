//! How directions are chosen, how paths end, and what a wrong choice looks like. By the teacher, beside the product.

use crate::Desk;
use crate::film::{Shot, mean_luminance, rms_error, row};
use crate::scenes;
use crate::teacher::{Directions, Ending, Patch, Random, Teacher, integral_sample, moments};
use bevy_kiln::bake::Picture;
use bevy_kiln::math::Welford;
use bevy_kiln::scene::{Camera, Scene};
use bevy_kiln::trace::Tracer;
use glam::Vec3;
use std::f64::consts::PI;

const DIRECTIONS: [Directions; 3] = [Directions::UniformSphere, Directions::UniformHemisphere, Directions::Cosine];

/// Three ways to choose directions, at equal samples.
pub fn sampling(desk: &Desk) {
    for (name, radiance) in SKIES {
        let row: Vec<String> = DIRECTIONS.iter().map(|&directions| spread(directions, radiance)).collect();
        desk.say(&format!("{name}: {}", row.join(", ")));
    }
    let scene = scenes::balls_under_a_sky();
    let tracer = Tracer::new(&scene);
    let patch_at = |_| Patch { albedo: Vec3::splat(0.5), radiance: Vec3::ZERO };
    let camera = scenes::above();
    let picture = |directions, samples, seed| {
        let teacher = Teacher { tracer: &tracer, patch_at: &patch_at, sky: 1.0, directions, ending: Ending::Cap(50) };
        teacher.picture(&camera, 96, samples, seed)
    };
    let reference = picture(Directions::Cosine, 512, 9);
    let pictures = DIRECTIONS.map(|directions| {
        let picture = picture(directions, 16, 1);
        desk.say(&format!("16 paths, {directions:?}: rms error {:.1} %", 100.0 * rms_error(&picture, &reference)));
        picture
    });
    desk.keep("sampling", &row(&pictures), 0.8);
}

/// Radiance by direction in the frame of a floor that faces +Z.
type Sky = fn(Vec3) -> f64;

const SKIES: [(&str, Sky); 3] = [
    ("the same everywhere", |_| 1.0),
    ("brighter upwards, L = cos θ", |w| f64::from(w.z.max(0.0))),
    ("a lamp, 30° around the zenith", |w| if w.z > 0.866_025_4 { 1.0 } else { 0.0 }),
];

/// Irradiance of a floor by 100 000 directions, and the standard deviation of one.
fn spread(directions: Directions, radiance: Sky) -> String {
    let mut random = Random::new(directions as u64);
    let values = (0..100_000).map(|_| {
        let (wi, share) = directions.sample(&mut random);
        PI * f64::from(share) * radiance(wi)
    });
    let moments: Welford = values.collect();
    format!("{directions:?} E {:.3} σ {:.3}", moments.mean(), moments.variance().sqrt())
}

/// Paths that end by chance, with and without the weight, against a cap.
pub fn roulette(desk: &Desk) {
    for ending in [Ending::Cap(0), Ending::Roulette, Ending::RouletteWithoutWeight] {
        let values = moments(200_000, 4, |random| integral_sample(ending, 0.6, random));
        let (mean, error) = (values.mean(), values.standard_error());
        desk.say(&format!("the integral, {ending:?}: {mean:.3} ± {error:.4}"));
    }
    let (scene, camera) = (scenes::cornell(), scenes::cornell_camera());
    let tracer = Tracer::new(&scene);
    let endings = [Ending::Roulette, Ending::RouletteWithoutWeight, Ending::Cap(50)];
    let mut pictures = endings
        .map(|ending| {
            let teacher = Teacher {
                tracer: &tracer,
                patch_at: &scenes::cornell_patch,
                sky: 0.0,
                directions: Directions::Cosine,
                ending,
            };
            teacher.picture(&camera, 96, 384, 5)
        })
        .to_vec();
    pictures.push(Shot { scene: &scene, camera: &camera, size: [96; 2], samples: 64 }.take());
    for (name, picture) in ["with 1/p", "without", "cap of 50", "the product"].into_iter().zip(&pictures) {
        desk.say(&format!("{name}: mean luminance {:.4} cd/m²", mean_luminance(picture)));
    }
    desk.keep("roulette", &row(&pictures), 0.7);
}

/// A furnace in which nothing can be seen unless something is wrong.
pub fn furnace(desk: &Desk) {
    let sky = 0.5;
    let scene = scenes::balls_in_a_furnace(sky);
    let camera = Camera::look_at("furnace", Vec3::Z * 9.0, Vec3::ZERO, 0.6);
    let mut pictures = vec![Shot { scene: &scene, camera: &camera, size: [96; 2], samples: 128 }.take()];
    for directions in [Directions::Cosine, Directions::CosineTwice, Directions::WrongDensity] {
        pictures.push(by_teacher(&scene, &camera, directions, sky));
    }
    for (name, picture) in ["the product", "the teacher", "too dim", "too bright"].into_iter().zip(&pictures) {
        let errors = picture.radiance.iter().map(|radiance| f64::from(radiance.y - sky).abs());
        let worst = errors.fold(0.0, f64::max);
        desk.say(&format!("{name}: mean {:.4}, worst pixel off by {worst:.4} of {sky}", mean_luminance(picture)));
    }
    desk.keep("furnace", &row(&pictures), 1.0);
    let tracer = Tracer::new(&scenes::furnace(0.5, 1.0));
    let patch_at = |_| Patch { albedo: Vec3::splat(0.5), radiance: Vec3::ONE };
    for directions in [Directions::Cosine, Directions::CosineTwice, Directions::WrongDensity] {
        let teacher = Teacher { tracer: &tracer, patch_at: &patch_at, sky: 0.0, directions, ending: Ending::Cap(50) };
        let radiance = teacher.inside(Vec3::ZERO, 100_000, 3);
        let (mean, error) = (radiance.mean(), radiance.standard_error());
        desk.say(&format!("in a closed cube of albedo 0.5, {directions:?}: L = {mean:.3} ± {error:.3}"));
    }
}

fn by_teacher(scene: &Scene, camera: &Camera, directions: Directions, sky: f32) -> Picture {
    let patch_at = scenes::furnace_ball_patch(sky);
    let tracer = Tracer::new(scene);
    let teacher = Teacher { tracer: &tracer, patch_at: &patch_at, sky, directions, ending: Ending::Cap(50) };
    teacher.picture(camera, 96, 128, 7)
}
