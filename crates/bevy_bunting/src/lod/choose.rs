//! The choice of levels, and of who sleeps because nobody looks.

use std::time::Duration;

use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_math::Vec3;
use bevy_platform::time::Instant;
use bevy_time::Time;
use bevy_transform::helper::TransformHelper;

use super::budget::{ClothBudget, LodCosts, LodReport};
use super::costs::{CostModel, CostTable};
use super::governor::{Candidate, Governor, Limits, wanted_level};
use super::kinds::Kinds;
use super::viewer::{LodViewer, Look, Sight, View};
use super::{ClothLevelChanged, LodChoice, LodSet};
use crate::batch::batches::ClothBatches;
use crate::cloth::activity::{ClothActivity, ClothWatch};
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothPaused;
use crate::cloth::state::ClothState;
use crate::diagnostics::{ClothCounts, ClothTimings};
use crate::motion::pose::PoseHistory;
use crate::motion::take_up::TakingUp;
use crate::settings::ClothSettings;

/// Ticks from one in which costs are measured to the next: clocks cost time, too.
const MEASURED_EVERY: u32 = 8;

/// Ticks from one in which a cloth is looked at to the next. Others are looked at in between.
const LOOKED_AT_EVERY: u32 = 4;

/// Ticks after which a cloth that is not seen falls asleep: two looks.
const ASLEEP_AFTER: u32 = 2 * LOOKED_AT_EVERY;

/// What the choice remembers from tick to tick.
#[derive(Resource, Debug, Default)]
pub(crate) struct Chooser {
    governor: Governor,
    model: CostModel,
    kinds: Kinds,
    candidates: Vec<Candidate>,
    entities: Vec<Entity>,
    /// Number of the tick.
    now: u32,
    /// Number of cloths so far, for their turns.
    cloths: u32,
    /// What the last tick should have cost by the table besides its batches, µs.
    besides: f32,
    /// Particles of the finer levels of its changes in somebody's picture.
    changed: usize,
    /// Time that changes took that nobody and that somebody saw, without seats.
    changing: [Duration; 2],
}

/// A cloth, as the choice sees it.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct Chosen {
    entity: Entity,
    lods: Ref<'static, LodSet>,
    frame: &'static PoseHistory,
    instance: &'static mut ClothInstance,
    state: &'static mut ClothState,
    watch: &'static mut ClothWatch,
    paused: Has<ClothPaused>,
    /// Its vertices are on the way to where they are attached: another level would have others there.
    taking_up: Has<TakingUp>,
}

#[expect(clippy::too_many_arguments, reason = "a system")]
pub(crate) fn choose_levels(
    mut cloths: Query<Chosen>,
    viewers: Query<(Entity, &LodViewer)>,
    transforms: TransformHelper,
    settings: Res<ClothSettings>,
    time: Res<Time>,
    budget: Res<ClothBudget>,
    timings: Option<Res<ClothTimings>>,
    mut chooser: ResMut<Chooser>,
    mut batches: ResMut<ClothBatches>,
    mut report: ResMut<LodReport>,
    mut counts: ResMut<ClothCounts>,
    mut commands: Commands,
) {
    let began = Instant::now();
    let chooser = &mut *chooser;
    let (table, fixed) = match budget.costs {
        LodCosts::Fixed(table) => (table, true),
        LodCosts::Measured => (CostTable::default(), false),
    };
    if fixed {
        chooser.model = CostModel::default();
        batches.measures = false;
    } else {
        chooser.learn(&table, &batches, timings.as_deref());
        batches.measures = chooser.now.is_multiple_of(MEASURED_EVERY);
    }
    let views: Vec<View> = viewers
        .iter()
        .filter_map(|(entity, viewer)| {
            let pose = transforms.compute_global_transform(entity).ok()?;
            Some(View::new(viewer, &pose, budget.margin))
        })
        .collect();
    let limits = Limits {
        budget: budget.tick.as_secs_f32() * 1e6 - chooser.model.tick(&table),
        refine_above: budget.refine_above,
        coarsen_below: budget.coarsen_below,
        switches: budget.switches,
    };

    *report = LodReport::default();
    chooser.candidates.clear();
    chooser.entities.clear();
    counts.0.fill(0);
    chooser.now = chooser.now.wrapping_add(1);
    (chooser.changed, chooser.changing) = (0, [Duration::ZERO; 2]);
    for mut cloth in &mut cloths {
        let turn = cloth.watch.turn.wrapping_add(chooser.now).is_multiple_of(LOOKED_AT_EVERY);
        let changed = cloth.instance.is_changed() || cloth.lods.is_changed();
        if changed || (turn && !cloth.sleeps_on(&views)) {
            chooser.look_at(&mut cloth, &views, &budget, &limits, &mut batches, &mut commands);
        }
        if let Some(candidate) = cloth.watch.candidate {
            chooser.candidates.push(Candidate {
                ready: chooser.now.wrapping_sub(cloth.watch.changed) > budget.dwell,
                fresh: cloth.instance.unmoved,
                ..candidate
            });
            chooser.entities.push(cloth.entity);
            counts.add(candidate.level as usize);
        } else if cloth.watch.activity != ClothActivity::Ticking {
            report.count(cloth.watch.activity);
        } else if cloth.paused && cloth.instance.levels.is_some() {
            counts.add(cloth.instance.level);
        }
    }
    let tick = time.delta_secs();
    chooser.kinds.appraise(&table, &chooser.model, &settings, tick, fixed);
    let choice = chooser.governor.choose(&chooser.kinds.kinds, &chooser.candidates, &limits);
    let kinds = &chooser.kinds;
    let each = chooser.candidates.iter();
    let particles = each.map(|it| kinds.particles(it.kind as usize, it.level as usize));
    chooser.besides = CostModel::besides_by_table(&table, particles);
    report.expected = Duration::from_secs_f32(1e-6 * (choice.cost + chooser.model.tick(&table)));
    report.held_back = choice.held_back;
    report.switches = choice.switches.len();
    report.choice = began.elapsed() - chooser.changing.iter().sum::<Duration>();

    let switches = choice.switches.clone();
    for (index, to) in switches {
        if let Ok(mut cloth) = cloths.get_mut(chooser.entities[index]) {
            counts.0[cloth.instance.level] -= 1;
            counts.add(to);
            let seen = chooser.candidates[index].seen;
            chooser.change(&mut cloth, to, seen, &mut batches, &mut commands);
        }
    }
}

