//! Readings of the light meter, and means over them.

use bevy_kiln::bake::{CancelToken, MeterPoint, MeterReading, MeterSettings, measure_irradiance};
use bevy_kiln::math::{Welford, welch_t_test};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::{Estimator, Transport};
use glam::{FloatExt, Vec3};

/// A meter at `position` that faces `normal`.
pub fn at(position: Vec3, normal: Vec3) -> MeterPoint {
    MeterPoint { position, normal }
}

/// Readings with this many paths each.
pub fn read(scene: &Scene, points: &[MeterPoint], samples: u32, transport: Transport) -> Vec<MeterReading> {
    let settings = MeterSettings { transport, samples_per_point: samples, threads: None };
    let measurement =
        measure_irradiance(scene, points, &settings, &(), &CancelToken::default()).expect("the scene can be measured");
    assert!(measurement.readings.iter().all(|reading| reading.irradiance.is_finite() && reading.stderr.is_finite()));
    measurement.readings
}

/// Light by this estimator, under another seed for each so that their errors are independent.
pub fn by(estimator: Estimator) -> Transport {
    Transport { estimator, seed: estimator as u64 + 1, ..Transport::default() }
}

/// Mean of a channel over readings, and the standard error of that mean.
pub fn mean(readings: &[MeterReading], channel: usize) -> (f64, f64) {
    let count = readings.len() as f64;
    let sum: f64 = readings.iter().map(|reading| reading.irradiance[channel]).sum();
    let squares: f64 = readings.iter().map(|reading| reading.stderr[channel].powi(2)).sum();
    (sum / count, squares.sqrt() / count)
}

/// A grid of points over the six sides of a box, facing inwards, clear of the edges.
pub fn on_walls(low: Vec3, high: Vec3, per_side: u32) -> Vec<MeterPoint> {
    let mut points = Vec::new();
    for axis in 0..3 {
        for (wall, sign) in [(low, 1.0), (high, -1.0)] {
            for index in 0..per_side * per_side {
                let cell = |number: u32| (number as f32 + 0.5) / per_side as f32;
                let mut position = wall;
                position[(axis + 1) % 3] = low[(axis + 1) % 3].lerp(high[(axis + 1) % 3], cell(index % per_side));
                position[(axis + 2) % 3] = low[(axis + 2) % 3].lerp(high[(axis + 2) % 3], cell(index / per_side));
                let mut normal = Vec3::ZERO;
                normal[axis] = sign;
                points.push(at(position, normal));
            }
        }
    }
    points
}

/// Whether two estimators agree: not told apart by Welch's test, and seen well enough that 1 % would be.
pub fn agree(a: &Welford, b: &Welford) -> Result<(), String> {
    let spread = a.standard_error().hypot(b.standard_error());
    if 4.0 * spread > 0.01 * a.mean() {
        return Err(format!("too noisy to see 1 %: {} and {} ± {spread}", a.mean(), b.mean()));
    }
    let welch = welch_t_test(a, b).ok_or("no spread to judge by")?;
    if welch.p_value < 1e-4 { Err(format!("{} and {}: p = {}", a.mean(), b.mean(), welch.p_value)) } else { Ok(()) }
}
