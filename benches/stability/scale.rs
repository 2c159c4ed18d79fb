//! How large the room: the same furnace from a tenth of a millimetre to a hundred kilometres, turned so that no wall is
//! parallel to an axis.

use crate::meter::{mean_irradiance, measure};
use crate::naive::{Ending, FYROX_BIAS, GODOT_BIAS, PathTracer};
use crate::scenes::{askew, furnace, in_f64, points_on_walls};
use crate::sweep::{Axis, Curve, Effort, Side, Sweep, rms_error};
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::{Estimator, Tracer, Transport};
use glam::{Affine3A, Vec3};
use std::f64::consts::PI;

const ALBEDO: f32 = 0.8;

/// Points of each estimate, on each of six walls.
const POINTS_PER_WALL: u32 = 32;

/// Paths from each point.
const PATHS: u32 = 64;

/// Estimates that an error is the root mean square of.
const ESTIMATES: u64 = 16;

pub fn sweep(effort: Effort) -> Sweep {
    let difficulties: Vec<f64> = (-4..=5).map(|power| 10_f64.powi(power)).collect();
    let place = |&side: &f64| {
        let world = Affine3A::from_scale_rotation_translation(Vec3::splat(side as f32), askew(), Vec3::ZERO);
        let points = |seed| points_on_walls(in_f64(world), u64::from(effort.of(POINTS_PER_WALL)), seed);
        Trial { scene: furnace(world, ALBEDO), points: (0..ESTIMATES).map(points).collect() }
    };
    let trials: Vec<Trial> = difficulties.iter().map(place).collect();
    Sweep {
        name: "scale",
        title: "The same room, tiny or huge",
        about: format!(
            "A closed room of albedo {ALBEDO} whose walls glow, askew to the axes: E = π/(1 − ρ) on every wall at any\n\
             size. {} points × {PATHS} paths; root mean square error of {ESTIMATES} estimates. Naive: rays that start\n\
             a constant length off the surface.",
            6 * effort.of(POINTS_PER_WALL)
        ),
        difficulty: Axis { title: "side of the room [m]", decades: [-4, 5], step: 3 },
        error: Axis { title: "relative error", decades: [-5, 1], step: 1 },
        difficulties,
        curves: vec![
            Curve {
                side: Side::Ours,
                name: "bevy_kiln",
                errors: trials.iter().map(Trial::ours).collect(),
                label: [0.38, 0.2],
            },
            Curve {
                side: Side::Naive,
                name: "bias 0.5 mm (Godot)",
                errors: trials.iter().map(|trial| trial.naive(GODOT_BIAS)).collect(),
                label: [0.33, 0.66],
            },
            Curve {
                side: Side::Naive,
                name: "bias 10 mm (Fyrox)",
                errors: trials.iter().map(|trial| trial.naive(FYROX_BIAS)).collect(),
                label: [0.26, 0.92],
            },
        ],
        notes: vec![],
    }
}

/// A furnace of [`ALBEDO`] and where to measure in it, per estimate.
pub struct Trial {
    pub scene: Scene,
    pub points: Vec<Vec<MeterPoint>>,
}

impl Trial {
    /// Our error. Light is found by meeting it, as by the naive method.
    pub fn ours(&self) -> f64 {
        let estimate = |(seed, points): (usize, &Vec<MeterPoint>)| {
            let transport = Transport { estimator: Estimator::Bsdf, seed: seed as u64, ..Transport::default() };
            mean_irradiance(&measure(&self.scene, points, PATHS, transport))
        };
        rms_error(self.points.iter().enumerate().map(estimate), truth())
    }

    /// The naive method's error with a constant bias [m].
    pub fn naive(&self, bias: f32) -> f64 {
        let tracer = Tracer::new(&self.scene);
        let naive = PathTracer { tracer: &tracer, albedo: ALBEDO, bias, ending: Ending::Roulette };
        let estimate = |(seed, points): (usize, &Vec<MeterPoint>)| naive.mean_irradiance(points, PATHS, seed as u64);
        rms_error(self.points.iter().enumerate().map(estimate), truth())
    }
}

fn truth() -> f64 {
    PI / (1.0 - f64::from(ALBEDO))
}
