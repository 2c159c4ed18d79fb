//! Means, their standard errors and what they prove: Welford's running moments, Student intervals from independent
//! replicates, and Welch's test of two means. All in `f64`. Decides nothing about sampling.
//!
//! Welford 1962; merging: Chan, Golub and LeVeque 1979; Welch 1947.

use super::student_t_survival;

/// Running mean and variance of values that are taken in one at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Welford {
    count: u64,
    mean: f64,
    squares: f64,
}

impl Welford {
    /// Takes in one value.
    #[inline]
    pub fn push(&mut self, value: f64) {
        self.count += 1;
        let step = value - self.mean;
        self.mean += step / self.count as f64;
        self.squares += step * (value - self.mean);
    }

    /// Takes in all that `other` took. The order of merging changes the last bits.
    pub fn merge(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        let (n, m) = (self.count as f64, other.count as f64);
        let step = other.mean - self.mean;
        self.count += other.count;
        self.mean += step * m / (n + m);
        self.squares += other.squares + step * step * n * m / (n + m);
    }

    /// How many values it took.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Their mean; 0 of none.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The unbiased estimate of the variance of one value; infinite below two values, where nothing is known.
    pub fn variance(&self) -> f64 {
        if self.count < 2 { f64::INFINITY } else { self.squares / (self.count - 1) as f64 }
    }

    /// The standard error of the mean, of independent values; infinite below two.
    pub fn standard_error(&self) -> f64 {
        if self.count < 2 { f64::INFINITY } else { (self.variance() / self.count as f64).sqrt() }
    }
}

impl Extend<f64> for Welford {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, values: I) {
        values.into_iter().for_each(|value| self.push(value));
    }
}

impl FromIterator<f64> for Welford {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut moments = Self::default();
        moments.extend(values);
        moments
    }
}

/// The means of independent replicates of one estimate, and what they say about its error. Samples within a
/// replicate need not be independent; the replicates must be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Replicates(Welford);

impl Replicates {
    /// From the mean of each replicate.
    pub fn from_means(means: impl IntoIterator<Item = f64>) -> Self {
        Self(means.into_iter().collect())
    }

    /// How many replicates there are.
    pub fn count(&self) -> u64 {
        self.0.count()
    }

    /// The mean over all.
    pub fn mean(&self) -> f64 {
        self.0.mean()
    }

    /// The standard error of that mean; infinite below two replicates.
    pub fn standard_error(&self) -> f64 {
        self.0.standard_error()
    }

    /// Half the width of the interval around the mean that holds the truth in 95 of 100 cases (Student's t, so that
    /// few replicates give a wide one); infinite below two replicates.
    pub fn half_width_95(&self) -> f64 {
        if self.count() < 2 {
            return f64::INFINITY;
        }
        student_t_two_sided_95((self.count() - 1) as f64) * self.standard_error()
    }
}

