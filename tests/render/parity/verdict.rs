//! How far two pictures of lit pixels are apart, as shares.

use glam::DVec3;

/// Largest mean and largest single difference.
const MEAN: f64 = 0.01;
const WORST: f64 = 0.03;

/// A pixel is lit that has this share of the brightest.
const LIT: f64 = 0.05;

/// As many must be lit for a verdict.
const LEAST_LIT: usize = 700;

/// How far two pictures are apart.
#[derive(Debug)]
pub struct Difference {
    /// Lit pixels that were compared.
    pub lit: usize,
    /// Mean of the absolute differences over pixels and channels.
    pub mean: f64,
    /// The largest of them.
    pub worst: f64,
}

/// Compares `seen` with `truth`, pixel by pixel.
pub fn compare(seen: &[DVec3], truth: &[DVec3]) -> Difference {
    assert_eq!(seen.len(), truth.len());
    let brightest = truth.iter().map(|colour| colour.max_element()).fold(0.0, f64::max);
    let lit = seen.iter().zip(truth).filter(|(_, truth)| truth.min_element() > LIT * brightest);
    let (mut count, mut sum, mut worst) = (0, 0.0, 0.0_f64);
    for (&seen, &truth) in lit {
        let apart = (seen / truth - 1.0).abs();
        count += 1;
        sum += apart.element_sum() / 3.0;
        // What is no number is not to be lost.
        worst = if apart.is_finite() { worst.max(apart.max_element()) } else { f64::INFINITY };
    }
    Difference { lit: count, mean: sum / count as f64, worst }
}

impl Difference {
    /// Whether they are the same, and enough is lit to say so.
    pub fn verdict(&self) -> Result<(), String> {
        let holds = self.lit >= LEAST_LIT && self.mean <= MEAN && self.worst <= WORST;
        if holds { Ok(()) } else { Err(format!("they differ, or too little is lit: {self:?}")) }
    }
}

#[test]
fn planted_faults_are_found() {
    let truth: Vec<DVec3> = (0..2000).map(|pixel| DVec3::new(1.0, 0.6, 0.3) * (0.5 + pixel as f64 / 2e3)).collect();
    let verdict = |change: &dyn Fn(usize, DVec3) -> DVec3, truth: &[DVec3]| {
        let seen: Vec<DVec3> = truth.iter().enumerate().map(|(pixel, &value)| change(pixel, value)).collect();
        compare(&seen, truth).verdict()
    };
    assert_eq!(verdict(&|_, value| value * 1.005, &truth), Ok(()));
    assert!(verdict(&|_, value| value * 1.011, &truth).is_err(), "too bright");
    assert!(verdict(&|_, value| value * DVec3::new(1.0, 1.0, 0.96), &truth).is_err(), "a tint");
    assert!(verdict(&|pixel, value| value * if pixel == 7 { 1.04 } else { 1.0 }, &truth).is_err(), "one pixel");
    assert!(verdict(&|pixel, value| if pixel == 7 { DVec3::NAN } else { value }, &truth).is_err(), "no number");
    assert!(verdict(&|_, value| value, &truth[..600]).is_err(), "too few");
    let dark: Vec<DVec3> = truth.iter().enumerate().map(|(i, &v)| if i < 10 { v * 100.0 } else { v }).collect();
    assert!(verdict(&|_, value| value, &dark).is_err(), "too few are lit");
}
