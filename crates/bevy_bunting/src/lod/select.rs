//! The system that chooses levels: examines cloths, sends unseen ones to sleep, asks the governor,
//! and changes levels.

use std::time::Duration;

use bevy_app::{App, Plugin};
use bevy_ecs::change_detection::Tick;
use bevy_ecs::prelude::*;
use bevy_ecs::system::{SystemChangeTick, SystemParam};
use bevy_platform::time::Instant;
use bevy_time::Time;
use bevy_transform::helper::TransformHelper;

use crate::batch::assign::assign_lanes;
use crate::batch::batches::ClothBatches;
use crate::cloth::activity::ClothActivity;
use crate::cloth::instance::has_changed;
use crate::lod::budget::{ClothBudget, LodCosts};
use crate::lod::candidate::{Candidate, Limits};
use crate::lod::cost_model::CostModel;
use crate::lod::cost_table::CostTable;
use crate::lod::governor::{Choice, Governor};
use crate::lod::level_tables::LevelTables;
use crate::lod::lod_cloth::{EXAMINED_EVERY, LodCloth, LodClothItem};
use crate::lod::lod_set::{LodChoice, LodSet};
use crate::lod::record::LodRecord;
use crate::lod::report::{ClothCounts, LodReport};
use crate::lod::view::{Sight, Sighting, View};
use crate::lod::viewer::LodViewer;
use crate::schedule::{ClothSystems, ClothTick};
use crate::settings::ClothSettings;
use crate::timings::ClothTimings;

/// Number of ticks between two measurements of costs, since reading clocks takes time, too.
const MEASURED_EVERY: u32 = 8;

/// Ticks at the beginning that are all measured, as the machine is unknown.
const FIRST_MEASURED: u32 = 64;

/// Factor on the importance of a cloth that is not on a screen but near one.
const NEAR_SCREEN_IMPORTANCE: f32 = 1e-3;

/// Chooses levels of detail.
#[derive(Debug, Default)]
pub struct LodPlugin;

impl Plugin for LodPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<LodSet>()
            .register_type::<LodViewer>()
            .register_type::<ClothBudget>()
            .register_type::<LodReport>()
            .init_resource::<ClothBudget>()
            .init_resource::<LodReport>()
            .init_resource::<ClothCounts>()
            .init_resource::<LevelSelector>()
            .add_systems(
                ClothTick,
                select_levels.in_set(ClothSystems::SelectLod).before(assign_lanes),
            );
    }
}

/// State of the choice of levels that is kept from tick to tick.
#[derive(Resource, Debug, Default)]
pub(crate) struct LevelSelector {
    governor: Governor,
    model: CostModel,
    pub tables: LevelTables,
    candidates: Vec<Candidate>,
    /// Entities of the candidates.
    entities: Vec<Entity>,
    /// Number of the present tick.
    pub tick: u32,
    /// When levels were last chosen, as a tick of change.
    pub ran: Tick,
    /// Number of cloths so far; it staggers the examinations of cloths over ticks.
    pub cloths: u32,
    /// Whether there were cloths in the last tick that had not been simulated yet.
    has_fresh: bool,
    /// Tabulated overhead of the last tick: its cost besides batches and changes of level, µs.
    overhead: f32,
    /// Number of particles of the finer level, summed over the last tick's changes on a screen.
    changed_particles: usize,
    /// Times of the last tick's changes for cloths on no screen and on one, without the assignment of lanes.
    change_times: [Duration; 2],
}

/// The viewers, and the other inputs of the choice besides cloths.
#[derive(SystemParam)]
pub(crate) struct Conditions<'w, 's> {
    viewers: Query<'w, 's, (Entity, &'static LodViewer)>,
    transforms: TransformHelper<'w, 's>,
    settings: Res<'w, ClothSettings>,
    time: Res<'w, Time>,
    budget: Res<'w, ClothBudget>,
    timings: Option<Res<'w, ClothTimings>>,
    change_tick: SystemChangeTick,
}

/// Inputs of the examination of a cloth, besides the cloth.
struct Examination<'a> {
    views: Vec<View>,
    limits: Limits,
    budget: &'a ClothBudget,
}

