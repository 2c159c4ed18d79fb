//! Survival functions (1 − distribution function) of the normal, χ² and Student's t distributions, to better than
//! 10⁻¹⁰ of their value. Knows no samples: [`stats`](super::stats) does.
//!
//! Incomplete gamma and beta functions by series and by continued fraction, evaluated by Lentz's method (Abramowitz
//! and Stegun 1964, 6.5.29, 6.5.31, 26.5.8; Thompson and Barnett 1986). Log-gamma by Lanczos 1964 with the
//! coefficients of Godfrey 2001 for g = 7.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Terms after which a series or fraction is given up. Convergence needs some √parameter of them.
const MOST_TERMS: usize = 1_000_000;

/// P(X > z) of the standard normal distribution.
pub fn normal_survival(z: f64) -> f64 {
    let half_square = (z * FRAC_1_SQRT_2).powi(2);
    if z >= 0.0 { 0.5 * upper_gamma(0.5, half_square) } else { 1.0 - 0.5 * upper_gamma(0.5, half_square) }
}

/// P(X > x) of the χ² distribution with `degrees_of_freedom` > 0.
pub fn chi_squared_survival(x: f64, degrees_of_freedom: f64) -> f64 {
    upper_gamma(0.5 * degrees_of_freedom, 0.5 * x.max(0.0))
}

/// P(T > t) of Student's t distribution with `degrees_of_freedom` > 0, which need not be whole.
pub fn student_t_survival(t: f64, degrees_of_freedom: f64) -> f64 {
    let t2 = t * t;
    // Each form where it does not lose digits: the tail from its own end.
    let both = if t2 < degrees_of_freedom {
        1.0 - incomplete_beta(0.5, 0.5 * degrees_of_freedom, t2 / (degrees_of_freedom + t2))
    } else if t2.is_infinite() {
        0.0
    } else {
        incomplete_beta(0.5 * degrees_of_freedom, 0.5, degrees_of_freedom / (degrees_of_freedom + t2))
    };
    if t >= 0.0 { 0.5 * both } else { 1.0 - 0.5 * both }
}

/// ln Γ(x), x > 0.
fn ln_gamma(x: f64) -> f64 {
    const G: f64 = 7.0;
    const COEFFICIENTS: [f64; 8] = [
        676.520_368_121_885_1,
        -1_259.139_216_722_402_8,
        771.323_428_777_653_1,
        -176.615_029_162_140_6,
        12.507_343_278_686_905,
        -0.138_571_095_265_720_12,
        9.984_369_578_019_572e-6,
        1.505_632_735_149_311_6e-7,
    ];
    if x < 0.5 {
        return (PI / (PI * x).sin()).ln() - ln_gamma(1.0 - x);
    }
    let x = x - 1.0;
    let terms = COEFFICIENTS.iter().zip(1..).map(|(c, i)| c / (x + f64::from(i)));
    let sum = 0.999_999_999_999_809_9 + terms.sum::<f64>();
    let t = x + G + 0.5;
    0.5 * (2.0 * PI).ln() + (x + 0.5) * t.ln() - t + sum.ln()
}

/// Q(a, x) = Γ(a, x)/Γ(a), a > 0, x ≥ 0.
fn upper_gamma(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    if x.is_infinite() {
        return 0.0;
    }
    let front = (a * x.ln() - x - ln_gamma(a)).exp();
    if x < a + 1.0 {
        let mut term = 1.0 / a;
        let mut sum = term;
        for n in 1..MOST_TERMS {
            term *= x / (a + n as f64);
            sum += term;
            if term < sum * f64::EPSILON {
                break;
            }
        }
        1.0 - front * sum
    } else {
        let fraction = lentz(x + 1.0 - a, |n| {
            let n = n as f64;
            (-n * (n - a), x + 2.0 * n + 1.0 - a)
        });
        front / fraction
    }
}

