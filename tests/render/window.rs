//! Examples as programs of their own, in a window.

use crate::skip;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicU32, Ordering};

/// The program that `cargo test` has built beside this one.
pub fn program(example: &str) -> PathBuf {
    let own = std::env::current_exe().unwrap();
    let profile = own.parent().and_then(Path::parent).unwrap();
    let path = profile.join("examples").join(example).with_extension(std::env::consts::EXE_EXTENSION);
    let hint = format!("build it first: cargo build --features full --example {example}");
    assert!(path.is_file(), "there is no {}; {hint}", path.display());
    path
}

/// The example on the display that there is, or on one of its own.
pub fn under_a_display(example: &str) -> Option<Command> {
    if std::env::var_os("DISPLAY").is_some() {
        return Some(Command::new(program(example)));
    }
    let has_xvfb = std::env::var_os("PATH")
        .is_some_and(|path| std::env::split_paths(&path).any(|folder| folder.join("xvfb-run").is_file()));
    if !has_xvfb {
        skip("there is neither a display nor xvfb-run; .ci/install-renderer.sh installs the latter");
        return None;
    }
    // Two that start at once and look for a free number find the same one; so each begins elsewhere.
    static STARTED: AtomicU32 = AtomicU32::new(0);
    let number = 100 + 8 * (std::process::id() % 1000) + STARTED.fetch_add(1, Ordering::Relaxed);
    let mut command = Command::new("xvfb-run");
    command.args(["-a", "-n", &number.to_string(), "-s", "-screen 0 1280x1024x24"]).arg(program(example));
    Some(command)
}

pub fn lacks_a_renderer(output: &Output) -> bool {
    !output.status.success() && text(output).contains("Unable to find a GPU")
}

pub fn text(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes)).concat()
}
