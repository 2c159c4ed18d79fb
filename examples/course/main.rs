//! Remakes the pictures and the numbers of docs/course.md: path tracing as a course teaches it, topic by topic.
//!
//! `cargo run --no-default-features --features bake --example course`, with names of topics after `--` for some of
//! them and `--out DIR` for another folder. The product renders; `teacher.rs` is a second, small path tracer for what
//! the product leaves out on purpose.

mod film;
mod scenes;
mod stage;
mod teacher;
mod topics;

use bevy_kiln::bake::Picture;
use bevy_kiln::output::{Look, ToneCurve, write_picture};
use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use topics::TOPICS;

/// Where pictures go, and how long it has been.
pub struct Desk {
    out: PathBuf,
    start: Instant,
    /// Whether a picture could not be kept.
    has_failed: Cell<bool>,
}

impl Desk {
    /// A line of numbers.
    pub fn say(&self, line: &str) {
        println!("[{:6.1} s]   {line}", self.start.elapsed().as_secs_f64());
    }

    /// Keeps a picture in which `white` [cd/m²] is shown as white.
    pub fn keep(&self, name: &str, picture: &Picture, white: f32) {
        let path = self.out.join(name).with_extension("png");
        match write_picture(picture, &path, Look { ev100: (white / 1.2).log2(), tone: ToneCurve::Clip }) {
            Ok(()) => self.say(&format!("wrote {}", path.display())),
            Err(error) => {
                eprintln!("course: {error}");
                self.has_failed.set(true);
            }
        }
    }
}

fn main() -> ExitCode {
    let mut out = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures/course");
    let mut wanted = Vec::new();
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        match (arg.as_str(), TOPICS.iter().find(|topic| topic.name == arg)) {
            ("--out", _) => match args.next() {
                Some(folder) => out = folder.into(),
                None => return usage("--out needs a folder"),
            },
            (_, Some(topic)) => wanted.push(topic),
            _ => return usage(&format!("{arg} is no topic")),
        }
    }
    if wanted.is_empty() {
        wanted.extend(TOPICS);
    }
    let desk = Desk { out, start: Instant::now(), has_failed: Cell::new(false) };
    for (index, topic) in wanted.iter().enumerate() {
        desk.say(&format!("{}/{} {}", index + 1, wanted.len(), topic.name));
        (topic.run)(&desk);
    }
    desk.say("done");
    if desk.has_failed.get() { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

fn usage(reason: &str) -> ExitCode {
    let names: Vec<&str> = TOPICS.iter().map(|topic| topic.name).collect();
    eprintln!("course: {reason}\n\nusage: course [TOPIC...] [--out DIR]\ntopics: {}", names.join(" "));
    ExitCode::from(2)
}
