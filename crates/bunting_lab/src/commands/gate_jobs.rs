//! The gate's work, on all cores until nothing is left of it: families one command after the other would leave cores idle at the
//! end of each.

use std::time::Instant;

use super::{
    families::{self, Family},
    gate_cases::GateCase,
    progress,
};
use crate::{
    contacts, forces, fuzz,
    golden::{self, GoldenHash},
    oracles,
    output::table::Table,
    parallel,
    product::Product,
    stability,
};

/// Families that take longest, which begin first.
const LONGEST: [&str; 8] =
    ["soundness", "cloths", "itself", "meshes", "capstan", "sleep", "lying", "buckling"];
/// Names of what is not a family of a command.
const FUZZ: &str = "cloths at random";
const GOLDEN: &str = "golden hashes";

/// What the gate has measured.
pub struct Measured {
    /// Cases; none if only hashes were asked for.
    pub cases: Option<Vec<GateCase>>,
    /// Golden hashes.
    pub hashes: Vec<GoldenHash>,
    /// Times of the families.
    pub times: Table,
}

/// A piece of work, independent of the others.
struct Job {
    name: &'static str,
    work: Work,
}

enum Work {
    Oracle(oracles::trials::Trial),
    Stability(stability::Family),
    Contacts(contacts::Family),
    Forces(contacts::Family),
    Fuzz(u64),
    Golden(golden::Piece),
}

/// What is left of a job.
enum Done {
    Cases(Vec<GateCase>),
    Runs(Vec<golden::Run>),
}

/// Runs every case of the oracles, of the quick hard cases, contacts and forces that this machine can run, and of cloths at random,
/// unless only hashes are asked for, and the golden scenes.
#[must_use]
pub fn measure(hashes_only: bool) -> Measured {
    let pieces = golden::pieces().map(|piece| Job { name: GOLDEN, work: Work::Golden(piece) });
    let mut jobs = if hashes_only { Vec::new() } else { jobs_of_cases() };
    jobs.extend(pieces);
    let rank = |job: &Job| LONGEST.iter().position(|name| *name == job.name);
    // Small pieces come last: they fill the cores to the end.
    jobs.sort_by_key(|job| rank(job).unwrap_or(LONGEST.len()));
    let bar = progress(jobs.len());
    let done = parallel::map(&jobs, |job| {
        let start = Instant::now();
        let done = job.run();
        bar.inc(1);
        (done, start.elapsed().as_secs_f64())
    });
    bar.finish_and_clear();
    let (mut times, mut cases, mut runs) = (Vec::new(), Vec::new(), Vec::new());
    for (job, (done, seconds)) in jobs.iter().zip(done) {
        add_time(&mut times, job.name, seconds);
        match done {
            Done::Cases(of_job) => cases.extend(of_job),
            Done::Runs(of_piece) => runs.push(of_piece),
        }
    }
    Measured {
        cases: (!hashes_only).then_some(cases),
        hashes: golden::collect(&runs),
        times: families::times("gate", &times),
    }
}

/// Adds the time of a job to that of its family.
fn add_time(times: &mut Vec<Family<()>>, name: &'static str, seconds: f64) {
    match times.iter_mut().find(|family| family.name == name) {
        Some(family) => {
            family.cases.push(());
            family.seconds += seconds;
        }
        None => times.push(Family { name, cases: vec![()], seconds }),
    }
}

fn jobs_of_cases() -> Vec<Job> {
    let oracles = oracles::trials::ALL.map(|(name, trial)| (name, Work::Oracle(trial)));
    let stability = stability::ALL.map(|(name, family)| (name, Work::Stability(family)));
    let contacts = contacts::ALL.map(|(name, family)| (name, Work::Contacts(family)));
    let forces = forces::ALL.map(|(name, family)| (name, Work::Forces(family)));
    let seeds = fuzz::SEEDS.map(|seed| (FUZZ, Work::Fuzz(seed)));
    let families = oracles.into_iter().chain(stability).chain(contacts).chain(forces);
    families.chain(seeds).map(|(name, work)| Job { name, work }).collect()
}

impl Job {
    fn run(&self) -> Done {
        let rows = |command: &str, rows: Vec<contacts::Row>| {
            Done::Cases(rows.iter().map(|row| GateCase::of_row(command, row)).collect())
        };
        match self.work {
            Work::Oracle(trial) => {
                let cases =
                    trial(&|scene, settings| Box::new(Product::lone(settings).start(scene)));
                Done::Cases(cases.iter().map(GateCase::of_oracle).collect())
            }
            Work::Stability(family) => {
                Done::Cases(family(true).iter().filter_map(GateCase::of_hard_case).collect())
            }
            Work::Contacts(family) => rows("contacts", family(true)),
            Work::Forces(family) => rows("forces", family(true)),
            Work::Fuzz(seed) => rows("fuzz", fuzz::verdicts(seed)),
            Work::Golden(piece) => Done::Runs(piece.run()),
        }
    }
}
