//! Tests of forces, impulses and constraints of the user, in both layouts.

use std::sync::Arc;

use glam::{Quat, Vec3};

use crate::batch::lane_count::LaneCount;
use crate::batch::snapshot::ClothSnapshot;
use crate::batch::{ClothBatch, ParticlesMut};
use crate::fabric::{Fabric, FabricBuilder, FabricMaterial, Grid};
use crate::step::{Drive, StepSettings};

const TICK: f32 = 1.0 / 60.0;
const SETTINGS: [StepSettings; 2] = [StepSettings::yarns(3), StepSettings::gauss_seidel(4)];
const MATERIAL: FabricMaterial =
    FabricMaterial { damping: 0.0, internal_damping: 0.0, ..FabricMaterial::COTTON };
/// Widths of the batches: a single cloth across the lanes (or in a single lane, for the scheme without
/// chains), and cloths side by side.
const LAYOUTS: [LaneCount; 2] = [LaneCount::One, LaneCount::Eight];

fn sheet(pins: impl IntoIterator<Item = u32>) -> Arc<Fabric> {
    let builder = FabricBuilder::grid(Grid::new(9, 7, 1.0, 0.8)).pin(pins);
    Arc::new(builder.build().expect("a good fabric"))
}

/// A batch with a cloth in its last lane.
fn batch_of(fabric: &Arc<Fabric>, lanes: LaneCount, drive: Drive) -> (ClothBatch, usize) {
    let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
    let lane = batch.lane_count() - 1;
    let rest = ClothSnapshot::at_rest(fabric);
    batch.replace(lane, &rest, MATERIAL).expect("a good cloth");
    batch.drive(lane, drive).expect("a good drive");
    (batch, lane)
}

/// Runs ticks with a user's force after the prediction and a user's constraint after the solver's
/// constraints.
fn run(
    (batch, lane): (&mut ClothBatch, usize),
    settings: StepSettings,
    ticks: usize,
    mut force: impl FnMut(&mut ParticlesMut),
    mut constraint: impl FnMut(&mut ParticlesMut),
) -> ClothSnapshot {
    for _ in 0..ticks {
        batch.begin_tick(TICK, settings);
        for _ in 0..settings.substeps {
            batch.integrate();
            force(&mut batch.particles_mut(lane).expect("a cloth"));
            batch.solve_constraints();
            constraint(&mut batch.particles_mut(lane).expect("a cloth"));
            batch.update_velocities();
        }
    }
    batch.snapshot_without_history(lane)
}

fn everywhere() -> impl Iterator<Item = (LaneCount, StepSettings)> {
    LAYOUTS.into_iter().flat_map(|lanes| SETTINGS.map(|settings| (lanes, settings)))
}

fn farthest(one: &[Vec3], other: &[Vec3]) -> f32 {
    one.iter().zip(other).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max)
}

/// Noise of velocities, m/s: rounding errors of positions of a metre, a few 6e-8 m, that constraints correct
/// within an effective substep of 3 ms.
const VELOCITY_NOISE: f32 = 2e-4;
const ACCELERATION: Vec3 = Vec3::new(1.0, -3.0, 0.5);

fn accelerate(particles: &mut ParticlesMut) {
    accelerate_by(particles, ACCELERATION);
}

fn accelerate_by(particles: &mut ParticlesMut, acceleration: Vec3) {
    (0..particles.count()).for_each(|at| particles.add_acceleration(at, acceleration));
}

/// Rounding errors add up like a random walk, so the distance is the median of those in several directions.
#[test]
fn an_acceleration_equals_gravity() {
    let fabric = sheet([]);
    for (lanes, settings) in everywhere() {
        let mut distances = [0.0, 0.4, 0.8, 1.2, 1.6, 2.0, 2.4].map(|turn| {
            let acceleration = Quat::from_rotation_y(turn) * ACCELERATION;
            let gravity = Drive { gravity: acceleration, ..Drive::NONE };
            let (mut batch, lane) = batch_of(&fabric, lanes, gravity);
            let expected = run((&mut batch, lane), settings, 20, |_| {}, |_| {});
            let (mut batch, lane) = batch_of(&fabric, lanes, Drive::NONE);
            let push = |particles: &mut ParticlesMut| accelerate_by(particles, acceleration);
            let found = run((&mut batch, lane), settings, 20, push, |_| {});
            let off = farthest(&expected.velocities, &found.velocities);
            assert!(off < VELOCITY_NOISE, "{lanes:?} {settings:?}: {off} m/s");
            farthest(&expected.positions, &found.positions)
        });
        distances.sort_by(f32::total_cmp);
        let off = distances[distances.len() / 2];
        assert!(off < 1e-5, "{lanes:?} {settings:?}: {off} m");
    }
}

