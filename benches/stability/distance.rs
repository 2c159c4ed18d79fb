//! How near the lamp: a receiver from a ten-thousandth of a lamp's width to ten thousand widths under it.

use crate::meter::{mean_irradiance, measure};
use crate::numbers::Numbers;
use crate::scenes::{Stage, facing};
use crate::sweep::{Axis, Curve, Effort, Side, Sweep, rms_error};
use bevy_kiln::artefact::StableId;
use bevy_kiln::math::{combine, polygon_irradiance};
use bevy_kiln::scene::{Light, RectLight};
use bevy_kiln::trace::Transport;
use glam::{Affine3A, DVec3, Vec3};
use std::f32::consts::FRAC_PI_2;

/// Samples of each estimate.
const SAMPLES: u32 = 1024;

/// Estimates that an error is the root mean square of.
const ESTIMATES: u32 = 512;

/// Where the receiver's normal pierces the lamp, from its middle [widths]: nowhere in particular.
const ASIDE: DVec3 = DVec3::new(0.17, 0.0, 0.11);

pub fn sweep(effort: Effort) -> Sweep {
    let difficulties: Vec<f64> = (-4..=4).rev().map(|power| 10_f64.powi(power)).collect();
    let estimates = u64::from(effort.of(ESTIMATES));
    let errors = |estimate: &dyn Fn(f64, u64) -> f64| {
        let error = |&height: &f64| rms_error((0..estimates).map(|seed| estimate(height, seed)), truth(height));
        difficulties.iter().map(error).collect::<Vec<f64>>()
    };
    let ours = errors(&ours);
    let naive = errors(&naive);
    Sweep {
        name: "distance",
        title: "Right under the lamp",
        about: format!(
            "A square lamp, a receiver so many lamp widths under it. {SAMPLES} samples on the same kind of points;\n\
             root mean square error of {estimates} estimates against the closed form. Naive: a point chosen\n\
             uniformly on the lamp, E = L·cosθ·cosθ'·A/d², the textbook's area light."
        ),
        difficulty: Axis { title: "distance [lamp widths]", decades: [4, -4], step: 2 },
        error: Axis { title: "relative error", decades: [-9, 3], step: 3 },
        difficulties,
        curves: vec![
            Curve { side: Side::Ours, name: "bevy_kiln", errors: ours, label: [0.66, 0.4] },
            Curve { side: Side::Naive, name: "area sampling", errors: naive, label: [0.14, 0.64] },
        ],
        notes: vec![
            "So near, area sampling nearly always finds nothing, and once in many thousand samples far too much: its \
             true root\nmean square error at 10⁻⁴ is 100 (√(A/3πh²N)), of which so few estimates see only the darkness."
                .into(),
        ],
    }
}

/// The lamp's corners, seen from the receiver.
fn corners(height: f64) -> [DVec3; 4] {
    [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, z)| DVec3::new(x, height, z) - ASIDE)
}

fn truth(height: f64) -> f64 {
    polygon_irradiance(&corners(height), DVec3::Y)
}

fn ours(height: f64, seed: u64) -> f64 {
    let lamp = Light::Rect(RectLight {
        id: StableId::new("lamp"),
        name: "lamp".into(),
        // Local −Z, where it shines, is down.
        world_from_local: Affine3A::from_rotation_x(-FRAC_PI_2),
        width: 1.0,
        height: 1.0,
        radiance: Vec3::ONE,
        range: None,
    });
    let scene = Stage::default().light(lamp).build();
    let points = [facing(ASIDE - DVec3::Y * height, Vec3::Y)];
    mean_irradiance(&measure(&scene, &points, SAMPLES, Transport { seed, ..Transport::default() }))
}

fn naive(height: f64, seed: u64) -> f64 {
    let [low, _, high, _] = corners(height).map(DVec3::as_vec3);
    let sample = |index| {
        let [u, v, ..] = Numbers::new(combine(seed, 1), index).draw(0);
        let at = low + (high - low) * Vec3::new(u, 0.0, v);
        // cos θ = cos θ' = height / d, and the area is 1.
        let (height, squared) = (low.y, at.length_squared());
        f64::from(height * height / (squared * squared))
    };
    (0..u64::from(SAMPLES)).map(sample).sum::<f64>() / f64::from(SAMPLES)
}
