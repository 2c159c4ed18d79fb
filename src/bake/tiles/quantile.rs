//! By how many standard errors a texel may miss the truth in 95 of 100 cases, the larger of its own variance and that
//! pooled with those around it being taken for the true one.
//!
//! Taking the larger of two makes it larger in the mean. Where all texels are alike the share of intervals that hold
//! the truth is the mean of 1 − 2·Q(q·√w), w being the larger of both over the true variance and Q the normal
//! distribution's tail; own and pooled variance have χ² distributions. Solved for q once for each number of texels.

use crate::bake::REPLICATES;
use crate::math::{chi_squared_survival, normal_survival, student_t_two_sided_95};
use std::sync::LazyLock;

/// Texels whose variances are pooled, at most.
const MOST_POOLED: usize = 9;

/// Share of the intervals that hold the truth.
const COVERED: f64 = 0.95;

/// Equal shares of a distribution that stand for it.
const SHARES: usize = 24;

/// How often it is asked whether a texel is known well enough.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::bake) enum Looks {
    /// Once, when all paths are done.
    One,
    /// After each round, with an end at the first yes: what ends is what came out small, so that as many standard
    /// errors are taken as if the larger variance were none too large (Student's).
    Many,
}

static OF_ONE: LazyLock<[f64; MOST_POOLED]> = LazyLock::new(|| std::array::from_fn(|other| of_one_look(other + 1)));
static OF_MANY: LazyLock<[f64; MOST_POOLED]> =
    LazyLock::new(|| std::array::from_fn(|other| student_t_two_sided_95(freedom(other + 1))));

impl Looks {
    /// Standard errors in the half-width of a texel's interval, from so many texels, itself among them.
    pub(in crate::bake) fn quantile(self, texels: usize) -> f64 {
        let table = match self {
            Self::One => &OF_ONE,
            Self::Many => &OF_MANY,
        };
        table[texels.clamp(1, MOST_POOLED) - 1]
    }
}

fn freedom(texels: usize) -> f64 {
    f64::from(REPLICATES - 1) * texels as f64
}

fn of_one_look(texels: usize) -> f64 {
    if texels == 1 {
        return student_t_two_sided_95(freedom(1));
    }
    let (own, others) = (variances(freedom(1)), variances(freedom(texels - 1)));
    let larger: Vec<f64> = own
        .iter()
        .flat_map(|&own| {
            others.iter().map(move |&others| own.max((own + others * (texels - 1) as f64) / texels as f64))
        })
        .collect();
    let covered =
        |q: f64| larger.iter().map(|w| 1.0 - 2.0 * normal_survival(q * w.sqrt())).sum::<f64>() / larger.len() as f64;
    bisected(|q| covered(q) < COVERED)
}

/// Estimates of a variance of 1, in the middle of equal shares.
fn variances(freedom: f64) -> [f64; SHARES] {
    std::array::from_fn(|share| {
        let below = (share as f64 + 0.5) / SHARES as f64;
        bisected(|value| chi_squared_survival(value * freedom, freedom) > 1.0 - below)
    })
}

/// Where something ceases to hold, between 0 and 8.
fn bisected(holds: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 8.0);
    while high - low > 1e-6 {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By themselves texels are Student's; among others less is enough, and between 1.8 and 1.9 among many.
    #[test]
    fn quantiles() {
        for looks in [Looks::One, Looks::Many] {
            assert!((looks.quantile(1) - 2.1314).abs() < 1e-3);
            assert!((2..9).all(|texels| looks.quantile(texels + 1) < looks.quantile(texels)));
        }
        let [one, many] = [Looks::One, Looks::Many].map(|looks| looks.quantile(9));
        assert!((1.8..1.9).contains(&one) && (many - 1.9777).abs() < 1e-3, "{one} {many}");
    }
}
