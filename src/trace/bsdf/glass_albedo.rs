//! How much a rough interface of glass loses to second facets: tables over angle, roughness and index, from both of
//! its sides, computed when a tracer is made.
//!
//! An entry is 1 less the directional albedo, as energy, of what one facet reflects or refracts (Kulla and Conty
//! 2017). Where light that meets the interface from the dense side begins to be reflected whole, the entry peaks. So
//! angles are laid out from there, and indices by the cosine of that angle: then the peak lies at the same place in
//! each row. Nodes are few, each by quadrature; cubic interpolation once makes many of them, and every look-up is
//! linear. For indices from 1.021 to 2.5 and their inverses, perceptual roughness from 0.089 and angles up to 89° it is
//! within 8·10⁻³ of the lobe, and for 99 in 100 of them within 2·10⁻³ from outside and 3·10⁻³ from inside. Beyond 89°
//! it is within 0.05. Other indices take the nearest.

use super::albedo::{cell, height_of, roughness_at};
use super::fresnel::refract_at;
use super::ggx::Ggx;
use crate::math::unit_at;
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// The range of the critical angle's cosine: indices of 1.0206 and 2.5.
const COSINES: [f32; 2] = [0.2, 0.916_515_1];

/// Nodes over roughness and index that are computed.
const COARSE: [usize; 2] = [13, 10];

/// Cells over roughness, index and angle that each cell between computed nodes is cut into.
const CUTS: [usize; 3] = [4, 3, 2];

/// Nodes over roughness.
const ROUGHNESSES: usize = (COARSE[0] - 1) * CUTS[0] + 1;

/// Nodes over the index.
const INDICES: usize = (COARSE[1] - 1) * CUTS[1] + 1;

/// The parts of the layout of angles inside: up to half of the critical angle's cosine, up to all of it, beyond.
const PARTS: [f32; 2] = [0.25, 0.5];

/// Steps per cell in the averages.
const STEPS: usize = 4;

/// What is missing from either side.
#[derive(Clone, Debug)]
pub(super) struct GlassTables {
    outside: Side,
    inside: Side,
}

/// What is missing from one side.
#[derive(Clone, Debug)]
struct Side {
    /// Nodes over the angle.
    angles: usize,
    /// By roughness, then by index, then by angle.
    nodes: Vec<f32>,
    /// The fourth root of the average, which is nearly linear, by roughness, then by index.
    averages: Vec<f32>,
}

/// Whether a side is the one of the lower or of the higher index.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Medium {
    Rare,
    Dense,
}

/// What is missing of one interface from one side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Missing<'a> {
    nodes: &'a [f32],
    angles: usize,
    layout: Layout,
    /// Where between rows of roughness and of index.
    fraction: Vec2,
    /// The cosine-weighted mean over all angles.
    average: f32,
}

/// How angles are laid out.
#[derive(Clone, Copy, Debug)]
struct Layout {
    /// The scale of cosines on which nodes are dense.
    warp: f32,
    /// Cosine of the critical angle; 0 from the rare side, which has none.
    critical: f32,
}

impl GlassTables {
    /// Computes the tables: some 150 milliseconds. Always the same.
    pub(super) fn new() -> Self {
        // From the dense side the integrand has an edge, where all begins to be reflected.
        Self { outside: Side::new(Medium::Rare, 33, [377, 233]), inside: Side::new(Medium::Dense, 41, [987, 610]) }
    }

    /// What is missing on the near side, if the index on the far side over that on the near one is `eta`.
    #[inline]
    pub(super) fn at(&self, eta: f32, perceptual_roughness: f32) -> Missing<'_> {
        let (side, medium, sin) =
            if eta < 1.0 { (&self.inside, Medium::Dense, eta) } else { (&self.outside, Medium::Rare, eta.recip()) };
        let [low, high] = COSINES;
        let cos = (1.0 - sin * sin).max(0.0).sqrt().clamp(low, high);
        let (row, s) = cell(height_of(perceptual_roughness), ROUGHNESSES);
        let (column, t) = cell((cos - low) / (high - low), INDICES);
        let first = row * INDICES + column;
        let root = bilinear(|offset| side.averages[first + offset], INDICES, Vec2::new(s, t));
        Missing {
            nodes: &side.nodes[first * side.angles..(first + INDICES + 2) * side.angles],
            angles: side.angles,
            layout: Layout::new(medium, cos, perceptual_roughness),
            fraction: Vec2::new(s, t),
            average: (root * root) * (root * root),
        }
    }
}

