//! The statistical checks must accept what is right and reject each planted fault.

use super::super::testing::{
    ChiSquared, Domain, Random, Rejection, assert_mean, integrate, mean_and_error, mean_within, round_trip,
};
use glam::{Vec2, Vec3};
use std::f64::consts::PI;

/// A square of side 2 around a unit disk.
const SQUARE: Domain = Domain::Plane(Vec2::NEG_ONE, Vec2::ONE);

fn sphere(u: Vec2) -> Vec3 {
    let (sin, cos) = (2.0 * std::f32::consts::PI * u.x).sin_cos();
    let z = 2.0 * u.y - 1.0;
    let r = (1.0 - z * z).sqrt();
    Vec3::new(r * cos, r * sin, z)
}

fn hemisphere(u: Vec2) -> Vec3 {
    let w = sphere(u);
    if w.z > 0.0 { w } else { Vec3::new(w.x, w.y, (-w.z).max(1e-9)) }
}

fn uniform(area: f64) -> impl Fn(Vec3) -> f64 {
    move |_| 1.0 / area
}

#[test]
fn accepts_the_uniform_sphere() {
    assert!(ChiSquared::over(Domain::Sphere).run(sphere, uniform(4.0 * PI)).is_ok());
    let above = |w: Vec3| if w.z > 0.0 { 0.5 / PI } else { 0.0 };
    assert!(ChiSquared::over(Domain::Sphere).run(hemisphere, above).is_ok());
}

#[test]
fn a_right_sampler_is_rejected_as_rarely_as_promised() {
    // 100 seeds: of p-values no smaller than uniform ones at most 10 ± 3 lie below 0.1, and about one below 0.01.
    let p = |seed| {
        let test = ChiSquared { seed, samples: 20_000, cells: [11, 7], ..ChiSquared::over(Domain::Sphere) };
        test.run(sphere, uniform(4.0 * PI)).expect("nothing is wrong with it")
    };
    let p: Vec<f64> = (0..100).map(p).collect();
    let below = |limit: f64| p.iter().filter(|p| **p < limit).count();
    assert!(below(0.1) <= 20 && below(0.01) <= 4, "{p:?}");
    // And it is no rubber stamp: p-values spread.
    assert!(below(0.1) >= 1 && below(0.5) >= 20, "{p:?}");
}

#[test]
fn rejects_a_density_five_per_cent_too_high() {
    let found = ChiSquared::over(Domain::Sphere).run(sphere, |_| 1.05 / (4.0 * PI));
    assert!(matches!(found, Err(Rejection::Total(total)) if (total - 1.05).abs() < 1e-6), "{found:?}");
}

#[test]
fn rejects_a_missing_cosine() {
    // Directions uniform over the hemisphere, said to be distributed by the cosine.
    let cosine = |w: Vec3| f64::from(w.z.max(0.0)) / PI;
    let found = ChiSquared::over(Domain::Sphere).run(hemisphere, cosine);
    assert!(matches!(found, Err(Rejection::Counts(_))), "{found:?}");
    // And the other way round.
    let lifted = |u: Vec2| {
        let (r, (sin, cos)) = (u.x.sqrt(), (2.0 * std::f32::consts::PI * u.y).sin_cos());
        Vec3::new(r * cos, r * sin, (1.0 - u.x).sqrt())
    };
    assert!(ChiSquared::over(Domain::Sphere).run(lifted, cosine).is_ok());
    let above = |w: Vec3| if w.z > 0.0 { 0.5 / PI } else { 0.0 };
    assert!(matches!(ChiSquared::over(Domain::Sphere).run(lifted, above), Err(Rejection::Counts(_))));
}

#[test]
fn rejects_a_hemisphere_for_a_sphere_and_a_sphere_for_a_hemisphere() {
    let found = ChiSquared::over(Domain::Sphere).run(hemisphere, uniform(4.0 * PI));
    assert!(matches!(found, Err(Rejection::Counts(_))), "{found:?}");
    let above = |w: Vec3| if w.z > 0.0 { 0.5 / PI } else { 0.0 };
    let found = ChiSquared::over(Domain::Sphere).run(sphere, above);
    assert!(matches!(found, Err(Rejection::ZeroDensity(w)) if w.z <= 0.0), "{found:?}");
}

#[test]
fn rejects_a_sampler_that_misses_a_corner() {
    // Two per cent of each side, 0.04 % of the area: less than one cell.
    let misses = |u: Vec2| (if u.cmpgt(Vec2::splat(0.98)).all() { 0.5 * u } else { u }).extend(0.0);
    let unit = ChiSquared::over(Domain::Plane(Vec2::ZERO, Vec2::ONE));
    assert!(unit.run(|u| u.extend(0.0), uniform(1.0)).is_ok());
    let found = unit.run(misses, uniform(1.0));
    assert!(matches!(found, Err(Rejection::Counts(_))), "{found:?}");
}

