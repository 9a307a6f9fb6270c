//! Level tables: errors, costs and sizes of the levels of all cloths that share their fabrics.

use std::collections::HashMap;
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

/// The work of a level.
#[derive(Clone, Copy, Debug)]
struct WorkOfLevel {
    work: Work,
    /// Index of its costs among those of all kinds of work.
    kind: usize,
}

/// One table for each [`ClothLevels`] in use and each class of effort of its cloths.
#[derive(Debug, Default)]
pub(crate) struct LevelTables {
    /// Work of each level; empty while it is unknown.
    work: Vec<Vec<WorkOfLevel>>,
    /// Length of the ticks for which the work is known, s.
    tick: f32,
    /// Costs of each kind of work.
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
        self.tables[index] = LevelTable::new(
            fabrics().map(|fabric| level_error(fabric)).collect(),
            vec![Default::default(); levels.count()],
            vec![index as u32; levels.count()],
            radius,
        );
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

    /// Number of particles of a table's cloths at a level; none if they are held still.
    pub fn particles(&self, table: usize, level: usize) -> Option<usize> {
        self.particles[table].get(level).copied()
    }

    /// Updates all costs, once their work is known. With `fixed` costs sixteen lanes are assumed, whatever the machine's width. Cloths
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
        for (work, costs) in &mut self.costs {
            let Work { particles, step, most_single, pool, .. } = *work;
            *costs = model.costs(table, particles, step, widest, most_single, pool);
        }
        for (levels, table_of_costs) in self.work.iter().zip(&mut self.tables) {
            for (level, costs) in levels.iter().zip(&mut table_of_costs.costs) {
                *costs = self.costs[level.kind].1;
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
                let particles = fabric.particle_count();
                let work = Work { particles, step, most_single, topology, pool: None };
                WorkOfLevel { work, kind: 0 }
            };
            work.extend((0..levels.count()).map(work_of));
            is_new = true;
        }
        if is_new {
            self.find_owners();
            self.number_pools();
            self.find_kinds();
        }
    }

    /// Finds the tables that count the cloths of each level: the first of the same fabrics with the same substeps.
    fn find_owners(&mut self) {
        let mut of_fabrics: HashMap<usize, Vec<usize>> = HashMap::new();
        for index in 0..self.tables.len() {
            let same = of_fabrics.entry(self.levels[index].0.as_ptr().addr()).or_default();
            for (level, WorkOfLevel { work, .. }) in self.work[index].iter().enumerate() {
                let shares = |other: &&usize| {
                    self.work[**other].get(level).is_some_and(|it| it.work.step == work.step)
                };
                let owner = same.iter().find(shares).copied().unwrap_or(index);
                self.tables[index].owners[level] = owner as u32;
            }
            same.push(index);
        }
    }

    /// Numbers the topologies, with settings, of more than one fabric.
    fn number_pools(&mut self) {
        // For each topology its settings, each with the number of its pool and that of its fabrics.
        let mut pools: HashMap<u64, Vec<(StepSettings, u32, u32)>> = HashMap::new();
        let mut count = 0;
        for numbers in [false, true] {
            let in_use = (0..self.tables.len()).filter(|&it| self.levels[it].0.strong_count() > 0);
            for index in in_use {
                let levels = self.work[index].iter_mut().zip(&self.tables[index].owners);
                for (WorkOfLevel { work, .. }, &owner) in levels {
                    let Some(topology) = work.topology else { continue };
                    let of_topology = pools.entry(topology).or_default();
                    match of_topology.iter_mut().find(|(step, ..)| *step == work.step) {
                        Some((_, pool, fabrics)) if numbers => {
                            work.pool = (*fabrics > 1).then_some(*pool);
                        }
                        Some((.., fabrics)) => *fabrics += u32::from(owner as usize == index),
                        None => {
                            of_topology.push((work.step, count, 1));
                            count += 1;
                        }
                    }
                }
            }
        }
    }

    /// Finds the levels of equal work, whose costs are computed once.
    fn find_kinds(&mut self) {
        let mut of_size: HashMap<usize, Vec<usize>> = HashMap::new();
        self.costs.clear();
        for WorkOfLevel { work, kind } in self.work.iter_mut().flatten() {
            let kinds = of_size.entry(work.particles).or_default();
            let known = kinds.iter().copied().find(|&kind| self.costs[kind].0 == *work);
            *kind = known.unwrap_or(self.costs.len());
            if known.is_none() {
                kinds.push(*kind);
                self.costs.push((*work, BatchCosts::default()));
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
