//! White furnaces: what a surface scatters of light that comes from everywhere. By quadrature over the variates, of
//! the weights of samples; and by quadrature over directions, which knows nothing of sampling.

use super::super::ggx::{Ggx, half_vector};
use super::super::standard::{Standard, StandardParameters};
use super::super::{Bsdf, Density, Lambert, Phong};
use super::density::{COLUMNS, direction};
use super::subject::*;
use crate::math::testing::integrate;
use crate::trace::sampler::{Dimensions, Sampler, Sobol};
use glam::{DVec3, Vec3};

/// Rows of the quadrature over directions, on each side.
const HEIGHTS: u32 = 20;

/// Nodes of the quadrature over variates.
const NODES: u64 = 1 << 15;

/// The share of energy that is scattered, with its channels: the mean weight of samples. What crosses into another
/// index counts by its flux, which is the radiance times the index squared.
pub(super) fn scattered(subject: &Subject, wo: Vec3) -> Vec3 {
    let mut sum = DVec3::ZERO;
    for node in 0..NODES {
        let [u, v, choice, _] = Sobol::new(1, node).draw(Dimensions::Scatter { vertex: 0 });
        if let Some(sample) = (subject.sample)(wo, [u, v, choice]) {
            let flux = if sample.wi.z < 0.0 { subject.eta * subject.eta } else { 1.0 };
            sum += (sample.weight * flux).as_dvec3();
        }
    }
    (sum / NODES as f64).as_vec3()
}

/// The same of lobes that are spread out, from `evaluate` alone.
fn integrated(subject: &Subject, wo: Vec3) -> f64 {
    let side = |sign: f64, flux: f64| {
        let at = |s: [f64; 2]| {
            let (wi, solid_angle) = direction(s[0], 0.5 + sign * 0.5 * s[1]);
            0.5 * flux * solid_angle * f64::from((subject.evaluate)(wo, wi).x)
        };
        // Where facets seen edge-on begin to refract, the function jumps along a row: rows must be narrow, since a jump
        // at the rim of one falls between the nodes.
        let step = [1.0 / COLUMNS as f64, 1.0 / f64::from(HEIGHTS)];
        let cells = (0..COLUMNS).flat_map(|i| (0..HEIGHTS).map(move |j| [i as f64 * step[0], f64::from(j) * step[1]]));
        cells.map(|low| integrate(&at, low, step, 1e-6)).sum::<f64>()
    };
    side(1.0, 1.0) + side(-1.0, f64::from(subject.eta * subject.eta))
}

/// Samples' weights and the function itself say the same.
#[test]
fn weights_and_the_function_say_the_same() {
    for (number, mut subject) in everything().into_iter().enumerate() {
        let wo = outgoing([30.0, 60.0, 80.0][number % 3]);
        let (sampled, found) = (f64::from(scattered(&subject, wo).x), integrated(&subject, wo));
        assert!((sampled - found).abs() < 2e-3, "{}: {sampled} but {found}", subject.name);
        assert!(found <= 1.0 + 1.5e-3, "{}: {found}", subject.name);
        // Planted: a function without its cosine.
        let evaluate = subject.evaluate;
        subject.evaluate = Box::new(move |wo, wi| evaluate(wo, wi) / wi.z.abs().max(0.05));
        let found = integrated(&subject, wo);
        assert!(found > 1.1 * sampled, "{}: {sampled} and {found}", subject.name);
    }
}

/// The share of energy that is scattered, in the first channel: by quadrature over directions, and what goes in single
/// ones from samples.
pub(super) fn share(subject: &Subject, wo: Vec3) -> f64 {
    let mut single = 0.0;
    let count = 1 << 12;
    for node in 0..count {
        let [u, v, choice, _] = Sobol::new(2, node).draw(Dimensions::Scatter { vertex: 0 });
        if let Some(sample) = (subject.sample)(wo, [u, v, choice])
            && sample.density == Density::Delta
        {
            let flux = if sample.wi.z < 0.0 { subject.eta * subject.eta } else { 1.0 };
            single += f64::from(sample.weight.x * flux) / count as f64;
        }
    }
    single + integrated(subject, wo)
}

pub(super) const ROUGHNESSES: [f32; 7] = [0.0, 0.15, 0.25, 0.4, 0.6, 0.8, 1.0];
pub(super) const ALL_ANGLES: [f32; 6] = [0.0, 30.0, 60.0, 75.0, 85.0, 89.0];

/// The largest and the smallest albedo over roughness and angle.
pub(super) fn range(make: impl Fn(f32) -> Subject) -> (f64, f64) {
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    for roughness in ROUGHNESSES {
        let subject = make(roughness);
        for degrees in ALL_ANGLES {
            let albedo = share(&subject, outgoing(degrees));
            range = (range.0.min(albedo), range.1.max(albedo));
        }
    }
    range
}

/// How far the tables may be off: the sum of what they say is missing and what really is.
const TABLES_OFF: f64 = 1.5e-3;

