//! What is known of all cloths that are cut alike.

use std::sync::{Arc, Weak};

use bunting_solver::{Fabric, LaneCount, instruction_set};

use super::costs::{CostModel, CostTable};
use super::error::level_error;
use super::governor::Kind;
use crate::fabric::levels::ClothLevels;
use crate::settings::ClothSettings;

/// A cloth reaches farther from its middle than at rest by at most this part: it stretches little.
const STRETCH: f32 = 1.1;

/// Distance at rest from the particle in the middle to the one farthest from it, m.
fn reach(fabric: &Fabric) -> f32 {
    let rest = fabric.rest_positions();
    let middle = rest[rest.len() / 2];
    rest.iter().map(|place| place.distance(middle)).fold(0.0, f32::max)
}

/// One for each [`ClothLevels`] in use.
#[derive(Debug, Default)]
pub(crate) struct Kinds {
    levels: Vec<Weak<ClothLevels>>,
    particles: Vec<Vec<usize>>,
    radii: Vec<f32>,
    /// Errors and costs, as the governor wants them.
    pub kinds: Vec<Kind>,
}

impl Kinds {
    /// The kind of a cloth with these levels; found or made.
    pub fn of(&mut self, levels: &Arc<ClothLevels>) -> usize {
        let same = |known: &Weak<ClothLevels>| core::ptr::eq(known.as_ptr(), Arc::as_ptr(levels));
        if let Some(known) = self.levels.iter().position(same) {
            return known;
        }
        let fabrics = || (0..levels.count()).map(|level| levels.fabric(level));
        let kind = Kind {
            errors: fabrics().map(|fabric| level_error(fabric)).collect(),
            costs: vec![Default::default(); levels.count()],
        };
        let particles = fabrics().map(|fabric| fabric.particle_count()).collect();
        // The particle in the middle may be another one at each level.
        let radius = fabrics().map(|fabric| reach(fabric)).fold(0.0, f32::max);
        let free = self.levels.iter().position(|known| known.strong_count() == 0);
        let index = free.unwrap_or(self.kinds.len());
        if free.is_none() {
            self.levels.push(Weak::new());
            self.particles.push(Vec::new());
            self.radii.push(0.0);
            self.kinds.push(Kind::default());
        }
        self.levels[index] = Arc::downgrade(levels);
        self.particles[index] = particles;
        self.radii[index] = STRETCH * radius;
        self.kinds[index] = kind;
        index
    }

    /// No particle is farther from the one in the middle than this, m.
    pub fn radius(&self, kind: usize) -> f32 {
        self.radii[kind]
    }

    /// Particles at a level.
    pub fn particles(&self, kind: usize, level: usize) -> usize {
        self.particles[kind][level]
    }

    /// Brings all costs up to date. With a fixed table they are those of sixteen lanes whatever the
    /// machine has.
    pub fn appraise(
        &mut self,
        table: &CostTable,
        model: &CostModel,
        settings: &ClothSettings,
        tick: f32,
        fixed: bool,
    ) {
        let machine = if fixed || instruction_set() == "AVX-512" {
            LaneCount::Sixteen
        } else {
            LaneCount::Eight
        };
        let widest = settings.lanes.unwrap_or(machine);
        let gravity = settings.gravity.length();
        for (kind, levels) in self.kinds.iter_mut().zip(&self.levels) {
            // Those that are gone cost nothing.
            let Some(levels) = levels.upgrade() else { continue };
            for (level, costs) in kind.costs.iter_mut().enumerate() {
                let fabric = levels.fabric(level);
                let step = settings.limits(level).of_fabric(fabric, tick, gravity);
                let alone = match settings.lanes {
                    None => LaneCount::most_alone(fabric, step.scheme) as u32,
                    Some(_) => 0,
                };
                *costs = model.costs(table, fabric.particle_count(), step, widest, alone);
            }
        }
    }
}
