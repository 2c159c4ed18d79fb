//! A light meter: irradiance at points of the world, on surfaces or in mid-air.

use super::endless::{refuse_endless_paths, spread};
use super::gather::{Estimate, KeyKind, Paths, key};
use super::workers::Workers;
use super::{BakeError, BakeReport, BakeWarning, CancelToken, ProgressSink, Stage};
use crate::math::combine;
use crate::scene::Scene;
use crate::trace::{Compiled, Transport};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;
use std::num::NonZeroUsize;
use std::time::Instant;

/// Where to hold the meter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeterPoint {
    /// The point [m]. Within 1e-5 of the scene's extent from a surface it counts as lying on the nearest one, on the
    /// side of `normal`; and so it does far from the world's origin where only its rounding to f32 keeps it off.
    pub position: Vec3,
    /// The direction that the meter faces; its length does not matter.
    pub normal: Vec3,
}

/// What the meter shows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeterReading {
    /// Irradiance per channel [lx].
    pub irradiance: DVec3,
    /// Standard error of its mean [lx].
    pub stderr: DVec3,
    /// Paths that it is the mean of.
    pub samples: u64,
}

/// All readings, in the order of the points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurement {
    /// One per point.
    pub readings: Vec<MeterReading>,
    /// What was done.
    pub report: BakeReport,
}

/// What a measurement is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct MeterSettings {
    /// How light is followed.
    pub transport: Transport,
    /// Paths from each point; rounded up to a multiple of [`REPLICATES`](super::REPLICATES).
    pub samples_per_point: u32,
    /// Threads that trace; `None` for all cores.
    pub threads: Option<NonZeroUsize>,
}

impl Default for MeterSettings {
    fn default() -> Self {
        Self { transport: Transport::default(), samples_per_point: 256, threads: None }
    }
}

/// Measures the irradiance at points.
///
/// # Errors
///
/// [`BakeError::Settings`] for a point that is no number or a normal without direction,
/// [`BakeError::KeepsLight`], [`BakeError::Cancelled`].
pub fn measure_irradiance(
    scene: &Scene,
    points: &[MeterPoint],
    settings: &MeterSettings,
    progress: &dyn ProgressSink,
    cancel: &CancelToken,
) -> Result<Measurement, BakeError> {
    let clock = Instant::now();
    let MeterSettings { transport, samples_per_point, threads } = settings;
    if *samples_per_point == 0 {
        let reason = "a point needs at least one path; ask for 1 or more".to_owned();
        return Err(BakeError::Settings { setting: "spp", reason });
    }
    for (index, point) in points.iter().enumerate() {
        if !point.position.is_finite() || point.normal.try_normalize().is_none() {
            let reason = format!("point {} has a position that is no number or a normal of no length", index + 1);
            return Err(BakeError::Settings { setting: "points", reason });
        }
    }
    let workers = Workers::new(*threads, progress, cancel)?;
    workers.announce(Stage::Prepare)?;
    let Compiled { tracer, faults, census } = Compiled::new(scene, transport);
    refuse_endless_paths(scene, &tracer, transport, |probe, sobol, tally| {
        if let Some(point) = spread(points, probe) {
            let start = tracer.start_at(point.position, point.normal.normalize());
            tracer.diffuse_radiance(&start, sobol, transport, tally);
        }
    })?;
    let work = workers.gather(
        points,
        |point, cancel| {
            let start = tracer.start_at(point.position, point.normal.normalize());
            let key = key(KeyKind::Point, transport.seed, bits(point.position), bits(point.normal));
            Estimate::gather(
                Paths { key, count: *samples_per_point, clamp: transport.clamp },
                cancel,
                |sobol, tally| tracer.diffuse_radiance(&start, sobol, transport, tally),
            )
        },
        Estimate::relative_stderr,
    )?;
    let reading = |estimate: &Estimate| MeterReading {
        irradiance: estimate.mean * PI,
        stderr: estimate.stderr * PI,
        samples: estimate.samples,
    };
    let warnings = faults.into_iter().map(BakeWarning::from);
    let warnings = warnings.chain(BakeWarning::of_transport(transport, &census));
    Ok(Measurement {
        readings: work.results.iter().map(reading).collect(),
        report: BakeReport::of(&work, clock.elapsed(), transport, warnings),
    })
}

/// A key of a vector: a point's numbers do not depend on its place in the list.
fn bits(vector: Vec3) -> u64 {
    vector.to_array().iter().fold(0, |key, component| combine(key, u64::from(component.to_bits())))
}
