//! What is tested: each lobe by itself and mixes of them, over angles and parameters.

use super::super::albedo::AlbedoTables;
use super::super::clearcoat::Clearcoat;
use super::super::dielectric::Dielectric;
use super::super::diffuse_transmission::DiffuseTransmission;
use super::super::fresnel::Schlick;
use super::super::specular::Specular;
use super::super::standard::{Standard, StandardParameters};
use super::super::thin::Pane;
use super::super::{Bsdf, BsdfSample, Lambert, Phong, Proposal, Response};
use super::density::COLUMNS;
use crate::scene::Interior;
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;
use std::sync::LazyLock;

/// The tables that all tests share.
pub(super) static TABLES: LazyLock<AlbedoTables> = LazyLock::new(AlbedoTables::new);

/// A body of clear glass.
pub(super) const VOLUME: Interior =
    Interior::Volume { attenuation_colour: Vec3::ONE, attenuation_distance: f32::INFINITY };

/// Angles of `wo` to the normal [degrees].
pub(super) const ANGLES: [f32; 4] = [0.0, 45.0, 80.0, 89.0];

type Sample = dyn Fn(Vec3, [f32; 3]) -> Option<BsdfSample>;
type Evaluate = dyn Fn(Vec3, Vec3) -> Vec3;
type Pdf = dyn Fn(Vec3, Vec3) -> f32;

/// A way to scatter, in functions, each of which a test can replace by a faulty one.
pub(super) struct Subject {
    pub(super) name: String,
    pub(super) sample: Box<Sample>,
    pub(super) evaluate: Box<Evaluate>,
    pub(super) pdf: Box<Pdf>,
    /// Index on the far side over that on the near one.
    pub(super) eta: f32,
}

/// A direction at `degrees` to the normal, in no special plane: its mirror direction lies in the middle of a column of
/// cells, so that no quadrature misses a narrow lobe.
pub(super) fn outgoing(degrees: f32) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let (y, x) = (TAU * (12.5 / COLUMNS as f32 - 0.5)).sin_cos();
    Vec3::new(sin * x, sin * y, cos)
}

/// The colour of glass.
pub(super) const GREEN: Vec3 = Vec3::new(0.6, 1.0, 0.4);

/// A coloured lobe whose F0 and F90 are those of Bevy.
pub(super) fn schlick(f0: [f32; 3]) -> Schlick {
    Schlick::new(Vec3::from(f0))
}

/// A lobe by itself, in functions.
fn lobe(
    name: String,
    propose: impl Fn(Vec3, [f32; 3]) -> Option<Proposal> + 'static,
    respond: impl Fn(Vec3, Vec3) -> Response + Copy + 'static,
    eta: f32,
) -> Subject {
    Subject {
        name,
        sample: Box::new(move |wo, u| match propose(wo, u)? {
            Proposal::Spread(wi) => respond(wo, wi).sample(wi),
            Proposal::Single(sample) => Some(sample),
        }),
        evaluate: Box::new(move |wo, wi| respond(wo, wi).value),
        pdf: Box::new(move |wo, wi| respond(wo, wi).pdf),
        eta,
    }
}

macro_rules! subject {
    ($name:expr, $lobe:expr, $eta:expr) => {{
        let lobe = $lobe;
        Subject {
            name: $name,
            sample: Box::new(move |wo, u| lobe.sample(wo, u)),
            evaluate: Box::new(move |wo, wi| lobe.evaluate(wo, wi)),
            pdf: Box::new(move |wo, wi| lobe.pdf(wo, wi)),
            eta: $eta,
        }
    }};
}

pub(super) fn lambert() -> Subject {
    subject!("Lambert".into(), Bsdf::Lambert(Lambert { albedo: Vec3::new(0.73, 0.05, 1.0) }), 1.0)
}

pub(super) fn diffuser() -> Subject {
    let lobe = DiffuseTransmission { albedo: Vec3::new(0.73, 0.05, 1.0) };
    Subject {
        name: "diffuser".into(),
        sample: Box::new(move |_, [u, v, _]| Some(lobe.sample(Vec2::new(u, v)))),
        evaluate: Box::new(move |_, wi| lobe.evaluate(wi)),
        pdf: Box::new(move |_, wi| lobe.pdf(wi)),
        eta: 1.0,
    }
}

