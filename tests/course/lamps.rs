//! The two forms of the rendering equation, direct sampling, the sky's picture.

use crate::common::meter::{at, by, read};
use crate::common::statistics::mean_within;
use crate::film::slope;
use crate::scenes::{cornell, glowing, grey, sky_with_sun};
use crate::stage::Stage;
use crate::teacher::{Random, moments};
use bevy_kiln::bake::{MeterPoint, MeterReading};
use bevy_kiln::math::{Welford, polygon_irradiance, square_to_uniform_hemisphere};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::{Estimator, Tracer, Transport};
use glam::{DVec3, Vec3, Vec3Swizzles};
use std::f64::consts::{PI, TAU};

const HEIGHT: f32 = 2.2;
const LOW: Vec3 = Vec3::new(-1.6, HEIGHT, -1.0);
const SIDE: f32 = 1.6;

/// Half as high as the lamp, so that its shadow on the lamp is twice as wide.
const SHADE_LOW: Vec3 = Vec3::new(-0.6, 0.5 * HEIGHT, -0.3);
const SHADE_SIDE: f32 = 0.3;

/// A square lamp of radiance 1 over the origin, with a black square half way up.
fn shaded_lamp() -> Scene {
    Stage::default()
        .quad("lamp", LOW, [Vec3::X * SIDE, Vec3::Z * SIDE], glowing(0.0, 1.0))
        .quad("shade", SHADE_LOW, [Vec3::X * SHADE_SIDE, Vec3::Z * SHADE_SIDE], grey(0.0))
        .build()
}

/// The irradiance at the origin from a square overhead of radiance 1, by its corner and side.
fn square(low: Vec3, side: f32) -> f64 {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Z, Vec3::Z];
    let corners: Vec<DVec3> = corners.iter().map(|&corner| (low + corner * side).as_dvec3()).collect();
    polygon_irradiance(&corners, DVec3::Y)
}

/// The irradiance at the origin by Lambert's formula: the lamp's less that of the shade's shadow on it.
fn closed_form() -> f64 {
    square(LOW, SIDE) - square(SHADE_LOW * 2.0, SHADE_SIDE * 2.0)
}

/// Over directions: L cos θ, by uniform directions.
fn angular_form(tracer: &Tracer, random: &mut Random) -> f64 {
    let wi = square_to_uniform_hemisphere(random.square()).xzy();
    let is_lamp = tracer.closest_hit(Vec3::ZERO, wi).is_some_and(|hit| (hit.distance * wi.y - HEIGHT).abs() < 1e-3);
    if is_lamp { TAU * f64::from(wi.y) } else { 0.0 }
}

/// Over the lamp's area: L cos θ cos θ′ V / r², by uniform points. The lamp faces down, as the receiver faces up, so
/// that both cosines are one.
fn area_form(tracer: &Tracer, random: &mut Random, cosine_at_lamp: fn(f64) -> f64) -> f64 {
    let u = random.square();
    let point = LOW + Vec3::new(u.x, 0.0, u.y) * SIDE;
    let squared = f64::from(point.length_squared());
    let cosine = f64::from(HEIGHT) / squared.sqrt();
    let sees = tracer.is_visible(Vec3::ZERO, point * 0.9999);
    if sees { f64::from(SIDE * SIDE) * cosine * cosine_at_lamp(cosine) / squared } else { 0.0 }
}

#[test]
fn both_forms_of_the_rendering_equation_are_one() {
    let scene = shaded_lamp();
    let tracer = Tracer::new(&scene);
    let (truth, tolerance) = (closed_form(), 0.04 * closed_form());
    let judge = |values: &Welford| mean_within(values.mean(), values.standard_error(), truth, tolerance);
    judge(&moments(400_000, 1, |random| angular_form(&tracer, random))).unwrap();
    judge(&moments(20_000, 2, |random| area_form(&tracer, random, |cosine| cosine))).unwrap();
    judge(&moments(20_000, 3, |random| area_form(&tracer, random, |_| 1.0))).expect_err("a cosine was forgotten");
    for (estimator, samples) in [(Estimator::Bsdf, 1 << 16), (Estimator::Light, 1 << 12), (Estimator::Mis, 1 << 12)] {
        let reading = read(&scene, &[at(Vec3::ZERO, Vec3::Y)], samples, by(estimator))[0];
        mean_within(reading.irradiance.y, reading.stderr.y, truth, tolerance)
            .unwrap_or_else(|reason| panic!("{estimator:?}: {reason}"));
    }
}

