//! Samples against densities. A lobe may lose samples, where a facet sends light below the surface: these are counted
//! too, in a strip beside the sphere that holds what the density lacks of 1.

use super::super::ggx::{Ggx, half_vector, mirrored};
use super::super::{BsdfSample, Density};
use super::subject::{ANGLES, GREEN, Subject, dielectric, everything, outgoing, schlick, specular};
use crate::math::mix64;
use crate::math::testing::{ChiSquared, Domain, Rejection, integrate};
use glam::{Vec2, Vec3};
use std::f64::consts::{PI, TAU};

/// Columns of cells. The mirror direction of [`outgoing`] lies in the middle of one.
pub(super) const COLUMNS: usize = 31;

/// Rows of cells on the sphere; even, so that the horizon, where densities jump, ends a row.
const ROWS: usize = 24;

/// Why a density was rejected.
#[derive(Clone, Debug, PartialEq)]
enum Wrong {
    /// It integrates to more than 1: to this.
    Above(f64),
    /// The samples do not follow it.
    Samples(Rejection),
}

/// The direction at a point of the unit square that stands for the sphere, and the solid angle per area there. The
/// upper half is the near side. The height is stretched at the poles, where a narrow lobe would fall between the nodes
/// of a quadrature, and at the horizon, where a grazing one would.
pub(super) fn direction(x: f64, y: f64) -> (Vec3, f64) {
    let s = (2.0 * y - 1.0).abs();
    let t = 1.0 - s * s;
    let z = (s * s * (2.0 - s * s)).copysign(2.0 * y - 1.0);
    let r = t * (2.0 - t * t).sqrt();
    let (sin, cos) = (TAU * x).sin_cos();
    (Vec3::new((r * cos) as f32, (r * sin) as f32, z as f32), 16.0 * PI * s * t)
}

/// The inverse of [`direction`].
fn place(w: Vec3) -> Vec3 {
    let turn = w.y.atan2(w.x) / TAU as f32;
    let z = w.z.abs();
    // s² = 1 − √(1 − z), each written so that neither end loses its digits.
    let t = ((w.x * w.x + w.y * w.y) / (1.0 + z)).sqrt();
    let s = (z / (1.0 + t)).sqrt();
    Vec3::new(turn - turn.floor(), 0.5 + (0.5 * s).copysign(w.z), 0.0)
}

/// The density over the square.
fn per_area(pdf: &dyn Fn(Vec3) -> f64, x: f64, y: f64) -> f64 {
    let (w, solid_angle) = direction(x, y);
    solid_angle * pdf(w)
}

/// What the density integrates to over the sphere.
fn total(pdf: &dyn Fn(Vec3) -> f64) -> f64 {
    let at = |s: [f64; 2]| per_area(pdf, s[0], s[1]);
    let (columns, rows) = (COLUMNS, ROWS);
    let step = [1.0 / columns as f64, 1.0 / rows as f64];
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| [i as f64 * step[0], j as f64 * step[1]]));
    cells.map(|low| integrate(&at, low, step, 1e-6)).sum()
}

/// A third variate from two.
fn third(u: Vec2) -> f32 {
    let bits = mix64(u64::from(u.x.to_bits()) << 32 | u64::from(u.y.to_bits()));
    (bits >> 40) as f32 / 16_777_216.0
}

/// Holds samples against the density, over the sphere and the strip of what is lost.
fn check(subject: &Subject, wo: Vec3, pdf: &dyn Fn(Vec3) -> f64) -> Result<f64, Wrong> {
    let total = total(pdf);
    if total > 1.0 + 5e-4 {
        return Err(Wrong::Above(total));
    }
    let lost = (1.0 - total).max(1e-9);
    let strip = 1.0 / ROWS as f64;
    let high = Vec2::new(1.0, (1.0 + strip) as f32);
    let test = ChiSquared {
        cells: [COLUMNS, ROWS + 1],
        samples: 100_000,
        family: 128,
        ..ChiSquared::over(Domain::Plane(Vec2::ZERO, high))
    };
    let sample = |u: Vec2| match (subject.sample)(wo, [u.x, u.y, third(u)]) {
        Some(BsdfSample { wi, density: Density::Smooth(_), .. }) => place(wi),
        _ => {
            let x = third(Vec2::new(u.y, u.x));
            Vec3::new(x, 1.0 + strip as f32 * (0.01 + 0.98 * third(Vec2::splat(x))), 0.0)
        }
    };
    let density = |p: Vec3| {
        if p.y > 1.0 { lost / strip } else { per_area(pdf, f64::from(p.x), f64::from(p.y)) }
    };
    test.run(sample, density).map_err(Wrong::Samples)
}