#[test]
fn rejects_a_slight_tilt_and_a_doubled_stratum() {
    let unit = ChiSquared::over(Domain::Plane(Vec2::ZERO, Vec2::ONE));
    let tilted = |u: Vec2| Vec3::new(u.x.powf(1.05), u.y, 0.0);
    assert!(matches!(unit.run(tilted, uniform(1.0)), Err(Rejection::Counts(_))));
    let coarse = |u: Vec2| Vec3::new((u.x * 64.0).floor() / 64.0, u.y, 0.0);
    assert!(matches!(unit.run(coarse, uniform(1.0)), Err(Rejection::Counts(_))));
}

#[test]
fn rejects_what_is_no_number_or_no_point_of_the_domain() {
    let square = ChiSquared::over(SQUARE);
    let nan = square.run(|_| Vec3::NAN, uniform(4.0));
    assert!(matches!(nan, Err(Rejection::Sample(..))), "{nan:?}");
    let outside = square.run(|u| (3.0 * u).extend(0.0), uniform(4.0));
    assert!(matches!(outside, Err(Rejection::Sample(..))), "{outside:?}");
    let infinite = square.run(|u| (2.0 * u - Vec2::ONE).extend(0.0), |_| f64::INFINITY);
    assert!(matches!(infinite, Err(Rejection::Sample(..))), "{infinite:?}");
}

#[test]
fn rejects_a_test_that_decides_nothing() {
    let few = ChiSquared { samples: 30, ..ChiSquared::over(Domain::Plane(Vec2::ZERO, Vec2::ONE)) };
    let found = few.run(|u| u.extend(0.0), uniform(1.0));
    assert!(matches!(found, Err(Rejection::Vacuous(_))), "{found:?}");
}

#[test]
fn round_trips_find_an_inverse_that_is_none() {
    let map = |u: Vec2| u.extend(0.0);
    assert_eq!(round_trip(map, |p| p.truncate(), 0.0), Ok(()));
    assert!(round_trip(map, |p| p.truncate() + Vec2::new(1e-3, 0.0), 1e-4).is_err());
    assert!(round_trip(map, |p| Vec2::new(p.y, p.x), 1e-4).is_err());
    assert!(round_trip(map, |_| Vec2::NAN, 1e-4).is_err());
    // Wrong in one corner only.
    assert!(round_trip(map, |p| p.truncate().min(Vec2::splat(0.97)), 1e-4).is_err());
}

#[test]
fn quadrature_of_smooth_and_of_cut_off_functions() {
    let whole = integrate(&|s: [f64; 2]| (s[0] * 3.0).exp() * s[1] * s[1], [0.0; 2], [1.0; 2], 1e-9);
    assert!((whole - (3.0_f64.exp() - 1.0) / 9.0).abs() < 1e-8, "{whole}");
    let disk = |s: [f64; 2]| f64::from(u8::from(s[0] * s[0] + s[1] * s[1] < 1.0));
    let cells = (0..256).map(|i| [f64::from(i % 16) / 16.0, f64::from(i / 16) / 16.0]);
    let area: f64 = cells.map(|low| integrate(&disk, low, [1.0 / 16.0; 2], 1e-7)).sum();
    assert!((area - PI / 4.0).abs() < 1e-4, "{area}");
}

#[test]
fn a_mean_passes_only_if_it_is_right_and_known_well_enough() {
    assert!(mean_within(1.0, 0.001, 1.001, 0.01).is_ok());
    // Off, too noisy to tell, and no number at all.
    assert!(mean_within(1.0, 0.001, 1.02, 0.01).is_err());
    assert!(mean_within(1.0, 0.01, 1.0, 0.01).is_err());
    for (mean, error, truth) in
        [(f64::NAN, 0.0, 1.0), (1.0, f64::NAN, 1.0), (1.0, f64::INFINITY, 1.0), (1.0, -1.0, 1.0)]
    {
        assert!(mean_within(mean, error, truth, 0.01).is_err());
    }
}

#[test]
fn a_mean_of_few_values_proves_nothing() {
    let (mean, error) = mean_and_error(&[1.0; 15]);
    assert_eq!((mean, error), (1.0, f64::INFINITY));
    assert_mean(&[1.0; 16], 1.0, 0.0);
    let mut random = Random::new(3);
    let values: Vec<f64> = (0..100_000).map(|_| f64::from(random.unit())).collect();
    assert_mean(&values, 0.5, 0.006);
    assert!(std::panic::catch_unwind(|| assert_mean(&values, 0.51, 0.006)).is_err());
    assert!(std::panic::catch_unwind(|| assert_mean(&values[..100], 0.5, 0.006)).is_err());
}

#[test]
fn the_pseudo_random_numbers_are_the_published_ones() {
    let mut random = Random::new(1_234_567);
    assert_eq!([random.bits(), random.bits()], [6_457_827_717_110_365_317, 3_203_168_211_198_807_973]);
    assert!((0..10_000).map(|_| random.unit()).all(|u| (0.0..1.0).contains(&u)));
    let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
    for _ in 0..10_000 {
        let w = random.direction();
        (sum, squares) = (sum + w / 10_000.0, squares + w * w / 10_000.0);
    }
    assert!(sum.abs().max_element() < 0.03 && (squares - Vec3::splat(1.0 / 3.0)).abs().max_element() < 0.02);
}
