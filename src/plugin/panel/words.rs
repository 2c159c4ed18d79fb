//! The kiln's status in words and numbers for people.

use crate::bake::{BakePlan, Prediction, Stage};
use crate::plugin::{BakeStatus, KilnComparison, KilnEnding, KilnWork, RunningJob};

/// What the kiln is at, in a line or two.
pub(super) fn status(status: &BakeStatus) -> String {
    match (status.running(), status.outcomes().next()) {
        (Some(running), _) => of_running(running),
        (None, Some(outcome)) => of_ending(&outcome.ending),
        (None, None) => "Nothing is baked yet".to_owned(),
    }
}

/// How far the picture beside the frame is; nothing where there is none.
pub(super) fn comparison(comparison: &KilnComparison) -> String {
    let KilnComparison { is_on, paths, asked, failure, .. } = comparison;
    match (failure, is_on, paths) {
        (Some(reason), ..) => format!("No picture: {reason}"),
        (None, false, _) => String::new(),
        (None, true, 0) => "Left of the line the game, right of it the truth: a first look".to_owned(),
        (None, true, paths) => {
            format!("Left of the line the game, right of it the truth: {paths} of {asked} paths for each pixel")
        }
    }
}

fn of_running(running: &RunningJob) -> String {
    let work = match (running.work, running.stage, running.is_waiting) {
        (_, _, true) => "Waits for the end of the frame",
        (KilnWork::Plan, _, _) => "Plans",
        (_, Stage::Prepare, _) => "Prepares",
        (_, Stage::Gather, _) => "Traces",
        (_, Stage::Repair, _) => "Fills borders",
        (_, Stage::Probes, _) => "Probes the air",
    };
    let mut line = format!("{work}, {:.0} %", 100.0 * running.fraction);
    if running.is_paused {
        line.push_str(", paused");
    }
    if let Some(seconds) = running.seconds_left {
        line.push_str(&format!(", {} left", time(seconds)));
    }
    if let Some(error) = running.relative_stderr {
        line.push_str(&format!("\nStandard error so far {}", percent(error)));
    }
    line
}

fn of_ending(ending: &KilnEnding) -> String {
    match ending {
        KilnEnding::Baked { texels, kept, seconds, entities, .. } => {
            let kept = if *kept > 0 { format!(", {kept} of them kept") } else { String::new() };
            let (texels, objects) = (counted(*texels, "texel"), counted(*entities as u64, "object"));
            format!("Baked {texels}{kept}\non {objects} in {}", time(*seconds))
        }
        KilnEnding::Planned(plan) => plan_line(plan),
        KilnEnding::Failed { cancelled: true, .. } => "Stopped".to_owned(),
        KilnEnding::Failed { reason, .. } => format!("Failed: {reason}"),
    }
}

fn plan_line(plan: &BakePlan) -> String {
    let megabytes = plan.memory_bytes as f64 / 1e6;
    let memory = if megabytes < 9.95 { format!("{megabytes:.1} MB") } else { format!("{megabytes:.0} MB") };
    let (texels, textures) = (counted(plan.texels, "texel"), counted(plan.pages.into(), "texture"));
    format!("{texels} in {textures}\n{memory} while it bakes")
}

fn counted(count: u64, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// A price on its button.
pub(super) fn price(price: &Prediction) -> String {
    format!("{} in {}", percent(price.error), time(price.seconds))
}

/// The effects that a plan simulates, by name and share of the time.
pub(super) fn effects(plan: &BakePlan) -> String {
    let on = plan.effects.iter().filter(|planned| planned.on);
    let lines = on.map(|planned| match planned.cost_share {
        Some(share) => format!("{} ({:.0} %)", planned.effect, 100.0 * share),
        None => planned.effect.to_string(),
    });
    lines.collect::<Vec<_>>().join(", ")
}

fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent < 10.0 { format!("{percent:.1} %") } else { format!("{percent:.0} %") }
}

fn time(seconds: f64) -> String {
    match seconds {
        s if s < 9.95 => format!("{s:.1} s"),
        s if s < 119.5 => format!("{s:.0} s"),
        s if s < 7170.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_people_read() {
        for (seconds, words) in [(0.04, "0.0 s"), (9.9, "9.9 s"), (61.0, "61 s"), (600.0, "10 min"), (9000.0, "2.5 h")]
        {
            assert_eq!(time(seconds), words);
        }
        assert_eq!((percent(0.0123), percent(0.25)), ("1.2 %".to_owned(), "25 %".to_owned()));
        assert_eq!(status(&BakeStatus::default()), "Nothing is baked yet");
    }

    #[test]
    fn what_is_one_is_told_as_one() {
        assert_eq!((counted(1, "object"), counted(2, "object")), ("1 object".to_owned(), "2 objects".to_owned()));
        assert_eq!(price(&Prediction { error: 0.02, seconds: 12.0 }), "2.0 % in 12 s");
    }
}
