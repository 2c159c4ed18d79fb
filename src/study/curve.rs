//! A curve: the error of one technique after more and more paths, its slope, its floor and its prices.

use super::fit::{Cost, PRICED_ERRORS, Price, Slope, cost, jackknifed};
use super::technique::Technique;
use super::truth::{Difference, GROUPS, Standing, Truth};

/// What one technique costs.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The technique.
    pub technique: Technique,
    /// From few paths to many.
    pub points: Vec<Point>,
    /// Over paths, of the points that are known; `None` for fewer than three.
    pub slope: Option<Slope>,
    /// Over processor time.
    pub slope_over_time: Option<Slope>,
    /// What is left of the error with any number of paths; `None` where nothing is.
    pub floor: Option<Floor>,
    /// What errors cost.
    pub prices: Vec<Price>,
}

/// An error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Paths from each texel.
    pub paths: u32,
    /// Processor time of the whole lightmap [s].
    pub cpu_seconds: f64,
    /// Root mean square error over the mean of the reference, by luminance.
    pub error: f64,
    /// How far it can be trusted.
    pub standing: Standing,
}

/// What a biased technique does not get below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floor {
    /// Root mean square error over the mean of the reference, without noise.
    pub error: f64,
    /// Share of the mean light that is missing.
    pub missing: f64,
}

/// What was measured after some paths, before there is a reference to compare it with.
pub(super) struct Snapshot {
    pub(super) paths: u32,
    /// Of the whole lightmap [s].
    pub(super) cpu_seconds: f64,
    /// Per receiver [cd/m²].
    pub(super) means: Vec<f64>,
    /// Variances of these, where they are known.
    pub(super) variances: Vec<f64>,
}

/// All that was measured of one technique.
pub(super) struct Trail {
    pub(super) technique: Technique,
    pub(super) snapshots: Vec<Snapshot>,
}

impl Trail {
    /// Held against the reference.
    pub(super) fn curve(&self, truth: &Truth) -> Curve {
        let differences: Vec<Difference> =
            self.snapshots.iter().map(|snapshot| truth.compare(&snapshot.means)).collect();
        let point = |(snapshot, difference): (&Snapshot, &Difference)| Point {
            paths: snapshot.paths,
            cpu_seconds: snapshot.cpu_seconds,
            error: difference.error(),
            standing: difference.standing(),
        };
        let points: Vec<Point> = self.snapshots.iter().zip(&differences).map(point).collect();
        let is_known = |point: &Point| point.standing == Standing::Known;
        // What lies behind the first unknown point is none the better for a lucky number.
        let known = points.iter().take_while(|point| is_known(point)).count();
        let without: Vec<[f64; GROUPS]> = differences[..known]
            .iter()
            .map(|difference| std::array::from_fn(|group| difference.error_without(group)))
            .collect();
        let over = |abscissa: fn(&Point) -> f64| -> Vec<[f64; 2]> {
            points[..known].iter().map(|point| [abscissa(point), point.error]).collect()
        };
        let over_paths = over(|point| f64::from(point.paths));
        let over_time = over(|point| point.cpu_seconds);
        let floor = self.floor(truth);
        let least = floor.map_or(0.0, |floor| floor.error);
        let price = |error| Price { error, cost: cost(&over_time, least, error) };
        Curve {
            technique: self.technique,
            slope: jackknifed(&over_paths, &without),
            slope_over_time: jackknifed(&over_time, &without),
            prices: PRICED_ERRORS.into_iter().map(price).collect(),
            floor,
            points,
        }
    }

    fn floor(&self, truth: &Truth) -> Option<Floor> {
        let last = self.snapshots.last().filter(|last| last.variances.len() == last.means.len())?;
        let has_floor = matches!(self.technique, Technique::Capped(_) | Technique::Reused);
        let mean = last.means.iter().sum::<f64>() / last.means.len().max(1) as f64;
        let floor = || Floor { error: truth.floor(&last.means, &last.variances), missing: 1.0 - mean / truth.mean() };
        has_floor.then(floor)
    }
}

impl Curve {
    /// What an error costs, of those that have a price.
    pub fn price(&self, error: f64) -> Option<Cost> {
        self.prices.iter().find(|price| price.error == error).map(|price| price.cost)
    }
}
