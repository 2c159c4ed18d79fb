//! The catalogue of hard cases: each with what makes it hard, what goes wrong elsewhere, what must hold here, and the
//! guard in our code that makes it hold. `docs/numerics.md` shows it as a table, which is written from here.
//!
//! Every case is a test by its own name (`cargo test --test stability place::`). Every guard is a piece of the source
//! that can be taken out: `cargo test --test stability without:: -- --ignored` does so, in a copy, and asks that each
//! case of that guard then fails. What was seen is kept in `seen.txt`.

#[path = "../common/mod.rs"]
mod common;

mod case;
mod cases;
mod guard;
mod guards;
mod judge;
mod look;
mod page;
mod removal;
mod seen;
mod things;
mod truths;
mod worlds;

use libtest_mimic::{Arguments, Failed, Trial};
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let mut trials: Vec<Trial> = cases::all()
        .into_iter()
        .map(|(group, case)| Trial::test(case.full_name(group), || (case.check)().map_err(Failed::from)))
        .collect();
    trials.extend([
        Trial::test("catalogue::is_sound", || cases::are_sound().map_err(Failed::from)),
        Trial::test("catalogue::guards_stand_in_the_source", || guard::all_stand().map_err(Failed::from)),
        Trial::test("catalogue::each_case_was_seen_failing", || seen::is_complete().map_err(Failed::from)),
        Trial::test("catalogue::page_is_up_to_date", || page::is_up_to_date().map_err(Failed::from)),
        Trial::test("look::rejects_what_is_wrong", || look::rejects_what_is_wrong().map_err(Failed::from)),
        Trial::test("judge::rejects_what_is_wrong", || judge::rejects_what_is_wrong().map_err(Failed::from)),
    ]);
    // One after the other in one copy of the tree: they share its build.
    trials.extend(guard::all().into_iter().map(|guard| {
        Trial::test(format!("without::{}", guard.name), || removal::run(guard).map_err(Failed::from))
            .with_ignored_flag(true)
    }));
    libtest_mimic::run(&arguments, trials).exit_code()
}
