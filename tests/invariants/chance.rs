//! Runs of a law on scenes by chance, always the same ones.

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngSeed, TestCaseError, TestError, TestRunner};
use std::fmt::{Debug, Display};

/// How long to look.
#[derive(Clone, Copy, Debug)]
pub struct Search {
    pub cases: u32,
    /// Steps of shrinking, each of which renders.
    pub shrinks: u32,
}

/// Steps enough for a list of a few parts.
const SHRINKS: u32 = 24;

/// The smallest case found that breaks a law, and how.
pub struct Broken<T> {
    pub case: T,
    pub reason: String,
}

fn run<T: Clone + Debug>(
    search: Search,
    strategy: impl Strategy<Value = T>,
    law: impl Fn(&T) -> Result<(), String>,
) -> Result<(), Broken<T>> {
    let config = Config {
        cases: search.cases,
        max_shrink_iters: search.shrinks,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(0x6b69_6c6e),
        ..Config::default()
    };
    let outcome = TestRunner::new(config).run(&strategy, |case| law(&case).map_err(TestCaseError::fail));
    match outcome {
        Ok(()) => Ok(()),
        Err(TestError::Fail(reason, case)) => Err(Broken { case, reason: reason.message().to_owned() }),
        Err(TestError::Abort(reason)) => panic!("no cases: {reason}"),
    }
}

/// Panics with the smallest case that breaks a law.
pub fn holds<T: Clone + Debug + Display>(
    cases: u32,
    strategy: impl Strategy<Value = T>,
    law: impl Fn(&T) -> Result<(), String>,
) {
    if let Err(Broken { case, reason }) = run(Search { cases, shrinks: SHRINKS }, strategy, law) {
        panic!("{reason}\nin the smallest scene that was found:\n{case}");
    }
}

/// The smallest case in which a planted fault is found; panics if none is.
pub fn finds<T: Clone + Debug>(
    search: Search,
    strategy: impl Strategy<Value = T>,
    law: impl Fn(&T) -> Result<(), String>,
) -> Broken<T> {
    match run(search, strategy, law) {
        Err(broken) => broken,
        Ok(()) => panic!("a planted fault was not found"),
    }
}