pub(crate) fn select_levels(
    mut cloths: Query<LodCloth>,
    conditions: Conditions,
    mut selector: ResMut<LevelSelector>,
    mut batches: ResMut<ClothBatches>,
    mut report: ResMut<LodReport>,
    mut counts: ResMut<ClothCounts>,
    mut commands: Commands,
) {
    let began = Instant::now();
    let selector = &mut *selector;
    selector.ran = conditions.change_tick.this_run();
    let table = selector.learn(&conditions, &mut batches);
    let empty_tick = selector.model.empty_tick(&table);
    let examination = conditions.examination(empty_tick);
    selector.begin_tick();
    *report = LodReport::default();
    counts.0.fill(0);
    let tick = conditions.time.delta_secs();
    for mut cloth in &mut cloths {
        cloth.update_effort(tick);
        if selector.is_due(&mut cloth, &examination.views) {
            selector.examine(&mut cloth, &examination, &mut batches, &mut commands);
        }
        selector.collect(&cloth, examination.budget.dwell, &mut report, &mut counts);
    }
    let choice = selector.choose(&table, &conditions, &examination.limits);
    report.expected = Duration::from_secs_f32(1e-6 * (choice.cost + empty_tick));
    report.held_back = choice.held_back;
    report.switches = choice.switches.len();
    report.choice = began.elapsed() - selector.change_times.iter().sum::<Duration>();

    for (index, to) in choice.switches {
        if let Ok(mut cloth) = cloths.get_mut(selector.entities[index]) {
            let candidate = selector.candidates[index];
            let still = selector.tables.tables[candidate.table as usize].still();
            let was_still = cloth.record.activity == ClothActivity::OverBudget;
            let is_still = to as u32 == still;
            report.over_budget += usize::from(is_still);
            report.over_budget -= usize::from(was_still);
            if !was_still {
                counts.0[candidate.level as usize] -= 1;
            }
            if was_still || is_still {
                cloth.set_still(is_still, to as u32, selector.tick);
            }
            if !is_still {
                counts.add(to);
                selector.change(&mut cloth, to, candidate.on_screen, &mut batches, &mut commands);
            }
        }
    }
}

impl Conditions<'_, '_> {
    /// Views and limits; `empty_tick` is the cost of a tick without any cloth, µs.
    fn examination(&self, empty_tick: f32) -> Examination<'_> {
        let budget = &*self.budget;
        let views = self.viewers.iter().filter_map(|(entity, viewer)| {
            let pose = self.transforms.compute_global_transform(entity).ok()?;
            Some(View::new(viewer, &pose, budget.margin))
        });
        let limits = Limits {
            budget: budget.tick.as_secs_f32() * 1e6 - empty_tick,
            refine_above: budget.refine_above,
            coarsen_below: budget.coarsen_below,
            switches: budget.switches,
        };
        Examination { views: views.collect(), limits, budget }
    }

    fn has_fixed_costs(&self) -> bool {
        matches!(self.budget.costs, LodCosts::Fixed(_))
    }
}

impl LevelSelector {
    /// Forgets the tables of levels that no cloth has any more.
    pub fn forget_unused(&mut self) {
        self.tables.forget_unused();
    }

    /// Learns from the last tick's measurements, decides whether this tick is measured, and returns the table
    /// of costs.
    fn learn(&mut self, conditions: &Conditions, batches: &mut ClothBatches) -> CostTable {
        match conditions.budget.costs {
            LodCosts::Fixed(table) => {
                self.model = CostModel::of_table();
                batches.is_timed = false;
                table
            }
            LodCosts::Measured => {
                let table = CostTable::default();
                self.learn_costs(&table, batches, conditions.timings.as_deref());
                batches.is_timed =
                    self.tick < FIRST_MEASURED || self.tick.is_multiple_of(MEASURED_EVERY);
                table
            }
        }
    }

    fn learn_costs(
        &mut self,
        table: &CostTable,
        batches: &ClothBatches,
        timings: Option<&ClothTimings>,
    ) {
        let in_changes = match self.changed_particles {
            0 => 0.0,
            _ => (self.change_times[1] + batches.assignment_time).as_secs_f32() * 1e6,
        };
        self.model.learn_changes(table.change(self.changed_particles), in_changes);
        if !batches.is_timed {
            return;
        }
        let in_batches: f32 = batches.timings().map(|batch| batch.time).sum();
        self.model.learn_batches(table, batches.timings());
        // Work that each new cloth needs once is not part of the overhead of every tick.
        if let Some(timings) = timings.filter(|_| !self.has_fresh) {
            let total = timings.total().as_secs_f32() * 1e6;
            self.model.learn_overhead(self.overhead, total - in_batches - in_changes);
        }
    }

