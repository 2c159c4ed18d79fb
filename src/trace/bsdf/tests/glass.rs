//! Rough glass: its tables against the lobe, the white furnace from both sides, and faults in what makes up for what
//! one facet loses.

use super::super::again::{Again, average_reflectance};
use super::super::dielectric::Dielectric;
use super::super::fresnel::refract_at;
use super::super::ggx::Ggx;
use super::super::glass_albedo::Lattice;
use super::furnace::{ALL_ANGLES, range, scattered, share};
use super::reciprocity::worst;
use super::subject::{GREEN, Subject, TABLES, dielectric, outgoing};
use crate::math::testing::Random;
use glam::Vec3;
use std::f32::consts::PI;

/// The errors of the tables at random places, scaled, in order: of perceptual roughness from 0.089 and up to 89°.
fn errors(inside: bool, scale: f32) -> Vec<f32> {
    let fine = Lattice::new([10_946, 6765]);
    let mut random = Random::new(41);
    let mut errors = Vec::new();
    for _ in 0..1500 {
        let [roughness, critical] = [0.089 + 0.911 * random.unit(), 0.2 + 0.7165 * random.unit()];
        let sin = (1.0 - critical * critical).sqrt();
        let eta = if inside { sin } else { sin.recip() };
        let cos = 0.0175 + 0.9825 * random.unit().powi(2);
        let truth = fine.missing(&Ggx::new(roughness).expect("rough"), eta, cos);
        errors.push((scale * TABLES.glass().at(eta, roughness).at(cos) - truth).abs());
    }
    errors.sort_by(f32::total_cmp);
    errors
}

#[test]
fn the_tables_are_as_accurate_as_stated() {
    for (inside, most, nearly) in [(false, 8e-3, 2e-3), (true, 8e-3, 3e-3)] {
        let found = errors(inside, 1.0);
        assert!(found[1499] < most && found[1485] < nearly, "{inside}: {}, {}", found[1499], found[1485]);
        let scaled = errors(inside, 0.97);
        assert!(scaled[1499] > most && scaled[1485] > nearly, "{inside}: {}, {}", scaled[1499], scaled[1485]);
    }
}

/// The averages belong to the tables as they are looked up.
#[test]
fn averages_are_those_of_the_table() {
    for roughness in [0.1, 0.333, 0.7, 0.95, 1.0] {
        for eta in [1.0 / 2.3, 1.0 / 1.37, 1.1, 1.5, 3.0] {
            let row = TABLES.glass().at(eta, roughness);
            let (mut missing, steps) = (0.0, 20_000);
            for step in 0..steps {
                let x = (f64::from(step) + 0.5) / f64::from(steps);
                missing += 4.0 * x * x * x * f64::from(row.at((x * x) as f32)) / f64::from(steps);
            }
            let found = f64::from(row.average());
            assert!((found / missing - 1.0).abs() < 0.01, "{roughness}, {eta}: {found} but {missing}");
        }
    }
}

#[test]
fn the_average_reflectance_is_near() {
    for n in [1.0_f32, 1.1, 1.33, 1.5, 2.0, 2.5] {
        let mus = (0..10_000).map(|i| (i as f32 + 0.5) / 1e4);
        let mean: f32 = mus.map(|mu| 2e-4 * mu * refract_at(mu, n).reflectance).sum();
        assert!((mean - average_reflectance(n)).abs() < 6e-3, "{n}: {mean} but {}", average_reflectance(n));
    }
}

/// Nothing is lost and nothing made, from either side, but for what the tables may be off.
#[test]
fn white_glass_loses_nothing() {
    let mut found = Vec::new();
    for n in [1.05, 1.2, 1.33, 1.5, 1.8, 2.4] {
        for (eta, off) in [(n, if n < 1.1 { 4e-3 } else { 2e-3 }), (1.0 / n, 5e-3)] {
            let (low, high) = range(|roughness| dielectric(roughness, eta, Vec3::ONE));
            found.push((eta, low, high, (1.0 - low).max(high - 1.0) < off));
        }
    }
    assert!(found.iter().all(|(.., within)| *within), "{found:#?}");
}

