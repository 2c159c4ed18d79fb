//! What was seen when a guard was taken out: `seen.txt`, a line for each case, written by the runs of
//! [`crate::removal`].

use crate::case::Verdict;
use crate::cases;
use crate::guard::Guard;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// How a case failed without its guard.
pub struct Failure {
    /// Tells by which edits the guard was taken out.
    pub guard: String,
    /// What the case said.
    pub message: String,
}

/// The failures that were seen, by the case's full name.
pub fn load() -> Result<BTreeMap<String, Failure>, String> {
    let text = std::fs::read_to_string(path()).map_err(|error| format!("{}: {error}", path().display()))?;
    let failure = |line: &str| {
        let mut parts = line.splitn(3, " | ").map(str::to_owned);
        let (Some(case), Some(guard), Some(message)) = (parts.next(), parts.next(), parts.next()) else {
            return Err(format!("seen.txt has a line that is none: {line}"));
        };
        Ok((case, Failure { guard, message }))
    };
    text.lines().map(failure).collect()
}

/// Adds what was seen of these cases.
pub fn add(guard: &Guard, messages: Vec<(String, String)>) -> Verdict {
    let mut seen = load()?;
    for (case, message) in messages {
        seen.insert(case, Failure { guard: mark(guard), message });
    }
    let known: Vec<String> = cases::all().iter().map(|(group, case)| case.full_name(*group)).collect();
    seen.retain(|case, _| known.contains(case));
    let lines: Vec<String> =
        seen.iter().map(|(case, Failure { guard, message })| format!("{case} | {guard} | {message}\n")).collect();
    std::fs::write(path(), lines.concat()).map_err(|error| format!("{}: {error}", path().display()))
}

/// Whether every case failed once without the guard that it names, as that is taken out today.
pub fn is_complete() -> Verdict {
    let seen = load()?;
    let unseen: Vec<String> = cases::all()
        .into_iter()
        .filter(|(group, case)| {
            seen.get(&case.full_name(*group)).is_none_or(|failure| failure.guard != mark(case.guard))
        })
        .map(|(group, case)| format!("{} (without::{})", case.full_name(group), case.guard.name))
        .collect();
    if unseen.is_empty() {
        return Ok(());
    }
    Err(format!("not seen failing without its guard: {}", unseen.join(", ")))
}

/// A guard's name and a fingerprint of its edits (FNV-1a).
fn mark(guard: &Guard) -> String {
    let texts = guard.edits.iter().flat_map(|edit| [edit.file, edit.text, edit.instead]);
    let hash = texts
        .flat_map(str::bytes)
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
    format!("{} {:08x}", guard.name, hash >> 32)
}

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/stability/seen.txt")
}
