//! The statistical checks of this crate's tests: does a sampler follow its density, is an inverse one, is a mean the
//! truth. Each answers with a reason, so that tests can show that it rejects planted faults.
//!
//! Compiled both into the library's own tests and, by path, into the integration tests. So it uses the standard
//! library and glam only, and one name of its parent: `chi_squared_survival`.
//!
//! The χ² test of samplers follows the manner of Mitsuba 3 (Jakob et al.): cells of odd number against the integral
//! of the density over each, rare cells pooled, zero density a fault of its own, Šidák for many tests. The sum over
//! all cells is blind to a fault in a single one, so the worst cell is also held against its own Poisson law.

use super::chi_squared_survival;
use glam::{Vec2, Vec3};
use std::f64::consts::PI;

/// Chance at which all χ² tests of one family together may reject what is right.
const SIGNIFICANCE: f64 = 0.01;

/// Expected hits below which a cell is pooled with others: Cochran's rule.
const POOL_BELOW: f64 = 5.0;

/// How far the integral of a density may lie from 1.
const TOTAL_TOLERANCE: f64 = 1e-3;

/// A small source of pseudo-random numbers: SplitMix64 (Steele, Lea and Flood 2014).
pub(crate) struct Random(u64);

impl Random {
    /// The sequence that belongs to `seed`.
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// The next number in [0, 1), a multiple of 2⁻²⁴.
    pub(crate) fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / 16_777_216.0
    }

    /// The next point in [0, 1)².
    pub(crate) fn square(&mut self) -> Vec2 {
        Vec2::new(self.unit(), self.unit())
    }

    /// The next direction, uniform over the sphere, unit length.
    pub(crate) fn direction(&mut self) -> Vec3 {
        loop {
            let v = 2.0 * Vec3::new(self.unit(), self.unit(), self.unit()) - Vec3::ONE;
            if (1e-4..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}

/// Where samples lie, and how a pair of coordinates in [0, 1]² covers it with equal areas.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Domain {
    /// The plane rectangle from the first corner to the second; z is 0 and ignored. Density per area.
    Plane(Vec2, Vec2),
    /// The unit sphere, by longitude and height. Density per solid angle.
    Sphere,
}

impl Domain {
    fn area(self) -> f64 {
        match self {
            Self::Plane(low, high) => f64::from((high - low).element_product()),
            Self::Sphere => 4.0 * PI,
        }
    }

    fn point(self, s: [f64; 2]) -> Vec3 {
        match self {
            Self::Plane(low, high) => (low + Vec2::new(s[0] as f32, s[1] as f32) * (high - low)).extend(0.0),
            Self::Sphere => {
                let (sin, cos) = (2.0 * PI * s[0]).sin_cos();
                let z = 2.0 * s[1] - 1.0;
                let r = (1.0 - z * z).max(0.0).sqrt();
                Vec3::new((r * cos) as f32, (r * sin) as f32, z as f32)
            }
        }
    }

    fn coordinates(self, p: Vec3) -> [f64; 2] {
        match self {
            Self::Plane(low, high) => {
                let s = (p.truncate() - low) / (high - low);
                [f64::from(s.x), f64::from(s.y)]
            }
            Self::Sphere => {
                let turn = f64::from(p.y).atan2(f64::from(p.x)) / (2.0 * PI);
                [turn - turn.floor(), 0.5 * (f64::from(p.z) + 1.0)]
            }
        }
    }
}

/// A χ² test of a sampler on a two-dimensional domain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChiSquared {
    /// Where samples lie.
    pub(crate) domain: Domain,
    /// Cells along each coordinate; odd, so that none ends on an equator.
    pub(crate) cells: [usize; 2],
    /// How many samples are drawn.
    pub(crate) samples: usize,
    /// Of the random numbers.
    pub(crate) seed: u64,
    /// How many tests make one family, which together reject what is right in 1 of 100 cases (Šidák 1967).
    pub(crate) family: usize,
}

/// Why a sampler was rejected.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Rejection {
    /// A sample or its density is not finite, or lies outside the domain.
    Sample(Vec3, f64),
    /// A sample where the density is zero or negative.
    ZeroDensity(Vec3),
    /// The density does not integrate to 1 but to this.
    Total(f64),
    /// Too few cells to decide anything: this many.
    Vacuous(usize),
    /// The counts do not follow the density: with this p-value, below what was asked.
    Counts(f64),
}

