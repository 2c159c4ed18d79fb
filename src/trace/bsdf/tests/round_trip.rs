//! A sample's weight and density are what is found for its direction, and the maps from the square can be undone.

use super::super::ggx::Ggx;
use super::super::{Bsdf, Density, Lambert, Standard, StandardParameters};
use super::subject::{ANGLES, Subject, TABLES, WHITE, everything, outgoing};
use crate::math::testing::{Random, round_trip};
use glam::{Vec2, Vec3};
use std::f64::consts::TAU;

/// The worst relative difference between a sample's weight and `evaluate` over `pdf`, and between the densities.
fn worst(subject: &Subject) -> f32 {
    let mut random = Random::new(11);
    let mut worst = 0.0_f32;
    let mut found = 0;
    for degrees in ANGLES.into_iter().cycle().take(4000) {
        let wo = outgoing(degrees);
        let u = [random.unit(), random.unit(), random.unit()];
        let Some(sample) = (subject.sample)(wo, u) else {
            continue;
        };
        let Density::Smooth(density) = sample.density else {
            continue;
        };
        let pdf = (subject.pdf)(wo, sample.wi);
        let weight = (subject.evaluate)(wo, sample.wi) / pdf;
        worst = worst.max((density - pdf).abs() / pdf);
        worst = worst.max((weight - sample.weight).abs().max_element() / weight.max_element().max(1e-3));
        found += 1;
    }
    assert!(found > 1000, "{}: {found} samples", subject.name);
    worst
}

#[test]
fn a_sample_is_what_is_found_for_its_direction() {
    for mut subject in everything() {
        let off = worst(&subject);
        assert!(off < 1e-5, "{}: {off}", subject.name);
        let sample = subject.sample;
        subject.sample = Box::new(move |wo, u| {
            let mut sample = sample(wo, u)?;
            sample.weight *= 1.05;
            Some(sample)
        });
        assert!(worst(&subject) > 0.04, "{}", subject.name);
    }
}

/// The caps of visible normals, from a normal back to the two variates.
#[test]
fn visible_normals_can_be_undone() {
    for roughness in [0.3, 0.7, 1.0_f32] {
        let alpha = roughness * roughness;
        let ggx = Ggx::new(roughness).expect("rough");
        for degrees in ANGLES {
            let wo = outgoing(degrees);
            let o = Vec3::new(alpha * wo.x, alpha * wo.y, wo.z).as_dvec3().normalize();
            let inverse = |m: Vec3, upside: f64| {
                let m = Vec3::new(m.x / alpha, m.y / alpha, m.z).as_dvec3().normalize();
                let c = 2.0 * o.dot(m) * m - o;
                let turn = c.y.atan2(c.x) / TAU;
                let height = (c.z + upside * o.z) / (1.0 + o.z);
                Vec2::new((turn - turn.floor()) as f32, 1.0 - height as f32)
            };
            // Around the top and at the bottom of the cap the angle has no digits; between them it must be right.
            let within = |u: Vec2| Vec2::splat(0.02) + 0.96 * u;
            let map = |u: Vec2| ggx.sample(wo, within(u).to_array());
            let back = |u: Vec2| (u - Vec2::splat(0.02)) / 0.96;
            let found = round_trip(map, |m| back(inverse(m, 1.0)), 2e-3);
            assert!(found.is_ok(), "{roughness}, {degrees}°: {found:?}");
            // Planted: a cap that begins at the wrong height.
            assert!(round_trip(map, |m| back(inverse(m, -1.0)), 2e-3).is_err() || o.z < 2e-3);
        }
    }
}

/// With nothing to reflect the standard material is Lambert's surface.
#[test]
fn without_reflectance_the_standard_material_is_lambertian() {
    let colour = Vec3::new(0.73, 0.05, 1.0);
    let parameters = StandardParameters { reflectance: 0.0, base_colour: colour, ..WHITE };
    let (standard, lambert) = (Bsdf::Standard(Standard::new(&parameters, &TABLES)), Lambert { albedo: colour });
    let mut random = Random::new(3);
    for degrees in ANGLES.into_iter().cycle().take(4000) {
        let (wo, u) = (outgoing(degrees), random.square());
        let sample = standard.sample(wo, [u.x, u.y, random.unit()]).expect("nothing is lost");
        let truth = lambert.sample(u);
        assert_eq!((sample.wi, sample.density), (truth.wi, truth.density));
        assert!((sample.weight - truth.weight).abs().max_element() <= 1e-7 * 2.0);
        let wi = random.direction();
        assert_eq!((standard.evaluate(wo, wi), standard.pdf(wo, wi)), (lambert.evaluate(wi), lambert.pdf(wi)));
    }
}
