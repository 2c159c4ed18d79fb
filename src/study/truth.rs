//! Errors against a reference that is not exact itself: its own noise is known from its runs and is taken out.
//!
//! Over receivers, the mean of (estimate − reference)² is the error's square plus the reference's variance, as the two
//! have random numbers of their own. What is left after subtracting that is an honest square of the error as long as it
//! is not small beside what was subtracted.

/// Parts of the receivers, each spread over all: what they say of one and the same thing differs by chance, which is
/// how sure it is.
pub(super) const GROUPS: usize = 16;

/// The largest share of a squared difference that may be the reference's own noise: then its error is half of the
/// whole's.
const MOST_NOISE: f64 = 0.25;

/// How far an error can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// The reference is better by far.
    Known,
    /// It nears the error of the reference: neither shown nor fitted.
    NearReference,
}

/// The reference: mean luminance of each receiver and the variance of that mean.
pub(super) struct Truth {
    means: Vec<f64>,
    variances: Vec<f64>,
    mean: f64,
}

impl Truth {
    pub(super) fn new(means: Vec<f64>, variances: Vec<f64>) -> Self {
        let mean = means.iter().sum::<f64>() / means.len().max(1) as f64;
        Self { means, variances, mean }
    }

    /// Mean over the receivers [cd/m²].
    pub(super) fn mean(&self) -> f64 {
        self.mean
    }

    /// The reference's own root mean square error, over its mean.
    pub(super) fn own_error(&self) -> f64 {
        (self.variances.iter().sum::<f64>() / self.variances.len().max(1) as f64).sqrt() / self.mean
    }

    /// How far estimates are off.
    pub(super) fn compare(&self, means: &[f64]) -> Difference {
        let mut sums = [Sums::default(); GROUPS];
        for (index, (mean, (truth, variance))) in means.iter().zip(self.means.iter().zip(&self.variances)).enumerate() {
            let sum = &mut sums[index % GROUPS];
            sum.squares += (mean - truth) * (mean - truth);
            sum.noise += variance;
            sum.count += 1.0;
        }
        Difference { sums, mean: self.mean }
    }

    /// The error that is left of a biased estimate without noise, from estimates with known variances: over the mean.
    pub(super) fn floor(&self, means: &[f64], variances: &[f64]) -> f64 {
        let whole = self.compare(means).total();
        let own: f64 = variances.iter().sum();
        ((whole.squares - whole.noise - own).max(0.0) / whole.count.max(1.0)).sqrt() / self.mean
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    squares: f64,
    /// The reference's variance.
    noise: f64,
    count: f64,
}

/// How far estimates are off, by groups of receivers.
#[derive(Clone, Debug)]
pub(super) struct Difference {
    sums: [Sums; GROUPS],
    mean: f64,
}

impl Difference {
    /// Root mean square error over the reference's mean.
    pub(super) fn error(&self) -> f64 {
        self.of(self.total())
    }

    /// The same without one of the groups.
    pub(super) fn error_without(&self, group: usize) -> f64 {
        let (all, out) = (self.total(), self.sums[group]);
        self.of(Sums { squares: all.squares - out.squares, noise: all.noise - out.noise, count: all.count - out.count })
    }

    pub(super) fn standing(&self) -> Standing {
        let Sums { squares, noise, .. } = self.total();
        if noise > MOST_NOISE * squares || squares <= 0.0 { Standing::NearReference } else { Standing::Known }
    }

    fn total(&self) -> Sums {
        self.sums.iter().fold(Sums::default(), |a, b| Sums {
            squares: a.squares + b.squares,
            noise: a.noise + b.noise,
            count: a.count + b.count,
        })
    }

    fn of(&self, sums: Sums) -> f64 {
        ((sums.squares - sums.noise).max(0.0) / sums.count.max(1.0)).sqrt() / self.mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::testing::Random;

    /// A number with mean 0 and variance 1.
    fn chance(random: &mut Random) -> f64 {
        (0..12).map(|_| f64::from(random.unit())).sum::<f64>() - 6.0
    }

    /// Receivers of known light, a reference of known noise, and estimates of known noise and bias.
    fn synthetic(noise: f64, bias: f64, of_reference: f64) -> (Truth, Vec<f64>, Vec<f64>) {
        let mut random = Random::new(5);
        let lights: Vec<f64> = (0..4096).map(|_| 1.5 + f64::from(random.unit())).collect();
        let reference = lights.iter().map(|light| light + of_reference * chance(&mut random)).collect();
        let estimates = lights.iter().map(|light| light * (1.0 - bias) + noise * chance(&mut random)).collect();
        (Truth::new(reference, vec![of_reference.powi(2); 4096]), estimates, vec![noise.powi(2); 4096])
    }

    #[test]
    fn the_noise_of_the_reference_is_taken_out() {
        let (truth, estimates, _) = synthetic(0.10, 0.0, 0.04);
        let difference = truth.compare(&estimates);
        // 0.1 of 2; with the reference's noise left in it were 0.0539. 4096 receivers know it to 1.3 %.
        assert!((difference.error() - 0.05).abs() < 4.0 * 0.013 * 0.05, "{}", difference.error());
        assert!((truth.own_error() - 0.02).abs() < 2e-4, "{}", truth.own_error());
        assert_eq!(difference.standing(), Standing::Known);
        let (truth, estimates, _) = synthetic(0.04, 0.0, 0.04);
        assert_eq!(truth.compare(&estimates).standing(), Standing::NearReference);
    }

    #[test]
    fn leaving_groups_out_changes_an_error_by_chance_only() {
        let (truth, estimates, _) = synthetic(0.10, 0.0, 0.01);
        let difference = truth.compare(&estimates);
        let off: Vec<f64> =
            (0..GROUPS).map(|group| difference.error_without(group) / difference.error() - 1.0).collect();
        assert!(off.iter().all(|off| off.abs() < 0.02) && off.iter().any(|off| *off != 0.0), "{off:?}");
    }

    /// A planted bias is found, whatever the noise; without one there is next to none.
    #[test]
    fn a_planted_bias_is_the_floor() {
        let (truth, estimates, variances) = synthetic(0.10, 0.2, 0.02);
        // The root of the mean square of the light, over its mean: 1 + 1/48.
        let expected = 0.2 * (1.0_f64 + 1.0 / 48.0).sqrt();
        let floor = truth.floor(&estimates, &variances);
        assert!((floor - expected).abs() < 0.005, "{floor} {expected}");
        let (truth, estimates, variances) = synthetic(0.10, 0.0, 0.02);
        let floor = truth.floor(&estimates, &variances);
        assert!(floor < 0.015, "{floor}");
    }
}
