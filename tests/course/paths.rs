//! Directions, roulette, furnaces, and the second opinion on the Cornell box.

use crate::common::meter::{at, mean, on_walls, read};
use crate::common::statistics::mean_within;
use crate::scenes::{cornell, cornell_patch, furnace};
use crate::teacher::{Directions, Ending, Patch, Teacher, integral_sample, moments};
use bevy_kiln::bake::{MeterPoint, MeterReading};
use bevy_kiln::math::{Frame, Welford};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::{Tracer, Transport};
use glam::Vec3;
use std::f64::consts::PI;

/// Radiance by the cosine to the zenith.
type Sky = fn(f32) -> f32;

/// Variance of one sample of the irradiance, over π²; from ∫ cosⁿ over the sphere, the hemisphere, and by the cosine.
#[test]
fn what_three_ways_to_choose_directions_cost() {
    let uniform_sky = [5.0 / 3.0, 1.0 / 3.0, 0.0];
    let cosine_sky = [1.6 - 4.0 / 9.0, 0.8 - 4.0 / 9.0, 0.5 - 4.0 / 9.0];
    let skies: [(Sky, f64, [f64; 3]); 2] =
        [(|_| 1.0, PI, uniform_sky), (|cosine| cosine.max(0.0), 2.0 * PI / 3.0, cosine_sky)];
    for (radiance, truth, variances) in skies {
        let ways = [Directions::UniformSphere, Directions::UniformHemisphere, Directions::Cosine];
        for (directions, variance) in ways.into_iter().zip(variances) {
            let values = moments(200_000, directions as u64, |random| {
                let (wi, share) = directions.sample(random);
                PI * f64::from(share * radiance(wi.z))
            });
            mean_within(values.mean(), values.standard_error(), truth, 0.02 * truth).unwrap();
            let found = values.variance() / (PI * PI);
            assert!((found - variance).abs() <= 0.03 * variance + 1e-9, "{directions:?}: {found} for {variance}");
        }
    }
}

/// ∫₀² 3 sin x dx = 3 (1 − cos 2), as the course works it: plain, by roulette, and by roulette without its weight.
#[test]
fn roulette_on_an_integral() {
    let survival = 0.6_f64;
    let truth = 3.0 * (1.0 - 2.0_f64.cos());
    let count = 200_000;
    let endings = [Ending::Cap(0), Ending::Roulette, Ending::RouletteWithoutWeight];
    let [plain, weighted, unweighted] =
        endings.map(|ending| moments(count, 4, |random| integral_sample(ending, survival, random)));
    // E[X²] of one plain value; roulette divides it by p, its weight left out multiplies it by p.
    let square = 18.0 * (1.0 - 4.0_f64.sin() / 4.0);
    let expected = [
        (&plain, truth, square - truth.powi(2)),
        (&weighted, truth, square / survival - truth.powi(2)),
        (&unweighted, survival * truth, survival * square - (survival * truth).powi(2)),
    ];
    for (values, mean, variance) in expected {
        mean_within(values.mean(), values.standard_error(), mean, 0.02 * truth).unwrap();
        let standard_error = (variance / count as f64).sqrt();
        assert!((values.standard_error() / standard_error - 1.0).abs() < 0.01, "{values:?} for {standard_error}");
    }
    assert!((truth - 4.248).abs() < 1e-3 && weighted.variance() > plain.variance());
    let judge = mean_within(unweighted.mean(), unweighted.standard_error(), truth, 0.02 * truth);
    judge.expect_err("roulette without its weight is biased");
}

/// Radiance in a closed cube of this albedo that glows with 1, by the teacher.
fn in_furnace(albedo: f32, directions: Directions, ending: Ending) -> Welford {
    let tracer = Tracer::new(&furnace(albedo, 1.0));
    let patch_at = |_| Patch { albedo: Vec3::splat(albedo), radiance: Vec3::ONE };
    Teacher { tracer: &tracer, patch_at: &patch_at, sky: 0.0, directions, ending }.inside(Vec3::ZERO, 60_000, 11)
}

