//! How smooth the metal: a meter over a floor of white metal under a white sky. Whatever the roughness, the floor gives
//! back all that it gets, and E = π.

use crate::meter::measure;
use crate::numbers::Numbers;
use crate::plain_ggx::PlainGgx;
use crate::scenes::{Stage, facing};
use crate::sweep::{Axis, Curve, Effort, Side, Sweep, rms_error};
use bevy_kiln::math::{combine, square_to_cosine_hemisphere};
use bevy_kiln::scene::{Material, Scattering, Scene, Standard};
use bevy_kiln::trace::Transport;
use glam::{Affine3A, DVec3, Vec2, Vec3};
use std::f64::consts::PI;

/// Samples of each estimate.
const SAMPLES: u32 = 1024;

/// Estimates that an error is the root mean square of.
const ESTIMATES: u32 = 256;

const ROUGHNESSES: [f32; 13] = [1.0, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05, 0.032, 0.01, 3e-3, 1e-3, 3e-4, 1e-4];

pub fn sweep(effort: Effort) -> Sweep {
    let estimates = effort.of(ESTIMATES);
    let ours = |&roughness: &f32| {
        let scene = floor(roughness);
        // All places over the floor are alike, and each has random numbers of its own.
        let meter = |index| facing(DVec3::new(f64::from(index), 0.3, 0.0), Vec3::NEG_Y);
        let meters: Vec<_> = (0..estimates).map(meter).collect();
        let readings = measure(&scene, &meters, SAMPLES, Transport::default()).readings;
        rms_error(readings.iter().map(|reading| reading.irradiance.y), PI)
    };
    let naive = |&roughness: &f32| {
        let metal = PlainGgx::new(roughness);
        rms_error((0..u64::from(estimates)).map(|seed| naive(&metal, seed)), PI)
    };
    Sweep {
        name: "roughness",
        title: "Metal as smooth as a mirror",
        about: format!(
            "A meter that faces a floor of white metal under a white sky: E = π at any roughness. {SAMPLES} samples;\n\
             root mean square error of {estimates} estimates. Naive: the GGX lobe as printed, in f32, made good for\n\
             light between its facets by 1/albedo (Turquin 2019), in directions that know of nothing but the cosine."
        ),
        difficulty: Axis { title: "perceptual roughness √α", decades: [0, -4], step: 1 },
        error: Axis { title: "relative error", decades: [-7, 3], step: 2 },
        difficulties: ROUGHNESSES.iter().map(|&roughness| f64::from(roughness)).collect(),
        curves: vec![
            Curve {
                side: Side::Ours,
                name: "bevy_kiln",
                errors: ROUGHNESSES.iter().map(ours).collect(),
                label: [0.45, 0.28],
            },
            Curve {
                side: Side::Naive,
                name: "cosine-sampled GGX in f32",
                errors: ROUGHNESSES.iter().map(naive).collect(),
                label: [0.12, 0.93],
            },
        ],
        notes: vec!["Below a roughness of 0.032 (α < 10⁻³) ours counts as a mirror.".into()],
    }
}

fn floor(perceptual_roughness: f32) -> Scene {
    let metal = Standard { metallic: 1.0, perceptual_roughness, ..Standard::default() };
    let metal = Material::scattering("white metal", Vec3::ONE, Scattering::Standard(Box::new(metal)));
    let [x, z] = [Vec3::X, Vec3::Z].map(|axis| axis * 2000.0);
    Stage::default().quad("floor", Affine3A::IDENTITY, -0.5 * (x + z), [z, x], metal).white_sky().build()
}

fn naive(metal: &PlainGgx, seed: u64) -> f64 {
    let sample = |index| {
        let numbers = Numbers::new(combine(seed, 3), index);
        let [wo, wi] = [0, 1].map(|set| {
            let [u, v, ..] = numbers.draw(set);
            square_to_cosine_hemisphere(Vec2::new(u, v))
        });
        // The densities' cosines cancel; what is left is π of the meter and π of the lobe, in a sky of 1.
        PI * f64::from(std::f32::consts::PI * metal.evaluate(wo, wi))
    };
    (0..u64::from(SAMPLES)).map(sample).sum::<f64>() / f64::from(SAMPLES)
}
