//! A few tiles sampled beforehand: how bright the scene is, and what an error will cost in time.
//!
//! Tiles come in an order of chance, so the first of them stand for all. Their texels go through the first rounds as in
//! the bake ([`super::tiles`]). An error that these reach is priced by what they did; for a smaller one the widths of
//! the last round are carried on as a power of the paths, whose exponent is that of the rounds before, since Sobol's
//! points beat the root of the number by as much as the light is smooth. Nothing but times depends on the clock.

use super::plan::Prediction;
use super::sites::Site;
use super::tiles::{ErrorTarget, LEAST_PATHS, Looks, MOST_PATHS, Rounds, Tile, after};
use super::workers::Workers;
use super::{BakeError, CancelToken, DARK};
use crate::math::Portable;
use crate::trace::{Tracer, Transport};
use cpu_time::ThreadTime;
use std::time::Instant;

/// Share of the texels that are surveyed, and how many at least and at most.
const SHARE: usize = 16;
const LEAST_TEXELS: usize = 1024;
const MOST_TEXELS: usize = 8192;

/// Rounds of the survey.
const ROUNDS: usize = 3;

/// Between which the exponent lies that widths fall with: by chance it may come out as none that light has.
const EXPONENTS: [f64; 2] = [0.4, 0.8];

/// Errors that a price is given for.
const PRICED_ERRORS: [f64; 5] = [0.10, 0.05, 0.02, 0.01, 0.005];

/// Between which errors one is looked for that fits a time, and in how many halvings.
const ERRORS: [f64; 2] = [1e-4, 1.0];
const HALVINGS: u32 = 40;

/// Share of the time that tracing may take by the prediction: the rest of a bake takes some as well.
const TRACING: f64 = 0.9;

/// What there is to survey.
pub(super) struct Surveyed<'a> {
    pub(super) tiles: &'a [Tile],
    pub(super) sites: &'a [Site],
    pub(super) tracer: &'a Tracer,
}

/// What was learnt.
#[derive(Clone, Debug)]
pub(super) struct Survey {
    /// By groups, the texels of each having the same number of paths.
    groups: Vec<Vec<Texel>>,
    /// How many texels of the bake each stands for.
    stands_for: f64,
    /// Time that passes for a second of processor time: less than one where there are several threads.
    wall_per_cpu: f64,
    exponent: f64,
    /// Mean luminance [cd/m²].
    mean: f64,
}

/// A texel after each round.
#[derive(Clone, Copy, Debug)]
struct Texel {
    value: f64,
    half_widths: [f64; ROUNDS],
    /// Processor time of a path [s].
    seconds_per_path: f64,
}

fn paths_of(round: usize) -> u32 {
    LEAST_PATHS << round
}

impl Surveyed<'_> {
    /// Samples the first tiles.
    pub(super) fn survey(&self, transport: &Transport, workers: &Workers<'_>) -> Result<Survey, BakeError> {
        let wanted = (self.sites.len() / SHARE).clamp(LEAST_TEXELS, MOST_TEXELS);
        let mut texels = 0;
        let is_wanted = |tile: &&Tile| {
            let before = texels;
            texels += tile.sites.len();
            before < wanted
        };
        let few: Vec<&Tile> = self.tiles.iter().take_while(is_wanted).collect();
        let clock = Instant::now();
        let of_tiles = workers.gather_quietly(&few, |tile, cancel| self.of_tile(tile, transport, cancel))?;
        let wall = clock.elapsed().as_secs_f64();
        Ok(Survey::new(of_tiles.into_iter().flatten().collect(), self.sites.len(), wall))
    }

    fn of_tile(&self, tile: &Tile, transport: &Transport, cancel: &CancelToken) -> Option<Vec<Vec<Texel>>> {
        let clock = ThreadTime::now();
        let mut rounds = Rounds::new(tile, self.sites, self.tracer, transport);
        let mut half_widths = vec![[0.0; ROUNDS]; tile.sites.len()];
        for round in 0..ROUNDS {
            rounds.sample(paths_of(round), |_| true, cancel)?;
            rounds.pool(Looks::Many);
            let widths = half_widths.iter_mut().zip(&rounds.estimates);
            widths.for_each(|(widths, estimate)| widths[round] = estimate.half_width);
        }
        let paths: u64 = rounds.estimates.iter().map(|estimate| estimate.samples).sum();
        let seconds_per_path = clock.elapsed().as_secs_f64() / paths.max(1) as f64;
        let texel = |place: usize| Texel {
            value: rounds.estimates[place].level,
            half_widths: half_widths[place],
            seconds_per_path,
        };
        Some(tile.groups().map(|group| group.map(texel).collect()).collect())
    }
}

