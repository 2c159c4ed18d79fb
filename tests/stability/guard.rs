//! Guards: the pieces of source that make hard cases hold, and how each is taken out.

use crate::case::Verdict;
use crate::cases;
use std::path::{Path, PathBuf};

/// A piece of our code that keeps hard cases stable.
pub struct Guard {
    /// What it is called.
    pub name: &'static str,
    /// What it does, with formula and source (author, year) where it has one.
    pub does: &'static str,
    /// How it is taken out.
    pub edits: &'static [Edit],
}

/// A piece of a file, and what stands there without the guard.
pub struct Edit {
    /// Path from the repository's root.
    pub file: &'static str,
    /// The text, which stands there exactly once.
    pub text: &'static str,
    /// What replaces it.
    pub instead: &'static str,
}

impl Edit {
    /// The file without the guard.
    pub fn apply(&self, root: &Path) -> Result<(PathBuf, String), String> {
        let path = root.join(self.file);
        let source = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", self.file))?;
        match source.matches(self.text).count() {
            1 => Ok((path, source.replace(self.text, self.instead))),
            count => Err(format!("{} has this {count} times, not once: {}", self.file, self.text)),
        }
    }
}

/// All guards that cases name, in the order in which they name them.
pub fn all() -> Vec<&'static Guard> {
    let mut guards: Vec<&'static Guard> = Vec::new();
    for (_, case) in cases::all() {
        if !guards.iter().any(|guard| guard.name == case.guard.name) {
            guards.push(case.guard);
        }
    }
    guards
}

/// Whether every guard stands in the source as the catalogue says: it cannot rot unseen.
pub fn all_stand() -> Verdict {
    for guard in all() {
        if guard.edits.is_empty() || guard.does.is_empty() {
            return Err(format!("{} is no guard", guard.name));
        }
        for edit in guard.edits {
            if edit.text == edit.instead {
                return Err(format!("{} changes nothing", guard.name));
            }
            edit.apply(Path::new(env!("CARGO_MANIFEST_DIR"))).map_err(|error| format!("{}: {error}", guard.name))?;
        }
    }
    Ok(())
}