#[test]
fn roulette_in_a_furnace() {
    let albedo = 0.6_f64;
    // A path that goes on by chance p = ρ without its weight reflects ρ² each time.
    let cases = [
        (Ending::Roulette, 1.0 / (1.0 - albedo)),
        (Ending::RouletteWithoutWeight, 1.0 / (1.0 - albedo * albedo)),
        (Ending::Cap(50), (1.0 - albedo.powi(51)) / (1.0 - albedo)),
        (Ending::Cap(2), 1.0 + albedo + albedo * albedo),
    ];
    for (ending, truth) in cases {
        let values = in_furnace(albedo as f32, Directions::Cosine, ending);
        mean_within(values.mean(), values.standard_error(), truth, 0.03 * truth)
            .unwrap_or_else(|reason| panic!("{ending:?}: {reason}"));
    }
}

/// What a furnace test says.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict {
    Right,
    TooDim,
    TooBright,
    /// Too noisy to tell 5 % apart.
    Unclear,
}

fn verdict(mean: f64, standard_error: f64, truth: f64) -> Verdict {
    let margin = 4.0 * standard_error;
    match (mean - truth) / truth {
        _ if margin.is_nan() || margin > 0.05 * truth => Verdict::Unclear,
        off if off.abs() * truth <= margin => Verdict::Right,
        off if off < 0.0 => Verdict::TooDim,
        _ => Verdict::TooBright,
    }
}

#[test]
fn the_furnace_tells_what_is_wrong() {
    let albedo = 0.5;
    let readings = read(&furnace(albedo, 1.0), &on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), 1 << 12, Transport::default());
    let (irradiance, error) = mean(&readings, 1);
    assert_eq!(verdict(irradiance / PI, error / PI, 2.0), Verdict::Right);
    // The faults reflect 2/3 and 4/3 of what they should: L = 1/(1 − ρ·2/3) and 1/(1 − ρ·4/3).
    let cases = [
        (Directions::UniformSphere, Verdict::Right, 2.0),
        (Directions::UniformHemisphere, Verdict::Right, 2.0),
        (Directions::Cosine, Verdict::Right, 2.0),
        (Directions::CosineTwice, Verdict::TooDim, 1.5),
        (Directions::WrongDensity, Verdict::TooBright, 3.0),
    ];
    for (directions, expected, radiance) in cases {
        // Not by roulette, under which two of these have no finite variance.
        let values = in_furnace(albedo, directions, Ending::Cap(50));
        assert_eq!(verdict(values.mean(), values.standard_error(), 2.0), expected, "{directions:?} {values:?}");
        mean_within(values.mean(), values.standard_error(), radiance, 0.1 * radiance)
            .unwrap_or_else(|reason| panic!("{directions:?}: {reason}"));
    }
    assert_eq!(verdict(1.0, 1.0, 2.0), Verdict::Unclear);
}

/// Points on three walls of the Cornell box.
fn cornell_points() -> [MeterPoint; 3] {
    [
        at(Vec3::new(0.0, 2.0, 2.0), Vec3::X),
        at(Vec3::new(1.0, 3.0, 5.592), Vec3::NEG_Z),
        at(Vec3::new(2.0, 5.488, 4.5), Vec3::NEG_Y),
    ]
}

/// Mean green irradiance over points, and its standard error, by the teacher.
fn second_opinion(scene: &Scene, points: &[MeterPoint], ending: Ending) -> (f64, f64) {
    let tracer = Tracer::new(scene);
    let directions = Directions::Cosine;
    let teacher = Teacher { tracer: &tracer, patch_at: &cornell_patch, sky: 0.0, directions, ending };
    let count = points.len() as f64;
    let (mut sum, mut squares) = (0.0, 0.0);
    for (index, MeterPoint { position, normal }) in points.iter().enumerate() {
        let frame = Frame::new(*normal);
        let values = moments(120_000, index as u64, |random| {
            let (wi, share) = directions.sample(random);
            let origin = *position + *normal * 1e-4;
            PI * f64::from(share * teacher.radiance(origin, frame.world_from_local(wi), random).y)
        });
        sum += values.mean();
        squares += values.standard_error().powi(2);
    }
    (sum / count, squares.sqrt() / count)
}

#[test]
fn the_teacher_agrees_with_the_product_on_the_cornell_box() {
    let (scene, points) = (cornell(), cornell_points());
    let readings: Vec<MeterReading> = read(&scene, &points, 1 << 13, Transport::default());
    let (truth, truth_error) = mean(&readings, 1);
    let judge = |(mean, error): (f64, f64)| mean_within(mean, error.hypot(truth_error), truth, 0.08 * truth);
    judge(second_opinion(&scene, &points, Ending::Roulette)).unwrap();
    judge(second_opinion(&scene, &points, Ending::RouletteWithoutWeight)).expect_err("a planted loss went unseen");
}
