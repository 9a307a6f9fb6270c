//! The cost model: a table of costs, and factors by which this machine differs from it.

use bunting_solver::{LaneCount, StepSettings};

use crate::batch::cost_kind::{BatchTiming, CostKind};
use crate::lod::batch_costs::{BatchCosts, Pool};
use crate::lod::cost_table::CostTable;

/// Rates at which the model approaches a measurement above, and one below, its expectation. They differ so
/// that most ticks cost no more than expected; equal rates would give the mean.
const RATES: [f32; 2] = [0.2, 0.05];

/// Factor on the table's costs before anything was measured: the machine is unknown, and caches are cold. Smaller: the
/// first second is over the budget on slow machines. Larger: cloths start coarser than they need to.
const UNKNOWN_MACHINE: f32 = 1.5;

/// Fraction of the sums of earlier changes of level that is kept when one more is measured: about twenty
/// changes count.
const KEPT: f32 = 0.95;

/// Greatest ratio of a measurement to the expectation that is used: longer ticks were disturbed by other work
/// of the machine.
const GREATEST_RATIO: f32 = 1.5;

/// Number of measurements of other batches after which the factor of batches that there are no longer is forgotten: some
/// minutes. Fewer: levels that come back are expected to cost what batches do on average. More: ever new meshes leave a
/// longer list of factors.
const MOST_MISSED: u32 = 2048;

/// Measured over tabulated cost of batches of one kind.
#[derive(Clone, Copy, Debug)]
struct BatchFactor {
    kind: CostKind,
    /// None until the end of the first tick in which there are such batches.
    factor: Option<Factor>,
    /// Costs of all such batches in the tick that is learnt from, µs: tabulated and measured.
    sums: [f32; 2],
    /// Number of measurements since there were such batches.
    missed: u32,
}

/// Measured over tabulated cost.
#[derive(Clone, Copy, Debug)]
struct Factor {
    value: f32,
    /// Number of measurements so far.
    measured: u32,
}

impl Factor {
    /// Nothing measured yet.
    const UNKNOWN: Self = Self { value: UNKNOWN_MACHINE, measured: 0 };

    /// Moves towards a measured factor: the mean of the first ones.
    fn approach(&mut self, measured: f32) {
        let measured = measured.min(GREATEST_RATIO * self.value);
        self.measured = self.measured.saturating_add(1);
        let least = RATES[usize::from(measured <= self.value)];
        let rate = least.max(1.0 / self.measured as f32);
        self.value += rate * (measured - self.value);
    }
}

/// Expected costs of batches: the cost in the table times a measured factor for each kind of batch.
#[derive(Clone, Debug)]
pub(crate) struct CostModel {
    /// In ascending order of their numbers of particles.
    factors: Vec<BatchFactor>,
    /// Measured over tabulated cost of all batches: the factor of batches that were not measured yet.
    general_factor: Factor,
    /// Measured over tabulated cost of the overhead: everything besides batches and changes of level.
    overhead_factor: Factor,
    /// Sums over changes of level, µs: tabulated and measured. Later changes count more.
    changes: [f32; 2],
}

impl Default for CostModel {
    fn default() -> Self {
        Self {
            factors: Vec::new(),
            general_factor: Factor::UNKNOWN,
            overhead_factor: Factor::UNKNOWN,
            changes: [1.0; 2],
        }
    }
}

impl CostModel {
    /// Expects the costs in the table.
    pub fn of_table() -> Self {
        let exact = Factor { value: 1.0, measured: 0 };
        Self { general_factor: exact, overhead_factor: exact, ..Self::default() }
    }