impl Missing<'_> {
    /// The share of light that is lost where it comes from or goes to this cosine.
    #[inline]
    pub(super) fn at(&self, cos: f32) -> f32 {
        let (angle, t) = cell(self.layout.place(cos.clamp(0.0, 1.0)), self.angles);
        let along = |offset: usize| {
            let index = offset * self.angles + angle;
            self.nodes[index] + t * (self.nodes[index + 1] - self.nodes[index])
        };
        bilinear(along, INDICES, self.fraction)
    }

    /// The cosine-weighted mean of [`at`](Self::at).
    #[inline]
    pub(super) fn average(&self) -> f32 {
        self.average
    }
}

/// Between four nodes, the second two of which lie `stride` after the first.
#[inline]
fn bilinear(node: impl Fn(usize) -> f32, stride: usize, fraction: Vec2) -> f32 {
    let along = |row: usize| {
        let low = node(row);
        low + fraction.y * (node(row + 1) - low)
    };
    let low = along(0);
    low + fraction.x * (along(stride) - low)
}

impl Layout {
    #[inline]
    fn new(medium: Medium, critical: f32, perceptual_roughness: f32) -> Self {
        let r = perceptual_roughness.min(1.0);
        Self { warp: 0.01 + r * r, critical: if medium == Medium::Dense { critical } else { 0.0 } }
    }

    /// Where a cosine lies, in [0, 1].
    #[inline]
    fn place(&self, cos: f32) -> f32 {
        let dense = |x: f32, warp: f32| x * (1.0 + warp) / (x + warp);
        let [half, whole] = PARTS;
        let (c, k) = (self.critical, self.warp);
        if c <= 0.0 {
            dense(cos, k)
        } else if cos < 0.5 * c {
            half * dense(cos / (0.5 * c), k / (0.5 * c))
        } else if cos < c {
            whole - (whole - half) * dense((c - cos) / (0.5 * c), k / (0.5 * c))
        } else {
            whole + (1.0 - whole) * dense((cos - c) / (1.0 - c), k / (1.0 - c))
        }
    }

    /// The inverse of [`place`](Self::place).
    fn cos(&self, place: f32) -> f32 {
        let sparse = |y: f32, warp: f32| y * warp / (1.0 + warp - y);
        let [half, whole] = PARTS;
        let (c, k) = (self.critical, self.warp);
        let cos = if c <= 0.0 {
            sparse(place, k)
        } else if place < half {
            0.5 * c * sparse(place / half, k / (0.5 * c))
        } else if place < whole {
            c - 0.5 * c * sparse((whole - place) / (whole - half), k / (0.5 * c))
        } else {
            c + (1.0 - c) * sparse((place - whole) / (1.0 - whole), k / (1.0 - c))
        };
        cos.min(1.0)
    }
}

impl Side {
    fn new(medium: Medium, coarse_angles: usize, lattice: [usize; 2]) -> Self {
        let rule = Lattice::new(lattice);
        let mut coarse = Vec::with_capacity(COARSE[0] * COARSE[1] * coarse_angles);
        for row in 0..COARSE[0] {
            for column in 0..COARSE[1] {
                let (layout, roughness, sin) = node(medium, [row, column], COARSE);
                let eta = if medium == Medium::Dense { sin } else { sin.recip() };
                let ggx = Ggx::new(roughness);
                coarse.extend((0..coarse_angles).map(|angle| {
                    let cos = layout.cos(angle as f32 / (coarse_angles - 1) as f32);
                    ggx.map_or(0.0, |ggx| rule.missing(&ggx, eta, cos))
                }));
            }
        }
        // Each pass refines the last axis and makes it the first.
        let mut nodes = coarse;
        for (axis, count) in [(2, coarse_angles), (1, COARSE[1]), (0, COARSE[0])] {
            nodes = refined(&nodes, count, CUTS[axis]);
        }
        for node in &mut nodes {
            *node = node.clamp(0.0, 1.0);
        }
        let angles = (coarse_angles - 1) * CUTS[2] + 1;
        // All three axes have gone round: roughness, index, angle again.
        let averages = nodes.chunks(angles).enumerate().map(|(row, line)| {
            let (layout, ..) = node(medium, [row / INDICES, row % INDICES], [ROUGHNESSES, INDICES]);
            average(line, &layout).sqrt().sqrt()
        });
        let averages = averages.collect();
        Self { angles, nodes, averages }
    }
}

