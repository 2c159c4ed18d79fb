//! How much the GGX lobe reflects in all: tables over angle and roughness, computed when a tracer is made.
//!
//! With Schlick's Fresnel term the directional albedo is linear in F0 and F90 (Karis 2013): E = F0 · A + F90 · B. The
//! tables hold A and B; their sum is the albedo of facets that reflect all, 1 less what leaves facets only to hit
//! others. That the averages are those of the interpolated table, not of the lobe, keeps what is built on them in
//! balance: the share that compensation gives back is exactly what the table says is missing. An entry is within
//! 1.5·10⁻³ of the lobe from a perceptual roughness of 0.089 on, below which Bevy displays nothing, and within 6·10⁻³
//! of it at every other.

use super::fresnel::{SCHLICK_AVERAGE, Schlick, schlick_weight};
use super::ggx::{Ggx, SMOOTH_BELOW, mirrored};
use super::glass_albedo::GlassTables;
use crate::math::{Portable, unit_at};
use glam::{Vec2, Vec3};
use std::f32::consts::PI;
use std::sync::OnceLock;

/// Nodes over the angle.
const ANGLES: usize = 64;

/// Nodes over the roughness.
const ROUGHNESSES: usize = 49;

/// Perceptual roughness below which the rows lie more densely than their mean.
const DENSE_BELOW: f32 = 0.8;

/// Nodes of the averages over the roughness.
const AVERAGES: usize = 129;

/// Nodes of the quadrature over visible normals: around, and over the height of the cap.
const QUADRATURE: [usize; 2] = [32, 40];

/// Directional albedo and its average, for every angle and roughness.
#[derive(Clone, Debug)]
pub(in crate::trace) struct AlbedoTables {
    /// By roughness, then by angle.
    nodes: Vec<Albedo>,
    /// By roughness: the fourth root of what is missing, which is nearly linear, and the share of F90.
    averages: Vec<[f32; 2]>,
    /// Of rough interfaces of glass; made at the first of them.
    glass: OnceLock<GlassTables>,
}

/// An albedo by its share of F0 and of F90.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Albedo {
    pub(super) f0: f32,
    pub(super) f90: f32,
}

impl Albedo {
    /// The albedo of facets with this reflectance.
    #[inline]
    pub(super) fn of(self, fresnel: &Schlick) -> Vec3 {
        fresnel.f0 * self.f0 + Vec3::splat(fresnel.f90 * self.f90)
    }

    /// The albedo of facets that reflect all.
    #[inline]
    pub(super) fn white(self) -> f32 {
        self.f0 + self.f90
    }

    #[inline]
    fn lerp(self, other: Self, t: f32) -> Self {
        Self { f0: self.f0 + t * (other.f0 - self.f0), f90: self.f90 + t * (other.f90 - self.f90) }
    }
}

/// The albedo of one roughness.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoughnessAlbedo<'a> {
    /// The rows below and above, and how far from the first to the second; `None` for a perfectly smooth surface.
    rows: Option<[&'a [Albedo]; 2]>,
    fraction: f32,
    warp: f32,
    /// What is missing of facets that reflect all, averaged.
    missing: f32,
    average: Albedo,
}

impl AlbedoTables {
    /// The tables of rough interfaces of glass. Few scenes have one, and they take longer than all others.
    #[inline]
    pub(super) fn glass(&self) -> &GlassTables {
        self.glass.get_or_init(GlassTables::new)
    }

    /// Computes the tables: some 200 milliseconds. Always the same.
    pub(in crate::trace) fn new() -> Self {
        let rule = Quadrature::new(QUADRATURE);
        let mut nodes = Vec::with_capacity(ROUGHNESSES * ANGLES);
        for row in 0..ROUGHNESSES {
            let roughness = roughness_at(row as f32 / (ROUGHNESSES - 1) as f32);
            let ggx = Ggx::new(roughness.max(1.001 * least()));
            for column in 0..ANGLES {
                let cos = unwarped(column as f32 / (ANGLES - 1) as f32, roughness);
                nodes.push(ggx.map_or(smooth(cos), |ggx| rule.albedo(&ggx, cos)));
            }
        }
        let mut tables = Self { nodes, averages: vec![[0.0; 2]; AVERAGES], glass: OnceLock::new() };
        let averages = (0..AVERAGES).map(|index| {
            let roughness = roughness_at(index as f32 / (AVERAGES - 1) as f32);
            let average = tables.at(roughness.max(1.001 * least())).integrated();
            [(1.0 - average.white()).max(0.0).sqrt().sqrt(), average.f90]
        });
        tables.averages = averages.collect();
        tables
    }

