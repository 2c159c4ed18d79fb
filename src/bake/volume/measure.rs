//! What a probe measures: the moments of the light around it, from which the ambient cube of least squares follows
//! (`math::AmbientCube`), in independently scrambled replicates whose spread is its error.

use crate::bake::CancelToken;
use crate::bake::gather::{Estimate, KeyKind, REPLICATES, key};
use crate::bake::tiles::{ErrorTarget, MOST_PATHS};
use crate::math::{AmbientCube, FACES, ambient_cube_weights, combine, luminance, student_t_two_sided_95};
use crate::trace::{Arrived, Sobol, Tally, Tracer, Transport};
use glam::{DVec3, Vec3};

/// Paths of each run between two looks at the cancel switch.
const CANCEL_INTERVAL: u64 = 32;

/// Moments of the light around a point, as `math::AmbientCube` has them [cd/m²].
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Moments(pub(super) [DVec3; FACES]);

impl Moments {
    /// Luminance of the mean radiance over all directions, whose six weights add up to 1 [cd/m²].
    pub(super) fn luminance(&self) -> f64 {
        luminance(self.0.iter().sum::<DVec3>())
    }
}

/// Sums over a probe's paths so far.
#[derive(Clone, Debug)]
pub(super) struct Probe {
    key: u64,
    /// Where it stands [m, world].
    point: Vec3,
    runs: [[DVec3; FACES]; REPLICATES as usize],
    /// Paths of each run.
    per_run: u64,
    tally: Tally,
    not_light: u64,
    /// What the clamp took, as luminance, over all paths.
    taken: f64,
}

impl Probe {
    /// At a point of the world [m].
    pub(super) fn new(seed: u64, point: Vec3) -> Self {
        let bits = point.to_array().iter().fold(0, |key, along| combine(key, u64::from(along.to_bits())));
        Self {
            key: key(KeyKind::VolumeProbe, seed, 0, bits),
            point,
            runs: [[DVec3::ZERO; FACES]; REPLICATES as usize],
            per_run: 0,
            tally: Tally::default(),
            not_light: 0,
            taken: 0.0,
        }
    }

    /// Carries on until there are at least `count` paths in all. `None` if cancelled.
    pub(super) fn extend(
        mut self,
        count: u32,
        tracer: &Tracer,
        transport: &Transport,
        cancel: &CancelToken,
    ) -> Option<Self> {
        let per_run = u64::from(count.div_ceil(REPLICATES));
        for (number, run) in self.runs.iter_mut().enumerate() {
            for index in self.per_run..per_run {
                if index.is_multiple_of(CANCEL_INTERVAL) && cancel.is_cancelled() {
                    return None;
                }
                let numbers = Sobol::new(combine(self.key, number as u64), index);
                let arrived = tracer.light_around(self.point, &numbers, transport, &mut self.tally);
                let sum = arrived[0].radiance + arrived[1].radiance;
                if !sum.is_finite() || arrived.iter().any(|light| light.radiance.min_element() < 0.0) {
                    self.not_light += 1;
                    continue;
                }
                let brightest = sum.max_element();
                let kept = transport.clamp.filter(|&limit| brightest > limit).map_or(1.0, |limit| limit / brightest);
                self.taken += luminance(sum * (1.0 - kept));
                for Arrived { direction, radiance } in arrived {
                    for (moment, weight) in run.iter_mut().zip(ambient_cube_weights(direction)) {
                        *moment += (radiance * (kept * weight)).as_dvec3();
                    }
                }
            }
        }
        self.per_run = self.per_run.max(per_run);
        Some(self)
    }

    /// Carries on until the probe is known as well as asked for, by as many paths again each time.
    pub(super) fn until(
        mut self,
        target: ErrorTarget,
        tracer: &Tracer,
        transport: &Transport,
        cancel: &CancelToken,
    ) -> Option<Self> {
        while !target.is_met(&self.estimate()) && self.paths() < u64::from(MOST_PATHS) {
            let paths = self.paths() as u32;
            self = self.extend(2 * paths, tracer, transport, cancel)?;
        }
        Some(self)
    }

    fn paths(&self) -> u64 {
        self.per_run * u64::from(REPLICATES)
    }

    /// The mean over all runs.
    pub(super) fn moments(&self) -> Moments {
        let all = self.runs.iter().fold([DVec3::ZERO; FACES], |sum, run| std::array::from_fn(|at| sum[at] + run[at]));
        Moments(all.map(|moment| moment / self.paths().max(1) as f64))
    }

    /// E/π averaged over all normals, and its error: that of a face, as the root of the mean square over all six.
    pub(super) fn estimate(&self) -> Estimate {
        let runs = f64::from(REPLICATES);
        let cube = |moments: &[DVec3; FACES], scale: f64| AmbientCube::unbounded(&moments.map(|moment| moment * scale));
        let mean = cube(&self.moments().0, 1.0);
        let of_runs = self.runs.each_ref().map(|run| cube(run, 1.0 / self.per_run.max(1) as f64));
        let spread = |error: &dyn Fn(DVec3) -> f64| -> f64 {
            let of_face = |run: &AmbientCube, face: usize| error(run.faces[face] - mean.faces[face]).powi(2);
            let squares = of_runs.iter().flat_map(|run| (0..FACES).map(move |face| of_face(run, face)));
            (squares.sum::<f64>() / (runs * (runs - 1.0) * FACES as f64)).sqrt()
        };
        let luminance_error = spread(&luminance);
        let every_second = of_runs.iter().step_by(2).map(AmbientCube::mean).sum::<DVec3>();
        Estimate {
            mean: mean.mean(),
            stderr: DVec3::new(spread(&|error| error.x), spread(&|error| error.y), spread(&|error| error.z)),
            luminance_error,
            half: every_second / (0.5 * runs),
            samples: self.paths(),
            rays: self.tally.rays,
            accepted: 1.0,
            clamped: self.taken / self.paths().max(1) as f64,
            not_light: self.not_light,
            endless: self.tally.endless,
            half_width: student_t_two_sided_95(runs - 1.0) * luminance_error,
            level: mean.luminance(),
        }
    }
}
