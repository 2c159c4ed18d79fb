//! What must hold of intervals and of texels that were sampled to a target.

use crate::reference::Known;
use bevy_kiln::bake::Lightmap;
use bevy_kiln::math::luminance;
use std::fmt;

/// One bake beside the truth.
#[derive(Clone, Debug)]
pub struct Truth {
    texels: Vec<Texel>,
    floor: f64,
    target: f64,
    samples: f64,
}

/// A texel beside the truth.
#[derive(Clone, Copy, Debug)]
pub struct Texel {
    /// How far it is off [cd/m²].
    pub off: f64,
    /// Half-width of its 95 % interval [cd/m²].
    pub half_width: f64,
    /// Its true value [cd/m²].
    pub truth: f64,
    /// Half-width of the reference's [cd/m²].
    pub long: f64,
}

impl Truth {
    /// The same texels, had each been left at another value and interval.
    pub fn left_at(&self, known: &[Known], left: impl Fn(&Known) -> [f64; 2]) -> Self {
        let texel = |(known, texel): (&Known, &Texel)| {
            let [value, half_width] = left(known);
            Texel { off: value - known.value, half_width, ..*texel }
        };
        Self { texels: known.iter().zip(&self.texels).map(texel).collect(), ..self.clone() }
    }

    pub fn new(lightmap: &Lightmap, known: &[Known]) -> Self {
        let page = &lightmap.pages[0];
        let texel = |known: &Known| Texel {
            off: luminance(page.raw[known.texel].as_dvec3()) - known.value,
            half_width: page.half_width[known.texel].into(),
            truth: known.value,
            long: known.half_width,
        };
        let intervals = &lightmap.report.intervals;
        Self {
            texels: known.iter().map(texel).collect(),
            floor: intervals.floor,
            target: intervals.target.unwrap_or(f64::INFINITY),
            samples: lightmap.report.samples as f64 / lightmap.report.texels as f64,
        }
    }
}

/// What was seen of several bakes.
#[derive(Clone, Copy, Debug)]
pub struct Calibration {
    /// Share of the texels whose interval holds the truth, and the standard error of that by the spread of the bakes.
    pub covered: [f64; 2],
    /// Share that is off by more than the target.
    pub exceeding: f64,
    /// Mean half-width over 1.96 times the true root of the mean square error.
    pub width: f64,
    /// Mean error over the mean value, and its standard error.
    pub bias: [f64; 2],
    /// The reference's mean half-width over the value, by the same floor.
    pub long: f64,
    /// The bakes' own.
    pub own: f64,
    /// Mean paths of a texel.
    pub samples: f64,
}

impl Calibration {
    pub fn of(bakes: &[Truth]) -> Self {
        let count = bakes.len() as f64;
        let mean = |of: &dyn Fn(&Truth) -> f64| bakes.iter().map(of).sum::<f64>() / count;
        let with_error = |of: &dyn Fn(&Truth) -> f64| {
            let centre = mean(of);
            let squares = bakes.iter().map(|bake| (of(bake) - centre).powi(2)).sum::<f64>();
            [centre, (squares / (count * (count - 1.0))).sqrt()]
        };
        let of_texels = |of: fn(&Truth, &Texel) -> f64| {
            move |bake: &Truth| bake.texels.iter().map(|texel| of(bake, texel)).sum::<f64>() / bake.texels.len() as f64
        };
        let squares = mean(&of_texels(|_, texel| texel.off.powi(2)));
        // What the reference is off by is no error of the bake.
        let of_reference = mean(&of_texels(|_, texel| (texel.long / 1.96).powi(2)));
        let total = mean(&of_texels(|_, texel| texel.truth));
        let covered = |_: &Truth, texel: &Texel| if texel.off.abs() <= texel.half_width { 1.0 } else { 0.0 };
        let [bias, bias_error] = with_error(&of_texels(|_, texel| texel.off));
        Self {
            covered: with_error(&of_texels(covered)),
            exceeding: mean(&of_texels(|bake, texel| {
                if texel.off.abs() > bake.target * texel.truth.max(bake.floor) { 1.0 } else { 0.0 }
            })),
            width: mean(&of_texels(|_, texel| texel.half_width)) / (1.96 * (squares - of_reference).max(0.0).sqrt()),
            bias: [bias / total, bias_error / total],
            long: mean(&of_texels(|bake, texel| texel.long / texel.truth.max(bake.floor))),
            own: mean(&of_texels(|bake, texel| texel.half_width / texel.truth.max(bake.floor))),
            samples: mean(&|bake| bake.samples),
        }
    }
}

/// What must hold of intervals at a fixed number of paths.
pub fn faults_of_intervals(seen: &Calibration) -> Vec<String> {
    let [covered, error] = seen.covered;
    // Four standard errors counted in, or too few bakes would pass for good ones.
    let is_off = covered - 4.0 * error < 0.93 || covered + 4.0 * error > 0.97;
    is_off.then(|| format!("{:.2} ± {:.2} % are covered", 100.0 * covered, 100.0 * error)).into_iter().collect()
}

/// What must hold of texels that were sampled until they were known to `target`.
pub fn faults_of_target(seen: &Calibration, target: f64) -> Vec<String> {
    let [covered, error] = seen.covered;
    let [bias, bias_error] = seen.bias;
    let mut faults = Vec::new();
    if covered - 4.0 * error < 0.93 {
        faults.push(format!("{:.2} ± {:.2} % are covered", 100.0 * covered, 100.0 * error));
    }
    if seen.width > 1.5 {
        faults.push(format!("intervals are {:.2} times as wide as the error", seen.width));
    }
    if seen.exceeding > 0.07 {
        faults.push(format!("{:.2} % exceed the target", 100.0 * seen.exceeding));
    }
    if bias.abs() + 4.0 * bias_error > 0.1 * target {
        faults.push(format!("the mean is off by {:.3} ± {:.3} %", 100.0 * bias, 100.0 * bias_error));
    }
    if seen.long > 0.1 * target {
        faults.push(format!("the reference is only known to {:.3} %", 100.0 * seen.long));
    }
    faults
}

impl fmt::Display for Calibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |share: f64| 100.0 * share;
        write!(
            f,
            "covered {:.2} ± {:.2} %, exceeding {:.2} %, width {:.3}, bias {:+.3} ± {:.3} %, own {:.2} %, reference {:.3} %, {:.0} paths",
            percent(self.covered[0]),
            percent(self.covered[1]),
            percent(self.exceeding),
            self.width,
            percent(self.bias[0]),
            percent(self.bias[1]),
            percent(self.own),
            percent(self.long),
            self.samples
        )
    }
}