    /// The albedo at a perceptual roughness.
    #[inline]
    pub(super) fn at(&self, perceptual_roughness: f32) -> RoughnessAlbedo<'_> {
        if Ggx::new(perceptual_roughness).is_none() {
            let average = Albedo { f0: 1.0 - SCHLICK_AVERAGE, f90: SCHLICK_AVERAGE };
            return RoughnessAlbedo { rows: None, fraction: 0.0, warp: 1.0, missing: 0.0, average };
        }
        let height = height_of(perceptual_roughness);
        let (row, fraction) = cell(height, ROUGHNESSES);
        let rows = [row, row + 1].map(|row| &self.nodes[row * ANGLES..(row + 1) * ANGLES]);
        let (index, t) = cell(height, AVERAGES);
        let [low, high] = [self.averages[index], self.averages[index + 1]];
        let root = low[0] + t * (high[0] - low[0]);
        let (missing, f90) = ((root * root) * (root * root), low[1] + t * (high[1] - low[1]));
        let average = Albedo { f0: 1.0 - missing - f90, f90 };
        RoughnessAlbedo { rows: Some(rows), fraction, warp: warp(perceptual_roughness.min(1.0)), missing, average }
    }
}

impl RoughnessAlbedo<'_> {
    /// The albedo seen at this cosine to the normal.
    #[inline]
    pub(super) fn at(&self, cos: f32) -> Albedo {
        let Some([low, high]) = self.rows else {
            return smooth(cos);
        };
        let x = cos * (1.0 + self.warp) / (cos + self.warp);
        let (column, t) = cell(x, ANGLES);
        low[column].lerp(low[column + 1], t).lerp(high[column].lerp(high[column + 1], t), self.fraction)
    }

    /// The cosine-weighted mean over all angles.
    #[inline]
    pub(super) fn average(&self) -> Albedo {
        self.average
    }

    /// What is missing at this cosine, of facets that reflect all.
    #[inline]
    pub(super) fn missing(&self, cos: f32) -> f32 {
        (1.0 - self.at(cos).white()).max(0.0)
    }

    /// Scattering function of light that is spread so that it makes up for what is missing, if all of it comes back:
    /// (1 − E(μo)) (1 − E(μi)) / (π (1 − E_average)) (Kulla and Conty 2017).
    #[inline]
    pub(super) fn compensation(&self, [missing_o, missing_i]: [f32; 2]) -> f32 {
        if self.missing > 0.0 { missing_o * missing_i / (PI * self.missing) } else { 0.0 }
    }

    /// The average by quadrature over each cell's width.
    fn integrated(&self) -> Albedo {
        let (mut f0, mut f90, mut total) = (0.0, 0.0, 0.0);
        let steps = 4 * (ANGLES - 1);
        for step in 0..steps {
            let x = (step as f32 + 0.5) / steps as f32;
            let cos = x * self.warp / (1.0 + self.warp - x);
            let slope = self.warp * (1.0 + self.warp) / ((1.0 + self.warp - x) * (1.0 + self.warp - x));
            let albedo = self.at(cos);
            let weight = f64::from(cos * slope);
            f0 += weight * f64::from(albedo.f0);
            f90 += weight * f64::from(albedo.f90);
            total += weight;
        }
        Albedo { f0: (f0 / total) as f32, f90: (f90 / total) as f32 }
    }
}

/// The least perceptual roughness that is not perfectly smooth.
#[inline]
fn least() -> f32 {
    SMOOTH_BELOW.sqrt()
}