    /// Learns from the measured batches of a tick. Those of one size, settings and width count as one: of many, some
    /// always take long.
    pub fn learn_batches(&mut self, table: &CostTable, batches: impl Iterator<Item = BatchTiming>) {
        for BatchTiming { kind, time } in batches {
            let by_table = table.batch(kind);
            if by_table <= 0.0 || !time.is_finite() {
                continue;
            }
            let index = self.index_of(kind).unwrap_or_else(|index| {
                let new = BatchFactor { kind, factor: None, sums: [0.0; 2], missed: 0 };
                self.factors.insert(index, new);
                index
            });
            let [tabulated, measured] = &mut self.factors[index].sums;
            *tabulated += by_table;
            *measured += time;
        }
        let mut all = [0.0; 2];
        for BatchFactor { factor, sums, missed, .. } in &mut self.factors {
            let [tabulated, measured] = core::mem::take(sums);
            *missed += 1;
            if tabulated > 0.0 {
                *missed = 0;
                let ratio = measured / tabulated;
                let start = Factor { measured: 0, ..self.general_factor };
                factor.get_or_insert(start).approach(ratio);
                all = [all[0] + tabulated, all[1] + measured];
            }
        }
        self.factors.retain(|it| it.missed < MOST_MISSED);
        if all[0] > 0.0 {
            self.general_factor.approach(all[1] / all[0]);
        }
    }

    /// Index of the factor of a kind of batch, or that at which it would have to be inserted.
    fn index_of(&self, kind: CostKind) -> Result<usize, usize> {
        let first = self.factors.partition_point(|it| it.kind.particles < kind.particles);
        let as_large = self.factors[first..].iter();
        let mut as_large = as_large.take_while(|it| it.kind.particles == kind.particles);
        as_large.position(|it| it.kind == kind).map(|index| first + index).ok_or(first)
    }

    /// Learns from the measured overhead of a tick, µs.
    pub fn learn_overhead(&mut self, tabulated: f32, measured: f32) {
        if tabulated > 0.0 && measured.is_finite() {
            self.overhead_factor.approach(measured.max(0.0) / tabulated);
        }
    }

    /// Learns from the measured changes of level of a tick, µs.
    pub fn learn_changes(&mut self, tabulated: f32, measured: f32) {
        if tabulated > 0.0 && measured.is_finite() {
            let greatest = GREATEST_RATIO * self.change_factor() * tabulated;
            for (sum, new) in self.changes.iter_mut().zip([tabulated, measured.min(greatest)]) {
                *sum = KEPT * *sum + new;
            }
        }
    }

    /// Ratio of measured to tabulated cost of changes of level.
    fn change_factor(&self) -> f32 {
        self.changes[1] / self.changes[0]
    }

    /// Expected cost of a tick without any cloth, µs.
    pub fn empty_tick(&self, table: &CostTable) -> f32 {
        self.overhead_factor.value * table.tick
    }

    /// Expected costs of batches with so many particles in a lane, on a machine whose batches are at most
    /// `widest`, with at most `most_single` cloths in batches of one lane. `pool` is the number of the pool of cloths of
    /// several fabrics.
    pub fn costs(
        &self,
        table: &CostTable,
        particles: usize,
        settings: StepSettings,
        widest: LaneCount,
        most_single: u32,
        pool: Option<u32>,
    ) -> BatchCosts {
        let cost = |lanes: LaneCount, mixed: bool| {
            let kind = CostKind { particles, settings, lanes, mixed };
            let known = self.index_of(kind).ok().and_then(|index| self.factors[index].factor);
            let factor = known.unwrap_or(self.general_factor);
            factor.value * table.batch(kind)
        };
        let one = cost(LaneCount::One, false);
        let eight = |mixed: bool| match widest {
            LaneCount::One => 8.0 * one,
            _ => cost(LaneCount::Eight, mixed),
        };
        let is_wide = widest == LaneCount::Sixteen;
        BatchCosts {
            one,
            eight: eight(false),
            sixteen: is_wide.then(|| cost(LaneCount::Sixteen, false)),
            most_single: if widest == LaneCount::One { 8 } else { most_single },
            pool: pool.map(|index| Pool { index, eight: eight(true) }),
            per_cloth: self.overhead_factor.value * table.per_cloth(particles),
            change: self.change_factor() * table.change(particles),
        }
    }

