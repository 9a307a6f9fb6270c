//! The gate's cases, with their verdicts and figures.

use crate::{
    contacts::Row,
    figure::Figure,
    oracles,
    stability::{HardCase, Status},
};

/// Factor by which ratios of times differ between builds with and without optimisation, and on busy machines. A time within this
/// factor of its limit is neither known to pass nor known to fail.
const UNCLEAR: f64 = 1.5;

/// What became of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It holds.
    Passes,
    /// It does not.
    Fails,
    /// It is a time near its limit.
    Unclear,
}

/// A case of the gate.
#[derive(Clone, Debug, PartialEq)]
pub struct GateCase {
    /// Command, name and size: no two cases have the same.
    pub identity: String,
    /// What became of it.
    pub verdict: Verdict,
    /// What must not exceed a limit, less being better; none of times, which change from run to run.
    pub error: Option<f64>,
    /// The limit.
    pub limit: f64,
    /// What was measured, as the file of figures watches it; none of times.
    pub figure: Option<Figure>,
}

impl GateCase {
    /// A case whose figure is what must not exceed the limit.
    fn new(identity: String, passes: bool, value: f64, limit: f64) -> Self {
        let verdict = if passes { Verdict::Passes } else { Verdict::Fails };
        let figure = Some(Figure::of_case(identity.clone(), value, limit));
        Self { identity, verdict, error: Some(value), limit, figure }
    }

    /// The line of the case in the list of known failures: its identity and its error, a dash where that is not compared.
    #[must_use]
    pub fn line(&self) -> String {
        match self.error {
            Some(error) if error.is_finite() => format!("{}\t{error:.3e}", self.identity),
            _ => format!("{}\t–", self.identity),
        }
    }

    /// A closed form.
    #[must_use]
    pub fn of_oracle(case: &oracles::Case) -> Self {
        let identity = format!("oracles: {}", case.name);
        let allowed = case.tolerance * case.expected;
        let error = Some(case.relative_error);
        let limit = case.tolerance;
        Self { error, limit, ..Self::new(identity, case.pass, case.measured, allowed) }
    }

    /// A hard case; none where it was not run.
    #[must_use]
    pub fn of_hard_case(case: &HardCase) -> Option<Self> {
        let identity = format!("stability: {}, n = {}", case.name, case.n);
        let value = case.worst.unwrap_or(f64::NAN);
        let is_built = case.status == Status::Built;
        is_built.then(|| Self::new(identity, case.pass, value, case.limit))
    }

    /// A row of a command.
    #[must_use]
    pub fn of_row(command: &str, row: &Row) -> Self {
        let identity = format!("{command}: {}", row.name);
        let value = row.figure.unwrap_or(f64::NAN);
        let case = Self::new(identity, row.pass, value, row.limit);
        if !row.is_of_times {
            return case;
        }
        let unclear = row.limit / UNCLEAR..=row.limit * UNCLEAR;
        let is_unclear = unclear.contains(&value);
        let verdict = if is_unclear { Verdict::Unclear } else { case.verdict };
        Self { verdict, error: None, figure: None, ..case }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_near_their_limit_are_unclear_and_have_no_figure() {
        let verdict = |row: Row| GateCase::of_row("contacts", &row).verdict;
        let of = |figure| Row::new("a", "times", figure, 2.0, 0.0);
        assert_eq!(verdict(of(2.1)), Verdict::Fails);
        assert_eq!(verdict(of(2.1).of_times()), Verdict::Unclear);
        assert_eq!(verdict(of(3.1).of_times()), Verdict::Fails);
        assert_eq!(verdict(of(1.3).of_times()), Verdict::Passes);
        assert_eq!(verdict(of(f64::NAN).of_times()), Verdict::Fails);
        assert_eq!(GateCase::of_row("contacts", &of(3.1).of_times()).figure, None);
    }
}