/// I_x(a, b), a and b > 0, x in [0, 1].
fn incomplete_beta(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    // The fraction converges fast below the mean of the distribution; above it, count from the other end.
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(b, a, 1.0 - x);
    }
    let front = (ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * x.ln() + b * (-x).ln_1p()).exp();
    let fraction = lentz(1.0, |n| {
        let m = (n / 2) as f64;
        let numerator = if n.is_multiple_of(2) {
            m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m))
        } else {
            -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))
        };
        (numerator, 1.0)
    });
    front / (a * fraction)
}

/// b₀ + a₁/(b₁ + a₂/(b₂ + …)), with `term(n)` = (aₙ, bₙ).
fn lentz(b0: f64, term: impl Fn(usize) -> (f64, f64)) -> f64 {
    const TINY: f64 = 1e-300;
    let nonzero = |v: f64| if v.abs() < TINY { TINY } else { v };
    let mut value = nonzero(b0);
    let (mut c, mut d) = (value, 0.0);
    for n in 1..MOST_TERMS {
        let (an, bn) = term(n);
        d = 1.0 / nonzero(bn + an * d);
        c = nonzero(bn + an / c);
        let factor = c * d;
        value *= factor;
        if (factor - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, truth: f64) {
        assert!((value - truth).abs() <= 1e-10 * truth, "{value:e} for {truth:e}");
    }

    #[test]
    fn log_gamma_of_known_arguments() {
        close(ln_gamma(0.5), PI.sqrt().ln());
        close(ln_gamma(10.0), 362_880_f64.ln());
        close(ln_gamma(0.1), 2.252_712_651_734_206);
        assert!(ln_gamma(1.0).abs() < 1e-14 && ln_gamma(2.0).abs() < 1e-14);
    }

    #[test]
    fn normal_tail_of_known_arguments() {
        close(normal_survival(0.0), 0.5);
        close(normal_survival(1.0), 0.158_655_253_931_457_05);
        close(normal_survival(1.959_963_984_540_054), 0.025);
        close(normal_survival(5.0), 2.866_515_718_791_939e-7);
        close(normal_survival(-1.0), 0.841_344_746_068_542_9);
    }

    #[test]
    fn chi_squared_tail_of_known_arguments() {
        // Two degrees of freedom: exp(−x/2); four: (1 + x/2) exp(−x/2); one: both tails of the normal.
        for x in [0.01, 0.5, 3.0, 40.0, 300.0] {
            close(chi_squared_survival(x, 2.0), (-0.5 * x).exp());
            close(chi_squared_survival(x, 4.0), (1.0 + 0.5 * x) * (-0.5 * x).exp());
            close(chi_squared_survival(x, 1.0), 2.0 * normal_survival(x.sqrt()));
        }
        // Tables: 5 % points.
        assert!((chi_squared_survival(18.307_038_053_275_146, 10.0) - 0.05).abs() < 1e-10);
        assert!((chi_squared_survival(124.342_113_404_004_07, 100.0) - 0.05).abs() < 1e-10);
        assert_eq!(chi_squared_survival(-1.0, 3.0), 1.0);
    }

    #[test]
    fn student_tail_of_known_arguments() {
        // One degree of freedom: Cauchy; two: ½ − t/(2√(2 + t²)).
        for t in [0.0, 0.3, 1.0, 2.5, 12.0] {
            close(student_t_survival(t, 1.0), 0.5 - f64::atan(t) / PI);
            close(student_t_survival(t, 2.0), 0.5 - t / (2.0 * (2.0 + t * t).sqrt()));
            close(student_t_survival(-t, 2.0), 0.5 + t / (2.0 * (2.0 + t * t).sqrt()));
        }
        // Tables: two-sided 5 % points.
        for (dof, t) in [(5.0, 2.570_581_835_636_314), (15.0, 2.131_449_545_559_323), (30.0, 2.042_272_456_301_238)] {
            assert!((student_t_survival(t, dof) - 0.025).abs() < 1e-10, "{dof}");
        }
        assert!((student_t_survival(1.5, 1e7) - normal_survival(1.5)).abs() < 1e-7);
    }
}
