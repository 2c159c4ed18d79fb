//! `kiln study`.

use crate::args::{GoalArgs, StudyArgs};
use crate::failure::Failure;
use crate::scene;
use crate::talk::{Talk, duration, warn};
use bevy_kiln::bake::CancelToken;
use bevy_kiln::output::{study_answer, write_study};
use bevy_kiln::study::{Effort, StudyProgress, StudySettings, study};
use indicatif::{ProgressBar, ProgressStyle};
use std::cell::RefCell;
use std::io::IsTerminal;

pub(crate) fn run(args: &StudyArgs, cancel: &CancelToken) -> Result<(), Failure> {
    // No goal is asked for: a study goes as far as there is time.
    let goal = GoalArgs { error: None, time: None, spp: None, fast: false };
    let bake = scene::bake_settings(&args.scene, &args.layout, &goal)?;
    let settings = StudySettings { bake, effort: Effort::Time(args.time) };
    // Twenty minutes must not end at a name that is taken.
    if args.output.is_file() {
        let path = args.output.display();
        return Err(Failure::Failed(format!("{path} is a file, not a folder; name another folder or move it away")));
    }
    let extraction = scene::open(&args.scene, cancel)?;
    warn(&extraction.warnings.iter().map(ToString::to_string).collect::<Vec<_>>());
    let show = Show::new();
    let result = study(&extraction.scene, &settings, &|progress| show.tell(progress), cancel);
    show.end();
    let study = result?;
    warn(&study.warnings.iter().map(ToString::to_string).collect::<Vec<_>>());
    let name = args.scene.scene.file_name().unwrap_or(args.scene.scene.as_os_str()).to_string_lossy().into_owned();
    let files = write_study(&study, &name, &args.output).map_err(Failure::failed)?;
    Talk::Out.say(study_answer(&study));
    for sentence in &study.left_out {
        Talk::Out.say(format_args!("  {sentence}"));
    }
    let page = args.output.join("study.md");
    Talk::Out.say(format_args!(
        "wrote {} files into {}; begin with {}",
        files.len(),
        args.output.display(),
        page.display()
    ));
    Ok(())
}

/// Shows progress to a person: a bar on a terminal, plain lines elsewhere; both on standard error.
struct Show {
    bar: Option<ProgressBar>,
    /// The part that a plain line has told of.
    part: RefCell<String>,
}

impl Show {
    fn new() -> Self {
        let style = ProgressStyle::with_template("[{bar:40}] {percent:>3} % {msg}");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> ");
        let bar = std::io::stderr().is_terminal().then(|| ProgressBar::new(1000).with_style(style));
        Self { bar, part: RefCell::default() }
    }

    fn tell(&self, progress: &StudyProgress) {
        let left = progress.seconds_left.map_or_else(String::new, |left| format!(", {} left", duration(left)));
        match &self.bar {
            Some(bar) => {
                bar.set_position((1000.0 * progress.done) as u64);
                bar.set_message(format!("{}{left}", progress.what));
            }
            None => {
                if *self.part.borrow() != progress.what {
                    self.part.replace(progress.what.clone());
                    Talk::Err.say(format_args!("study {:.0} % {}{left}", 100.0 * progress.done, progress.what));
                }
            }
        }
    }

    fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
