//! Level tables: errors, costs and sizes of the levels of all cloths that share their fabrics.

use std::sync::{Arc, Weak};

use bunting_solver::{EffortClass, Fabric, LaneCount, Scheme, StepSettings};

use crate::fabric::levels::ClothLevels;
use crate::lod::batch_costs::BatchCosts;
use crate::lod::candidate::LevelTable;
use crate::lod::cost_model::CostModel;
use crate::lod::cost_table::CostTable;
use crate::lod::error::level_error;
use crate::settings::ClothSettings;

/// Factor on the greatest distance at rest from the middle particle that allows for stretch. Smaller: a
/// stretched cloth counts as off the screen while its border is still visible.
const STRETCH: f32 = 1.1;

/// Inputs of a level's costs, besides the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Work {
    particles: usize,
    step: StepSettings,
    most_single: u32,
    /// Topology of the fabric, see [`Fabric::topology`].
    topology: Option<u64>,
    /// Number of the pool of cloths of several fabrics; none where no other fabric has the topology.
    pool: Option<u32>,
}

/// One table for each [`ClothLevels`] in use and each class of effort of its cloths.
#[derive(Debug, Default)]
pub(crate) struct LevelTables {
    /// Work of each level; empty while it is unknown.
    work: Vec<Vec<Work>>,
    /// Length of the ticks for which the work is known, s.
    tick: f32,
    /// Costs of each kind of work in this tick.
    costs: Vec<(Work, BatchCosts)>,
    levels: Vec<(Weak<ClothLevels>, EffortClass)>,
    /// Number of particles at each level.
    particles: Vec<Vec<usize>>,
    /// Greatest distance of any particle from the middle one, m.
    radii: Vec<f32>,
    /// Errors and costs of each level.
    pub tables: Vec<LevelTable>,
}

impl LevelTables {
    /// Index of the table of a cloth with these levels in a class of effort. A missing table is added.
    pub fn index_of(&mut self, levels: &Arc<ClothLevels>, class: EffortClass) -> usize {
        let is_same = |known: &(Weak<ClothLevels>, EffortClass)| {
            core::ptr::eq(known.0.as_ptr(), Arc::as_ptr(levels)) && known.1 == class
        };
        if let Some(known) = self.levels.iter().position(is_same) {
            return known;
        }
        let fabrics = || (0..levels.count()).map(|level| levels.fabric(level));
        let unused = self.levels.iter().position(|known| known.0.strong_count() == 0);
        let index = unused.unwrap_or(self.tables.len());
        if unused.is_none() {
            self.levels.push((Weak::new(), class));
            self.work.push(Vec::new());
            self.particles.push(Vec::new());
            self.radii.push(0.0);
            self.tables.push(LevelTable::default());
        }
        self.levels[index] = (Arc::downgrade(levels), class);
        self.work[index].clear();
        self.particles[index] = fabrics().map(|fabric| fabric.particle_count()).collect();
        // The middle particle may differ from level to level.
        let radius = fabrics().map(|fabric| rest_radius(fabric)).fold(0.0, f32::max);
        self.radii[index] = STRETCH * radius;
        self.tables[index] = LevelTable {
            errors: fabrics().map(|fabric| level_error(fabric)).collect(),
            costs: vec![Default::default(); levels.count()],
            owners: vec![index as u32; levels.count()],
        };
        index
    }

    /// Forgets the tables of levels that no cloth has any more. Others keep their indices, which cloths know.
    pub fn forget_unused(&mut self) {
        let is_unused = |known: &(Weak<ClothLevels>, EffortClass)| known.0.strong_count() == 0;
        for index in 0..self.levels.len() {
            if is_unused(&self.levels[index]) {
                self.levels[index].0 = Weak::new();
                self.work[index] = Vec::new();
                self.particles[index] = Vec::new();
                self.tables[index] = LevelTable::default();
            }
        }
        let in_use = self.levels.iter().rposition(|known| !is_unused(known));
        let count = in_use.map_or(0, |last| last + 1);
        self.levels.truncate(count);
        self.work.truncate(count);
        self.particles.truncate(count);
        self.radii.truncate(count);
        self.tables.truncate(count);
    }

    /// Greatest distance of any particle of a table's cloths from the middle one, m.
    pub fn radius(&self, table: usize) -> f32 {
        self.radii[table]
    }

