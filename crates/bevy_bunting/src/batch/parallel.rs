//! Whether work on batches is spread over threads: where that saves more time than the threads take to wake up.

use crate::batch::cost_kind::CostKind;
use crate::lod::cost_table::CostTable;

/// Time that work must save for which sleeping threads of the pool wake up, by the table of costs, µs. Less: small crowds are
/// slowed down. More: cores are left idle.
const LEAST_SAVED: f32 = 60.0;

/// Time of a pass over bounds, normals or surfaces, for a particle in one lane, ns.
const PASS: f32 = 1.0;

/// Part of a substep that each of its phases takes.
const PART_OF_PHASE: f32 = 1.0 / 3.0;

/// Work on a batch.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Work {
    /// All substeps of a tick.
    Tick,
    /// A phase of a substep.
    Phase,
    /// A pass over particles: bounds, normals or the surface.
    Pass,
}

impl Work {
    /// Time of the work on a batch without contacts, by the table of costs, µs.
    pub fn time(self, kind: CostKind) -> f32 {
        let tick = || CostTable::default().batch(kind);
        match self {
            Self::Tick => tick(),
            Self::Phase => PART_OF_PHASE * tick() / kind.settings.substeps.max(1) as f32,
            Self::Pass => 1e-3 * PASS * (kind.particles * kind.lanes.get()) as f32,
        }
    }
}

/// Whether tasks of these times (µs) are done so much earlier by several threads that it is worth waking them.
pub(crate) fn pays(tasks: impl Iterator<Item = f32>, threads: usize) -> bool {
    let (sum, longest) =
        tasks.fold((0.0, 0.0), |(sum, longest): (f32, f32), time| (sum + time, longest.max(time)));
    sum - longest.max(sum / threads as f32) > LEAST_SAVED
}

#[cfg(test)]
mod tests {
    use bunting_solver::{LaneCount, StepSettings};

    use super::*;

    #[test]
    fn threads_are_woken_for_more_than_they_cost() {
        // Sixty-four flags, with one substep below 33 × 33.
        let flags = |n: usize, substeps: u32, work: Work| {
            let settings = StepSettings { passes: 2, ..StepSettings::yarns(substeps) };
            let kind =
                CostKind { particles: n * n, settings, lanes: LaneCount::Sixteen, mixed: false };
            pays([work.time(kind); 4].into_iter(), 2)
        };
        assert!(!flags(5, 1, Work::Tick) && !flags(9, 1, Work::Tick));
        assert!(flags(17, 1, Work::Tick) && flags(33, 2, Work::Tick));
        assert!(!flags(17, 1, Work::Phase) && flags(33, 2, Work::Phase));
    }

    #[test]
    fn one_long_task_wakes_nobody() {
        assert!(!pays([1e4, 1.0, 1.0].into_iter(), 4));
        assert!(pays([1e4, 1e4].into_iter(), 4));
    }
}
