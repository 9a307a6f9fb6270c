//! The systems that run the solver's phases.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_time::Time;
use bunting_solver::ClothBatch;

use crate::batch::batches::ClothBatches;
use crate::schedule::{ClothSubstep, ClothSubstepSystems, ClothSystems, ClothTick};

/// Number of this plugin's systems in [`ClothSubstep`].
const OWN_SYSTEMS: usize = 3;

/// Steps all batches.
#[derive(Debug, Default)]
pub struct SolverPlugin;

impl Plugin for SolverPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            ClothTick,
            (
                // The system is exclusive because it runs a schedule, whose systems conflict with no other
                // system.
                run_substeps.in_set(ClothSystems::Step).ambiguous_with_all(),
                compute_normals.in_set(ClothSystems::Normals),
            ),
        )
        .add_systems(
            ClothSubstep,
            (
                integrate.in_set(ClothSubstepSystems::Integrate),
                solve_constraints.in_set(ClothSubstepSystems::SolveConstraints),
                update_velocities.in_set(ClothSubstepSystems::UpdateVelocities),
            ),
        );
    }
}

fn run_substeps(world: &mut World) {
    let tick = world.resource::<Time>().delta_secs();
    let mut batches = world.resource_mut::<ClothBatches>();
    batches.begin_tick(tick);
    let count = batches.substeps();
    world.schedule_scope(ClothSubstep, |world, schedule| {
        if schedule.systems_len() == OWN_SYSTEMS {
            // Without systems of the user, all substeps run batch by batch, so that each batch stays in the
            // cache.
            world.resource_mut::<ClothBatches>().run_substeps();
            return;
        }
        for index in 0..count {
            world.resource_mut::<ClothBatches>().begin_substep(index, count);
            schedule.run(world);
        }
    });
}

fn integrate(mut batches: ResMut<ClothBatches>) {
    batches.begin_touching();
    batches.for_each_joining(ClothBatch::integrate);
}

fn solve_constraints(mut batches: ResMut<ClothBatches>) {
    batches.for_each_joining(ClothBatch::solve_constraints);
    batches.solve_touching();
}

fn update_velocities(mut batches: ResMut<ClothBatches>) {
    batches.for_each_joining(ClothBatch::update_velocities);
}

fn compute_normals(mut batches: ResMut<ClothBatches>) {
    batches.compute_normals();
}
