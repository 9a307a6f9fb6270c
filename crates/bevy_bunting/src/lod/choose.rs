//! The choice of levels, and of who sleeps because nobody looks.

use std::sync::Arc;
use std::time::{Duration, Instant};

use bevy_ecs::prelude::*;
use bevy_ecs::query::QueryData;
use bevy_math::Vec3;
use bevy_transform::helper::TransformHelper;

use super::budget::{ClothBudget, LodCosts, LodReport};
use super::costs::{CostModel, CostTable};
use super::governor::{Candidate, Governor, Limits, wanted_level};
use super::kinds::Kinds;
use super::viewer::{LodViewer, Look, Sight, View};
use super::{ClothLevelChanged, LodChoice, LodSet};
use crate::activity::{ClothActivity, ClothWatch};
use crate::batches::ClothBatches;
use crate::diagnostics::ClothTimings;
use crate::instance::ClothInstance;
use crate::mesh::ClothPaused;
use crate::pose::PoseHistory;
use crate::settings::ClothSettings;
use crate::state::ClothState;

/// Ticks from one in which costs are measured to the next: clocks cost time, too.
const MEASURED_EVERY: u32 = 8;

/// What the choice remembers from tick to tick.
#[derive(Resource, Debug, Default)]
pub(crate) struct Chooser {
    governor: Governor,
    model: CostModel,
    kinds: Kinds,
    candidates: Vec<Candidate>,
    entities: Vec<Entity>,
    ticks: u32,
    /// What the last tick should have cost by the table besides its batches, µs.
    besides: f32,
}

/// A cloth, as the choice sees it.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct Chosen {
    entity: Entity,
    lods: &'static LodSet,
    frame: &'static PoseHistory,
    instance: &'static mut ClothInstance,
    state: &'static mut ClothState,
    watch: &'static mut ClothWatch,
    paused: Has<ClothPaused>,
}

impl ChosenItem<'_, '_> {
    /// Moves the cloth to another level.
    fn change_level(&mut self, to: usize, batches: &mut ClothBatches, commands: &mut Commands) {
        let from = self.instance.level;
        if to == from {
            return;
        }
        self.instance.change_level(to, batches);
        if let Some((fabric, snapshot)) = self.instance.fabric().zip(self.instance.waiting()) {
            self.state.begin(to, &Arc::clone(fabric), &snapshot.positions);
        }
        self.watch.since_change = 0;
        commands.trigger(ClothLevelChanged { entity: self.entity, from, to });
    }

    /// Near the middle of a grid, in the world; no pass over all particles.
    fn middle(&self) -> Vec3 {
        let positions = self.state.positions();
        self.frame.end() * positions.get(positions.len() / 2).copied().unwrap_or_default()
    }
}