/// The layout, the perceptual roughness and the lower over the higher index of a node among so many.
fn node(medium: Medium, [row, column]: [usize; 2], [rows, columns]: [usize; 2]) -> (Layout, f32, f32) {
    let roughness = roughness_at(row as f32 / (rows - 1) as f32);
    let [low, high] = COSINES;
    let critical = low + (high - low) * (column as f32 / (columns - 1) as f32);
    // A hair above the least roughness, which rounding may call smooth.
    let roughness = (1.000_1 * roughness).min(1.0);
    (Layout::new(medium, critical, roughness), roughness, ((1.0 - critical) * (1.0 + critical)).sqrt())
}

/// Cuts each cell along the last axis, of `count` nodes, by cubic interpolation. That axis is the first of what comes
/// out, the others keep their order.
fn refined(nodes: &[f32], count: usize, cuts: usize) -> Vec<f32> {
    let lines = nodes.len() / count;
    let mut fine = Vec::with_capacity(lines * ((count - 1) * cuts + 1));
    for index in 0..=(count - 1) * cuts {
        let first = (index / cuts).saturating_sub(1).min(count - 4);
        let x = index as f32 / cuts as f32 - first as f32;
        let weights = [0, 1, 2, 3].map(|j| {
            let others = (0..4).filter(|&k| k != j);
            others.map(|k| (x - k as f32) / (j as f32 - k as f32)).product::<f32>()
        });
        let between = |line: &[f32]| weights.iter().zip(&line[first..]).map(|(weight, node)| weight * node).sum();
        fine.extend(nodes.chunks(count).map(|line| -> f32 { between(line) }));
    }
    fine
}

/// The cosine-weighted mean of a line that is looked up linearly.
fn average(line: &[f32], layout: &Layout) -> f32 {
    let steps = STEPS * (line.len() - 1);
    let (mut sum, mut last) = (0.0, 0.0);
    for step in 0..steps {
        let (index, t) = cell((step as f32 + 0.5) / steps as f32, line.len());
        let cos = f64::from(layout.cos((step as f32 + 1.0) / steps as f32));
        let value = line[index] + t * (line[index + 1] - line[index]);
        sum += (cos * cos - last) * f64::from(value);
        last = cos * cos;
    }
    sum.max(0.0) as f32
}

/// A rule over the spherical cap of visible normals: a lattice, since edges run across the cap in any direction, of
/// two consecutive Fibonacci numbers; dense at the rim, which holds the steep normals.
pub(super) struct Lattice {
    /// A point of the unit circle, a height and a weight.
    points: Vec<(Vec2, f32, f32)>,
}

impl Lattice {
    pub(super) fn new([count, turn]: [usize; 2]) -> Self {
        let point = |i: usize| {
            let q = (i as f32 + 0.5) / count as f32;
            // Half a turn is enough: the other is its mirror image.
            let around = unit_at(PI * ((i * turn % count) as f32 + 0.5) / count as f32);
            (around, q * q, 2.0 * q / count as f32)
        };
        Self { points: (0..count).map(point).collect() }
    }

    /// What one facet of the interface neither reflects to the near side nor refracts to the far one.
    pub(super) fn missing(&self, ggx: &Ggx, eta: f32, cos: f32) -> f32 {
        let cos = cos.clamp(1e-6, 1.0);
        let wo = Vec3::new(((1.0 - cos) * (1.0 + cos)).sqrt(), 0.0, cos);
        let mut scattered = 0.0;
        for &(around, height, weight) in &self.points {
            let m = ggx.cap_point(wo, around, height);
            let cos = wo.dot(m);
            let refracted = refract_at(cos, eta);
            let (up, down) = (2.0 * cos * m - wo, (cos / eta - refracted.cos) * m - wo / eta);
            let reflects = if up.z > 0.0 { refracted.reflectance * ggx.seen_from_both(wo, up) } else { 0.0 };
            let crosses = 1.0 - refracted.reflectance;
            let crosses = if crosses > 0.0 && down.z < 0.0 { crosses * ggx.seen_from_both(wo, down) } else { 0.0 };
            scattered += f64::from(weight * (reflects + crosses));
        }
        (1.0 - scattered) as f32
    }
}