#[test]
fn aiming_at_the_lamp_beats_waiting_for_it() {
    let point = [at(Vec3::new(1.0, 3.0, 5.592), Vec3::NEG_Z)];
    let [naive, direct] = [Estimator::Bsdf, Estimator::Light].map(|estimator| {
        let transport = Transport { max_bounces: Some(0), ..by(estimator) };
        read(&cornell(), &point, 1 << 14, transport)[0]
    });
    let apart = (naive.irradiance.y - direct.irradiance.y).abs();
    assert!(apart < 4.0 * naive.stderr.y.hypot(direct.stderr.y), "{naive:?} {direct:?}");
    assert!(direct.irradiance.y > 0.1 && direct.stderr.y * 10.0 < naive.stderr.y, "{naive:?} {direct:?}");
}

#[test]
fn a_small_sun_is_found_by_its_brightness() {
    let mut scene =
        Stage::default().quad("floor", Vec3::NEG_ONE.with_y(0.0), [Vec3::Z * 2.0, Vec3::X * 2.0], grey(0.0)).build();
    let sky = sky_with_sun();
    let sine_squared = |row: u32| (PI * f64::from(row) / f64::from(sky.height)).sin().powi(2);
    let truth: f64 = (0..sky.height / 2)
        .flat_map(|row| (0..sky.width).map(move |column| (row, column)))
        .map(|(row, column)| {
            let radiance = f64::from(sky.radiance[(row * sky.width + column) as usize].y);
            radiance * 0.5 * (sine_squared(row + 1) - sine_squared(row)) * TAU / f64::from(sky.width)
        })
        .sum();
    scene.environment = Some(sky);
    let point = [at(Vec3::ZERO, Vec3::Y)];
    let [mis, bsdf] = [Estimator::Mis, Estimator::Bsdf].map(|by_this| read(&scene, &point, 1 << 12, by(by_this))[0]);
    mean_within(mis.irradiance.y, mis.stderr.y, truth, 0.01 * truth).unwrap();
    assert!(mis.stderr.y * 20.0 < bsdf.stderr.y, "{mis:?} {bsdf:?}");
}

#[test]
fn error_falls_with_the_root_of_the_samples() {
    let scene = Stage::default().quad("lamp", LOW, [Vec3::X * SIDE, Vec3::Z * SIDE], glowing(0.0, 1.0)).build();
    let places: Vec<Vec3> = (0..64).map(|index| Vec3::new((index % 8) as f32, 0.0, (index / 8) as f32) * 0.3).collect();
    let points: Vec<MeterPoint> = places.iter().map(|&place| at(place, Vec3::Y)).collect();
    let errors = [16, 64, 256, 1024].map(|samples| {
        // Over directions, where neighbouring samples tell each other least.
        let transport = Transport { seed: u64::from(samples), estimator: Estimator::Bsdf, ..Transport::default() };
        let readings = read(&scene, &points, samples, transport);
        let off = |(reading, place): (&MeterReading, &Vec3)| reading.irradiance.y - square(LOW - *place, SIDE);
        let squares = readings.iter().zip(&places).map(|pair| off(pair).powi(2));
        (f64::from(samples), squares.sum::<f64>().sqrt())
    });
    let falls = |slope: f64| (-0.9..-0.4).contains(&slope);
    assert!(falls(slope(&errors)), "{} {errors:?}", slope(&errors));
    let biased = errors.map(|(samples, error)| (samples, error.hypot(0.5 * errors[0].1)));
    assert!(!falls(slope(&biased)), "an error that stays went unseen");
}