/// Mass is added beside isolated pins; gravity does not act on it.
#[test]
fn an_acceleration_acts_on_the_true_mass() {
    let fabric = sheet([0, 8]);
    let gravity = Drive { gravity: ACCELERATION, ..Drive::NONE };
    for (lanes, settings) in everywhere() {
        let (mut batch, lane) = batch_of(&fabric, lanes, gravity);
        batch.begin_tick(TICK, settings);
        batch.integrate();
        let expected = batch.snapshot_without_history(lane);
        let (mut batch, lane) = batch_of(&fabric, lanes, Drive::NONE);
        batch.begin_tick(TICK, settings);
        batch.integrate();
        accelerate(&mut batch.particles_mut(lane).expect("a cloth"));
        let found = batch.snapshot_without_history(lane);
        let off = farthest(&expected.positions, &found.positions);
        assert!(off < 1e-7, "{lanes:?} {settings:?}: {off} m");
        let off = farthest(&expected.velocities, &found.velocities);
        assert!(off < 1e-7, "{lanes:?} {settings:?}: {off} m/s");
    }
}

#[test]
fn an_impulse_moves_a_free_cloth_steadily() {
    let change = Vec3::new(0.5, 1.0, -2.0);
    let fabric = sheet([]);
    for (lanes, settings) in everywhere() {
        let (mut batch, lane) = batch_of(&fabric, lanes, Drive::NONE);
        run((&mut batch, lane), settings, 2, |_| {}, |_| {});
        let mut given = false;
        let push = |particles: &mut ParticlesMut| {
            if !core::mem::replace(&mut given, true) {
                (0..particles.count()).for_each(|at| particles.set_velocity(at, change));
            }
        };
        let found = run((&mut batch, lane), settings, 10, push, |_| {});
        let moved = change * (10.0 * TICK);
        let expected: Vec<Vec3> = fabric.rest_positions().iter().map(|at| *at + moved).collect();
        let off = farthest(&expected, &found.positions);
        assert!(off < 1e-5, "{lanes:?} {settings:?}: {off} m");
    }
}

#[test]
fn a_position_constraint_holds() {
    let fabric = sheet([]);
    let held = [0, 8];
    for (lanes, settings) in everywhere() {
        let (mut batch, lane) = batch_of(&fabric, lanes, Drive::default());
        let hold = |particles: &mut ParticlesMut| {
            for at in held {
                particles.set_position(at, fabric.rest_positions()[at]);
            }
        };
        let found = run((&mut batch, lane), settings, 60, |_| {}, hold);
        for at in held {
            assert_eq!(found.positions[at], fabric.rest_positions()[at], "{lanes:?}");
            assert!(found.velocities[at].length() < 1e-4, "{lanes:?} {settings:?}");
        }
        // Without the constraint the cloth would have fallen by 4.9 m.
        let mean: Vec3 = found.positions.iter().sum::<Vec3>() / found.positions.len() as f32;
        assert!(mean.y > -1.0, "{lanes:?} {settings:?}: {mean}");
    }
}

/// The solver does not undo a turn by a user's constraint as it undoes turns by its own corrections.
#[test]
fn a_constraint_turns_a_flag_about_its_pole() {
    const TURN: f32 = 0.01;
    let fabric = sheet((0..7).map(|row| 9 * row));
    for lanes in LAYOUTS {
        let (mut batch, lane) = batch_of(&fabric, lanes, Drive::NONE);
        let turn = |particles: &mut ParticlesMut| {
            for at in 0..particles.count() {
                let position = particles.position(at);
                particles.set_position(at, Quat::from_rotation_y(TURN) * position);
            }
        };
        // Each tick has one substep: first of first order, then of second.
        let ticks = 2;
        let found = run((&mut batch, lane), StepSettings::yarns(1), ticks, |_| {}, turn);
        let tip = found.positions[8];
        let angle = libm::atan2f(-tip.z, tip.x);
        // The second tick continues the motion of the first: ⅓ of the displacement and 8/9 of the velocity.
        assert!(angle > 3.0 * TURN && angle < 3.4 * TURN, "{lanes:?}: {angle} rad");
    }
}

#[test]
fn masses_are_those_of_the_cloth_and_pins_stay() {
    let fabric = sheet([0, 1, 2]);
    for (lanes, settings) in everywhere() {
        let (mut batch, lane) = batch_of(&fabric, lanes, Drive::NONE);
        batch.begin_tick(TICK, settings);
        assert!(batch.particles_mut(lane).is_none(), "no substep is under way");
        batch.integrate();
        let mut particles = batch.particles_mut(lane).expect("a cloth");
        let step = particles.effective_step();
        assert!(step > 0.0 && step <= TICK / settings.substeps as f32);
        for at in 0..particles.count() {
            let inverse_mass = particles.inverse_mass(at);
            let mass = MATERIAL.area_density * fabric.particle_areas()[at];
            let pinned = fabric.is_pinned(at);
            // The cloth carries no load, so no mass is added.
            let expected = if pinned { 0.0 } else { 1.0 };
            assert!((inverse_mass * mass - expected).abs() < 1e-5, "{lanes:?} {settings:?}");
            particles.set_position(at, Vec3::ONE);
            particles.add_acceleration(at, Vec3::ONE);
            particles.add_velocity(at, Vec3::ONE);
            if pinned {
                assert_eq!(particles.position(at), fabric.rest_positions()[at]);
                assert_eq!(particles.velocity(at), Vec3::ZERO);
            }
        }
        batch.update_velocities();
        assert!(batch.particles_mut(lane).is_none());
        assert!(batch.particles_mut(batch.lane_count()).is_none());
    }
}
