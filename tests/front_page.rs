//! The README's first program is the example that it names, and short.

const README: &str = include_str!("../README.md");
const QUICKSTART: &str = include_str!("../examples/quickstart/main.rs");

/// What an empty app has as well.
const EMPTY_APP: [&str; 6] = ["use bevy::prelude::*;", "fn main() -> AppExit {", "App::new()", ".run()", "}", ""];

/// Lines that a user may have to write.
const LINES: usize = 20;

fn program() -> Vec<&'static str> {
    let (_, after) = README.split_once("```rust,no_run\n").expect("a program in the README");
    after.split_once("```").unwrap().0.lines().map(str::trim).collect()
}

#[test]
fn the_program_is_the_example() {
    let mut lines = QUICKSTART.lines().map(str::trim);
    for wanted in program() {
        assert!(lines.any(|line| line == wanted), "examples/quickstart has no line \"{wanted}\" there");
    }
}

#[test]
fn the_program_is_short() {
    let own = program().into_iter().filter(|line| !EMPTY_APP.contains(line));
    let count = own.count();
    assert!((8..=LINES).contains(&count), "{count} lines");
}