    fn begin_tick(&mut self) {
        self.candidates.clear();
        self.entities.clear();
        self.tick = self.tick.wrapping_add(1);
        self.changed_particles = 0;
        self.change_times = [Duration::ZERO; 2];
    }

    /// Whether a cloth is to be examined: if it changed, or in its turn unless it stays off the screen.
    fn is_due(&self, cloth: &mut LodClothItem, views: &[View]) -> bool {
        let is_its_turn = cloth.record.phase.wrapping_add(self.tick).is_multiple_of(EXAMINED_EVERY);
        has_changed(&cloth.instance, |pending| pending.levels)
            || cloth.frame.has_new(&cloth.lods)
            || (is_its_turn && !cloth.stays_off_screen(views))
    }

    /// Examines a cloth: switches its level by distance, sends it to sleep or wakes it, and adds it to the
    /// candidates if it is simulated.
    fn examine(
        &mut self,
        cloth: &mut LodClothItem,
        examination: &Examination,
        batches: &mut ClothBatches,
        commands: &mut Commands,
    ) {
        cloth.record.candidate = None;
        let Some(levels) = &cloth.instance.levels else {
            // Other levels may lie at the same address later.
            cloth.record.forget_levels();
            return;
        };
        let table = self.tables.index_of(levels, cloth.effort.class());
        if !cloth.record.is_of(levels) {
            let radius = self.tables.radius(table);
            // The record starts so that the first change need not wait.
            let changed = self.tick.wrapping_sub(examination.budget.dwell);
            *cloth.record = LodRecord::new(levels, radius, self.cloths, changed);
            self.cloths = self.cloths.wrapping_add(1);
        }
        let centre = cloth.update_middle();
        let views = &examination.views;
        let mut sighting = None;
        let to = if matches!(cloth.instance.lods.choice, LodChoice::Automatic { .. }) {
            sighting = Some(Sighting::of(views, centre, cloth.radius()));
            cloth.instance.lods.pinned.unwrap_or(cloth.instance.level)
        } else {
            let nearest = views.iter().map(|view| view.distance(centre)).reduce(f32::min);
            cloth.instance.lods.level_at(nearest.unwrap_or(0.0), cloth.instance.level)
        };
        let on_screen = sighting.is_none_or(|it| it.sight == Sight::OnScreen);
        // A cloth keeps its level while newly attached vertices move to their places, since another level
        // would hold other vertices.
        let is_taking_up = cloth.instance.taking_up.is_some();
        let to = if is_taking_up { cloth.instance.level } else { to };
        self.change(cloth, to, on_screen, batches, commands);
        // Errors of levels are those of their fabrics.
        let size = cloth.instance.growth.end();
        let pixels_per_metre =
            sighting.map_or(0.0, |it| it.pixels_per_metre * size * cloth.instance.lods.bias);
        let fixed = sighting.is_none() || cloth.instance.lods.pinned.is_some() || is_taking_up;
        let is_small = pixels_per_metre * cloth.record.radius < examination.budget.still_below;
        let mut candidate = Candidate {
            table: table as u32,
            level: to as u32,
            pixels_per_metre,
            importance: sighting.map_or(0.0, |it| importance(&it, cloth.radius())),
            ready: false,
            fresh: cloth.instance.unmoved,
            fixed,
            may_be_still: is_small && !fixed,
            on_screen,
        };
        if cloth.instance.activity == ClothActivity::OverBudget && !candidate.may_be_still {
            cloth.set_still(false, to as u32, self.tick);
        }
        if let Some(sighting) = sighting.filter(|_| !cloth.paused && !is_taking_up) {
            let sight = sighting.sight;
            self.update_activity(cloth, &mut candidate, sight, examination, batches, commands);
        }
        cloth.record.activity = cloth.instance.activity;
        let is_still = cloth.instance.activity == ClothActivity::OverBudget;
        if is_still {
            candidate.level = self.tables.tables[table].still();
        }
        let is_simulated = cloth.instance.activity == ClothActivity::Ticking;
        cloth.record.candidate = ((is_simulated || is_still) && !cloth.paused).then_some(candidate);
    }