/// Where a perceptual roughness lies among the rows, in [0, 1]: they are dense where it is small.
#[inline]
pub(super) fn height_of(perceptual_roughness: f32) -> f32 {
    let (r, least) = (perceptual_roughness.clamp(least(), 1.0), least());
    (r - least) * (1.0 + DENSE_BELOW) / ((r + DENSE_BELOW) * (1.0 - least))
}

/// The inverse of [`height_of`].
pub(super) fn roughness_at(height: f32) -> f32 {
    let (y, least) = (height * (1.0 - least()), least());
    (least * (1.0 + DENSE_BELOW) + y * DENSE_BELOW) / (1.0 + DENSE_BELOW - y)
}

/// The scale of cosines on which the nodes over the angle lie densely.
#[inline]
fn warp(perceptual_roughness: f32) -> f32 {
    0.03 + 0.3 * perceptual_roughness
}

#[inline]
fn unwarped(x: f32, perceptual_roughness: f32) -> f32 {
    let k = warp(perceptual_roughness);
    (x * k / (1.0 + k - x)).min(1.0)
}

/// The albedo of a perfectly smooth surface.
#[inline]
fn smooth(cos: f32) -> Albedo {
    let f90 = schlick_weight(cos);
    Albedo { f0: 1.0 - f90, f90 }
}

/// The cell of `nodes` nodes over [0, 1] in which `x` lies, and where in it.
#[inline]
pub(super) fn cell(x: f32, nodes: usize) -> (usize, f32) {
    let at = x * (nodes - 1) as f32;
    let index = (at as usize).min(nodes - 2);
    (index, at - index as f32)
}

/// A rule over the spherical cap of visible normals: equal steps around, Gauss and Legendre's in the cube root of the
/// height, since the rim holds the steep normals, which are few and matter most.
pub(super) struct Quadrature {
    /// Points of the unit circle.
    angles: Vec<Vec2>,
    /// Heights and their weights.
    heights: Vec<[f64; 2]>,
}

impl Quadrature {
    pub(super) fn new([around, up]: [usize; 2]) -> Self {
        // Half a turn is enough: the other is its mirror image.
        let angles = (0..around).map(|i| unit_at(PI * (i as f32 + 0.5) / around as f32)).collect();
        let heights = gauss_legendre(up).into_iter().map(|[q, weight]| [q * q * q, 3.0 * q * q * weight]).collect();
        Self { angles, heights }
    }

    /// The directional albedo of the lobe.
    pub(super) fn albedo(&self, ggx: &Ggx, cos: f32) -> Albedo {
        let cos = cos.clamp(1e-6, 1.0);
        let wo = Vec3::new(((1.0 - cos) * (1.0 + cos)).sqrt(), 0.0, cos);
        let (mut f0, mut f90) = (0.0, 0.0);
        for &[height, weight] in &self.heights {
            for &angle in &self.angles {
                let m = ggx.cap_point(wo, angle, height as f32);
                if let Some(wi) = mirrored(wo, m) {
                    let seen = weight * f64::from(ggx.seen_from_both(wo, wi));
                    let s = f64::from(schlick_weight(wo.dot(m)));
                    f0 += seen * (1.0 - s);
                    f90 += seen * s;
                }
            }
        }
        let scale = 1.0 / self.angles.len() as f64;
        Albedo { f0: (f0 * scale) as f32, f90: (f90 * scale) as f32 }
    }
}

/// Nodes in (0, 1) and weights of the rule of `n` points, by Newton's method on Legendre's polynomial.
fn gauss_legendre(n: usize) -> Vec<[f64; 2]> {
    let legendre = |x: f64| {
        let (mut p, mut before) = (1.0, 0.0);
        for k in 0..n {
            let k = k as f64;
            (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
        }
        (p, n as f64 * (x * p - before) / (x * x - 1.0))
    };
    let node = |i: usize| {
        let mut x = -Portable::cos(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5));
        for _ in 0..6 {
            let (p, slope) = legendre(x);
            x -= p / slope;
        }
        let slope = legendre(x).1;
        [0.5 * (x + 1.0), 1.0 / ((1.0 - x * x) * slope * slope)]
    };
    (0..n).map(node).collect()
}
