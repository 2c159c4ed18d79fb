//! No code that shapes a result calls the C library: the source is read for it, since such a call would show in no
//! bake until somebody runs it on another machine.

use std::path::{Path, PathBuf};

/// What only informs or is only held against: distributions for tests, closed forms, and the functions' own tests.
const FREE: [&str; 5] = ["special.rs", "stats.rs", "form_factor.rs", "polygon.rs", "portable.rs"];

/// Functions of one number. Those of IEEE 754, as the square root, are no concern.
const ONES: [&str; 19] = [
    "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "exp2", "exp_m1", "ln",
    "ln_1p", "log2", "log10", "cbrt", "to_angle",
];

/// Functions of more, and those of glam that call them.
const MORE: [&str; 13] = [
    "atan2",
    "hypot",
    "powf",
    "log",
    "from_angle",
    "angle_between",
    "angle_to",
    "slerp",
    "from_rotation_x",
    "from_rotation_y",
    "from_rotation_z",
    "from_axis_angle",
    "from_euler",
];

/// The call in a line of code that the C library would answer.
fn call(line: &str) -> Option<String> {
    let code = line.split("//").next().unwrap_or_default();
    let of_one = ONES.iter().flat_map(|name| {
        [format!(".{name}()"), format!("f32::{name}("), format!("f64::{name}("), format!("f32::{name})")]
    });
    let of_more = MORE.iter().flat_map(|name| [format!(".{name}("), format!("::{name}(")]);
    let is_ours = |pattern: &str| pattern.starts_with("::") && code.contains(&format!("Portable{pattern}"));
    of_one.chain(of_more).find(|pattern| code.contains(pattern.as_str()) && !is_ours(pattern))
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> =
        entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect();
    files.sort();
    files
}

#[test]
fn no_result_hangs_on_the_c_library() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut read, mut found) = (0, Vec::new());
    for file in files(&root) {
        let name = file.strip_prefix(&root).unwrap().to_string_lossy().into_owned();
        if name.contains("test") || FREE.contains(&file.file_name().unwrap().to_str().unwrap()) {
            continue;
        }
        let text = std::fs::read_to_string(&file).unwrap();
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
        read += 1;
        let calls = code.lines().enumerate().filter_map(|(line, code)| Some((line + 1, call(code)?)));
        found.extend(calls.map(|(line, call)| format!("{name}:{line}: {call}")));
    }
    assert!(read > 100, "{read} files");
    assert!(found.is_empty(), "write `Portable::…` (src/math/portable.rs) instead: {found:#?}");
}

#[test]
fn calls_are_seen() {
    for line in ["let x = angle.sin();", "x.powf(2.4)", "f64::exp(x)", "map(f32::sin)", "Vec2::from_angle(a)"] {
        assert!(call(line).is_some(), "{line}");
    }
    for line in
        ["Portable::sin(x)", "Portable::atan2(y, x)", "x.sqrt()", "// x.sin()", "layout.cos(place)", "x.powi(2)"]
    {
        assert_eq!(call(line), None, "{line}");
    }
}
