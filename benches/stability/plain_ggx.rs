//! GGX as it is printed in papers and pasted into shaders: D·G/(4 cos θo cos θi) in f32, with the distribution of
//! Walter et al. 2007, Smith's height-correlated masking (Heitz 2014) and, for the light that goes from facet to
//! facet, a division by the lobe's own albedo (Turquin 2019, "Practical multiple scattering compensation for
//! microfacet models"), with which a white metal gives back all in exact arithmetic.

use crate::numbers::Numbers;
use glam::{DVec3, Vec3};
use std::f32::consts::PI;
use std::f64::consts::TAU;

/// Cosines at which the albedo is known.
const KNOTS: usize = 65;

/// Samples of each of them.
const SAMPLES: u64 = 4096;

/// A white metal.
pub struct PlainGgx {
    alpha: f32,
    /// Albedo of the lobe without compensation, at cosines from 0 to 1.
    albedo: Vec<f32>,
}

impl PlainGgx {
    /// From the square root of α.
    pub fn new(perceptual_roughness: f32) -> Self {
        let alpha = perceptual_roughness * perceptual_roughness;
        let cosine = |knot: usize| (knot as f64 / (KNOTS - 1) as f64).max(1e-3);
        let albedo = (0..KNOTS).map(|knot| single_albedo(f64::from(alpha), cosine(knot)) as f32).collect();
        Self { alpha, albedo }
    }

    /// The scattering function, without the cosine [1/sr].
    pub fn evaluate(&self, wo: Vec3, wi: Vec3) -> f32 {
        let h = (wo + wi).normalize();
        let a2 = self.alpha * self.alpha;
        let bracket = h.z * h.z * (a2 - 1.0) + 1.0;
        let density = a2 / (PI * bracket * bracket);
        let lambda = |cos: f32| 0.5 * ((1.0 + a2 * (1.0 - cos * cos) / (cos * cos)).sqrt() - 1.0);
        let masking = 1.0 / (1.0 + lambda(wo.z) + lambda(wi.z));
        density * masking / (4.0 * wo.z * wi.z) / self.albedo_at(wo.z)
    }

    fn albedo_at(&self, cos: f32) -> f32 {
        let place = cos * (KNOTS - 1) as f32;
        let knot = (place as usize).min(KNOTS - 2);
        let share = place - knot as f32;
        self.albedo[knot] * (1.0 - share) + self.albedo[knot + 1] * share
    }
}

/// Albedo of the lobe at a cosine, in f64, over visible normals (Dupuy and Benyoub 2023): the mean of G2/G1.
fn single_albedo(alpha: f64, cos: f64) -> f64 {
    let wo = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
    let lambda = |c: f64| 0.5 * ((1.0 + alpha * alpha * (1.0 - c * c) / (c * c)).sqrt() - 1.0);
    let sample = |index| {
        let [u, v, ..] = Numbers::new(0, index).draw(0).map(f64::from);
        let stretched = DVec3::new(alpha * wo.x, 0.0, wo.z).normalize();
        let z = (1.0 - v) * (1.0 + stretched.z) - stretched.z;
        let sin = (1.0 - z * z).max(0.0).sqrt();
        let cap = DVec3::new(sin * (TAU * u).cos(), sin * (TAU * u).sin(), z) + stretched;
        let m = DVec3::new(alpha * cap.x, alpha * cap.y, cap.z).normalize();
        let wi = 2.0 * wo.dot(m) * m - wo;
        if wi.z <= 0.0 { 0.0 } else { (1.0 + lambda(wo.z)) / (1.0 + lambda(wo.z) + lambda(wi.z)) }
    };
    (0..SAMPLES).map(sample).sum::<f64>() / SAMPLES as f64
}
