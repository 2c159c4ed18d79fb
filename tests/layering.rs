//! The house's one direction: `math, artefact ← scene ← trace ← bake ← study ← output ← plugin ← bin`. Each folder may
//! use those to its left and none to its right, and only `plugin` and `bin` name Bevy.

use std::path::{Path, PathBuf};

/// Each folder and those that it must not name.
const FORBIDDEN: [(&str, &[&str]); 8] = [
    ("math", &["artefact", "scene", "trace", "bake", "study", "output", "plugin"]),
    ("artefact", &["math", "scene", "trace", "bake", "study", "output", "plugin"]),
    ("scene", &["trace", "bake", "study", "output", "plugin"]),
    ("trace", &["bake", "study", "output", "plugin"]),
    ("bake", &["study", "output", "plugin"]),
    ("study", &["output", "plugin"]),
    ("output", &["plugin"]),
    ("plugin", &[]),
];

/// Why a line of code in `folder` breaks the direction, if it does.
fn breach(folder: &str, line: &str) -> Option<String> {
    let code = line.split("//").next().unwrap_or_default();
    let forbidden = FORBIDDEN.iter().find(|(name, _)| *name == folder)?.1;
    let names = |path: &str| {
        code.match_indices(path).any(|(at, _)| {
            let before = code[..at].chars().next_back();
            let after = code[at + path.len()..].chars().next();
            let is_part_of_a_name = |next: Option<char>| next.is_some_and(|c| c.is_alphanumeric() || c == '_');
            !is_part_of_a_name(before) && !is_part_of_a_name(after)
        })
    };
    let right = forbidden.iter().find(|right| names(&format!("crate::{right}")));
    // `use crate::{a, b}` lists folders in braces.
    let listed = code.trim_start().strip_prefix("use crate::{").and_then(|list| {
        let heads = list.split([',', '}']).map(|item| item.trim().split("::").next().unwrap_or_default());
        heads.filter_map(|head| forbidden.iter().find(|right| **right == head)).next()
    });
    if let Some(right) = right.or(listed) {
        return Some(format!("{folder} uses {right}"));
    }
    let is_bevy = names("bevy") && (code.contains("use bevy") || code.contains("bevy::"));
    (folder != "plugin" && is_bevy).then(|| format!("{folder} names Bevy"))
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

#[test]
fn every_import_runs_to_the_left() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for (folder, _) in FORBIDDEN {
        let files = rust_files(&source.join(folder));
        assert!(!files.is_empty(), "src/{folder} is empty");
        for file in files {
            let text = std::fs::read_to_string(&file).unwrap();
            for (number, line) in text.lines().enumerate() {
                if let Some(reason) = breach(folder, line) {
                    panic!("{}:{}: {reason}: {line}", file.display(), number + 1);
                }
            }
        }
    }
}

#[test]
fn only_one_file_names_the_tree_library() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let names_it = |file: &PathBuf| std::fs::read_to_string(file).unwrap().lines().any(|line| line.contains("obvhs::"));
    let files: Vec<PathBuf> = rust_files(&source).into_iter().filter(names_it).collect();
    assert_eq!(files, [source.join("trace/accel.rs")]);
}

/// The check itself.
#[test]
fn planted_breaches_are_caught() {
    for (folder, line) in [
        ("trace", "use crate::bake"),
        ("trace", "use crate::bake::BakeError;"),
        ("scene", "    let hit = crate::trace::Tracer::new(scene);"),
        ("math", "use crate::{scene::Scene, trace};"),
        ("bake", "pub use crate::output::write_lightmap;"),
        ("bake", "use crate::study::Study;"),
        ("study", "use crate::output::write_study;"),
        ("output", "use bevy::prelude::*;"),
        ("trace", "use bevy_kiln::bake::x; use bevy::math::Vec3;"),
    ] {
        assert!(breach(folder, line).is_some(), "{folder}: {line}");
    }
    for (folder, line) in [
        ("bake", "use crate::trace::Tracer;"),
        ("study", "use crate::bake::bake_lightmap;"),
        ("trace", "// use crate::bake"),
        ("bake", "use crate::trace::output_of;"),
        ("plugin", "use bevy::prelude::*;"),
        ("output", "/// As `bevy_image` reads it."),
    ] {
        assert_eq!(breach(folder, line), None, "{folder}: {line}");
    }
}
