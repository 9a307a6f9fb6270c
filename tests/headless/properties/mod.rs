//! Properties that hold of any input: nothing panics, every position is finite, and other cloths go on, bit for bit. Each run
//! tries the same inputs; `PROPTEST_RNG_SEED` and `PROPTEST_CASES` try others, and more.

mod attachments;
mod beside;
mod meshes;
mod numbers;
mod settings;
mod snapshots;
mod surroundings;

use std::env;
use std::panic::{self, AssertUnwindSafe};

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};

/// Checks a property of so many inputs at random, and of ever simpler ones once it does not hold: a panic shows the simplest.
pub(super) fn for_all<S: Strategy>(cases: u32, inputs: S, property: impl Fn(S::Value)) {
    let asked = |name: &str| env::var(name).ok().and_then(|asked| asked.parse::<u64>().ok());
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&asked("PROPTEST_RNG_SEED").unwrap_or(1).to_le_bytes());
    let cases = asked("PROPTEST_CASES").map_or(cases, |asked| asked as u32);
    let config = Config { failure_persistence: None, ..Config::with_cases(cases) };
    let random = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let held = TestRunner::new_with_rng(config, random).run(&inputs, |input| {
        panic::catch_unwind(AssertUnwindSafe(|| property(input)))
            .map_err(|_| TestCaseError::fail("it panics, as told above"))
    });
    held.unwrap_or_else(|failure| panic!("{failure}"));
}