pub(super) fn specular(roughness: f32, fresnel: Schlick) -> Subject {
    let coat = Specular::new(fresnel, roughness, &TABLES);
    let respond = move |wo: Vec3, wi: Vec3| coat.respond([wo, wi], [wo, wi].map(|w| coat.seen(w.z.abs())).each_ref());
    lobe(format!("specular {roughness}"), move |wo, u| coat.propose(wo, u, &coat.seen(wo.z)), respond, 1.0)
}

pub(super) fn clearcoat(roughness: f32, strength: f32) -> Subject {
    let coat = Clearcoat::new(strength, roughness, &TABLES);
    let respond = move |wo: Vec3, wi: Vec3| coat.respond(wo, wi);
    lobe(format!("coat {roughness}"), move |wo, u| coat.propose(wo, u), respond, 1.0)
}

pub(super) fn dielectric(roughness: f32, eta: f32, tint: Vec3) -> Subject {
    let glass = Dielectric::new(eta, tint, roughness, &TABLES);
    let respond = move |wo: Vec3, wi: Vec3| glass.respond(wo, wi);
    lobe(format!("glass {roughness}, {eta}"), move |wo, u| glass.propose(wo, u), respond, eta)
}

pub(super) fn pane(roughness: f32) -> Subject {
    let pane = Pane::new(schlick([0.04; 3]), Vec3::new(1.0, 0.8, 0.3), roughness, &TABLES);
    let respond = move |wo: Vec3, wi: Vec3| pane.respond(wo, wi);
    lobe(format!("pane {roughness}"), move |wo, u| pane.propose(wo, u), respond, 1.0)
}

pub(super) fn phong(exponent: f32) -> Subject {
    let lobe = Phong { diffuse: Vec3::new(0.5, 0.2, 0.0), specular: Vec3::new(0.5, 0.3, 0.1), exponent };
    subject!(format!("Phong {exponent}"), Bsdf::Phong(lobe), 1.0)
}

/// A white dielectric.
pub(super) const WHITE: StandardParameters = StandardParameters {
    base_colour: Vec3::ONE,
    metallic: 0.0,
    perceptual_roughness: 0.5,
    reflectance: 0.5,
    specular_tint: Vec3::ONE,
    specular_transmission: 0.0,
    eta: 1.5,
    interior: Interior::ThinWalled,
    diffuse_transmission: 0.0,
    clearcoat: 0.0,
    clearcoat_perceptual_roughness: 0.5,
};

pub(super) fn standard(name: &str, parameters: &StandardParameters) -> Subject {
    let bent = parameters.interior != Interior::ThinWalled && parameters.specular_transmission > 0.0;
    let eta = if bent { parameters.eta } else { 1.0 };
    subject!(name.into(), Bsdf::Standard(Standard::new(parameters, &TABLES)), eta)
}

/// Mixes that together have every lobe, each beside every other.
pub(super) fn mixes() -> Vec<(&'static str, StandardParameters)> {
    let colour = Vec3::new(0.8, 0.5, 0.2);
    let varnished = StandardParameters {
        clearcoat: 1.0,
        clearcoat_perceptual_roughness: 0.2,
        metallic: 0.4,
        base_colour: colour,
        ..WHITE
    };
    let lampshade = StandardParameters { diffuse_transmission: 0.6, base_colour: colour, ..WHITE };
    let frosted = StandardParameters { specular_transmission: 0.7, perceptual_roughness: 0.6, ..lampshade };
    // A diffuser has the same index on both sides, so it is no part of this one.
    let body = StandardParameters { interior: VOLUME, clearcoat: 0.5, diffuse_transmission: 0.0, ..frosted };
    vec![("varnished", varnished), ("lampshade", lampshade), ("frosted", frosted), ("body", body)]
}

/// Every lobe that is spread out, over its parameters, and the mixes.
pub(super) fn everything() -> Vec<Subject> {
    let mut all = vec![lambert(), diffuser()];
    all.extend([0.1, 0.3, 0.6, 1.0].map(|roughness| specular(roughness, schlick([0.9, 0.6, 0.3]))));
    all.extend([0.15, 0.5].map(|roughness| clearcoat(roughness, 0.7)));
    for eta in [1.5, 1.0 / 1.5, 2.4] {
        all.extend([0.2, 0.5, 1.0].map(|roughness| dielectric(roughness, eta, GREEN)));
    }
    all.extend([0.2, 0.5, 1.0].map(pane));
    all.extend([0.0, 20.0, 500.0].map(phong));
    all.extend(mixes().iter().map(|(name, parameters)| standard(name, parameters)));
    all
}
