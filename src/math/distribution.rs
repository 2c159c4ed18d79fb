//! Choosing one of many in proportion to weights. Does not know what is chosen.
//!
//! Inversion of the cumulative sums rather than an alias table: neighbours stay neighbours, so that a stratified
//! variate stays stratified, and the rest of the variate can be used again.

use thiserror::Error;

/// The largest `f32` below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// Why weights make no distribution.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum DistributionError {
    /// A weight below zero, or not finite.
    #[error("weight {index} is {weight}; weights must be finite and not negative")]
    Weight {
        /// Which one.
        index: usize,
        /// What it is.
        weight: f64,
    },
    /// The sum of the weights is not finite.
    #[error("the weights add up to more than a number holds; scale them down")]
    Overflow,
    /// Nothing to choose from.
    #[error("no weight is above zero; give at least one")]
    AllZero,
}

/// A distribution over the indices of the weights that it was made of, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Discrete {
    /// `ends[i]` is the sum of the weights up to and with `i`.
    ends: Vec<f64>,
    /// The last index of weight above zero.
    last: usize,
}

/// What was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscreteSample {
    /// Which entry; its weight is above zero.
    pub index: usize,
    /// With what probability.
    pub probability: f64,
    /// Where in the entry the variate fell, in [0, 1): uniform again, with the digits that the choice left over.
    pub remapped: f32,
}

impl Discrete {
    /// From weights in any unit. Fails on a weight that is negative or not finite, and if none is above zero.
    pub fn new(weights: impl IntoIterator<Item = f64>) -> Result<Self, DistributionError> {
        let mut sum = 0.0;
        let mut ends = Vec::new();
        let mut last = None;
        for (index, weight) in weights.into_iter().enumerate() {
            if !(weight.is_finite() && weight >= 0.0) {
                return Err(DistributionError::Weight { index, weight });
            }
            // A weight too small to move the sum cannot be chosen, and then has probability 0 too.
            if sum + weight > sum {
                last = Some(index);
            }
            sum += weight;
            ends.push(sum);
        }
        if sum.is_infinite() {
            return Err(DistributionError::Overflow);
        }
        Ok(Self { ends, last: last.ok_or(DistributionError::AllZero)? })
    }

    /// How many entries there are.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Never: a distribution without entries cannot be made.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The sum of the weights.
    pub fn total(&self) -> f64 {
        self.ends[self.last]
    }

    /// The probability of entry `index`; 0 beyond the last.
    #[inline]
    pub fn probability(&self, index: usize) -> f64 {
        self.ends.get(index).map_or(0.0, |end| (end - self.start(index)) / self.total())
    }

    /// The entry that belongs to `u` in [0, 1). Takes an `f64`, since of many entries some may be rarer than the
    /// steps of an `f32`: these would never be chosen.
    #[inline]
    pub fn sample(&self, u: f64) -> DiscreteSample {
        let at = u * self.total();
        let index = self.ends.partition_point(|&end| end <= at).min(self.last);
        let start = self.start(index);
        let weight = self.ends[index] - start;
        let remapped = ((at - start) / weight) as f32;
        DiscreteSample { index, probability: weight / self.total(), remapped: remapped.clamp(0.0, BELOW_ONE) }
    }

    #[inline]
    fn start(&self, index: usize) -> f64 {
        if index == 0 { 0.0 } else { self.ends[index - 1] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_the_unit_interval_are_the_probabilities() {
        let weights = [0.0, 3.0, 0.0, 1.0, 0.5, 0.0, 5.5, 0.0];
        let d = Discrete::new(weights).expect("fine weights");
        let (n, mut hits) = (100_000, [0_u32; 8]);
        for i in 0..n {
            let s = d.sample((f64::from(i) + 0.5) / f64::from(n));
            hits[s.index] += 1;
            assert_eq!(s.probability, d.probability(s.index));
            assert!((0.0..1.0).contains(&s.remapped));
        }
        for (i, w) in weights.into_iter().enumerate() {
            assert!((f64::from(hits[i]) / f64::from(n) - w / 10.0).abs() < 2e-5, "{i}");
            assert!((d.probability(i) - w / 10.0).abs() < 1e-15);
        }
        assert!(((0..8).map(|i| d.probability(i)).sum::<f64>() - 1.0).abs() < 1e-14);
        assert_eq!((d.len(), d.is_empty(), d.total(), d.probability(8)), (8, false, 10.0, 0.0));
    }

    #[test]
    fn the_remapped_variate_runs_through_the_entry() {
        let d = Discrete::new([1.0, 2.0, 1.0]).expect("fine weights");
        for (u, index, remapped) in [(0.0, 0, 0.0), (0.125, 0, 0.5), (0.25, 1, 0.0), (0.625, 1, 0.75), (0.75, 2, 0.0)] {
            let s = d.sample(u);
            assert_eq!((s.index, s.remapped), (index, remapped), "{u}");
        }
    }

    #[test]
    fn ends_never_give_an_entry_without_weight() {
        let d = Discrete::new([0.0, 0.0, 1e-300, 0.0]).expect("one weight");
        for u in [0.0, 0.5, 1.0 - f64::EPSILON / 2.0, 1.0] {
            let s = d.sample(u);
            assert_eq!((s.index, s.probability), (2, 1.0));
            assert!(s.remapped < 1.0);
        }
        // A weight below the rounding of the sum: never chosen, probability 0.
        let d = Discrete::new([1.0, 1e-20]).expect("fine weights");
        assert_eq!((d.sample(1.0).index, d.probability(1)), (0, 0.0));
        assert_eq!(Discrete::new([7.0]).expect("one weight").sample(0.3).probability, 1.0);
    }

    #[test]
    fn bad_weights_are_named() {
        assert_eq!(Discrete::new([]), Err(DistributionError::AllZero));
        assert_eq!(Discrete::new([0.0, 0.0]), Err(DistributionError::AllZero));
        assert_eq!(Discrete::new([1.0, -2.0]), Err(DistributionError::Weight { index: 1, weight: -2.0 }));
        assert!(matches!(Discrete::new([f64::NAN]), Err(DistributionError::Weight { index: 0, .. })));
        assert_eq!(Discrete::new([f64::MAX, f64::MAX]), Err(DistributionError::Overflow));
    }
}
