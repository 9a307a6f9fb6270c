//! The cost model: a table of costs, and factors by which this machine differs from it.

use bunting_solver::{LaneCount, StepSettings};

use crate::batch::batches::BatchTiming;
use crate::lod::batch_costs::BatchCosts;
use crate::lod::cost_table::CostTable;

/// Rates at which the model approaches a measurement above, and one below, its expectation. They differ so
/// that most ticks cost no more than expected; equal rates would give the mean.
const RATES: [f32; 2] = [0.2, 0.05];

/// Fraction of the sums of earlier changes of level that is kept when one more is measured: about twenty
/// changes count.
const KEPT: f32 = 0.95;

/// Greatest ratio of a measurement to the expectation that is used: longer ticks were disturbed by other work
/// of the machine.
const GREATEST_RATIO: f32 = 1.5;

/// Measured over tabulated cost of batches of one size, settings and width.
#[derive(Clone, Copy, Debug)]
struct BatchFactor {
    particles: usize,
    settings: StepSettings,
    lanes: LaneCount,
    /// Factor; none until the end of the first tick with such batches.
    factor: Option<f32>,
    /// Costs of all such batches in the measured tick, µs: tabulated and measured.
    sums: [f32; 2],
}

impl BatchFactor {
    fn is_of(&self, particles: usize, settings: StepSettings, lanes: LaneCount) -> bool {
        (self.particles, self.settings, self.lanes) == (particles, settings, lanes)
    }
}

/// Expected costs of batches: the cost in the table times a measured factor for each kind of batch.
#[derive(Clone, Debug)]
pub(crate) struct CostModel {
    factors: Vec<BatchFactor>,
    /// Ratio of measured to tabulated cost of all batches, used for batches that were never measured.
    general_factor: f32,
    /// Ratio of measured to tabulated overhead: everything besides batches and changes of level.
    overhead_factor: f32,
    /// Sums over changes of level, µs: tabulated and measured. Later changes weigh more.
    changes: [f32; 2],
}

impl Default for CostModel {
    fn default() -> Self {
        Self { factors: Vec::new(), general_factor: 1.0, overhead_factor: 1.0, changes: [1.0; 2] }
    }
}

impl CostModel {
    /// Learns from the measured batches of a tick. All batches of one size, settings and width are averaged,
    /// since among many batches some always take long.
    pub fn learn_batches(&mut self, table: &CostTable, batches: impl Iterator<Item = BatchTiming>) {
        for BatchTiming { particles, settings, lanes, time } in batches {
            let by_table = table.batch(particles, settings, lanes);
            if by_table <= 0.0 || !time.is_finite() {
                continue;
            }
            let known = self.factors.iter().position(|it| it.is_of(particles, settings, lanes));
            let index = known.unwrap_or(self.factors.len());
            if known.is_none() {
                let new = BatchFactor { particles, settings, lanes, factor: None, sums: [0.0; 2] };
                self.factors.push(new);
            }
            let [tabulated, measured] = &mut self.factors[index].sums;
            *tabulated += by_table;
            *measured += time;
        }
        let mut all = [0.0; 2];
        for BatchFactor { factor, sums, .. } in &mut self.factors {
            let [tabulated, measured] = core::mem::take(sums);
            if tabulated > 0.0 {
                let ratio = measured / tabulated;
                match factor {
                    Some(factor) => approach(factor, ratio),
                    None => *factor = Some(ratio.min(GREATEST_RATIO * self.general_factor)),
                }
                all = [all[0] + tabulated, all[1] + measured];
            }
        }
        if all[0] > 0.0 {
            approach(&mut self.general_factor, all[1] / all[0]);
        }
    }

