//! Helmholtz: f(wo, wi) = f(wi, wo). Where light is refracted, radiance changes with the index squared, and it is
//! f(wo, wi) · ηi² = f(wi, wo) · ηo², seen from either side (Veach 1997, § 5.2).

use super::super::fresnel::Schlick;
use super::super::ggx::{Ggx, half_vector};
use super::super::standard::StandardParameters;
use super::subject::{GREEN, Subject, WHITE, dielectric, everything, lambert, mixes, schlick, specular, standard};
use crate::math::testing::Random;
use glam::Vec3;

/// The worst relative difference between the way there and the way back; `turned` is the surface seen from behind.
pub(super) fn worst(subject: &Subject, turned: &Subject) -> f32 {
    let mut random = Random::new(21);
    let mut worst = 0.0_f32;
    let mut seen = [0, 0];
    for _ in 0..40_000 {
        let (mut wo, wi) = (random.direction(), random.direction());
        wo.z = wo.z.abs();
        if wo.z < 0.01 || wi.z.abs() < 0.01 {
            continue;
        }
        let there = (subject.evaluate)(wo, wi) / wi.z.abs();
        let back = if wi.z > 0.0 {
            (subject.evaluate)(wi, wo) / wo.z
        } else {
            let flip = Vec3::new(1.0, 1.0, -1.0);
            let square = subject.eta * subject.eta;
            (turned.evaluate)(wi * flip, wo * flip) / (wo.z * square)
        };
        let size = there.max(back).max_element();
        // What is fainter comes from facets seen edge-on, whose cosines have no digits left.
        if size > 1e-3 {
            seen[usize::from(wi.z < 0.0)] += 1;
            worst = worst.max((there - back).abs().max_element() / size);
        }
    }
    assert!(seen[0] + seen[1] > 500, "{}: {seen:?}", subject.name);
    worst
}

#[test]
fn the_way_back_scatters_alike() {
    for subject in everything() {
        if subject.eta == 1.0 {
            let off = worst(&subject, &subject);
            assert!(off < 1e-3, "{}: {off}", subject.name);
        }
    }
}

#[test]
fn refraction_goes_both_ways_by_the_index_squared() {
    for roughness in [0.2, 0.5, 1.0] {
        for eta in [1.5, 1.0 / 1.5, 2.4] {
            let (glass, turned) = (dielectric(roughness, eta, GREEN), dielectric(roughness, 1.0 / eta, GREEN));
            let off = worst(&glass, &turned);
            assert!(off < 1e-2, "{}: {off}", glass.name);
            // Planted: radiance that does not follow the index; the index not turned; a tint of one side alone.
            let mut faulty = dielectric(roughness, eta, GREEN);
            faulty.eta = 1.0;
            assert!(worst(&faulty, &turned) > 0.1, "{}", faulty.name);
            assert!(worst(&glass, &glass) > 0.1, "{}", glass.name);
        }
    }
}

#[test]
fn mixes_with_glass_go_both_ways() {
    let (_, body) = mixes().pop().expect("the last is a body of glass");
    let turned = StandardParameters { eta: 1.0 / body.eta, ..body };
    let off = worst(&standard("body", &body), &standard("turned", &turned));
    assert!(off < 1e-2, "{off}");
    assert!(worst(&standard("body", &body), &standard("body", &body)) > 0.1);
}

/// A masking term that asks only whether `wo` is seen, Bevy's way to compensate, and a base scaled by one side only.
#[test]
fn one_sided_faults_are_rejected() {
    let ggx = Ggx::new(0.7).expect("rough");
    let metal = schlick([0.9, 0.6, 0.3]);
    let mut subject = specular(0.7, metal);
    subject.evaluate = Box::new(move |wo, wi| {
        half_vector(wo, wi).map_or(Vec3::ZERO, |m| metal.at(wo.dot(m)) * ggx.reflection(wo, wi, m).1)
    });
    assert!(worst(&subject, &subject) > 0.1);
    let table = super::subject::TABLES.at(0.7);
    subject.evaluate = Box::new(move |wo, wi| {
        let scale = Vec3::ONE + metal.f0 * (1.0 / table.at(wo.z).white() - 1.0);
        half_vector(wo, wi).map_or(Vec3::ZERO, |m| metal.at(wo.dot(m)) * scale * ggx.reflection(wo, wi, m).0)
    });
    assert!(worst(&subject, &subject) > 0.01);
    let one_sided = Schlick::new(Vec3::splat(0.04));
    let mut diffuse = lambert();
    diffuse.evaluate = Box::new(move |wo, wi| (Vec3::ONE - one_sided.at(wo.z)) * wi.z.max(0.0));
    assert!(worst(&diffuse, &diffuse) > 0.1);
    // And the surface that it is about passes.
    assert!(worst(&standard("white", &WHITE), &standard("white", &WHITE)) < 1e-3);
}
