//! The light meter against reference irradiance.
mod common;
use bevy_kiln::bake::{CancelToken, MeterSettings, measure_irradiance};
use bevy_kiln::trace::*;
use common::{glb, table};

#[test]
fn explore() {
    for seed in 1..7 {
        let scene = glb::load("furnace_099");
        let refs = table::load("furnace_099");
        let mut points: Vec<_> = refs.iter().map(|r| r.point).collect();
        points.truncate(8);
        let settings = MeterSettings { samples_per_point: 32768, transport: Transport{estimator: Estimator::Bsdf, seed, ..Default::default()}, ..Default::default() };
        let m = measure_irradiance(&scene, &points, &settings, &(), &CancelToken::default()).unwrap();
        let mut bias = 0.0;  let mut sse=0.0;
        for (r, e) in refs.iter().zip(&m.readings) {
            bias += (e.irradiance.x - r.irradiance.x) / r.irradiance.x / 8.0;
            sse += (e.stderr.x / r.irradiance.x / 8.0).powi(2);
        }
        println!("seed {seed}: bias {bias:.5} +- {:.5}", sse.sqrt());
    }
}