/// Glass whose light from more than one facet is scaled by `stays` and `crosses` instead, which get the averages from
/// the near side and the far one.
fn replaced(roughness: f32, eta: f32, split: fn([f32; 2], f32) -> [f32; 2]) -> Subject {
    let mut subject = dielectric(roughness, eta, Vec3::ONE);
    let [near, far] = [eta, 1.0 / eta].map(|eta| TABLES.glass().at(eta, roughness));
    let glass = Dielectric::new(eta, Vec3::ONE, roughness, &TABLES);
    let [stays, crosses] = split([near.average(), far.average()], eta);
    subject.evaluate = Box::new(move |wo, wi| {
        let (once, cos) = (glass.once(wo, wi), wi.z.abs());
        let side = if wi.z > 0.0 { stays * near.at(cos) } else { crosses * far.at(cos) };
        once + Vec3::splat(side * near.at(wo.z) * cos / PI)
    });
    subject
}

/// What is right again, none at all, radiance that does not follow the index, and a split that is the same from both
/// sides: energy finds the first two faults, the way back the last two.
#[test]
fn faulty_compensation_is_rejected() {
    let right = |[near, far]: [f32; 2], eta: f32| {
        let reflectance = average_reflectance(eta.max(1.0 / eta));
        let crosses = (1.0 - reflectance * reflectance) * near.min(far * eta * eta) / near;
        [(1.0 - crosses) / near, crosses / (far * eta * eta)]
    };
    let none = |_: [f32; 2], _: f32| [0.0; 2];
    let unsquared = |[near, far]: [f32; 2], eta: f32| {
        let reflectance = average_reflectance(eta.max(1.0 / eta));
        let crosses = (1.0 - reflectance * reflectance) * near.min(far * eta * eta) / near;
        [(1.0 - crosses) / near, crosses / far]
    };
    let even = |[near, far]: [f32; 2], eta: f32| [0.5 / near, 0.5 / (far * eta * eta)];
    for eta in [1.5, 1.0 / 1.5] {
        let off = |split: fn([f32; 2], f32) -> [f32; 2]| {
            let at = |degrees: f32| (share(&replaced(0.9, eta, split), outgoing(degrees)) - 1.0).abs();
            at(0.0).max(at(60.0))
        };
        let back =
            |split: fn([f32; 2], f32) -> [f32; 2]| worst(&replaced(0.9, eta, split), &replaced(0.9, 1.0 / eta, split));
        assert!(off(right) < 4e-3 && back(right) < 1e-2, "{eta}: {}, {}", off(right), back(right));
        assert!(off(none) > 0.1 && back(none) < 1e-2, "{eta}: {}, {}", off(none), back(none));
        assert!(off(unsquared) > 0.03 && back(unsquared) > 0.1, "{eta}: {}, {}", off(unsquared), back(unsquared));
        assert!(off(even) < 4e-3 && back(even) > 0.1, "{eta}: {}, {}", off(even), back(even));
    }
}

#[test]
fn the_way_back_is_the_same_by_the_index_squared() {
    for roughness in [0.4, 0.8, 1.0] {
        for eta in [1.1, 1.33, 1.0 / 1.33] {
            let [glass, turned] = [eta, 1.0 / eta].map(|eta| dielectric(roughness, eta, GREEN));
            let off = worst(&glass, &turned);
            assert!(off < 1e-2, "{}: {off}", glass.name);
        }
        // What met more than one facet by itself, beyond the tables' indices too.
        for eta in [1.05, 1.5, 2.4, 1.0 / 2.4, 4.0] {
            let [glass, turned] = [eta, 1.0 / eta].map(|eta| {
                let again = Again::new(eta, GREEN, roughness, &TABLES);
                let mut subject = dielectric(roughness, eta, GREEN);
                subject.evaluate = Box::new(move |wo, wi| again.evaluate(again.missing(wo.z), wi));
                subject
            });
            let off = worst(&glass, &turned);
            assert!(off < 1e-4, "{}: {off}", glass.name);
        }
    }
}

/// White glass says that it scatters all, and tinted glass about what it does.
#[test]
fn estimates_of_the_albedo_are_close() {
    for roughness in [0.0, 0.3, 0.6, 1.0] {
        for eta in [1.5, 1.0 / 1.5, 2.4] {
            for degrees in ALL_ANGLES {
                let wo = outgoing(degrees);
                let white = Dielectric::new(eta, Vec3::ONE, roughness, &TABLES).albedo(wo);
                assert!((white - Vec3::ONE).abs().max_element() < 1e-6, "{roughness}, {eta}, {degrees}°: {white}");
                let said = Dielectric::new(eta, GREEN, roughness, &TABLES).albedo(wo);
                let found = scattered(&dielectric(roughness, eta, GREEN), wo);
                let off = (said - found).abs().max_element();
                assert!(off < 0.35, "{roughness}, {eta}, {degrees}°: {said} but {found}");
            }
        }
    }
}