    /// Sends a cloth to sleep or wakes it. Off the screen it changes to its coarsest level, which takes the
    /// least memory and at which the cloth is shown first when it comes back.
    fn update_activity(
        &mut self,
        cloth: &mut LodClothItem,
        candidate: &mut Candidate,
        sight: Sight,
        examination: &Examination,
        batches: &mut ClothBatches,
        commands: &mut Commands,
    ) {
        let table = &self.tables.tables[candidate.table as usize];
        let wants_finer = !candidate.fixed
            && candidate.wanted_level(table, &examination.limits) < candidate.level;
        let coarsest = cloth.instance.lods.pinned.unwrap_or(table.coarsest() as usize);
        let wakes = cloth.update_activity(sight, wants_finer, self.tick);
        if wakes || cloth.instance.activity == ClothActivity::OffScreen {
            self.change(cloth, coarsest, candidate.on_screen, batches, commands);
        }
        if wakes {
            // A cloth that comes into view need not wait for a finer level.
            cloth.record.changed = self.tick.wrapping_sub(examination.budget.dwell);
            candidate.level = coarsest as u32;
        }
    }

    /// Changes the level of a cloth if it differs, and records the time.
    fn change(
        &mut self,
        cloth: &mut LodClothItem,
        to: usize,
        on_screen: bool,
        batches: &mut ClothBatches,
        commands: &mut Commands,
    ) {
        let from = cloth.instance.level;
        if from == to {
            return;
        }
        let began = Instant::now();
        cloth.change_level(to, on_screen, self.tick, batches, commands);
        self.change_times[usize::from(on_screen)] += began.elapsed();
        if let (true, Some(levels)) = (on_screen, &cloth.instance.levels) {
            self.changed_particles += levels.fabric(from.min(to)).particle_count();
        }
    }

    /// Adds a simulated cloth to the candidates. Counts every cloth as simulated, paused or asleep.
    fn collect(
        &mut self,
        cloth: &LodClothItem,
        dwell: u32,
        report: &mut LodReport,
        counts: &mut ClothCounts,
    ) {
        report.fewer_levels += usize::from(cloth.record.has_fewer_levels);
        if let Some(candidate) = cloth.record.candidate {
            let ready = self.tick.wrapping_sub(cloth.record.changed) > dwell;
            let is_still = cloth.record.activity == ClothActivity::OverBudget;
            // A cloth that has been simulated since counts as changed when it is at rest again.
            let fresh = candidate.fresh && cloth.instance.unmoved && !is_still;
            self.candidates.push(Candidate { ready, fresh, ..candidate });
            self.entities.push(cloth.entity);
            if is_still {
                report.count(ClothActivity::OverBudget);
            } else {
                counts.add(candidate.level as usize);
                report.efforts[cloth.effort.class().index()] += 1;
            }
        } else if cloth.record.activity != ClothActivity::Ticking {
            report.count(cloth.record.activity);
        } else if cloth.paused && cloth.instance.levels.is_some() {
            counts.add(cloth.instance.level);
        }
    }

    /// Asks the governor for changes of level.
    fn choose(&mut self, table: &CostTable, conditions: &Conditions, limits: &Limits) -> Choice {
        let (settings, tick) = (&conditions.settings, conditions.time.delta_secs());
        let fixed = conditions.has_fixed_costs();
        self.tables.update_work(settings, settings.is_changed(), tick);
        self.tables.update_costs(table, &self.model, settings.lanes, fixed);
        let particles = self
            .candidates
            .iter()
            .filter_map(|it| self.tables.particles(it.table as usize, it.level as usize));
        self.overhead = CostModel::tabulated_overhead(table, particles);
        self.has_fresh = self.candidates.iter().any(|it| it.fresh);
        self.governor.choose(&self.tables.tables, &self.candidates, limits).clone()
    }
}

/// Importance of a pixel of error of a cloth with a radius (m): the square of the number of pixels that the
/// cloth fills, as large cloths draw attention.
fn importance(sighting: &Sighting, radius: f32) -> f32 {
    let pixels = (sighting.pixels_per_metre * radius).powi(2);
    let factor = if sighting.sight == Sight::OnScreen { 1.0 } else { NEAR_SCREEN_IMPORTANCE };
    factor * pixels * pixels
}

#[cfg(test)]
#[path = "select_tests.rs"]
mod tests;
