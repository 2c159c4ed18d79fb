//! The kiln for another process: methods of the Bevy Remote Protocol (JSON-RPC 2.0), put into the app's `RemotePlugin`
//! if it has one. None of them waits: what takes time is a job, and `kiln.progress` tells how far it is.
//!
//! | Method | Parameters | Result |
//! |---|---|---|
//! | `kiln.bake` | any of [`BakeParams`](params::BakeParams) | `{"job": n}` |
//! | `kiln.plan` | the same | `{"job": n}` |
//! | `kiln.progress` | `{"job": n}`, or nothing for the latest | how far it is, or how it ended |
//! | `kiln.pause`, `kiln.resume`, `kiln.cancel` | nothing | `{"job": n}` |
//! | `kiln.clear` | nothing | `null` |

mod answer;
mod params;

use super::baking::{BakeLightmaps, BakeStatus, KilnBusy, KilnControl};
use answer::{KILN_BUSY, NO_JOB, answer, progress_of};
use bevy::prelude::*;
use bevy::remote::{BrpError, BrpResult, RemoteInstantMethodSystemId, RemoteMethodSystemId, RemoteMethods};
use params::{BakeParams, ProgressParams, read};
use serde_json::Value;

/// Adds the methods where there is somebody to call them. After every plugin is built, so that their order is free.
pub(super) fn finish(app: &mut App) {
    let world = app.world_mut();
    if !world.contains_resource::<RemoteMethods>() {
        return;
    }
    let methods: [(&str, RemoteInstantMethodSystemId); 7] = [
        ("kiln.bake", world.register_system(bake)),
        ("kiln.plan", world.register_system(plan)),
        ("kiln.progress", world.register_system(progress)),
        ("kiln.pause", world.register_system(pause)),
        ("kiln.resume", world.register_system(resume)),
        ("kiln.cancel", world.register_system(cancel)),
        ("kiln.clear", world.register_system(clear)),
    ];
    let mut known = world.resource_mut::<RemoteMethods>();
    for (name, system) in methods {
        known.insert(name, RemoteMethodSystemId::Instant(system));
    }
}

fn bake(In(params): In<Option<Value>>, mut kiln: KilnControl) -> BrpResult {
    let settings = settings(params, &mut kiln)?;
    kiln.bake(settings).map(answer).map_err(busy)
}

fn plan(In(params): In<Option<Value>>, mut kiln: KilnControl) -> BrpResult {
    let settings = settings(params, &mut kiln)?;
    kiln.plan(settings).map(answer).map_err(busy)
}

/// The next bake, and over it what the request says.
fn settings(params: Option<Value>, kiln: &mut KilnControl) -> BrpResult<BakeLightmaps> {
    read::<BakeParams>(params)?.over(kiln.next_bake().clone())
}

fn progress(In(params): In<Option<Value>>, status: Res<BakeStatus>) -> BrpResult {
    let ProgressParams { job } = read(params)?;
    progress_of(&status, job)
}

fn pause(In(_): In<Option<Value>>, mut kiln: KilnControl) -> BrpResult {
    kiln.pause().map(answer).ok_or_else(nothing_runs)
}

fn resume(In(_): In<Option<Value>>, mut kiln: KilnControl) -> BrpResult {
    kiln.resume().map(answer).ok_or_else(nothing_runs)
}

fn cancel(In(_): In<Option<Value>>, mut kiln: KilnControl) -> BrpResult {
    kiln.cancel().map(answer).ok_or_else(nothing_runs)
}

fn clear(In(_): In<Option<Value>>, mut kiln: KilnControl) -> BrpResult {
    kiln.clear();
    Ok(Value::Null)
}

fn busy(busy: KilnBusy) -> BrpError {
    let sentence = match busy {
        KilnBusy::Baking(job) => format!("a bake is running (job {job}); wait for it or call kiln.cancel first"),
        KilnBusy::Planning(job) => format!("a plan is running (job {job}); wait for it or call kiln.cancel first"),
    };
    BrpError { code: KILN_BUSY, message: sentence, data: None }
}

fn nothing_runs() -> BrpError {
    let message = "no job is running; start one with kiln.bake or kiln.plan".to_owned();
    BrpError { code: NO_JOB, message, data: None }
}
