//! How far the work is: a bar on a terminal, plain lines elsewhere; both on standard error.

use crate::talk::{Talk, duration};
use bevy_kiln::bake::{Progress, ProgressSink, Stage};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Least time between two redrawings of the bar.
const REDRAW: Duration = Duration::from_millis(100);

/// Shows progress to a person.
pub(crate) struct Show {
    bar: Option<ProgressBar>,
    state: Mutex<State>,
}

struct State {
    stage: Option<Stage>,
    began: Instant,
    drawn: Option<Instant>,
    /// Tenths of the stage that a plain line has told.
    tenths: u64,
}

impl Show {
    pub(crate) fn new() -> Self {
        let style = ProgressStyle::with_template("{prefix:>8} [{bar:40}] {percent:>3} % {msg}");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> ");
        let bar = std::io::stderr().is_terminal().then(|| ProgressBar::new(0).with_style(style));
        let state = State { stage: None, began: Instant::now(), drawn: None, tenths: 0 };
        Self { bar, state: Mutex::new(state) }
    }

    /// Takes the bar away.
    pub(crate) fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl ProgressSink for Show {
    fn report(&self, progress: Progress) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.stage != Some(progress.stage) {
            *state = State { stage: Some(progress.stage), began: Instant::now(), drawn: None, tenths: 0 };
        }
        let is_last = progress.done >= progress.total;
        match &self.bar {
            Some(bar) if is_last || state.drawn.is_none_or(|drawn| drawn.elapsed() >= REDRAW) => {
                state.drawn = Some(Instant::now());
                bar.set_length(progress.total);
                bar.set_position(progress.done);
                bar.set_prefix(name(progress.stage));
                bar.set_message(remarks(&progress, state.began));
            }
            Some(_) => {}
            None => {
                let tenths = (10 * progress.done).checked_div(progress.total).unwrap_or(0);
                if tenths > state.tenths {
                    state.tenths = tenths;
                    let remarks = remarks(&progress, state.began);
                    Talk::Err.say(format_args!("{} {} % {remarks}", name(progress.stage), 10 * tenths));
                }
            }
        }
    }
}

fn name(stage: Stage) -> &'static str {
    match stage {
        Stage::Prepare => "prepare",
        Stage::Gather => "trace",
        Stage::Repair => "repair",
        Stage::Probes => "probes",
    }
}

/// The error so far and the time left.
fn remarks(progress: &Progress, began: Instant) -> String {
    let mut parts = Vec::new();
    if let Some(error) = progress.relative_stderr {
        parts.push(format!("error {:.2} %", 100.0 * error));
    }
    if progress.done > 0 && progress.done < progress.total {
        let to_do = (progress.total - progress.done) as f64 / progress.done as f64;
        parts.push(format!("{} left", duration(began.elapsed().as_secs_f64() * to_do)));
    }
    parts.join(", ")
}
