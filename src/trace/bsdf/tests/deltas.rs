//! Single directions and Fresnel's laws, in closed form.

use super::super::fresnel::{Schlick, refract_at};
use super::super::standard::{Standard, StandardParameters};
use super::super::{Bsdf, Density, Mirror, Refraction};
use super::subject::{ANGLES, TABLES, VOLUME, WHITE, clearcoat, dielectric, outgoing, schlick, specular};
use glam::Vec3;

const LEVEL: Vec3 = Vec3::new(-1.0, -1.0, 1.0);

#[test]
fn a_mirror_obeys_the_law_of_reflection() {
    let colour = Vec3::new(0.9, 0.5, 0.1);
    let mirror = Bsdf::Mirror(Mirror { reflectance: colour });
    for degrees in ANGLES {
        let wo = outgoing(degrees);
        let sample = mirror.sample(wo, [0.3, 0.6, 0.9]).expect("a mirror reflects");
        assert_eq!((sample.wi, sample.weight, sample.density), (wo * LEVEL, colour, Density::Delta));
        assert_eq!((mirror.evaluate(wo, sample.wi), mirror.pdf(wo, sample.wi)), (Vec3::ZERO, 0.0));
    }
    assert!(!mirror.has_smooth() && !mirror.transmits());
    assert!(Bsdf::Mirror(Mirror { reflectance: Vec3::ZERO }).sample(Vec3::Z, [0.5; 3]).is_none());
}

/// sin θi · η = sin θo in the plane of incidence, and all weights together what Fresnel says.
#[test]
fn refraction_obeys_snell_and_fresnel() {
    for eta in [1.5_f32, 1.0 / 1.5, 1.0] {
        let tint = Vec3::new(1.0, 0.5, 0.2);
        for lobe in [Bsdf::Refraction(Refraction { eta, tint }), body(eta, tint)] {
            for degrees in ANGLES {
                let wo = outgoing(degrees);
                let sin = degrees.to_radians().sin() / eta;
                let (mut reflected, mut crossed) = (Vec3::ZERO, Vec3::ZERO);
                for step in 0..1000 {
                    let u = (step as f32 + 0.5) / 1000.0;
                    let Some(sample) = lobe.sample(wo, [0.3, 0.6, u]) else {
                        continue;
                    };
                    assert_eq!(sample.density, Density::Delta);
                    if sample.wi.z > 0.0 {
                        assert!((sample.wi - wo * LEVEL).length() < 1e-6);
                        reflected += sample.weight / 1000.0;
                    } else {
                        let truth = Vec3::new(-wo.x / eta, -wo.y / eta, -(1.0 - sin * sin).sqrt());
                        assert!((sample.wi - truth).length() < 2e-4, "{degrees}°: {} but {truth}", sample.wi);
                        crossed += sample.weight / 1000.0;
                    }
                }
                let reflectance = if sin >= 1.0 { 1.0 } else { reflectance(degrees, eta) };
                assert!((reflected - Vec3::splat(reflectance)).abs().max_element() < 2e-3, "{eta}, {degrees}°");
                let truth = tint * (1.0 - reflectance) / (eta * eta);
                assert!((crossed - truth).abs().max_element() < 5e-3, "{eta}, {degrees}°: {crossed} but {truth}");
            }
        }
    }
}

/// A smooth body of glass as Bevy's material.
fn body(eta: f32, tint: Vec3) -> Bsdf<'static> {
    let parameters = StandardParameters {
        specular_transmission: 1.0,
        interior: VOLUME,
        perceptual_roughness: 0.0,
        base_colour: tint,
        eta,
        ..WHITE
    };
    Bsdf::Standard(Standard::new(&parameters, &TABLES))
}

/// Fresnel's equations by angles: sin²(i − t) / sin²(i + t) and tan²(i − t) / tan²(i + t).
fn reflectance(degrees: f32, eta: f32) -> f32 {
    let i = f64::from(degrees).to_radians();
    let t = (i.sin() / f64::from(eta)).asin();
    if i < 1e-9 {
        return ((eta - 1.0) / (eta + 1.0)).powi(2);
    }
    let [s, p] = [((i - t).sin() / (i + t).sin()).powi(2), ((i - t).tan() / (i + t).tan()).powi(2)];
    (0.5 * (s + p)) as f32
}