    /// Number of particles of a table's cloths at a level.
    pub fn particles(&self, table: usize, level: usize) -> usize {
        self.particles[table][level]
    }

    /// Updates all costs. With `fixed` costs sixteen lanes are assumed, whatever the machine's width. Cloths
    /// of different fabrics have few different sizes, so that few costs are computed.
    pub fn update_costs(
        &mut self,
        table: &CostTable,
        model: &CostModel,
        widest: Option<LaneCount>,
        fixed: bool,
    ) {
        let machine = if fixed { LaneCount::Sixteen } else { LaneCount::widest() };
        let widest = widest.map_or(machine, |widest| widest.min(machine));
        self.costs.clear();
        for (levels, table_of_costs) in self.work.iter().zip(&mut self.tables) {
            for (work, cost) in levels.iter().zip(&mut table_of_costs.costs) {
                let known = self.costs.iter().find(|(known, _)| known == work);
                *cost = known.map(|(_, cost)| *cost).unwrap_or_else(|| {
                    let Work { particles, step, most_single, pool, .. } = *work;
                    let new = model.costs(table, particles, step, widest, most_single, pool);
                    self.costs.push((*work, new));
                    new
                });
            }
        }
    }

    /// Updates the work of new tables, and of all tables if the length of a tick (s) or the settings changed.
    pub fn update_work(&mut self, settings: &ClothSettings, changed: bool, tick: f32) {
        if changed || self.tick != tick {
            self.tick = tick;
            self.work.iter_mut().for_each(Vec::clear);
        }
        let gravity = settings.gravity.length();
        let mut is_new = false;
        for ((levels, class), work) in self.levels.iter().zip(&mut self.work) {
            if !work.is_empty() {
                continue;
            }
            let Some(levels) = levels.upgrade() else { continue };
            let work_of = |level: usize| {
                let fabric = levels.fabric(level);
                let step =
                    settings.limits(level).of_fabric(fabric, tick, class.acceleration(gravity));
                let most_single = match settings.lanes {
                    None => LaneCount::most_alone(fabric, step.scheme) as u32,
                    Some(_) => 0,
                };
                let topology = fabric.topology().filter(|_| step.scheme == Scheme::Yarns);
                Work { particles: fabric.particle_count(), step, most_single, topology, pool: None }
            };
            work.extend((0..levels.count()).map(work_of));
            is_new = true;
        }
        if is_new {
            self.find_owners();
            self.number_pools();
        }
    }

    /// Finds the tables that count the cloths of each level: the first of the same fabrics with the same substeps.
    fn find_owners(&mut self) {
        for index in 0..self.tables.len() {
            let levels = self.levels[index].0.as_ptr();
            let same =
                (0..index).filter(|&other| core::ptr::eq(self.levels[other].0.as_ptr(), levels));
            let same: Vec<usize> = same.collect();
            for (level, work) in self.work[index].iter().enumerate() {
                let shares = |other: &&usize| {
                    self.work[**other].get(level).is_some_and(|other| other.step == work.step)
                };
                let owner = same.iter().find(shares).copied().unwrap_or(index);
                self.tables[index].owners[level] = owner as u32;
            }
        }
    }

    /// Numbers the topologies, with settings, of more than one fabric.
    fn number_pools(&mut self) {
        let mut pools: Vec<(u64, StepSettings, u32)> = Vec::new();
        for numbers in [false, true] {
            let in_use = (0..self.tables.len()).filter(|&it| self.levels[it].0.strong_count() > 0);
            for index in in_use {
                for (work, &owner) in self.work[index].iter_mut().zip(&self.tables[index].owners) {
                    let Some(topology) = work.topology else { continue };
                    let is_of =
                        |pool: &(u64, StepSettings, u32)| (pool.0, pool.1) == (topology, work.step);
                    match pools.iter().position(is_of) {
                        Some(pool) if numbers => {
                            work.pool = (pools[pool].2 > 1).then_some(pool as u32);
                        }
                        Some(pool) => pools[pool].2 += u32::from(owner as usize == index),
                        None => pools.push((topology, work.step, 1)),
                    }
                }
            }
        }
    }
}

/// Greatest distance at rest of any particle from the middle one, m.
fn rest_radius(fabric: &Fabric) -> f32 {
    let rest = fabric.rest_positions();
    let middle = rest[rest.len() / 2];
    rest.iter().map(|position| position.distance(middle)).fold(0.0, f32::max)
}