impl Chooser {
    /// Learns from the last tick, as far as it was measured.
    fn learn(&mut self, table: &CostTable, batches: &ClothBatches, timings: Option<&ClothTimings>) {
        let in_changes = match self.changed {
            0 => 0.0,
            _ => (self.changing[1] + batches.settling).as_secs_f32() * 1e6,
        };
        self.model.learn_changes(table.change(self.changed), in_changes);
        if !batches.measures {
            return;
        }
        let in_batches: f32 = batches.measured().map(|batch| batch.time).sum();
        self.model.learn(table, batches.measured());
        if let Some(timings) = timings {
            let total = timings.total().as_secs_f32() * 1e6;
            self.model.learn_besides(self.besides, total - in_batches - in_changes);
        }
    }

    /// Moves a cloth to another level, and notes what that costs.
    fn change(
        &mut self,
        cloth: &mut ChosenItem,
        to: usize,
        seen: bool,
        batches: &mut ClothBatches,
        commands: &mut Commands,
    ) {
        let from = cloth.instance.level;
        if from == to {
            return;
        }
        let began = Instant::now();
        cloth.change_level(to, seen, self.now, batches, commands);
        self.changing[usize::from(seen)] += began.elapsed();
        if let (true, Some(levels)) = (seen, &cloth.instance.levels) {
            self.changed += levels.fabric(from.min(to)).particle_count();
        }
    }

    /// Looks at a cloth: whether it sleeps, and what it wants.
    fn look_at(
        &mut self,
        cloth: &mut ChosenItem,
        views: &[View],
        budget: &ClothBudget,
        limits: &Limits,
        batches: &mut ClothBatches,
        commands: &mut Commands,
    ) {
        cloth.watch.candidate = None;
        let Some(levels) = &cloth.instance.levels else { return };
        let kind = self.kinds.of(levels);
        if !cloth.watch.is_of(levels) {
            let radius = self.kinds.radius(kind);
            // The first change need not wait.
            let long_ago = self.now.wrapping_sub(budget.dwell);
            *cloth.watch = ClothWatch::new(levels, radius, self.cloths, long_ago);
            self.cloths = self.cloths.wrapping_add(1);
        }
        let centre = cloth.find_middle();
        let mut look = None;
        let to = if matches!(cloth.lods.choice, LodChoice::Automatic { .. }) {
            look = Some(Look::of(views, centre, cloth.watch.radius));
            cloth.lods.pinned.unwrap_or(cloth.instance.level)
        } else {
            let nearest = views.iter().map(|view| view.distance(centre)).reduce(f32::min);
            // Without a viewer all is as near as can be.
            cloth.lods.level_at(nearest.unwrap_or(0.0), cloth.instance.level)
        };
        let to = if cloth.taking_up { cloth.instance.level } else { to };
        let seen = look.as_ref().is_none_or(|look| look.sight == Sight::Seen);
        self.change(cloth, to, seen, batches, commands);
        let mut candidate = Candidate {
            kind: kind as u32,
            level: to as u32,
            scale: look.map_or(0.0, |look| look.scale * cloth.lods.bias),
            weight: look.map_or(0.0, |look| weight(&look, cloth.watch.radius)),
            ready: false,
            fresh: false,
            fixed: look.is_none() || cloth.lods.pinned.is_some() || cloth.taking_up,
            seen,
        };
        if let Some(look) = look.filter(|_| !cloth.paused && !cloth.taking_up) {
            let errors = &self.kinds.kinds[kind].errors;
            let finer =
                !candidate.fixed && wanted_level(errors, &candidate, limits) < candidate.level;
            let to = cloth.lods.pinned.unwrap_or(errors.len() - 1);
            if cloth.sleep(look.sight, finer, self.now) {
                // It has settled when it is seen, and then need not wait for a finer level.
                self.change(cloth, to, seen, batches, commands);
                cloth.watch.changed = self.now.wrapping_sub(budget.dwell);
                candidate.level = to as u32;
            } else if cloth.instance.activity == ClothActivity::OffScreen {
                // That is how it will be seen next. Until then it takes the less memory.
                self.change(cloth, to, seen, batches, commands);
            }
        }
        cloth.watch.activity = cloth.instance.activity;
        let simulated = cloth.instance.activity == ClothActivity::Ticking && !cloth.paused;
        cloth.watch.candidate = simulated.then_some(candidate);
    }
}

