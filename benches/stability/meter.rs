//! Our side: the product's public API on one thread, and what its estimates are off by.

use bevy_kiln::bake::{CancelToken, Measurement, MeterPoint, MeterSettings, measure_irradiance};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::Transport;
use std::num::NonZeroUsize;

/// Measures at points, so many paths each.
pub fn measure(scene: &Scene, points: &[MeterPoint], samples_per_point: u32, transport: Transport) -> Measurement {
    let settings = MeterSettings { transport, samples_per_point, threads: NonZeroUsize::new(1) };
    measure_irradiance(scene, points, &settings, &(), &CancelToken::default()).expect("a sound scene and sound points")
}

/// Mean irradiance over the points [lx].
pub fn mean_irradiance(measurement: &Measurement) -> f64 {
    let readings = &measurement.readings;
    readings.iter().map(|reading| reading.irradiance.y).sum::<f64>() / readings.len() as f64
}
