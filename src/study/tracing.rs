//! Receivers traced by each technique in turn, and by the reference.

use super::budget::{Budget, Part};
use super::curve::{Snapshot, Trail};
use super::technique::Technique;
use super::truth::Truth;
use super::{Reference, StudySettings};
use crate::bake::{BakeError, REPLICATES, Receivers, Sums};
use std::time::{Duration, Instant};

/// Sets the reference's random numbers apart from all others.
const SALT: u64 = 0x0074_7275_7468;

/// How many times the paths of the longest curve the reference gets, where paths were asked for.
pub(super) const REFERENCE_PATHS: f64 = 8.0;

/// Weight of the reference, which gets besides what the others leave.
pub(super) const REFERENCE_WEIGHT: f64 = 25.0;

/// Longest time between two looks at the clock while the reference is traced [s].
const STEP: f64 = 2.0;

/// Traces one technique as long as it may.
pub(super) fn trace(
    receivers: &Receivers<'_>,
    technique: Technique,
    settings: &StudySettings,
    part: &Part<'_>,
) -> Result<Trail, BakeError> {
    let manner = technique.manner(settings);
    let of_all = receivers.texels() as f64 / receivers.count().max(1) as f64;
    let first_pass = receivers.first_pass().map_or(0.0, |first| first.cpu_seconds);
    let state = std::cell::RefCell::new((receivers.sums(0), Duration::ZERO));
    let mut snapshots = Vec::new();
    part.double(
        |count| {
            let (sums, cpu) = &mut *state.borrow_mut();
            *cpu += receivers.carry_on(receivers.tracer(), &manner, sums, count)?;
            Ok::<(), BakeError>(())
        },
        |paths| {
            let (sums, cpu) = &*state.borrow();
            snapshots.push(Snapshot {
                paths,
                cpu_seconds: first_pass + of_all * cpu.as_secs_f64(),
                means: sums.iter().map(Sums::mean).collect(),
                variances: sums.iter().map(Sums::variance).collect(),
            });
        },
    )?;
    Ok(Trail { technique, snapshots })
}

/// Traces the reference: what a bake does, with other random numbers, for as long as there is time.
pub(super) fn reference(
    receivers: &Receivers<'_>,
    settings: &StudySettings,
    budget: &mut Budget<'_>,
) -> Result<(Truth, Reference), BakeError> {
    let manner = Technique::Mis.manner(settings);
    let part = budget.part("reference", REFERENCE_WEIGHT, REFERENCE_PATHS);
    let (mut sums, mut paths, mut cpu) = (receivers.sums(SALT), 0, Duration::ZERO);
    let clock = Instant::now();
    let mut step = REPLICATES;
    while paths < part.most() {
        let next = part.most().min(paths + step);
        cpu += receivers.carry_on(receivers.tracer(), &manner, &mut sums, next)?;
        paths = next;
        let seconds = clock.elapsed().as_secs_f64();
        let left = part.left();
        part.report(left.map_or(f64::from(paths) / f64::from(part.most()), |left| seconds / (seconds + left)));
        let room = left.unwrap_or(STEP).min(STEP).min(seconds.max(0.01));
        step = (room * f64::from(paths) / seconds.max(1e-9)) as u32 / REPLICATES * REPLICATES;
        if step == 0 && left.is_some() {
            break;
        }
        step = step.max(REPLICATES);
    }
    let truth = Truth::new(sums.iter().map(Sums::mean).collect(), sums.iter().map(Sums::variance).collect());
    let of_all = receivers.texels() as f64 / receivers.count().max(1) as f64;
    let reference =
        Reference { mean: truth.mean(), paths, error: truth.own_error(), cpu_seconds: of_all * cpu.as_secs_f64() };
    Ok((truth, reference))
}