#[test]
fn fresnel_at_the_angles_with_names() {
    for eta in [1.5_f32, 1.0 / 1.5, 2.4] {
        let normal = ((eta - 1.0) / (eta + 1.0)).powi(2);
        assert!((refract_at(1.0, eta).reflectance - normal).abs() < 1e-6);
        // Brewster's angle: half of what is polarised across is all there is.
        let brewster = eta.atan();
        let across = ((brewster.cos() - eta * brewster.sin()) / (brewster.cos() + eta * brewster.sin())).powi(2);
        let found = refract_at(brewster.cos(), eta);
        assert!((found.reflectance - 0.5 * across).abs() < 1e-6, "{eta}: {found:?}");
        assert!((found.cos - brewster.sin()).abs() < 1e-6);
        assert!((refract_at(1e-6, eta).reflectance - 1.0).abs() < 1e-4);
    }
    // The critical angle of glass: all but all is reflected before it, all beyond it.
    let critical = (1.0_f32 / 1.5).asin();
    let before = refract_at((critical - 1e-4).cos(), 1.0 / 1.5);
    let beyond = refract_at((critical + 1e-4).cos(), 1.0 / 1.5);
    assert!(before.reflectance > 0.9 && before.reflectance < 1.0 && before.cos > 0.0, "{before:?}");
    assert_eq!((beyond.reflectance, beyond.cos), (1.0, 0.0));
    for degrees in [0.0, 20.0, 40.0, 60.0, 85.0] {
        let (found, truth) = (refract_at(f32::cos(f32::to_radians(degrees)), 1.5), reflectance(degrees, 1.5));
        assert!((found.reflectance - truth).abs() < 1e-5, "{degrees}°");
    }
}

#[test]
fn schlick_is_bevys() {
    let fresnel = Schlick::new(Vec3::new(0.04, 0.04, 0.04));
    assert_eq!((fresnel.f90, fresnel.at(1.0), fresnel.at(0.0)), (1.0, fresnel.f0, Vec3::ONE));
    let faint = Schlick::new(Vec3::splat(0.01));
    assert!((faint.f90 - 0.01 * 3.0 * 50.0 * 0.33).abs() < 1e-6);
    assert_eq!(Schlick::new(Vec3::ZERO).at(0.0), Vec3::ZERO);
    let mean: f32 = (0..10_000).map(|i| (i as f32 + 0.5) / 1e4).map(|mu| 2e-4 * mu * fresnel.at(mu).x).sum();
    assert!((mean - fresnel.average().x).abs() < 1e-5, "{mean}");
}

/// Smooth coats reflect by Schlick's term in the mirror direction; what goes through a smooth pane is no scattering.
#[test]
fn smooth_coats_and_panes() {
    let fresnel = schlick([0.9, 0.6, 0.3]);
    for degrees in ANGLES {
        let wo = outgoing(degrees);
        let metal = (specular(0.0, fresnel).sample)(wo, [0.5; 3]).expect("reflects");
        assert_eq!((metal.wi, metal.weight, metal.density), (wo * LEVEL, fresnel.at(wo.z), Density::Delta));
        let coat = (clearcoat(0.01, 0.5).sample)(wo, [0.5; 3]).expect("reflects");
        let varnish = Schlick { f0: Vec3::splat(0.04), f90: 1.0 }.at(wo.z);
        assert_eq!((coat.wi, coat.weight, coat.density), (wo * LEVEL, 0.5 * varnish, Density::Delta));

        let tint = Vec3::new(0.8, 0.5, 0.2);
        let pane = StandardParameters {
            specular_transmission: 1.0,
            perceptual_roughness: 0.0,
            base_colour: tint,
            clearcoat: 0.5,
            clearcoat_perceptual_roughness: 0.0,
            ..WHITE
        };
        let bsdf = Bsdf::Standard(Standard::new(&pane, &TABLES));
        let leaves = Vec3::ONE - 0.5 * varnish;
        let reflected = Schlick::new(Vec3::splat(0.04)).at(wo.z);
        let truth = leaves * tint * (Vec3::ONE - reflected);
        assert!((bsdf.straight(wo.z) - truth).abs().max_element() < 1e-6);
        assert!(!bsdf.has_smooth() && !bsdf.transmits());
        let mut sum = Vec3::ZERO;
        for step in 0..1000 {
            let sample = bsdf.sample(wo, [0.3, 0.4, (step as f32 + 0.5) / 1000.0]).expect("reflects");
            assert_eq!((sample.wi, sample.density), (wo * LEVEL, Density::Delta));
            sum += sample.weight / 1000.0;
        }
        let truth = 0.5 * varnish + leaves * reflected;
        assert!((sum - truth).abs().max_element() < 5e-3, "{sum} but {truth}");
    }
}

/// What is no interface lets light straight through, however rough.
#[test]
fn matched_indices_do_not_scatter() {
    let wo = outgoing(80.0);
    let sample = (dielectric(1.0, 1.0, Vec3::ONE).sample)(wo, [0.4, 0.5, 0.6]).expect("crosses");
    assert!((sample.wi + wo).length() < 1e-6 && (sample.weight - Vec3::ONE).length() < 1e-6);
    assert_eq!(sample.density, Density::Delta);
}