impl Survey {
    fn new(groups: Vec<Vec<Texel>>, total: usize, wall: f64) -> Self {
        let texels: Vec<Texel> = groups.iter().flatten().copied().collect();
        let count = texels.len().max(1) as f64;
        let squares = |round: usize| texels.iter().map(|texel| texel.half_widths[round].powi(2)).sum::<f64>();
        let ratio = squares(0) / squares(ROUNDS - 1);
        let exponent = 0.5 * Portable::ln(ratio) / Portable::ln(f64::from(1_u32 << (ROUNDS - 1)));
        let exponent = if exponent.is_finite() { exponent } else { 0.5 };
        let cpu: f64 = texels.iter().map(|texel| texel.seconds_per_path * f64::from(paths_of(ROUNDS - 1))).sum();
        Self {
            stands_for: total as f64 / count,
            wall_per_cpu: if cpu > 0.0 { wall / cpu } else { 1.0 },
            exponent: exponent.clamp(EXPONENTS[0], EXPONENTS[1]),
            mean: texels.iter().map(|texel| texel.value).sum::<f64>() / count,
            groups,
        }
    }

    /// What is darker than this is not held to an error of its own value [cd/m²].
    pub(super) fn floor(&self) -> f64 {
        DARK * self.mean
    }

    /// Prices of a few errors, with processor time [s] that all of them take besides.
    pub(super) fn prices(&self, besides: f64) -> Vec<Prediction> {
        let seconds = |error| self.seconds(error) + self.wall_per_cpu * besides;
        PRICED_ERRORS.into_iter().map(|error| Prediction { error, seconds: seconds(error) }).collect()
    }

    /// Time that tracing to an error will take [s].
    pub(super) fn seconds(&self, relative: f64) -> f64 {
        let target = ErrorTarget { relative, floor: self.floor() };
        let seconds = |group: &Vec<Texel>| {
            let paths = group.iter().map(|texel| self.paths(texel, target)).max().unwrap_or(0);
            f64::from(paths) * group.iter().map(|texel| texel.seconds_per_path).sum::<f64>()
        };
        self.wall_per_cpu * self.stands_for * self.groups.iter().map(seconds).sum::<f64>()
    }

    /// The smallest error that takes no more than a time [s], rounded up.
    pub(super) fn error_within(&self, seconds: f64) -> f64 {
        let [mut low, mut high] = ERRORS;
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            if self.seconds(middle) > TRACING * seconds { low = middle } else { high = middle }
        }
        // To two digits, so that a person can ask for it again.
        let mut decade = ERRORS[0];
        while 10.0 * decade <= high {
            decade *= 10.0;
        }
        (10.0 * high / decade).ceil() * (0.1 * decade)
    }

    /// Paths that a texel will take.
    fn paths(&self, texel: &Texel, target: ErrorTarget) -> u32 {
        let wanted = target.relative * texel.value.max(target.floor);
        if let Some(round) = texel.half_widths.iter().position(|&width| width <= wanted) {
            // A round between two of the survey's may do.
            let between = paths_of(round) / 4 * 3;
            let before = texel.half_widths[round.saturating_sub(1)];
            let width = before * Portable::powf(1.5, -self.exponent);
            return if round > 0 && width <= wanted { between } else { paths_of(round) };
        }
        let last = texel.half_widths[ROUNDS - 1];
        let mut paths = paths_of(ROUNDS - 1);
        while paths < MOST_PATHS
            && last * Portable::powf(f64::from(paths_of(ROUNDS - 1)) / f64::from(paths), self.exponent) > wanted
        {
            paths = after(paths);
        }
        paths
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Texels of value 1 whose intervals are `width` wide after the first round and fall with a power of the paths.
    fn survey(width: f64, power: f64) -> Survey {
        let half_widths = std::array::from_fn(|round| width * Portable::powf(f64::from(1_u32 << round), -power));
        let texel = Texel { value: 1.0, half_widths, seconds_per_path: 1e-6 };
        Survey::new(vec![vec![texel]; 10], 1000, 10.0 * 1e-6 * f64::from(paths_of(ROUNDS - 1)))
    }

    #[test]
    fn prices_follow_the_power_that_the_rounds_show() {
        for power in [0.5, 0.7] {
            let survey = survey(0.3, power);
            assert!((survey.exponent - power).abs() < 1e-6, "{}", survey.exponent);
            // Within the rounds, and far beyond them: the next round that is narrow enough.
            for error in [0.25, 0.1, 0.01] {
                let needed = f64::from(LEAST_PATHS) * Portable::powf(0.3 / error, 1.0 / power);
                let mut paths = LEAST_PATHS;
                while f64::from(paths) < needed {
                    paths = after(paths);
                }
                let paths = f64::from(paths);
                let seconds = survey.seconds(error);
                assert!((seconds / (1000.0 * 1e-6 * paths) - 1.0).abs() < 1e-6, "{power} {error}: {seconds}");
            }
        }
    }

    #[test]
    fn a_time_buys_an_error_that_fits_it() {
        let survey = survey(0.3, 0.5);
        for seconds in [0.2, 5.0, 80.0] {
            let error = survey.error_within(seconds);
            assert!(survey.seconds(error) <= TRACING * seconds, "{seconds}: {error}");
            // A person can ask for it again.
            let digits = format!("{error:.1e}").parse::<f64>().unwrap();
            assert!((digits / error - 1.0).abs() < 1e-9, "{error}");
        }
        // No time is too short or too long.
        assert!(survey.error_within(0.0) <= 1.0 + 1e-9 && survey.error_within(1e12) >= 1e-4);
    }
}