fn own_density(subject: &Subject, wo: Vec3) -> impl Fn(Vec3) -> f64 {
    move |wi| f64::from((subject.pdf)(wo, wi))
}

/// Every lobe and every mix from every angle, in four tests that can run beside one another.
fn samples_follow(part: usize) {
    for subject in everything().iter().skip(part).step_by(4) {
        for degrees in ANGLES {
            let wo = outgoing(degrees);
            let found = check(subject, wo, &own_density(subject, wo));
            assert!(found.is_ok(), "{} at {degrees}°: {found:?}", subject.name);
        }
    }
}

#[test]
fn samples_follow_their_density_1() {
    samples_follow(0);
}

#[test]
fn samples_follow_their_density_2() {
    samples_follow(1);
}

#[test]
fn samples_follow_their_density_3() {
    samples_follow(2);
}

#[test]
fn samples_follow_their_density_4() {
    samples_follow(3);
}

/// A density 5 % too large, whether it is whole or lacks what is lost.
#[test]
fn a_scaled_density_is_rejected() {
    for (number, subject) in everything().iter().enumerate() {
        let wo = outgoing(ANGLES[number % ANGLES.len()]);
        let found = check(subject, wo, &|wi| 1.05 * f64::from((subject.pdf)(wo, wi)));
        assert!(found.is_err(), "{}: {found:?}", subject.name);
    }
}

/// The density of normals taken for that of directions, for reflection and for refraction.
#[test]
fn a_missing_jacobian_is_rejected() {
    let (roughness, wo) = (0.5, outgoing(45.0));
    let ggx = Ggx::new(roughness).expect("rough");
    let subject = specular(roughness, schlick([0.02; 3]));
    let jacobian = |wi: Vec3| half_vector(wo, wi).map_or(0.0, |m| 4.0 * wo.dot(m));
    let found = check(&subject, wo, &|wi| f64::from((subject.pdf)(wo, wi) * jacobian(wi)));
    assert!(found.is_err(), "{found:?}");
    // One that is right for wi, not for wo, has the right form and the wrong size.
    let plain = |wi: Vec3| half_vector(wo, wi).map_or(0.0, |m| ggx.density(m) * m.z / (4.0 * wo.dot(m)));
    let found = check(&subject, wo, &|wi| f64::from(plain(wi)));
    assert!(found.is_err(), "{found:?}");
    let glass = dielectric(roughness, 1.5, GREEN);
    let found = check(&glass, wo, &|wi| {
        let whole = f64::from((glass.pdf)(wo, wi));
        let square = f64::from((wo + 1.5 * wi).length_squared());
        if wi.z < 0.0 { whole * square } else { whole }
    });
    assert!(found.is_err(), "{found:?}");
}

/// The index turned upside down.
#[test]
fn a_swapped_index_is_rejected() {
    for degrees in ANGLES {
        let (wo, glass) = (outgoing(degrees), dielectric(0.5, 1.5, GREEN));
        let swapped = dielectric(0.5, 1.0 / 1.5, GREEN);
        let found = check(&glass, wo, &|wi| f64::from((swapped.pdf)(wo, wi)));
        assert!(found.is_err(), "{degrees}°: {found:?}");
    }
}

/// Samples that are silently turned up again instead of lost, and a lost share that the density does not know.
#[test]
fn wrong_losses_are_rejected() {
    let wo = outgoing(80.0);
    let ggx = Ggx::new(1.0).expect("rough");
    let mut subject = specular(1.0, schlick([0.02; 3]));
    let pdf = move |wi: Vec3| half_vector(wo, wi).map_or(0.0, |m| ggx.reflection(wo, wi, m).1);
    let reflected = move |wo: Vec3, u: [f32; 3]| {
        mirrored(wo, ggx.sample(wo, [u[0], u[1]])).map(|wi| BsdfSample {
            wi,
            weight: Vec3::ONE,
            density: Density::Smooth(1.0),
        })
    };
    subject.sample = Box::new(reflected);
    let found = check(&subject, wo, &|wi| f64::from(pdf(wi)));
    assert!(found.is_ok(), "{found:?}");
    subject.sample = Box::new(move |wo, u| {
        reflected(wo, u).or(Some(BsdfSample { wi: Vec3::Z, weight: Vec3::ONE, density: Density::Smooth(1.0) }))
    });
    let found = check(&subject, wo, &|wi| f64::from(pdf(wi)));
    assert!(found.is_err(), "{found:?}");
    subject.sample = Box::new(move |wo, u| reflected(wo, u).filter(|_| u[2] < 0.95));
    let found = check(&subject, wo, &|wi| f64::from(pdf(wi)));
    assert!(found.is_err(), "{found:?}");
}