impl ChiSquared {
    /// A test over `domain` that suits most samplers: 51 × 25 cells, 200 000 samples.
    pub(crate) fn over(domain: Domain) -> Self {
        Self { domain, cells: [51, 25], samples: 200_000, seed: 1, family: 32 }
    }

    /// Draws samples and holds their counts against the integrals of `pdf` over the cells. Returns the p-value, or a
    /// bound on it.
    pub(crate) fn run(&self, sample: impl Fn(Vec2) -> Vec3, pdf: impl Fn(Vec3) -> f64) -> Result<f64, Rejection> {
        let counts = self.counts(sample, &pdf)?;
        let expected = self.expected(&pdf);
        let total = expected.iter().sum::<f64>() / self.samples as f64;
        if (total - 1.0).abs().partial_cmp(&TOTAL_TOLERANCE) != Some(std::cmp::Ordering::Less) {
            return Err(Rejection::Total(total));
        }
        let pooled = pool(&counts, &expected);
        if pooled.len() < 10 {
            return Err(Rejection::Vacuous(pooled.len()));
        }
        let statistic: f64 = pooled.iter().map(|(count, mean)| (count - mean).powi(2) / mean).sum();
        let all = chi_squared_survival(statistic, (pooled.len() - 1) as f64);
        let worst = pooled.iter().map(|&(count, mean)| poisson(count, mean)).fold(1.0, f64::min);
        // Two tests, the second of as many cells: Bonferroni.
        let p = (2.0 * all.min(worst * pooled.len() as f64)).min(1.0);
        if p > 1.0 - (1.0 - SIGNIFICANCE).powf(1.0 / self.family as f64) { Ok(p) } else { Err(Rejection::Counts(p)) }
    }

    fn counts(&self, sample: impl Fn(Vec2) -> Vec3, pdf: impl Fn(Vec3) -> f64) -> Result<Vec<f64>, Rejection> {
        let mut random = Random::new(self.seed);
        let mut counts = vec![0.0; self.cells[0] * self.cells[1]];
        for _ in 0..self.samples {
            let p = sample(random.square());
            let density = pdf(p);
            let s = self.domain.coordinates(p);
            // Rounding may carry a sample over the rim of its domain, by no more than this.
            if !(density.is_finite() && s.iter().all(|s| (-1e-6..=1.0 + 1e-6).contains(s))) {
                return Err(Rejection::Sample(p, density));
            }
            if density <= 0.0 {
                return Err(Rejection::ZeroDensity(p));
            }
            let cell = |i: usize| ((s[i].max(0.0) * self.cells[i] as f64) as usize).min(self.cells[i] - 1);
            counts[cell(1) * self.cells[0] + cell(0)] += 1.0;
        }
        Ok(counts)
    }

    fn expected(&self, pdf: impl Fn(Vec3) -> f64) -> Vec<f64> {
        let scale = self.domain.area() * self.samples as f64;
        let density = |s: [f64; 2]| scale * pdf(self.domain.point(s));
        let step = self.cells.map(|n| 1.0 / n as f64);
        let cells = (0..self.cells[1]).flat_map(|j| (0..self.cells[0]).map(move |i| [i as f64, j as f64]));
        // A tenth of a hit in a cell is far below its own noise.
        cells.map(|c| integrate(&density, [c[0] * step[0], c[1] * step[1]], step, 0.01)).collect()
    }
}

/// Counts and expected counts, rare cells pooled. The last pool may be a rare one and then joins the one before.
fn pool(counts: &[f64], expected: &[f64]) -> Vec<(f64, f64)> {
    let mut order: Vec<usize> = (0..counts.len()).collect();
    order.sort_by(|&a, &b| expected[b].total_cmp(&expected[a]));
    let mut pools: Vec<(f64, f64)> = Vec::new();
    let mut open = (0.0, 0.0);
    for i in order {
        open = (open.0 + counts[i], open.1 + expected[i]);
        if open.1 >= POOL_BELOW {
            pools.push(open);
            open = (0.0, 0.0);
        }
    }
    if let Some(last) = pools.last_mut() {
        *last = (last.0 + open.0, last.1 + open.1);
    }
    pools
}

