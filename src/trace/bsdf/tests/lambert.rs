//! Scattering: samples follow their density, no light is made, and swapping the two directions changes nothing.

use super::super::{Density, Lambert};
use crate::math::testing::{ChiSquared, Domain, Random, Rejection, integrate};
use glam::Vec3;
use std::f64::consts::{PI, TAU};

const ALBEDO: Vec3 = Vec3::new(0.73, 0.05, 1.0);

fn lambert() -> Lambert {
    Lambert { albedo: ALBEDO }
}

#[test]
fn samples_follow_their_density() {
    let bsdf = lambert();
    let test = ChiSquared::over(Domain::Sphere);
    let p = test.run(|u| bsdf.sample(u).wi, |wi| f64::from(bsdf.pdf(wi)));
    assert!(p.is_ok(), "{p:?}");
    // Planted: a density 5 % too large; one without its cosine; one that sees through the surface.
    let wrong = test.run(|u| bsdf.sample(u).wi, |wi| 1.05 * f64::from(bsdf.pdf(wi)));
    assert!(matches!(wrong, Err(Rejection::Total(_))), "{wrong:?}");
    let wrong = test.run(|u| bsdf.sample(u).wi, |wi| if wi.z > 0.0 { TAU.recip() } else { 0.0 });
    assert!(matches!(wrong, Err(Rejection::Counts(_))), "{wrong:?}");
    let wrong = test.run(|u| bsdf.sample(u).wi, |wi| f64::from(wi.z.abs()) / TAU);
    assert!(matches!(wrong, Err(Rejection::Counts(_))), "{wrong:?}");
}

#[test]
fn a_sample_is_what_is_found_for_its_direction() {
    let bsdf = lambert();
    let mut random = Random::new(1);
    for _ in 0..10_000 {
        let sample = bsdf.sample(random.square());
        let pdf = bsdf.pdf(sample.wi);
        assert_eq!(sample.density, Density::Smooth(pdf));
        let weight = bsdf.evaluate(sample.wi) / pdf;
        assert!((weight - sample.weight).abs().max_element() < 1e-6, "{sample:?} but {weight}");
    }
}

/// The integral of the scattering function times the cosine is the albedo, and nothing goes below the surface.
#[test]
fn the_albedo_is_reflected() {
    let bsdf = lambert();
    for channel in 0..3 {
        let at = |s: [f64; 2]| {
            let (sin, cos) = (TAU * s[0]).sin_cos();
            let r = (1.0 - s[1] * s[1]).sqrt();
            let wi = Vec3::new((r * cos) as f32, (r * sin) as f32, s[1] as f32);
            TAU * f64::from(bsdf.evaluate(wi)[channel])
        };
        let albedo = integrate(&at, [0.0, 0.0], [1.0, 1.0], 1e-9);
        assert!((albedo - f64::from(ALBEDO[channel])).abs() < 1e-6, "{albedo}");
    }
    let mut random = Random::new(2);
    for _ in 0..1000 {
        let mut wi = random.direction();
        wi.z = -wi.z.abs();
        assert_eq!((bsdf.evaluate(wi), bsdf.pdf(wi)), (Vec3::ZERO, 0.0));
    }
}

/// Helmholtz: f(wo, wi) = f(wi, wo). A function that does not know wo is reciprocal only if it is constant.
#[test]
fn the_way_back_scatters_alike() {
    let bsdf = lambert();
    let mut random = Random::new(3);
    for _ in 0..1000 {
        let [there, back] = [0, 1].map(|_| bsdf.sample(random.square()).wi);
        let [f, g] = [there, back].map(|wi| bsdf.evaluate(wi) / wi.z);
        assert!((f - g).abs().max_element() < 1e-6, "{there} {back}");
        assert!((f - ALBEDO / PI as f32).abs().max_element() < 1e-6);
    }
}