#[expect(clippy::too_many_arguments, reason = "a system")]
pub(crate) fn choose_levels(
    mut cloths: Query<Chosen>,
    viewers: Query<(Entity, &LodViewer)>,
    transforms: TransformHelper,
    settings: Res<ClothSettings>,
    budget: Res<ClothBudget>,
    timings: Option<Res<ClothTimings>>,
    mut chooser: ResMut<Chooser>,
    mut batches: ResMut<ClothBatches>,
    mut report: ResMut<LodReport>,
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
        batches.measures = chooser.ticks.is_multiple_of(MEASURED_EVERY);
        chooser.ticks = chooser.ticks.wrapping_add(1);
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
    for mut cloth in &mut cloths {
        let Some(levels) = &cloth.instance.levels else { continue };
        if !cloth.watch.is_of(levels) {
            let kind = chooser.kinds.of(levels);
            *cloth.watch = ClothWatch::new(levels, kind, chooser.kinds.radius(kind));
        }
        cloth.watch.since_change = cloth.watch.since_change.saturating_add(1);
        let centre = cloth.middle();
        let look = match &cloth.lods.choice {
            LodChoice::Distances(_) => {
                let nearest = views.iter().map(|view| view.distance(centre)).reduce(f32::min);
                // Without a viewer all is as near as can be.
                let to = cloth.lods.level_at(nearest.unwrap_or(0.0), cloth.instance.level);
                cloth.change_level(to, &mut batches, &mut commands);
                None
            }
            LodChoice::Automatic { .. } => {
                if let Some(level) = cloth.lods.pinned {
                    cloth.change_level(level, &mut batches, &mut commands);
                }
                Some(Look::of(&views, centre, cloth.watch.radius))
            }
        };
        if cloth.paused {
            continue;
        }
        let mut candidate = Candidate {
            kind: cloth.watch.kind,
            level: cloth.instance.level as u32,
            scale: look.map_or(0.0, |look| look.scale * cloth.lods.bias),
            weight: 0.0,
            ready: cloth.watch.since_change > budget.dwell,
            fixed: look.is_none() || cloth.lods.pinned.is_some(),
        };
        if let Some(look) = look {
            candidate.weight = weight(&look, cloth.watch.radius);
            let errors = &chooser.kinds.kinds[candidate.kind as usize].errors;
            let wants_finer =
                !candidate.fixed && wanted_level(errors, &candidate, &limits) < candidate.level;
            let coarsest = errors.len() - 1;
            if let Some(level) = sleep(&mut cloth, look.sight, wants_finer, budget.dwell, coarsest)
            {
                cloth.change_level(level, &mut batches, &mut commands);
                // It was not seen: it need not wait for a finer one.
                cloth.watch.since_change = budget.dwell;
                (candidate.level, candidate.ready) = (level as u32, true);
            }
        }
        match cloth.instance.activity {
            ClothActivity::Ticking => {
                chooser.candidates.push(candidate);
                chooser.entities.push(cloth.entity);
            }
            ClothActivity::OffScreen => report.off_screen += 1,
            ClothActivity::OutOfRange => report.out_of_range += 1,
            ClothActivity::AtRest => report.at_rest += 1,
        }
    }

    chooser.kinds.appraise(&table, &chooser.model, &settings, fixed);
    let choice = chooser.governor.choose(&chooser.kinds.kinds, &chooser.candidates, &limits);
    let kinds = &chooser.kinds;
    let particles = chooser
        .candidates
        .iter()
        .map(|candidate| kinds.particles(candidate.kind as usize, candidate.level as usize));
    chooser.besides = CostModel::besides_by_table(&table, particles);
    let expected = choice.cost + chooser.model.tick(&table);
    report.expected = Duration::from_secs_f32(1e-6 * expected);
    report.held_back = choice.held_back;
    report.switches = choice.switches.len();
    report.choice = began.elapsed();
    for &(index, to) in &choice.switches {
        if let Ok(mut cloth) = cloths.get_mut(chooser.entities[index]) {
            cloth.change_level(to, &mut batches, &mut commands);
        }
    }
}

impl Chooser {
    /// Learns from the last tick, if it was measured.
    fn learn(&mut self, table: &CostTable, batches: &ClothBatches, timings: Option<&ClothTimings>) {
        if !batches.measures {
            return;
        }
        let in_batches: f32 = batches.measured().map(|batch| batch.time).sum();
        self.model.learn(table, batches.measured());
        if let Some(timings) = timings {
            let total = timings.total().as_secs_f32() * 1e6;
            self.model.learn_besides(self.besides, total - in_batches);
        }
    }
}

/// What a pixel of a cloth's error counts: the pixels that the cloth fills, little where they are
/// beside the screen.
fn weight(look: &Look, radius: f32) -> f32 {
    const BESIDE: f32 = 1e-3;
    let size = look.scale * radius;
    let part = if look.sight == Sight::Seen { 1.0 } else { BESIDE };
    part * size * size
}

/// Sends a cloth to sleep that nobody sees, and wakes it when somebody does; at the level that is
/// returned.
fn sleep(
    cloth: &mut ChosenItem,
    sight: Sight,
    wants_finer: bool,
    dwell: u32,
    coarsest: usize,
) -> Option<usize> {
    let unseen = match sight {
        Sight::Seen | Sight::Beside => None,
        Sight::OffScreen => Some(ClothActivity::OffScreen),
        Sight::OutOfRange => Some(ClothActivity::OutOfRange),
    };
    cloth.watch.unseen = if unseen.is_some() { cloth.watch.unseen.saturating_add(1) } else { 0 };
    let now = cloth.instance.activity;
    match (now, unseen) {
        (ClothActivity::Ticking, Some(reason)) if cloth.watch.unseen > dwell => {
            cloth.instance.activity = reason;
        }
        (ClothActivity::OffScreen | ClothActivity::OutOfRange, Some(reason)) if now != reason => {
            cloth.instance.activity = reason;
        }
        (ClothActivity::OffScreen | ClothActivity::OutOfRange, None) => {
            cloth.instance.activity = ClothActivity::Ticking;
            return Some(cloth.lods.pinned.unwrap_or(coarsest));
        }
        (ClothActivity::AtRest, None) if wants_finer => {
            cloth.instance.activity = ClothActivity::Ticking;
        }
        _ => {}
    }
    None
}