#[test]
fn a_white_compensated_metal_reflects_all() {
    let white = schlick([1.0; 3]);
    let (low, high) = range(|roughness| specular(roughness, white));
    assert!(low > 1.0 - TABLES_OFF && high < 1.0 + TABLES_OFF, "{low} to {high}");
    // Planted: no compensation; and masking of each side by itself, which loses more than the table says.
    let uncompensated = |roughness: f32| {
        let mut subject = specular(roughness, white);
        if let Some(ggx) = Ggx::new(roughness) {
            let once = move |wo: Vec3, wi: Vec3| half_vector(wo, wi).map_or(0.0, |m| ggx.reflection(wo, wi, m).0);
            subject.evaluate = Box::new(move |wo, wi| Vec3::splat(once(wo, wi)));
        }
        subject
    };
    let (low, _) = range(uncompensated);
    assert!(low < 0.6, "{low}");
    let separable = |roughness: f32| {
        let mut subject = specular(roughness, white);
        if let Some(ggx) = Ggx::new(roughness) {
            let whole = specular(roughness, white).evaluate;
            subject.evaluate = Box::new(move |wo, wi| {
                let Some(m) = half_vector(wo, wi) else {
                    return Vec3::ZERO;
                };
                let g1 = |w: Vec3| ggx.visible(w, m) * w.z / (w.dot(m) * ggx.density(m));
                let (right, once) = (whole(wo, wi), ggx.reflection(wo, wi, m).0);
                right + Vec3::splat(g1(wo) * g1(wi) * ggx.density(m) / (4.0 * wo.z) - once)
            });
        }
        subject
    };
    let (low, _) = range(separable);
    assert!(low < 1.0 - 4.0 * TABLES_OFF, "{low}");
}

#[test]
fn nothing_reflects_more_than_arrives() {
    let whites: [(&str, StandardParameters, f64); 8] = [
        ("dielectric", WHITE, 1.0),
        ("metal", StandardParameters { metallic: 1.0, ..WHITE }, 1.0),
        // Half of what the coat leaves meets no diffuse base, and what bounces between facets of F0 = 0.52 is halved.
        ("half metal", StandardParameters { metallic: 0.5, ..WHITE }, 0.6),
        ("lampshade", StandardParameters { diffuse_transmission: 0.5, ..WHITE }, 1.0),
        ("shiny", StandardParameters { reflectance: 1.0, ..WHITE }, 1.0),
        ("varnished", StandardParameters { clearcoat: 1.0, ..WHITE }, 0.9),
        ("half glass", StandardParameters { specular_transmission: 0.5, interior: VOLUME, ..WHITE }, 0.8),
        ("half pane", StandardParameters { specular_transmission: 0.5, ..WHITE }, 0.5),
    ];
    for (name, parameters, least) in whites {
        for coat in [0.0, 1.0] {
            let make = |roughness| {
                let parameters = StandardParameters { perceptual_roughness: roughness, ..parameters };
                let parameters = StandardParameters { clearcoat_perceptual_roughness: coat, ..parameters };
                super::subject::standard(name, &parameters)
            };
            let (low, high) = range(make);
            assert!(low > least - TABLES_OFF && high < 1.0 + TABLES_OFF, "{name}: {low} to {high}");
        }
    }
}

#[test]
fn a_white_pane_loses_nothing() {
    let parameters = StandardParameters { specular_transmission: 1.0, ..WHITE };
    for roughness in ROUGHNESSES {
        let parameters = StandardParameters { perceptual_roughness: roughness, ..parameters };
        let lobes = Standard::new(&parameters, &TABLES);
        let subject = standard("pane", &parameters);
        for degrees in ALL_ANGLES {
            let wo = outgoing(degrees);
            let all = share(&subject, wo) + f64::from(lobes.straight(wo.z).x);
            assert!((all - 1.0).abs() < TABLES_OFF, "{roughness}, {degrees}°: {all}");
        }
    }
}

/// Lafortune and Willems: the glossy lobe reflects all of its share at normal incidence and less at every other angle.
#[test]
fn phong_keeps_to_its_bound() {
    for exponent in [0.0, 1.0, 20.0, 500.0] {
        let lobe = Phong { diffuse: Vec3::ZERO, specular: Vec3::ONE, exponent };
        let mut subject = phong(exponent);
        subject.evaluate = Box::new(move |wo, wi| Bsdf::Phong(lobe).evaluate(wo, wi));
        let at = |degrees| share(&subject, outgoing(degrees));
        assert!((at(0.0) - 1.0).abs() < 1e-3, "{exponent}: {}", at(0.0));
        for pair in ALL_ANGLES.windows(2) {
            assert!(at(pair[1]) <= at(pair[0]) + 1e-3, "{exponent} at {}°", pair[1]);
        }
    }
    let lambert = Bsdf::Lambert(Lambert { albedo: Vec3::splat(0.5) });
    assert_eq!(lambert.albedo(Vec3::Z), Vec3::splat(0.5));
}

/// What lobes say about their albedo, by which paths are steered, is near to what they do.
#[test]
fn estimates_of_the_albedo_are_close() {
    for (name, parameters) in mixes() {
        let (subject, lobes) = (standard(name, &parameters), Standard::new(&parameters, &TABLES));
        for degrees in ALL_ANGLES {
            let wo = outgoing(degrees);
            let (found, said) = (scattered(&subject, wo), lobes.albedo(wo));
            assert!((found - said).abs().max_element() < 0.4, "{name} at {degrees}°: {found} but {said}");
        }
    }
}
