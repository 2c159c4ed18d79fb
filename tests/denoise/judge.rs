//! Errors and contrasts of a page against a long reference.

use crate::reference::Reference;
use bevy_kiln::bake::{Page, TexelState};
use glam::{DVec3, Vec3};

/// Steps to the eight neighbours.
const STEPS: [[i32; 2]; 8] = [[1, 0], [0, 1], [-1, 0], [0, -1], [1, 1], [-1, 1], [1, -1], [-1, -1]];

/// An error over a page, by luminance; the reference's own is taken out.
#[derive(Clone, Copy, Debug)]
pub struct Error {
    /// Root of the mean square over the mean of the reference.
    pub root: f64,
    /// Mean of the errors, each over its texel's light or a twentieth of the mean; times √(π/2), so that of normal
    /// errors it is the mean standard error.
    pub relative: f64,
}

pub struct Judge<'a> {
    page: &'a Page,
    reference: &'a Reference,
    /// Measured texels.
    texels: Vec<usize>,
    /// Mean light of the reference.
    mean: f64,
}

fn luminance(value: Vec3) -> f64 {
    value.as_dvec3().dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

impl<'a> Judge<'a> {
    pub fn new(page: &'a Page, reference: &'a Reference) -> Self {
        assert_eq!(page.raw.len(), reference.value.len(), "the reference is of another page");
        let texels: Vec<usize> =
            (0..page.raw.len()).filter(|&index| page.state[index] == TexelState::Measured).collect();
        let mean = texels.iter().map(|&index| luminance(reference.value[index])).sum::<f64>() / texels.len() as f64;
        Self { page, reference, texels, mean }
    }

    fn average(&self, of: impl Fn(usize) -> f64) -> f64 {
        self.texels.iter().map(|&index| of(index)).sum::<f64>() / self.texels.len() as f64
    }

    /// Root of the mean square of the reference's own error over its mean.
    pub fn error_of_reference(&self) -> f64 {
        self.average(|index| self.reference.stderr[index].powi(2)).sqrt() / self.mean
    }

    pub fn error(&self, values: &[Vec3]) -> Error {
        let off = |index: usize| luminance(values[index] - self.reference.value[index]);
        let square = self.average(|index| off(index).powi(2) - self.reference.stderr[index].powi(2));
        let light = |index: usize| luminance(self.reference.value[index]).max(0.05 * self.mean);
        let relative = self.average(|index| off(index).abs() / light(index));
        Error { root: square.max(0.0).sqrt() / self.mean, relative: relative * std::f64::consts::FRAC_PI_2.sqrt() }
    }

    pub fn total(&self, values: &[Vec3]) -> f64 {
        self.average(|index| luminance(values[index]))
    }

    /// The measured texel of the same chart at a step.
    fn beside(&self, index: usize, step: [i32; 2], state: TexelState) -> Option<usize> {
        let width = self.page.width as i32;
        let [x, y] = [index as i32 % width + step[0], index as i32 / width + step[1]];
        let is_inside = (0..width).contains(&x) && (0..self.page.height as i32).contains(&y);
        let other = (y * width + x) as usize;
        let is_it = || self.page.state[other] == state && self.page.chart[other] == self.page.chart[index];
        (is_inside && is_it()).then_some(other)
    }

    /// Differences across shadow edges and away from what stands on a surface, as a share of the reference's.
    pub fn contrasts(&self, values: &[Vec3]) -> [f64; 2] {
        [
            self.contrast(values, 0.15, |index, step| self.edge(index, step)),
            self.contrast(values, 0.05, |index, step| self.contact(index, step)),
        ]
    }

    /// The texels on both sides of one, in its row or its column.
    fn edge(&self, index: usize, [x, y]: [i32; 2]) -> Option<[usize; 2]> {
        let measured = TexelState::Measured;
        // Each pair once.
        (x * y == 0 && x + y > 0).then_some(())?;
        Some([self.beside(index, [x, y], measured)?, self.beside(index, [-x, -y], measured)?])
    }

    /// A texel at the foot of something, and the third one from it. In all eight directions: in four there are too few
    /// to be told from their noise.
    fn contact(&self, index: usize, [x, y]: [i32; 2]) -> Option<[usize; 2]> {
        let is_dark = |texel: usize| luminance(self.reference.value[texel]) < 1e-3 * self.mean;
        let below =
            self.beside(index, [-x, -y], TexelState::Measured).filter(|&texel| is_dark(texel) && !is_dark(index));
        below.or_else(|| self.beside(index, [-x, -y], TexelState::Hidden))?;
        Some([index, self.beside(index, [3 * x, 3 * y], TexelState::Measured)?])
    }

    fn contrast(&self, values: &[Vec3], least: f64, pair: impl Fn(usize, [i32; 2]) -> Option<[usize; 2]>) -> f64 {
        let (mut found, mut truth, mut count) = (0.0, 0.0, 0);
        for &index in &self.texels {
            for step in STEPS {
                let Some([one, other]) = pair(index, step) else { continue };
                let [a, b] = [one, other].map(|texel| luminance(self.reference.value[texel]));
                // By the reference alone, or noise would choose.
                if (a - b).abs() > least * (a + b) {
                    truth += (a - b).abs();
                    found += (a - b).signum() * luminance(values[one] - values[other]);
                    count += 1;
                }
            }
        }
        assert!(count >= 12, "only {count} pairs of texels");
        found / truth
    }
}

/// A page under a Gaussian blur of a width [texels] that stays within each chart: what a denoiser must not be.
pub fn blurred(page: &Page, width: f32) -> Vec<Vec3> {
    let judge = Judge { page, reference: &Reference::default(), texels: Vec::new(), mean: 0.0 };
    let blur = |index: usize| {
        let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
        for step in (-4..=4).flat_map(|y| (-4..=4).map(move |x| [x, y])) {
            let Some(other) = judge.beside(index, step, TexelState::Measured) else { continue };
            let weight = (-((step[0] * step[0] + step[1] * step[1]) as f32) / (2.0 * width * width)).exp();
            sum += weight * page.raw[other];
            weights += weight;
        }
        if weights > 0.0 { sum / weights } else { page.raw[index] }
    };
    (0..page.raw.len()).map(blur).collect()
}
