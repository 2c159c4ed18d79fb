//! What a person reads.

use bevy_kiln::bake::{BakePlan, BakeReport, Intervals};
use bevy_kiln::trace::Effect;
use std::fmt::Display;
use std::io::Write;

/// Where text for a person goes. Where standard output carries data, it goes to standard error.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Talk {
    Out,
    Err,
}

impl Talk {
    /// Text beside JSON or a table on standard output.
    pub(crate) fn beside(data_on_stdout: bool) -> Self {
        if data_on_stdout { Self::Err } else { Self::Out }
    }

    /// One line. A closed pipe is nobody's fault and stops nothing.
    pub(crate) fn say(self, line: impl Display) {
        let _ = match self {
            Self::Out => writeln!(std::io::stdout(), "{line}"),
            Self::Err => writeln!(std::io::stderr(), "{line}"),
        };
    }

    pub(crate) fn plan(self, plan: &BakePlan) {
        self.say("plan: effects, the share of the time that would be saved without each, and why");
        let width = Effect::ALL.into_iter().map(|effect| effect.name().len()).max().unwrap_or(0);
        for effect in &plan.effects {
            let mark = if effect.on { "on " } else { "off" };
            let share = effect.cost_share.map_or_else(String::new, |share| format!("{:.0} %", 100.0 * share));
            self.say(format_args!("  {:width$}  {mark}  {share:>5}  {}", effect.effect.name(), effect.reason));
        }
        let mebibytes = plan.memory_bytes as f64 / f64::from(1 << 20);
        let pages = if plan.pages == 1 { "page" } else { "pages" };
        self.say(format_args!("  {} texels on {} {pages}, {mebibytes:.1} MiB", plan.texels, plan.pages));
        for prediction in &plan.predicted {
            let error = 100.0 * prediction.error;
            self.say(format_args!("  about {} for an error of {error:.1} % at 95 %", duration(prediction.seconds)));
        }
    }

    pub(crate) fn report(self, what: &str, report: &BakeReport) {
        let per_second = report.samples as f64 / report.wall_seconds.max(1e-9);
        let error = &report.relative_stderr;
        let balance = report.energy_balance;
        self.say("report");
        self.say(format_args!("  {} {what}, {} samples, {} rays", report.texels, report.samples, report.rays));
        self.say(format_args!(
            "  {} ({:.1} s of processor time), {per_second:.0} samples per second",
            duration(report.wall_seconds),
            report.cpu_seconds
        ));
        self.say(format_args!(
            "  relative standard error: mean {:.3} %, 95 % below {:.3} %, worst {:.3} %",
            100.0 * error.mean,
            100.0 * error.p95,
            100.0 * error.max
        ));
        if report.intervals != Intervals::default() {
            self.intervals(&report.intervals);
        }
        if let Some(taken) = report.clamped_light {
            self.say(format_args!("  the clamp took {:.3} % of the light", 100.0 * taken));
        }
        for (how, effects) in [("on", report.forced.on), ("off", report.forced.off)] {
            let names: Vec<&str> = effects.iter().map(Effect::name).collect();
            if !names.is_empty() {
                self.say(format_args!("  forced {how}: {}", names.join(", ")));
            }
        }
        if let Some(balance) = balance {
            self.say(format_args!("  energy balance: {balance:.5} (absorbed / emitted)"));
        }
    }
}

impl Talk {
    /// How well texels are known.
    fn intervals(self, intervals: &Intervals) {
        let [mean, p95, max] =
            [intervals.half_width.mean, intervals.half_width.p95, intervals.half_width.max].map(|width| 100.0 * width);
        self.say(format_args!(
            "  95 % intervals: ± {mean:.2} % of the value in the mean, 95 % within {p95:.2} %, worst {max:.2} %"
        ));
        if let Some(target) = intervals.target {
            let missed = match intervals.missed {
                0 => "every texel is within it".to_owned(),
                missed => format!("{missed} texels are not, with as many paths as one may have"),
            };
            let floor = intervals.floor;
            self.say(format_args!("  target: {:.2} %, of {floor:.3} cd/m² at least; {missed}", 100.0 * target));
        }
    }

    /// How the texels are laid out, and what was done to them once they were measured.
    pub(crate) fn repair(self, report: &BakeReport) {
        let pages = if report.pages == 1 { "page" } else { "pages" };
        let fill = 100.0 * report.fill;
        self.say(format_args!(
            "  {} {pages}, {fill:.0} % of them texels; {} objects unwrapped, {} texels hidden",
            report.pages, report.unwrapped, report.hidden
        ));
        if let Some(first) = report.first_pass {
            self.say(format_args!(
                "  fast mode: paths end on {} texels of a first pass, which took {} of processor time",
                first.texels,
                duration(first.cpu_seconds)
            ));
        }
        if let Some(denoised) = report.denoised {
            let [before, after] = [denoised.before, denoised.after].map(|error| 100.0 * error.mean);
            self.say(format_args!("  denoised: estimated error {before:.2} % before, {after:.2} % after (mean)"));
        }
        if let Some(seams) = report.seams {
            let [before, after] = [seams.before, seams.after].map(|jump| 100.0 * jump.max);
            self.say(format_args!(
                "  seams: {} joints, largest jump {before:.1} % before, {after:.2} % after",
                seams.joints
            ));
        }
    }
}

/// Warnings, which always go to standard error.
pub(crate) fn warn(warnings: &[String]) {
    for warning in warnings {
        Talk::Err.say(format_args!("warning: {warning}"));
    }
}

/// A time for a person.
pub(crate) fn duration(seconds: f64) -> String {
    if seconds < 60.0 {
        format!("{seconds:.1} s")
    } else if seconds < 3600.0 {
        format!("{:.0} min {:.0} s", (seconds / 60.0).floor(), (seconds % 60.0).floor())
    } else {
        format!("{:.0} h {:.0} min", (seconds / 3600.0).floor(), (seconds % 3600.0 / 60.0).floor())
    }
}