/// The value that Student's t distribution stays below with probability `p` in (0, 1), to 10⁻¹⁰ of it. NaN where `p`
/// or the degrees of freedom lie outside their range. Costs some microseconds: keep it, do not ask per texel.
pub fn student_t_quantile(p: f64, degrees_of_freedom: f64) -> f64 {
    if !(p > 0.0 && p < 1.0 && degrees_of_freedom > 0.0) {
        return f64::NAN;
    }
    if p < 0.5 {
        return -student_t_quantile(1.0 - p, degrees_of_freedom);
    }
    let above = |t: f64| student_t_survival(t, degrees_of_freedom) > 1.0 - p;
    let (mut low, mut high) = (0.0, 1.0);
    while above(high) && high < f64::MAX / 2.0 {
        (low, high) = (high, 2.0 * high);
    }
    while high - low > 1e-11 * high {
        let middle = 0.5 * (low + high);
        if above(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// By how many standard errors a mean may miss the truth in 95 of 100 cases: 1.96 for many degrees of freedom,
/// 12.7 for one.
pub fn student_t_two_sided_95(degrees_of_freedom: f64) -> f64 {
    student_t_quantile(0.975, degrees_of_freedom)
}

/// What [`welch_t_test`] found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Welch {
    /// Difference of the means over its standard error.
    pub t: f64,
    /// Degrees of freedom after Welch and Satterthwaite.
    pub degrees_of_freedom: f64,
    /// The probability of a difference this large or larger, either way, if the means were the same.
    pub p_value: f64,
}

/// Whether two sets of independent values have one mean, without assuming one variance. `None` where a set has fewer
/// than two values. Two sets without any variance have p = 1 if their means are equal, else 0.
pub fn welch_t_test(a: &Welford, b: &Welford) -> Option<Welch> {
    if a.count() < 2 || b.count() < 2 {
        return None;
    }
    let share = |w: &Welford| w.variance() / w.count() as f64;
    let (va, vb) = (share(a), share(b));
    let difference = a.mean() - b.mean();
    if va + vb == 0.0 {
        let (t, p_value) = if difference == 0.0 { (0.0, 1.0) } else { (difference.signum() * f64::INFINITY, 0.0) };
        return Some(Welch { t, degrees_of_freedom: (a.count() + b.count() - 2) as f64, p_value });
    }
    let t = difference / (va + vb).sqrt();
    let spread = va * va / (a.count() - 1) as f64 + vb * vb / (b.count() - 1) as f64;
    let degrees_of_freedom = (va + vb).powi(2) / spread;
    Some(Welch { t, degrees_of_freedom, p_value: 2.0 * student_t_survival(t.abs(), degrees_of_freedom) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, truth: f64, tolerance: f64) {
        assert!((value - truth).abs() <= tolerance, "{value} for {truth}");
    }

    #[test]
    fn moments_of_known_values() {
        let w: Welford = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].into_iter().collect();
        assert_eq!((w.count(), w.mean()), (8, 5.0));
        close(w.variance(), 32.0 / 7.0, 1e-14);
        close(w.standard_error(), (32.0_f64 / 56.0).sqrt(), 1e-14);
    }

    #[test]
    fn a_large_offset_does_not_drown_the_variance() {
        let w: Welford = [4.0, 7.0, 13.0, 16.0].map(|v| v + 1e9).into_iter().collect();
        close(w.variance(), 30.0, 1e-6);
    }

    #[test]
    fn merging_is_taking_in_all() {
        let values: Vec<f64> = (0..100).map(|i| f64::from(i * i % 37)).collect();
        for cut in [0, 1, 50, 99, 100] {
            let mut left: Welford = values[..cut].iter().copied().collect();
            left.merge(&values[cut..].iter().copied().collect());
            let all: Welford = values.iter().copied().collect();
            assert_eq!(left.count(), all.count());
            close(left.mean(), all.mean(), 1e-12);
            close(left.variance(), all.variance(), 1e-10);
        }
    }

    #[test]
    fn one_value_knows_no_error() {
        let one: Welford = [3.0].into_iter().collect();
        assert_eq!((one.mean(), one.variance(), one.standard_error()), (3.0, f64::INFINITY, f64::INFINITY));
        assert_eq!(Replicates::from_means([3.0]).half_width_95(), f64::INFINITY);
    }

    #[test]
    fn quantiles_of_the_tables() {
        let table =
            [(1.0, 12.706_204_736_174_7), (2.0, 4.302_652_729_749_46), (15.0, 2.131_449_545_559_32), (1e9, 1.959_964)];
        for (dof, t) in table {
            close(student_t_two_sided_95(dof), t, 1e-6);
        }
        close(student_t_quantile(0.9, 10.0), 1.372_183_641_110_34, 1e-9);
        close(student_t_quantile(0.1, 10.0), -1.372_183_641_110_34, 1e-9);
        close(student_t_quantile(0.5, 4.0), 0.0, 1e-10);
        assert!(student_t_quantile(0.0, 4.0).is_nan() && student_t_quantile(0.3, 0.0).is_nan());
    }

    #[test]
    fn the_interval_of_replicates_is_students() {
        let r = Replicates::from_means([1.0, 2.0, 3.0]);
        assert_eq!((r.count(), r.mean()), (3, 2.0));
        close(r.standard_error(), 1.0 / 3.0_f64.sqrt(), 1e-14);
        close(r.half_width_95(), 4.302_652_729_749_46 / 3.0_f64.sqrt(), 1e-8);
    }

    #[test]
    fn welch_on_a_worked_example() {
        // Means 4 and 8, variances 2.5 and 10, five values each: t = −4/√2.5, 12.5²·4/(2.5² + 10²) degrees.
        let a: Welford = [2.0, 3.0, 4.0, 5.0, 6.0].into_iter().collect();
        let b: Welford = [4.0, 6.0, 8.0, 10.0, 12.0].into_iter().collect();
        let w = welch_t_test(&a, &b).expect("both have five values");
        close(w.t, -4.0 / 2.5_f64.sqrt(), 1e-12);
        close(w.degrees_of_freedom, 625.0 / 106.25, 1e-12);
        close(w.p_value, 2.0 * student_t_survival(4.0 / 2.5_f64.sqrt(), 625.0 / 106.25), 1e-14);
        assert!(w.p_value > 0.04 && w.p_value < 0.05);
        assert!(welch_t_test(&a, &Welford::default()).is_none());
        let constant: Welford = [1.0, 1.0].into_iter().collect();
        let other: Welford = [2.0, 2.0].into_iter().collect();
        assert_eq!(welch_t_test(&constant, &constant).map(|w| w.p_value), Some(1.0));
        assert_eq!(welch_t_test(&constant, &other).map(|w| w.p_value), Some(0.0));
    }
}
