//! When two means are one: the difference and four standard errors of it together must lie within the tolerance, so
//! that noise can hide nothing. What is too noisy is measured again with more paths, up to a limit.

use crate::common::meter::{mean, read};
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::Transport;

/// A mean and its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mean {
    pub value: f64,
    pub error: f64,
}

impl Mean {
    /// Of the green light over points [lx].
    pub fn of(scene: &Scene, points: &[MeterPoint], samples: u32, transport: Transport) -> Self {
        let (value, error) = mean(&read(scene, points, samples, transport), 1);
        Self { value, error }
    }

    pub fn plus(self, other: Self) -> Self {
        Self { value: self.value + other.value, error: self.error.hypot(other.error) }
    }

    pub fn times(self, factor: f64) -> Self {
        Self { value: factor * self.value, error: factor * self.error }
    }
}

/// Whether two means are one, to a share of the larger.
pub fn same(a: Mean, b: Mean, tolerance: f64) -> Result<(), String> {
    let (difference, noise) = ((a.value - b.value).abs(), 4.0 * a.error.hypot(b.error));
    let limit = tolerance * a.value.max(b.value);
    // Written so that NaN fails.
    if difference + noise <= limit {
        Ok(())
    } else {
        Err(format!("{} ± {} and {} ± {} are not one to {tolerance}", a.value, a.error, b.value, b.error))
    }
}

/// Paths per point, to begin with and at most.
const PATHS: [u32; 2] = [256, 1 << 16];

/// [`same`], of what `measure` finds with as many paths per point as it takes to leave half of the tolerance to the
/// difference. Then noise alone is rejected in 1 of 10 000 cases.
pub fn settle(tolerance: f64, measure: impl Fn(u32) -> [Mean; 2]) -> Result<(), String> {
    let mut samples = PATHS[0];
    loop {
        let [a, b] = measure(samples);
        let (noise, limit) = (4.0 * a.error.hypot(b.error), tolerance * a.value.max(b.value));
        // Quiet enough, or so far apart that no noise would do it.
        let is_clear = noise <= 0.5 * limit || (a.value - b.value).abs() > limit + 2.0 * noise;
        if is_clear || samples >= PATHS[1] {
            return same(a, b, tolerance);
        }
        samples *= 4;
    }
}

#[test]
fn means_are_told_apart() {
    let mean = |value: f64, error: f64| Mean { value, error };
    assert_eq!(same(mean(1.0, 0.001), mean(1.003, 0.001), 0.01), Ok(()));
    assert_eq!(same(mean(0.0, 0.0), mean(0.0, 0.0), 0.01), Ok(()));
    for (a, b) in [
        (mean(1.0, 0.0), mean(1.02, 0.0)),
        // Too noisy to say.
        (mean(1.0, 0.01), mean(1.0, 0.0)),
        (mean(1.0, 0.001), mean(1.008, 0.001)),
        (mean(f64::NAN, 0.0), mean(1.0, 0.0)),
        (mean(1.0, f64::NAN), mean(1.0, 0.0)),
        (mean(1.0, 0.0), mean(0.0, 0.0)),
    ] {
        assert!(same(a, b, 0.01).is_err(), "{a:?} {b:?}");
    }
}

#[test]
fn noise_calls_for_more_paths() {
    let noisy = |samples: u32| Mean { value: 1.0, error: 0.1 / f64::from(samples).sqrt() };
    let asked = std::cell::Cell::new(0);
    let measure = |samples| {
        asked.set(samples);
        [noisy(samples), Mean { value: 1.001, error: 0.0 }]
    };
    assert_eq!(settle(0.01, measure), Ok(()));
    assert_eq!(asked.get(), 1 << 14);
    assert!(settle(1e-4, measure).is_err());
}
