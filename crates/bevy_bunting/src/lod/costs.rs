//! What batches cost: a table, and how far this machine is from it.

use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::{LaneCount, StepSettings};

use super::governor::BatchCosts;

/// Part of the way to a dearer measurement that the model goes, and to a cheaper one: unequal, so
/// that it expects what most ticks do not exceed rather than their mean.
const RATES: [f32; 2] = [0.2, 0.05];

/// Part of what was known of changes of level that is kept when there is a new one: some twenty count.
const KEPT: f32 = 0.95;

/// A measurement counts for at most this many times what was expected: a tick in which the machine
/// did something else says nothing of the cloths.
const GREATEST_SURPRISE: f32 = 1.5;

/// What cloth costs, by width of its batch: one, eight or sixteen lanes. A batch that is filled in
/// part costs as much as a full one.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub struct CostTable {
    /// A particle of all lanes in a substep of one pass, ns.
    pub substep: [f32; 3],
    /// The same in every further pass, ns.
    pub pass: [f32; 3],
    /// A cloth in a tick, besides: driving it and publishing its state, ns a particle.
    pub publish: f32,
    /// The same, whatever its particles, ns.
    pub cloth: f32,
    /// A tick, whatever is in it, µs.
    pub tick: f32,
    /// A change of level in somebody's picture, ns a particle of the finer of the two.
    pub change: f32,
}

impl Default for CostTable {
    /// One core of a server Xeon with AVX-512, in 2026, of a 33 × 33 flag in the wind.
    fn default() -> Self {
        Self {
            substep: [21.0, 80.0, 137.0],
            pass: [4.8, 17.5, 31.0],
            publish: 2.0,
            cloth: 200.0,
            tick: 20.0,
            change: 170.0,
        }
    }
}

impl CostTable {
    /// A batch in a tick, µs.
    #[must_use]
    pub fn batch(&self, particles: usize, settings: StepSettings, lanes: LaneCount) -> f32 {
        let width = width(lanes);
        let passes = settings.passes.saturating_sub(1) as f32;
        let substep = self.substep[width] + passes * self.pass[width];
        1e-3 * particles as f32 * settings.substeps as f32 * substep
    }

    /// A change between a level and a coarser one, µs; particles of the finer.
    pub fn change(&self, particles: usize) -> f32 {
        1e-3 * self.change * particles as f32
    }

    /// A cloth in a tick, besides its part of a batch, µs.
    fn each(&self, particles: usize) -> f32 {
        1e-3 * (self.cloth + self.publish * particles as f32)
    }
}

fn width(lanes: LaneCount) -> usize {
    match lanes {
        LaneCount::One => 0,
        LaneCount::Eight => 1,
        LaneCount::Sixteen => 2,
    }
}

/// A batch as it was measured in a tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measured {
    pub particles: usize,
    pub settings: StepSettings,
    pub lanes: LaneCount,
    /// µs.
    pub time: f32,
}

/// How many times more than the table says one kind of batch costs.
#[derive(Clone, Copy, Debug)]
struct Factor {
    particles: usize,
    settings: StepSettings,
    lanes: LaneCount,
    factor: f32,
}

/// Expects of every batch what the table says times what was measured of its like.
#[derive(Clone, Debug)]
pub(crate) struct CostModel {
    factors: Vec<Factor>,
    /// Of batches that were not measured yet.
    general: f32,
    /// Of everything besides batches and changes of level.
    besides: f32,
    /// What the table expected of changes of level, and what they took, µs: those of late count more.
    changes: [f32; 2],
}

impl Default for CostModel {
    fn default() -> Self {
        Self { factors: Vec::new(), general: 1.0, besides: 1.0, changes: [1.0; 2] }
    }
}

impl CostModel {
    /// Learns from all batches of a tick.
    pub fn learn(&mut self, table: &CostTable, batches: impl Iterator<Item = Measured>) {
        let (mut expected, mut measured) = (0.0, 0.0);
        for batch in batches {
            let by_table = table.batch(batch.particles, batch.settings, batch.lanes);
            if by_table <= 0.0 || !batch.time.is_finite() {
                continue;
            }
            expected += by_table;
            measured += batch.time;
            let ratio = batch.time / by_table;
            let same = |factor: &&mut Factor| {
                (factor.particles, factor.settings, factor.lanes)
                    == (batch.particles, batch.settings, batch.lanes)
            };
            match self.factors.iter_mut().find(same) {
                Some(known) => approach(&mut known.factor, ratio),
                None => self.factors.push(Factor {
                    particles: batch.particles,
                    settings: batch.settings,
                    lanes: batch.lanes,
                    factor: ratio.min(GREATEST_SURPRISE * self.general),
                }),
            }
        }
        if expected > 0.0 {
            approach(&mut self.general, measured / expected);
        }
    }

