//! Straight lines through curves on logarithmic axes: how fast an error falls, and what one costs.

use super::truth::GROUPS;
use crate::math::Portable;

/// Fewest points that a line is laid through.
const LEAST_POINTS: usize = 3;

/// Errors that a price is given for.
pub const PRICED_ERRORS: [f64; 5] = [0.10, 0.05, 0.02, 0.01, 0.005];

/// How fast an error falls on logarithmic axes: −½ for plain Monte Carlo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// The slope.
    pub value: f64,
    /// Its standard error, from leaving out each of sixteen groups of receivers in turn (Tukey's jackknife).
    pub stderr: f64,
}

/// What an error costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Price {
    /// Root mean square error over the mean.
    pub error: f64,
    /// What it takes.
    pub cost: Cost,
}

/// A time, and how it is known. Processor seconds for the whole lightmap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cost {
    /// Between two points of the curve [s].
    Measured(f64),
    /// No more than the first point took [s].
    AtMost(f64),
    /// By the fitted slope, beyond the last point [s].
    Extrapolated(f64),
    /// More paths do not lead there.
    Never,
}

impl Cost {
    /// The time, where there is one [s].
    pub fn seconds(self) -> Option<f64> {
        match self {
            Self::Measured(seconds) | Self::AtMost(seconds) | Self::Extrapolated(seconds) => Some(seconds),
            Self::Never => None,
        }
    }
}

/// The least-squares slope of log y over log x; `None` for fewer than three points, or where one has no logarithm.
pub(super) fn slope(points: &[[f64; 2]]) -> Option<f64> {
    if points.len() < LEAST_POINTS || points.iter().flatten().any(|value| !(value.is_finite() && *value > 0.0)) {
        return None;
    }
    let logs: Vec<[f64; 2]> = points.iter().map(|point| point.map(Portable::ln)).collect();
    let count = logs.len() as f64;
    let [x, y] = [0, 1].map(|axis| logs.iter().map(|point| point[axis]).sum::<f64>() / count);
    let across: f64 = logs.iter().map(|point| (point[0] - x) * (point[0] - x)).sum();
    let both: f64 = logs.iter().map(|point| (point[0] - x) * (point[1] - y)).sum();
    (across > 0.0).then(|| both / across)
}

/// The slope through points whose errors are known for all receivers and without each group of them. Points of one
/// curve share paths, so that residuals from the line would say too little of its error.
pub(super) fn jackknifed(all: &[[f64; 2]], without: &[[f64; GROUPS]]) -> Option<Slope> {
    let value = slope(all)?;
    let slopes: Option<Vec<f64>> = (0..GROUPS)
        .map(|group| {
            let points: Vec<[f64; 2]> =
                all.iter().zip(without).map(|(point, errors)| [point[0], errors[group]]).collect();
            slope(&points)
        })
        .collect();
    let slopes = slopes?;
    let count = GROUPS as f64;
    let mean = slopes.iter().sum::<f64>() / count;
    let squares: f64 = slopes.iter().map(|slope| (slope - mean) * (slope - mean)).sum();
    Some(Slope { value, stderr: ((count - 1.0) / count * squares).sqrt() })
}

/// What an error costs on a curve of times and errors, the first the cheapest. `floor` is what no number of paths gets
/// below.
pub(super) fn cost(curve: &[[f64; 2]], floor: f64, error: f64) -> Cost {
    let Some(reached) = curve.iter().position(|point| point[1] <= error) else {
        let (Some(last), Some(slope)) = (curve.last(), slope(curve)) else { return Cost::Never };
        if floor >= error || slope >= 0.0 {
            return Cost::Never;
        }
        return Cost::Extrapolated(last[0] * Portable::powf(error / last[1], 1.0 / slope));
    };
    let Some([before, after]) = reached.checked_sub(1).map(|before| [curve[before], curve[reached]]) else {
        return Cost::AtMost(curve[0][0]);
    };
    let share = Portable::ln(before[1] / error) / Portable::ln(before[1] / after[1]);
    Cost::Measured(before[0] * Portable::powf(after[0] / before[0], share))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn falling(power: f64) -> Vec<[f64; 2]> {
        (0..8).map(|step| f64::from(16 << step)).map(|paths| [paths, 0.4 * paths.powf(power)]).collect()
    }

    #[test]
    fn slopes_are_fitted_right() {
        for power in [-0.5, -1.0, -0.75] {
            assert!((slope(&falling(power)).unwrap() - power).abs() < 1e-12);
        }
        assert_eq!(slope(&falling(-0.5)[..2]), None);
        let mut black = falling(-0.5);
        black[3][1] = 0.0;
        assert_eq!(slope(&black), None);
    }

    #[test]
    fn a_slope_is_as_sure_as_its_groups_agree() {
        let all = falling(-0.5);
        let alike: Vec<[f64; GROUPS]> = all.iter().map(|point| [point[1]; GROUPS]).collect();
        let sure = jackknifed(&all, &alike).unwrap();
        assert!((sure.value + 0.5).abs() < 1e-12 && sure.stderr < 1e-12, "{sure:?}");
        // Every second group falls faster by a little.
        let split = |point: &[f64; 2]| -> [f64; GROUPS] {
            std::array::from_fn(|group| point[1] * point[0].powf(if group % 2 == 0 { 0.01 } else { -0.01 }))
        };
        let unsure = jackknifed(&all, &all.iter().map(split).collect::<Vec<_>>()).unwrap();
        // Slopes of ±0.01 about the mean: √(15/16 · 16 · 0.01²).
        assert!((unsure.stderr - 15.0_f64.sqrt() * 0.01).abs() < 1e-9, "{unsure:?}");
    }

    #[test]
    fn prices_lie_on_the_curve_or_are_marked() {
        // The error is 0.4 / √t: 10 % at 16.
        let curve = falling(-0.5);
        let measured = |error: f64, seconds: f64| match cost(&curve, 0.0, error) {
            Cost::Measured(found) => assert!((found / seconds - 1.0).abs() < 1e-9, "{found} {seconds}"),
            other => panic!("{error}: {other:?}"),
        };
        measured(0.05, 64.0);
        measured(0.04, 100.0);
        assert_eq!(cost(&curve, 0.0, 0.2), Cost::AtMost(16.0));
        let Cost::Extrapolated(seconds) = cost(&curve, 0.0, 0.004) else { panic!() };
        assert!((seconds / 10_000.0 - 1.0).abs() < 1e-9, "{seconds}");
        assert_eq!(cost(&curve, 0.02, 0.004), Cost::Never);
        let flat: Vec<[f64; 2]> = (1..5).map(|step| [f64::from(step), 0.3]).collect();
        assert_eq!(cost(&flat, 0.0, 0.1), Cost::Never);
        assert_eq!(cost(&[], 0.0, 0.1), Cost::Never);
    }
}
