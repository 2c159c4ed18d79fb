//! Takes a guard out of a copy of the tree, builds that, and asks that every case of the guard fails.
//!
//! With `KILN_WRITE_SNAPSHOTS` set, what they said is kept in `seen.txt`.

use crate::case::Verdict;
use crate::guard::Guard;
use crate::{cases, seen};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// What a build of the library and this test needs.
const PARTS: [&str; 6] = ["Cargo.toml", "Cargo.lock", "src", "tests", "benches", "examples"];

/// How long a case may take that without its guard may never end.
const PATIENCE: Duration = Duration::from_secs(120);

/// One at a time: they share the copy.
static TURN: Mutex<()> = Mutex::new(());

/// Takes `guard` out and runs its cases.
pub fn run(guard: &'static Guard) -> Verdict {
    let _turn = TURN.lock().map_err(|error| error.to_string())?;
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let copy = Path::new(env!("CARGO_TARGET_TMPDIR")).join("taken_out");
    std::fs::create_dir_all(&copy).map_err(|error| format!("{}: {error}", copy.display()))?;
    for part in PARTS {
        mirror(&here.join(part), &copy.join(part)).map_err(|error| format!("copying {part}: {error}"))?;
    }
    for edit in guard.edits {
        // Of two edits in one file, the second finds the first done.
        let (path, source) = edit.apply(&copy)?;
        std::fs::write(&path, source).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    let program = build(&copy)?;
    let mut failures = Vec::new();
    let mut survivors = Vec::new();
    for (group, case) in cases::all().into_iter().filter(|(_, case)| case.guard.name == guard.name) {
        let name = case.full_name(group);
        match fails(&program, &copy, &name)? {
            Some(message) => failures.push((name, message)),
            None => survivors.push(name),
        }
    }
    if std::env::var_os("KILN_WRITE_SNAPSHOTS").is_some() {
        seen::add(guard, failures)?;
    }
    if survivors.is_empty() {
        return Ok(());
    }
    Err(format!("without {} these hold all the same: {}", guard.name, survivors.join(", ")))
}

/// Makes `to` what `from` is. What is the same is not touched, so that it is not built again.
fn mirror(from: &Path, to: &Path) -> std::io::Result<()> {
    if from.is_dir() {
        std::fs::create_dir_all(to)?;
        for entry in std::fs::read_dir(from)? {
            let name = entry?.file_name();
            mirror(&from.join(&name), &to.join(&name))?;
        }
        for entry in std::fs::read_dir(to)? {
            let name = entry?.file_name();
            if !from.join(&name).exists() {
                let gone = to.join(&name);
                if gone.is_dir() { std::fs::remove_dir_all(gone)? } else { std::fs::remove_file(gone)? }
            }
        }
        return Ok(());
    }
    let bytes = std::fs::read(from)?;
    if std::fs::read(to).is_ok_and(|there| there == bytes) { Ok(()) } else { std::fs::write(to, bytes) }
}

/// Builds this test in the copy; its program.
fn build(copy: &Path) -> Result<PathBuf, String> {
    let output = Command::new(env!("CARGO"))
        .args(["test", "--no-default-features", "--features", "bake", "--test", "stability", "--no-run"])
        .arg("--message-format=json-render-diagnostics")
        .current_dir(copy)
        .env("CARGO_TARGET_DIR", copy.with_extension("build"))
        .output()
        .map_err(|error| format!("cargo: {error}"))?;
    if !output.status.success() {
        return Err(format!("without it nothing builds: {}", String::from_utf8_lossy(&output.stderr)));
    }
    let messages = String::from_utf8_lossy(&output.stdout);
    let program = messages.lines().rev().find_map(|line| {
        let message: serde_json::Value = serde_json::from_str(line).ok()?;
        message["executable"].as_str().map(PathBuf::from)
    });
    program.ok_or_else(|| "cargo names no program".into())
}

/// What a case says, run by itself; `None` if it holds.
fn fails(program: &Path, copy: &Path, case: &str) -> Result<Option<String>, String> {
    let log = copy.with_extension("log");
    let file = std::fs::File::create(&log).map_err(|error| format!("{}: {error}", log.display()))?;
    let mut child = Command::new(program)
        .args(["--exact", case])
        .current_dir(copy)
        .stdout(file)
        .stderr(Stdio::null())
        .spawn()
        .map_err(|error| format!("{}: {error}", program.display()))?;
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().map_err(|error| error.to_string())? {
            break status;
        }
        if start.elapsed() > PATIENCE {
            child.kill().and_then(|()| child.wait()).map_err(|error| error.to_string())?;
            return Ok(Some(format!("did not end within {} s", PATIENCE.as_secs())));
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    if status.success() {
        return Ok(None);
    }
    let text = std::fs::read_to_string(&log).map_err(|error| format!("{}: {error}", log.display()))?;
    let said = text.split_once(&format!("---- {case} ----\n")).map_or("the program died", |(_, said)| said);
    let first = said.lines().find(|line| !line.is_empty()).unwrap_or_default();
    Ok(Some(first.replace('|', "/").chars().take(160).collect()))
}
