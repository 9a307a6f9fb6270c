//! Soundness: a solver must not gain energy by itself, oscillate at rest, stay locked, or slow down.

mod falling;
mod free;
mod hang;
mod jerk;
mod momentum;
mod pulled;
mod rates;
mod run;
mod strips;

use super::case::HardCase;

/// All cases.
pub fn cases(quick: bool) -> Vec<HardCase> {
    let mut cases = free::cases(quick);
    cases.extend(falling::cases());
    cases.extend(momentum::cases(quick));
    cases.extend(pulled::cases());
    cases.extend(strips::cases(quick));
    cases.extend(jerk::cases(quick));
    cases.extend(rates::cases());
    cases.extend(hang::cases(quick));
    cases
}