impl ChosenItem<'_, '_> {
    /// Moves the cloth to another level; without care, if nobody sees it become coarser.
    fn change_level(
        &mut self,
        to: usize,
        seen: bool,
        now: u32,
        batches: &mut ClothBatches,
        commands: &mut Commands,
    ) {
        let from = self.instance.level;
        let unseen = !seen && to > from;
        if unseen {
            self.instance.drop_to(to, batches);
        } else {
            self.instance.change_level(to, batches);
        }
        let instance = &*self.instance;
        if let Some((levels, snapshot)) = instance.levels.as_ref().zip(instance.waiting()) {
            if unseen {
                self.state.begin_anew(to, levels, &snapshot.positions);
            } else if instance.activity == ClothActivity::Ticking && !self.paused {
                self.state.go_on(to, levels, &snapshot.positions);
            } else {
                self.state.begin(to, levels, &snapshot.positions);
            }
        }
        self.watch.changed = now;
        if let Some(candidate) = &mut self.watch.candidate {
            candidate.level = to as u32;
        }
        commands.trigger(ClothLevelChanged { entity: self.entity, from, to });
    }

    /// Near the middle of a grid, in the world; no pass over all particles.
    fn find_middle(&mut self) -> Vec3 {
        let positions = self.state.positions();
        self.watch.middle = positions.get(positions.len() / 2).copied().unwrap_or_default();
        self.frame.end() * self.watch.middle
    }

    /// Whether the cloth sleeps, and is still out of everybody's picture. Most do.
    fn sleeps_on(&self, views: &[View]) -> bool {
        self.watch.activity == ClothActivity::OffScreen
            && Look::of(views, self.frame.end() * self.watch.middle, self.watch.radius).sight
                == Sight::OffScreen
    }

    /// Sends a cloth to sleep that nobody sees, and wakes it when somebody does. Whether it comes
    /// back from out of sight.
    fn sleep(&mut self, sight: Sight, wants_finer: bool, now: u32) -> bool {
        let unseen = match sight {
            Sight::Seen | Sight::Beside => None,
            Sight::OffScreen => Some(ClothActivity::OffScreen),
            Sight::OutOfRange => Some(ClothActivity::OutOfRange),
        };
        if unseen.is_none() {
            self.watch.seen = now;
        }
        let (is, slept) =
            (self.instance.activity, now.wrapping_sub(self.watch.seen) > ASLEEP_AFTER);
        let becomes = match (is, unseen) {
            (ClothActivity::Ticking, Some(unseen)) if slept => unseen,
            (ClothActivity::OffScreen | ClothActivity::OutOfRange, Some(unseen)) => unseen,
            (ClothActivity::OffScreen | ClothActivity::OutOfRange, None) => ClothActivity::Ticking,
            (ClothActivity::AtRest, None) if wants_finer => ClothActivity::Ticking,
            _ => is,
        };
        if becomes != is {
            self.instance.activity = becomes;
        }
        becomes == ClothActivity::Ticking && is != becomes && is != ClothActivity::AtRest
    }
}

/// What a pixel of a cloth's error counts: the square of the pixels that the cloth fills, because the
/// eye goes to what is large; little where they are beside the screen.
fn weight(look: &Look, radius: f32) -> f32 {
    const BESIDE: f32 = 1e-3;
    let filled = (look.scale * radius).powi(2);
    let part = if look.sight == Sight::Seen { 1.0 } else { BESIDE };
    part * filled * filled
}