    /// Tabulated overhead of a tick, µs; `cloths` are the numbers of particles of each cloth.
    pub fn tabulated_overhead(table: &CostTable, cloths: impl Iterator<Item = usize>) -> f32 {
        table.tick + cloths.map(|particles| table.per_cloth(particles)).sum::<f32>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: CostTable = CostTable {
        substep: [100.0, 200.0, 300.0],
        pass: [10.0, 20.0, 30.0],
        batch: [0.0; 3],
        mixed: 1.0,
        publish: 2.0,
        cloth: 0.0,
        tick: 10.0,
        change: 50.0,
    };
    const SETTINGS: StepSettings = StepSettings::yarns(2);

    fn kind(settings: StepSettings, lanes: LaneCount) -> CostKind {
        CostKind { particles: 1000, settings, lanes, mixed: false }
    }

    fn sixteen(time: f32) -> BatchTiming {
        BatchTiming { kind: kind(SETTINGS, LaneCount::Sixteen), time }
    }

    #[test]
    fn costs_are_those_of_whole_batches() {
        assert_eq!(TABLE.batch(kind(SETTINGS, LaneCount::Sixteen)), 600.0);
        let passes = StepSettings { passes: 3, ..SETTINGS };
        assert_eq!(TABLE.batch(kind(passes, LaneCount::Eight)), 480.0);
        let costs =
            CostModel::of_table().costs(&TABLE, 1000, SETTINGS, LaneCount::Sixteen, 1, None);
        let sixteen = Some(600.0);
        let expected = BatchCosts {
            one: 200.0,
            eight: 400.0,
            sixteen,
            most_single: 1,
            pool: None,
            per_cloth: 2.0,
            change: 50.0,
        };
        assert_eq!(costs, expected);
        let narrow = CostModel::of_table().costs(&TABLE, 1000, SETTINGS, LaneCount::Eight, 1, None);
        assert_eq!(narrow.sixteen, None);
    }

    #[test]
    fn the_model_approaches_what_is_measured() {
        let mut model = CostModel::of_table();
        for _ in 0..200 {
            model.learn_batches(&TABLE, [sixteen(1800.0)].into_iter());
            model.learn_overhead(10.0, 40.0);
            model.learn_changes(30.0, 60.0);
        }
        let costs =
            |particles| model.costs(&TABLE, particles, SETTINGS, LaneCount::Sixteen, 1, None);
        assert!((costs(1000).sixteen.expect("wide") / 1800.0 - 1.0).abs() < 0.01);
        // Batches that were never measured have the general factor.
        assert!((costs(500).eight / 600.0 - 1.0).abs() < 0.01);
        assert!((model.empty_tick(&TABLE) / 40.0 - 1.0).abs() < 0.01);
        assert!((costs(1000).change / 100.0 - 1.0).abs() < 0.01);
    }

    #[test]
    fn of_many_batches_the_mean_counts() {
        let mut model = CostModel::of_table();
        for _ in 0..50 {
            let times = (0..200).map(|batch| if batch % 10 == 0 { 1500.0 } else { 500.0 });
            model.learn_batches(&TABLE, times.map(sixteen));
        }
        let costs = model.costs(&TABLE, 1000, SETTINGS, LaneCount::Sixteen, 1, None);
        assert!((costs.sixteen.expect("wide") / 600.0 - 1.0).abs() < 0.01, "{costs:?}");
    }

    #[test]
    fn kinds_of_batches_that_are_gone_are_forgotten() {
        let mut model = CostModel::of_table();
        for particles in 0..3 * MOST_MISSED {
            let kind = CostKind { particles: 100 + particles as usize, ..sixteen(1.0).kind };
            model.learn_batches(&TABLE, [BatchTiming { kind, time: 1.0 }].into_iter());
        }
        assert!(model.factors.len() <= MOST_MISSED as usize);
    }

    #[test]
    fn one_bad_tick_changes_little() {
        let mut model = CostModel::of_table();
        (0..50).for_each(|_| model.learn_batches(&TABLE, [sixteen(600.0)].into_iter()));
        model.learn_batches(&TABLE, [sixteen(60_000.0)].into_iter());
        let costs = model.costs(&TABLE, 1000, SETTINGS, LaneCount::Sixteen, 1, None);
        assert!(costs.sixteen.expect("wide") < 1.11 * 600.0);
    }
}
