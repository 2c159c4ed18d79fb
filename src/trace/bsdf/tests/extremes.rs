//! Whatever the parameters, the directions and the variates: numbers that are finite and not negative.

use super::super::albedo::AlbedoTables;
use super::super::standard::{Standard, StandardParameters};
use super::super::{Bsdf, Density, Phong, Refraction};
use super::subject::{TABLES, VOLUME, WHITE};
use crate::math::testing::Random;
use crate::scene::Interior;
use glam::Vec3;

/// Unlikely variates among the likely.
fn variate(random: &mut Random) -> f32 {
    match random.bits() % 8 {
        0 => 0.0,
        1 => 1.0 - 0.5 * f32::EPSILON,
        2 => f32::EPSILON,
        _ => random.unit(),
    }
}

/// Parameters at either end of their range, and between.
fn unit(random: &mut Random) -> f32 {
    match random.bits() % 6 {
        0 => 0.0,
        1 => 1.0,
        2 => 0.0317,
        3 => 1e-4,
        _ => random.unit(),
    }
}

/// A direction that grazes, by as little as 10⁻⁷, lies along the normal, or is any.
fn direction(random: &mut Random) -> Vec3 {
    let mut w = random.direction();
    match random.bits() % 5 {
        0 => w.z = 1e-7 + 1e-4 * random.unit().powi(4),
        1 => w = Vec3::new(1e-7 * w.x, 1e-7 * w.y, 1.0),
        2 => w = Vec3::Z,
        _ => w.z = w.z.abs().max(1e-7),
    }
    w.normalize()
}

/// Panics unless all that a surface says is a number that it may be.
fn hold(bsdf: &Bsdf, random: &mut Random, what: &dyn std::fmt::Debug) {
    for _ in 0..20 {
        let wo = direction(random);
        let u = [variate(random), variate(random), variate(random)];
        let mut wi = direction(random);
        if let Some(sample) = bsdf.sample(wo, u) {
            let density = match sample.density {
                Density::Smooth(pdf) => pdf,
                Density::Delta => 1.0,
            };
            let sound = sample.weight.is_finite() && sample.weight.min_element() >= 0.0 && density > 0.0;
            assert!(sound && density.is_finite(), "{what:?} from {wo} by {u:?}: {sample:?}");
            assert!((sample.wi.length() - 1.0).abs() < 1e-5, "{what:?} from {wo} by {u:?}: {sample:?}");
            wi = sample.wi;
        } else {
            wi.z *= if random.bits().is_multiple_of(2) { 1.0 } else { -1.0 };
        }
        let (value, pdf) = (bsdf.evaluate(wo, wi), bsdf.pdf(wo, wi));
        let sound = value.is_finite() && value.min_element() >= 0.0 && pdf.is_finite() && pdf >= 0.0;
        assert!(sound, "{what:?}: {value} with {pdf} from {wo} to {wi}");
        let together = bsdf.respond(wo, wi);
        assert_eq!((together.value, together.pdf), (value, pdf), "{what:?} from {wo} to {wi}");
        let hidden = !bsdf.has_smooth() || wi.z < 0.0 && !bsdf.transmits();
        assert!(!hidden || value == Vec3::ZERO, "{what:?} from {wo} to {wi}: {value}");
        let albedo = bsdf.albedo(wo) + bsdf.straight(wo.z);
        assert!(albedo.min_element() >= 0.0 && albedo.max_element() < 1.001, "{what:?} from {wo}: {albedo}");
    }
}

#[test]
fn the_standard_material_stays_finite() {
    let mut random = Random::new(31);
    for _ in 0..20_000 {
        let r = &mut random;
        let parameters = StandardParameters {
            base_colour: Vec3::new(unit(r), unit(r), unit(r)),
            metallic: unit(r),
            perceptual_roughness: unit(r),
            reflectance: unit(r),
            specular_tint: Vec3::new(unit(r), unit(r), unit(r)),
            specular_transmission: unit(r),
            eta: [1.5, 1.0 / 1.5, 1.0, 1.001, 0.999, 3.0, 0.3, 1.000_1][(r.bits() % 8) as usize],
            interior: if r.bits().is_multiple_of(2) { Interior::ThinWalled } else { VOLUME },
            diffuse_transmission: unit(r),
            clearcoat: unit(r),
            clearcoat_perceptual_roughness: unit(r),
        };
        let bsdf = Bsdf::Standard(Standard::new(&parameters, &TABLES));
        hold(&bsdf, r, &parameters);
    }
}

#[test]
fn the_other_surfaces_stay_finite() {
    let mut random = Random::new(32);
    for _ in 0..5000 {
        let r = &mut random;
        let exponent = [0.0, 1e-3, 1.0, 50.0, 1e4, 1e6][(r.bits() % 6) as usize];
        let (diffuse, specular) = (0.5 * Vec3::splat(unit(r)), 0.5 * Vec3::new(unit(r), unit(r), unit(r)));
        let phong = Phong { diffuse, specular, exponent };
        hold(&Bsdf::Phong(phong), r, &phong);
        let eta = [1.5, 1.0 / 1.5, 1.0, 1e-2, 1e2][(r.bits() % 5) as usize];
        let refraction = Refraction { eta, tint: Vec3::new(unit(r), unit(r), unit(r)) };
        hold(&Bsdf::Refraction(refraction), r, &refraction);
    }
    hold(&Bsdf::None, &mut random, &"nothing");
}

/// Directions from below and numbers that are none give nothing, or at least no panic.
#[test]
fn what_makes_no_sense_gives_nothing() {
    let bsdf = Bsdf::Standard(Standard::new(&StandardParameters { specular_transmission: 0.5, ..WHITE }, &TABLES));
    for wo in [Vec3::NEG_Z, Vec3::X] {
        assert!(bsdf.sample(wo, [0.5; 3]).is_none());
        assert_eq!((bsdf.evaluate(wo, Vec3::Z), bsdf.pdf(wo, Vec3::Z)), (Vec3::ZERO, 0.0));
    }
    let tables: &AlbedoTables = &TABLES;
    for nonsense in [f32::NAN, f32::INFINITY, -1.0] {
        let parameters = StandardParameters { perceptual_roughness: nonsense, ..WHITE };
        let bsdf = Bsdf::Standard(Standard::new(&parameters, tables));
        let _ = (bsdf.sample(Vec3::Z, [0.5; 3]), bsdf.evaluate(Vec3::Z, Vec3::Z));
    }
}

/// Out of what is 100 times as dense, within a part in a million of the critical angle: by the sine, f32 tells on
/// which side a direction lies; by the cosine, 0.99995, it is off by a part in a thousand.
#[test]
fn the_critical_angle_of_a_dense_body() {
    let at = |share: f64| {
        let sin = 0.01 * share;
        let wo = Vec3::new(sin as f32, 0.0, (1.0 - sin * sin).sqrt() as f32);
        Refraction { eta: 0.01, tint: Vec3::ONE }.sample(wo, 0.999_999).map(|sample| sample.wi.z)
    };
    assert!(at(1.0 - 1e-6).is_some_and(|z| z < 0.0));
    assert!(at(1.0 + 1e-6).is_some_and(|z| z > 0.0));
}