    /// Learns what a tick took besides its batches, µs, where the table says `expected`.
    pub fn learn_besides(&mut self, expected: f32, time: f32) {
        if expected > 0.0 && time.is_finite() {
            approach(&mut self.besides, time.max(0.0) / expected);
        }
    }

    /// Learns what the changes of level in a tick took, µs, where the table says `expected`.
    pub fn learn_changes(&mut self, expected: f32, time: f32) {
        if expected > 0.0 && time.is_finite() {
            let surprise = GREATEST_SURPRISE * self.change() * expected;
            for (sum, new) in self.changes.iter_mut().zip([expected, time.min(surprise)]) {
                *sum = KEPT * *sum + new;
            }
        }
    }

    /// How many times more than the table says a change of level costs.
    fn change(&self) -> f32 {
        self.changes[1] / self.changes[0]
    }

    /// What a tick costs whatever is in it, µs.
    pub fn tick(&self, table: &CostTable) -> f32 {
        self.besides * table.tick
    }

    /// What batches of a level cost. `widest` is the machine's, `alone` how many ride alone.
    pub fn costs(
        &self,
        table: &CostTable,
        particles: usize,
        settings: StepSettings,
        widest: LaneCount,
        alone: u32,
    ) -> BatchCosts {
        let cost = |lanes: LaneCount| {
            let known = self.factors.iter().find(|factor| {
                (factor.particles, factor.settings, factor.lanes) == (particles, settings, lanes)
            });
            let factor = known.map_or(self.general, |known| known.factor);
            factor * table.batch(particles, settings, lanes)
        };
        let one = cost(LaneCount::One);
        let each = self.besides * table.each(particles);
        let change = self.change() * table.change(particles);
        match widest {
            LaneCount::One => {
                BatchCosts { one, eight: 8.0 * one, sixteen: None, alone: 8, each, change }
            }
            LaneCount::Eight => {
                BatchCosts { one, eight: cost(widest), sixteen: None, alone, each, change }
            }
            LaneCount::Sixteen => {
                let [eight, sixteen] = [LaneCount::Eight, widest].map(cost);
                BatchCosts { one, eight, sixteen: Some(sixteen), alone, each, change }
            }
        }
    }

    /// What cloths cost besides their batches by the table, µs; particles of each.
    pub fn besides_by_table(table: &CostTable, cloths: impl Iterator<Item = usize>) -> f32 {
        table.tick + cloths.map(|particles| table.each(particles)).sum::<f32>()
    }
}

fn approach(factor: &mut f32, measured: f32) {
    let measured = measured.min(GREATEST_SURPRISE * *factor);
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

    fn sixteen(time: f32) -> Measured {
        Measured { particles: 1000, settings: SETTINGS, lanes: LaneCount::Sixteen, time }
    }

    #[test]
    fn the_table_is_of_whole_batches() {
        assert_eq!(TABLE.batch(1000, SETTINGS, LaneCount::Sixteen), 600.0);
        let passes = StepSettings { passes: 3, ..SETTINGS };
        assert_eq!(TABLE.batch(1000, passes, LaneCount::Eight), 480.0);
        let costs = CostModel::default().costs(&TABLE, 1000, SETTINGS, LaneCount::Sixteen, 1);
        let sixteen = Some(600.0);
        let expected =
            BatchCosts { one: 200.0, eight: 400.0, sixteen, alone: 1, each: 2.0, change: 50.0 };
        assert_eq!(costs, expected);
        let narrow = CostModel::default().costs(&TABLE, 1000, SETTINGS, LaneCount::Eight, 1);
        assert_eq!(narrow.sixteen, None);
    }

    #[test]
    fn the_model_comes_to_what_is_measured() {
        let mut model = CostModel::default();
        for _ in 0..200 {
            model.learn(&TABLE, [sixteen(1800.0)].into_iter());
            model.learn_besides(10.0, 40.0);
            model.learn_changes(30.0, 60.0);
        }
        let costs = |particles| model.costs(&TABLE, particles, SETTINGS, LaneCount::Sixteen, 1);
        assert!((costs(1000).sixteen.expect("wide") / 1800.0 - 1.0).abs() < 0.01);
        // What was never measured is as much dearer than the table as what was.
        assert!((costs(500).eight / 600.0 - 1.0).abs() < 0.01);
        assert!((model.tick(&TABLE) / 40.0 - 1.0).abs() < 0.01);
        assert!((costs(1000).change / 100.0 - 1.0).abs() < 0.01);
    }

    #[test]
    fn one_bad_tick_changes_little() {
        let mut model = CostModel::default();
        (0..50).for_each(|_| model.learn(&TABLE, [sixteen(600.0)].into_iter()));
        model.learn(&TABLE, [sixteen(60_000.0)].into_iter());
        let costs = model.costs(&TABLE, 1000, SETTINGS, LaneCount::Sixteen, 1);
        assert!(costs.sixteen.expect("wide") < 1.11 * 600.0);
    }
}
