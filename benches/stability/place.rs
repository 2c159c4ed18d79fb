//! How far from the origin: the same room of 4 m, up to a thousand kilometres away.

use crate::naive::{FYROX_BIAS, GODOT_BIAS};
use crate::scale::Trial;
use crate::scenes::{askew, facing, furnace, unit};
use crate::sweep::{Axis, Curve, Effort, Side, Sweep};
use bevy_kiln::math::combine;
use glam::{Affine3A, DVec3, Vec3};

/// Side of the room [m].
const SIDE: f32 = 4.0;

/// A direction in which all coordinates grow; a unit vector.
const AWAY: DVec3 = DVec3::new(0.6, 0.48, 0.64);

/// Points of each estimate.
const POINTS: u32 = 192;

/// Estimates that an error is the root mean square of.
const ESTIMATES: u64 = 16;

pub fn sweep(effort: Effort) -> Sweep {
    let difficulties: Vec<f64> = vec![1.0, 1e1, 1e2, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6];
    let place = |&away: &f64| {
        let centre = AWAY * away;
        let world = Affine3A::from_scale_rotation_translation(Vec3::splat(SIDE), askew(), centre.as_vec3());
        let points = |seed| (0..u64::from(effort.of(POINTS))).map(move |index| combine(seed, index));
        let points = |seed| points(seed).map(|key| point(centre, key)).collect();
        Trial { scene: furnace(world, 0.8), points: (0..ESTIMATES).map(points).collect() }
    };
    let trials: Vec<Trial> = difficulties.iter().map(place).collect();
    let naive = |bias| trials.iter().map(|trial| trial.naive(bias)).collect();
    Sweep {
        name: "place",
        title: "Far from the origin",
        about: format!(
            "The closed room of albedo 0.8 again, {SIDE} m wide, so far from the origin; f32 rounds its corners there\n\
             (by 8 mm at 100 km), but it stays closed and E = π/(1 − ρ) at every point in it. Meters in mid-air,\n\
             {} points × 64 paths; root mean square error of {ESTIMATES} estimates. Naive: as before.",
            effort.of(POINTS)
        ),
        difficulty: Axis { title: "distance from the origin [m]", decades: [0, 6], step: 1 },
        error: Axis { title: "relative error", decades: [-5, 1], step: 1 },
        difficulties,
        curves: vec![
            Curve {
                side: Side::Ours,
                name: "bevy_kiln",
                errors: trials.iter().map(Trial::ours).collect(),
                label: [0.1, 0.2],
            },
            Curve { side: Side::Naive, name: "bias 0.5 mm (Godot)", errors: naive(GODOT_BIAS), label: [0.2, 0.72] },
            Curve { side: Side::Naive, name: "bias 10 mm (Fyrox)", errors: naive(FYROX_BIAS), label: [0.5, 0.92] },
        ],
        notes: vec![],
    }
}

/// A meter within half the room, facing anywhere.
fn point(centre: DVec3, key: u64) -> bevy_kiln::bake::MeterPoint {
    let [x, y, z, up, around] = [0, 1, 2, 3, 4].map(|axis| unit(combine(key, axis)) - 0.5);
    let (sin, cos) = (std::f64::consts::TAU * around).sin_cos();
    let level = (1.0 - 4.0 * up * up).sqrt();
    let normal = DVec3::new(level * cos, 2.0 * up, level * sin).as_vec3().normalize();
    facing(centre + DVec3::new(x, y, z) * 0.5 * f64::from(SIDE), normal)
}