    /// Learns from the measured overhead of a tick, µs.
    pub fn learn_overhead(&mut self, tabulated: f32, measured: f32) {
        if tabulated > 0.0 && measured.is_finite() {
            approach(&mut self.overhead_factor, measured.max(0.0) / tabulated);
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
        self.overhead_factor * table.tick
    }

    /// Expected costs of batches with a number of particles in each lane, on a machine with batches of at
    /// most `widest`, and with at most `most_single` cloths in batches of one lane.
    pub fn costs(
        &self,
        table: &CostTable,
        particles: usize,
        settings: StepSettings,
        widest: LaneCount,
        most_single: u32,
    ) -> BatchCosts {
        let cost = |lanes: LaneCount| {
            let known = self.factors.iter().find(|it| it.is_of(particles, settings, lanes));
            let factor = known.and_then(|known| known.factor).unwrap_or(self.general_factor);
            factor * table.batch(particles, settings, lanes)
        };
        let one = cost(LaneCount::One);
        let (eight, sixteen, most_single) = match widest {
            LaneCount::One => (8.0 * one, None, 8),
            LaneCount::Eight => (cost(LaneCount::Eight), None, most_single),
            LaneCount::Sixteen => {
                (cost(LaneCount::Eight), Some(cost(LaneCount::Sixteen)), most_single)
            }
        };
        BatchCosts {
            one,
            eight,
            sixteen,
            most_single,
            per_cloth: self.overhead_factor * table.per_cloth(particles),
            change: self.change_factor() * table.change(particles),
        }
    }

    /// Tabulated overhead of a tick, µs; `cloths` are the numbers of particles of each cloth.
    pub fn tabulated_overhead(table: &CostTable, cloths: impl Iterator<Item = usize>) -> f32 {
        table.tick + cloths.map(|particles| table.per_cloth(particles)).sum::<f32>()
    }
}

/// Moves a factor towards a measured one.
fn approach(factor: &mut f32, measured: f32) {
    let measured = measured.min(GREATEST_RATIO * *factor);
    let rate = if measured > *factor { RATES[0] } else { RATES[1] };
    *factor += rate * (measured - *factor);
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: CostTable = CostTable {
        substep: [100.0, 200.0, 300.0],
        pass: [10.0, 20.0, 30.0],
        publish: 2.0,
        cloth: 0.0,
        tick: 10.0,
        change: 50.0,
    };
    const SETTINGS: StepSettings = StepSettings::yarns(2);

    fn sixteen(time: f32) -> BatchTiming {
        BatchTiming { particles: 1000, settings: SETTINGS, lanes: LaneCount::Sixteen, time }
    }

    #[test]
    fn costs_are_those_of_whole_batches() {
        assert_eq!(TABLE.batch(1000, SETTINGS, LaneCount::Sixteen), 600.0);
        let passes = StepSettings { passes: 3, ..SETTINGS };
        assert_eq!(TABLE.batch(1000, passes, LaneCount::Eight), 480.0);
        let costs = CostModel::default().costs(&TABLE, 1000, SETTINGS, LaneCount::Sixteen, 1);
        let sixteen = Some(600.0);
        let expected = BatchCosts {
            one: 200.0,
            eight: 400.0,
            sixteen,
            most_single: 1,
            per_cloth: 2.0,
            change: 50.0,
        };
        assert_eq!(costs, expected);
        let narrow = CostModel::default().costs(&TABLE, 1000, SETTINGS, LaneCount::Eight, 1);
        assert_eq!(narrow.sixteen, None);
    }

    #[test]
    fn the_model_approaches_what_is_measured() {
        let mut model = CostModel::default();
        for _ in 0..200 {
            model.learn_batches(&TABLE, [sixteen(1800.0)].into_iter());
            model.learn_overhead(10.0, 40.0);
            model.learn_changes(30.0, 60.0);
        }
        let costs = |particles| model.costs(&TABLE, particles, SETTINGS, LaneCount::Sixteen, 1);
        assert!((costs(1000).sixteen.expect("wide") / 1800.0 - 1.0).abs() < 0.01);
        // Batches that were never measured have the general factor.
        assert!((costs(500).eight / 600.0 - 1.0).abs() < 0.01);
        assert!((model.empty_tick(&TABLE) / 40.0 - 1.0).abs() < 0.01);
        assert!((costs(1000).change / 100.0 - 1.0).abs() < 0.01);
    }

    #[test]
    fn of_many_batches_the_mean_counts() {
        let mut model = CostModel::default();
        for _ in 0..50 {
            let times = (0..200).map(|batch| if batch % 10 == 0 { 1500.0 } else { 500.0 });
            model.learn_batches(&TABLE, times.map(sixteen));
        }
        let costs = model.costs(&TABLE, 1000, SETTINGS, LaneCount::Sixteen, 1);
        assert!((costs.sixteen.expect("wide") / 600.0 - 1.0).abs() < 0.01, "{costs:?}");
    }

    #[test]
    fn one_bad_tick_changes_little() {
        let mut model = CostModel::default();
        (0..50).for_each(|_| model.learn_batches(&TABLE, [sixteen(600.0)].into_iter()));
        model.learn_batches(&TABLE, [sixteen(60_000.0)].into_iter());
        let costs = model.costs(&TABLE, 1000, SETTINGS, LaneCount::Sixteen, 1);
        assert!(costs.sixteen.expect("wide") < 1.11 * 600.0);
    }
}