/// The probability that a Poisson variable of this mean lies as far out as `count`, on either side.
fn poisson(count: f64, mean: f64) -> f64 {
    let at_most = chi_squared_survival(2.0 * mean, 2.0 * (count + 1.0));
    let at_least = if count > 0.0 { 1.0 - chi_squared_survival(2.0 * mean, 2.0 * count) } else { 1.0 };
    (2.0 * at_most.min(at_least)).min(1.0)
}

/// The integral of `f` over the rectangle at `low` of size `step`, cut into quarters until these agree with the whole
/// to `tolerance`, or nine times.
pub(crate) fn integrate(f: &impl Fn([f64; 2]) -> f64, low: [f64; 2], step: [f64; 2], tolerance: f64) -> f64 {
    fn refine(f: &impl Fn([f64; 2]) -> f64, (low, step): ([f64; 2], [f64; 2]), whole: f64, left: (f64, u32)) -> f64 {
        let half = step.map(|s| 0.5 * s);
        let quarters = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
            .map(|q| [low[0] + q[0] * half[0], low[1] + q[1] * half[1]])
            .map(|low| (low, gauss(f, low, half)));
        let sum: f64 = quarters.iter().map(|q| q.1).sum();
        if left.1 == 0 || (sum - whole).abs() <= left.0 {
            return sum;
        }
        // Half the tolerance, not a quarter: where the density jumps, errors of the parts do not add up.
        quarters.iter().map(|&(low, part)| refine(f, (low, half), part, (0.5 * left.0, left.1 - 1))).sum()
    }
    refine(f, (low, step), gauss(f, low, step), (tolerance, 8))
}

/// Gauss–Legendre with three points along each side.
fn gauss(f: &impl Fn([f64; 2]) -> f64, low: [f64; 2], step: [f64; 2]) -> f64 {
    let offset = 0.5 * 0.6_f64.sqrt();
    let rule = [(0.5 - offset, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + offset, 5.0 / 18.0)];
    let pairs = rule.iter().flat_map(|x| rule.iter().map(move |y| (x, y)));
    let sum: f64 = pairs.map(|(x, y)| x.1 * y.1 * f([low[0] + x.0 * step[0], low[1] + y.0 * step[1]])).sum();
    sum * step[0] * step[1]
}

/// Whether `inverse` undoes `map` over the whole square, to `tolerance` in each coordinate: the worst point and its
/// distance if not. Points where the inverse has no answer (NaN) are such.
pub(crate) fn round_trip(
    map: impl Fn(Vec2) -> Vec3,
    inverse: impl Fn(Vec3) -> Vec2,
    tolerance: f32,
) -> Result<(), (Vec2, f32)> {
    let mut random = Random::new(7);
    let grid = (0..=32).flat_map(|i| (0..=32).map(move |j| Vec2::new(i as f32, j as f32) / 32.5));
    let mut worst = (Vec2::ZERO, 0.0);
    for u in grid.chain((0..10_000).map(|_| random.square())) {
        let distance = (inverse(map(u)) - u).abs().max_element();
        if distance.is_nan() || distance > worst.1 {
            worst = (u, distance);
        }
        if distance.is_nan() {
            break;
        }
    }
    if worst.1 <= tolerance { Ok(()) } else { Err(worst) }
}

/// Whether a mean agrees with the truth: |mean − truth| + 4 standard errors ≤ tolerance. An estimate too noisy to
/// tell fails, and so does NaN.
pub(crate) fn mean_within(mean: f64, standard_error: f64, truth: f64, tolerance: f64) -> Result<(), String> {
    let bound = (mean - truth).abs() + 4.0 * standard_error;
    if bound <= tolerance && standard_error >= 0.0 {
        return Ok(());
    }
    Err(format!("mean {mean} ± {standard_error} against {truth}: {bound} is not within {tolerance}"))
}

/// Mean and standard error of independent values; of fewer than 16 none is known.
pub(crate) fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, if values.len() < 16 { f64::INFINITY } else { (variance / n).sqrt() })
}

/// Panics unless the mean of independent `values` agrees with `truth` by [`mean_within`].
#[track_caller]
pub(crate) fn assert_mean(values: &[f64], truth: f64, tolerance: f64) {
    let (mean, error) = mean_and_error(values);
    if let Err(reason) = mean_within(mean, error, truth, tolerance) {
        panic!("{reason} ({} values)", values.len());
    }
}
