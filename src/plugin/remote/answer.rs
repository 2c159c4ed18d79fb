//! What another process hears: the kiln's status as JSON.

use crate::bake::{BakePlan, Stage};
use crate::plugin::{BakeId, BakeStatus, KilnEnding, KilnOutcome, KilnWarning, KilnWork, RunningJob};
use bevy::remote::{BrpError, BrpResult};
use serde_json::{Value, json};

/// Another job is not done. Of the numbers that JSON-RPC leaves to applications.
pub(super) const KILN_BUSY: i16 = -23601;
/// There is no such job.
pub(super) const NO_JOB: i16 = -23602;

/// A job that was taken.
pub(super) fn answer(job: BakeId) -> Value {
    json!({ "job": job.0 })
}

/// How far a job is, or how it ended; without a number, of the one that runs or else the latest.
pub(super) fn progress_of(status: &BakeStatus, job: Option<BakeId>) -> BrpResult {
    let running = status.running().filter(|running| job.is_none_or(|job| job == running.id));
    if let Some(running) = running {
        return Ok(of_running(running));
    }
    let outcome = match job {
        Some(job) => status.outcome(job),
        None => status.outcomes().next(),
    };
    match (outcome, job) {
        (Some(outcome), _) => Ok(of_outcome(outcome)),
        (None, None) => Ok(json!({ "state": "idle" })),
        (None, Some(job)) => {
            let message = format!("there is no job {job}, or it ended long ago; kiln.bake and kiln.plan tell numbers");
            Err(BrpError { code: NO_JOB, message, data: None })
        }
    }
}

fn of_running(running: &RunningJob) -> Value {
    let state = match (running.is_waiting, running.is_paused, running.work) {
        (true, _, _) => "waiting",
        (_, true, _) => "paused",
        (_, _, KilnWork::Plan) => "planning",
        (_, _, KilnWork::Bake) => "baking",
    };
    let stage = match running.stage {
        Stage::Prepare => "prepare",
        Stage::Gather => "gather",
        Stage::Repair => "repair",
        Stage::Probes => "probes",
    };
    json!({
        "job": running.id.0,
        "state": state,
        "stage": stage,
        "fraction": running.fraction,
        "relative_stderr": running.relative_stderr,
        "seconds": running.seconds,
        "seconds_left": running.seconds_left,
    })
}

fn of_outcome(outcome: &KilnOutcome) -> Value {
    let mut answer = match &outcome.ending {
        KilnEnding::Baked { texels, kept, samples, seconds, entities } => json!({
            "state": "baked",
            "texels": texels,
            "kept": kept,
            "samples": samples,
            "seconds": seconds,
            "entities": entities,
        }),
        KilnEnding::Planned(plan) => of_plan(plan),
        KilnEnding::Failed { reason, cancelled } => {
            json!({ "state": if *cancelled { "cancelled" } else { "failed" }, "reason": reason })
        }
    };
    answer["job"] = outcome.id.0.into();
    answer["warnings"] = outcome.warnings.iter().map(of_warning).collect();
    answer
}

/// Entities as the rest of the protocol writes them.
fn of_warning(warning: &KilnWarning) -> Value {
    json!({ "sentence": warning.sentence, "entity": warning.entity.map(|entity| entity.to_bits()) })
}

fn of_plan(plan: &BakePlan) -> Value {
    let effects = plan.effects.iter().map(|planned| {
        let name = planned.effect.to_string();
        json!({ "effect": name, "on": planned.on, "reason": planned.reason, "cost_share": planned.cost_share })
    });
    let prices = plan.predicted.iter().map(|price| json!({ "error": price.error, "seconds": price.seconds }));
    json!({
        "state": "planned",
        "texels": plan.texels,
        "pages": plan.pages,
        "memory_bytes": plan.memory_bytes,
        "effects": effects.collect::<Value>(),
        "predicted": prices.collect::<Value>(),
    })
}
