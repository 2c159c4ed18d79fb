//! How white the walls: a furnace in which light is reflected a thousand times before it is gone.

use crate::meter::{mean_irradiance, measure};
use crate::naive::{Ending, PathTracer};
use crate::scenes::{askew, furnace, in_f64, points_on_walls};
use crate::sweep::{Axis, Curve, Effort, Side, Sweep, rms_error};
use bevy_kiln::bake::BakeReport;
use bevy_kiln::trace::{Estimator, Tracer, Transport};
use glam::Affine3A;
use std::f64::consts::PI;

/// Points of each estimate, on each of six walls.
const POINTS_PER_WALL: u32 = 8;

/// Paths from each point.
const PATHS: u32 = 64;

/// Estimates that an error is the root mean square of.
const ESTIMATES: u64 = 16;

const ALBEDOS: [f32; 12] = [0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.998, 0.999];

/// A bias that does no harm in a room of a metre.
const SMALL_BIAS: f32 = 1e-5;

pub fn sweep(effort: Effort) -> Sweep {
    let per_wall = u64::from(effort.of(POINTS_PER_WALL));
    let world = Affine3A::from_quat(askew());
    let points: Vec<_> = (0..ESTIMATES).map(|seed| points_on_walls(in_f64(world), per_wall, seed)).collect();
    let truth = |albedo: f32| PI / (1.0 - f64::from(albedo));
    let mut notes = vec![format!(
        "What it costs ({} paths each):\n{:>10}{:>14}{:>14}{:>14}{:>18}",
        6 * per_wall * u64::from(PATHS),
        "albedo",
        "rays/path",
        "rays",
        "processor s",
        "paths for 1 %"
    )];
    let mut ours = Vec::new();
    for albedo in ALBEDOS {
        let scene = furnace(world, albedo);
        let run = |seed: u64| {
            let transport = Transport { estimator: Estimator::Bsdf, seed, ..Transport::default() };
            measure(&scene, &points[seed as usize], PATHS, transport)
        };
        let runs: Vec<_> = (0..ESTIMATES).map(run).collect();
        let error = rms_error(runs.iter().map(mean_irradiance), truth(albedo));
        notes.push(cost(albedo, &runs[0].report, error));
        ours.push(error);
    }
    let naive = |cap: u32| {
        let error = |&albedo: &f32| {
            let tracer = Tracer::new(&furnace(world, albedo));
            let naive = PathTracer { tracer: &tracer, albedo, bias: SMALL_BIAS, ending: Ending::Cap(cap) };
            let estimate = |seed: u64| naive.mean_irradiance(&points[seed as usize], PATHS, seed);
            rms_error((0..ESTIMATES).map(estimate), truth(albedo))
        };
        ALBEDOS.iter().map(error).collect()
    };
    Sweep {
        name: "albedo",
        title: "Walls as white as snow",
        about: format!(
            "A closed room whose walls glow and reflect ρ: E = π/(1 − ρ). {} points × {PATHS} paths; root mean square\n\
             error of {ESTIMATES} estimates. Naive: paths that end after so many bounces, which loses ρⁿ⁺¹ of the light.",
            6 * per_wall
        ),
        difficulty: Axis { title: "1/(1 − ρ), reflections of light", decades: [0, 3], step: 1 },
        error: Axis { title: "relative error", decades: [-5, 1], step: 1 },
        difficulties: ALBEDOS.iter().map(|&albedo| 1.0 / (1.0 - f64::from(albedo))).collect(),
        curves: vec![
            Curve { side: Side::Ours, name: "bevy_kiln", errors: ours, label: [0.5, 0.3] },
            Curve { side: Side::Naive, name: "3 bounces (Godot)", errors: naive(3), label: [0.1, 0.92] },
            Curve { side: Side::Naive, name: "8 bounces", errors: naive(8), label: [0.38, 0.64] },
        ],
        notes,
    }
}

/// A line about what one estimate cost, and how many paths would bring its error to 1 %.
fn cost(albedo: f32, report: &BakeReport, error: f64) -> String {
    let BakeReport { rays, samples, cpu_seconds, .. } = report;
    let (per_path, enough) = (*rays as f64 / *samples as f64, (error / 0.01).powi(2) * *samples as f64);
    format!("{albedo:>10}{per_path:>14.1}{rays:>14}{cpu_seconds:>14.3}{enough:>18.0}")
}
