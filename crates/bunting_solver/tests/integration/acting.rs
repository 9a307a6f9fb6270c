//! What acts on particles of meshes for a while.

use std::sync::Arc;

use crate::common::{irregular, net, trousers};
use bunting_solver::{
    ClothBatch, ClothSnapshot, Collider, Drive, Fabric, FabricBuilder, FabricMaterial, Grid,
    LaneCount, MovingPin, StepSettings,
};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

const TICK: f32 = 1.0 / 60.0;
const SETTINGS: StepSettings = StepSettings::yarns(2);
/// Not damped, and not stretched by what is tested.
const MATERIAL: FabricMaterial = FabricMaterial { damping: 0.0, ..FabricMaterial::FLAG_POLYESTER };

/// The sheet of [`irregular`] without pins.
fn free() -> Arc<Fabric> {
    let hung = irregular(13, 0.0);
    net(&FabricBuilder::new(hung.positions().to_vec(), hung.indices().to_vec()))
}

/// A cloth alone in its batch, without air and gravity.
fn in_space(fabric: &Arc<Fabric>) -> ClothBatch {
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
    batch.insert(&ClothSnapshot::at_rest(fabric), MATERIAL).expect("room");
    let space = Drive { gravity: Vec3::ZERO, air_density: 0.0, ..Drive::default() };
    batch.drive(0, space).expect("a lane");
    batch
}

/// Mean velocity of a cloth's mass, m/s.
fn mean_velocity(batch: &ClothBatch) -> Vec3 {
    let fabric = batch.fabric();
    let velocities = batch.snapshot(0).velocities;
    let weighted = velocities.iter().zip(fabric.particle_areas()).map(|(v, &area)| *v * area);
    weighted.sum::<Vec3>() / fabric.area()
}

/// Runs a tick in which `act` is called after each prediction.
fn tick_with(batch: &mut ClothBatch, mut act: impl FnMut(&mut ClothBatch)) {
    batch.begin_tick(TICK, SETTINGS);
    for _ in 0..SETTINGS.substeps {
        batch.integrate();
        act(batch);
        batch.solve_constraints();
        batch.update_velocities();
    }
    batch.compute_normals();
}

/// A flight in which a ball, a user and moving pins act on the cloth of one lane for a while. After some ticks it is taken
/// out and put back, if asked.
fn eventful(
    fabric: &Arc<Fabric>,
    lanes: LaneCount,
    others: usize,
    is_put_back: bool,
) -> ClothSnapshot {
    let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
    let rest = ClothSnapshot::at_rest(fabric);
    for lane in 0..=others {
        batch.insert(&rest, MATERIAL).expect("room");
        let wind = Vec3::new(1.0, 0.0, 3.0);
        batch.drive(lane, Drive { wind, ..Drive::default() }).expect("a lane");
    }
    let middle = rest.positions.iter().sum::<Vec3>() / rest.positions.len() as f32;
    let pinned = |particle: &usize| fabric.is_pinned(*particle);
    let pins: Vec<usize> = (0..fabric.particle_count()).filter(pinned).collect();
    for tick in 0..40_u8 {
        // Stretches the cloth between its pins and the tethers.
        let lift = |tick: u8| Vec3::Y * 0.1 * f32::from(tick.clamp(24, 28) - 24);
        if (24..28).contains(&tick) {
            let [from, to] = [tick, tick + 1].map(lift);
            let moved = pins.iter().map(|&particle| {
                let at = fabric.rest_positions()[particle];
                MovingPin { particle: particle as u32, from: at + from, to: at + to }
            });
            batch.move_pins(others, moved.collect()).expect("pins");
        }
        let at = middle + Vec3::Z * (0.6 - 0.08 * f32::from(tick));
        let ball = Collider::fixed(SharedShape::ball(0.2), at, Quat::IDENTITY);
        batch.set_colliders(others, (4..12).contains(&tick).then_some(ball)).expect("a ball");
        tick_with(&mut batch, |batch| {
            if tick == 16 {
                let mut particles = batch.particles_mut(others).expect("a substep");
                particles.add_velocity(100, Vec3::X);
                particles.add_acceleration(90, Vec3::Z * 30.0);
            }
        });
        if is_put_back && [2, 6, 11, 12, 16, 17, 26, 30].contains(&tick) {
            let state = batch.snapshot(others);
            batch.replace(others, &state, MATERIAL).expect("its own state");
            let wind = Vec3::new(1.0, 0.0, 3.0);
            batch.drive(others, Drive { wind, ..Drive::default() }).expect("a lane");
        }
    }
    batch.snapshot(others)
}

#[test]
fn what_acts_for_a_while_has_the_same_bits_at_every_width() {
    for fabric in [irregular(13, 0.0), trousers()].map(|mesh| net(&mesh)) {
        let alone = eventful(&fabric, LaneCount::One, 0, false);
        assert!(alone.positions.iter().all(|at| at.is_finite()));
        assert!(alone == eventful(&fabric, LaneCount::One, 0, true));
        assert!(alone == eventful(&fabric, LaneCount::Eight, 0, false));
        assert!(alone == eventful(&fabric, LaneCount::Eight, 2, true));
        assert!(alone == eventful(&fabric, LaneCount::Sixteen, 3, false));
    }
}

/// Cloths that nothing acts on do not feel that something acts on others.
#[test]
fn what_acts_on_one_cloth_does_not_act_on_others() {
    let fabric = net(&irregular(13, 0.0));
    let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
    let rest = ClothSnapshot::at_rest(&fabric);
    let mut still = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
    still.insert(&rest, MATERIAL).expect("room");
    for _ in 0..2 {
        batch.insert(&rest, MATERIAL).expect("room");
    }
    for tick in 0..20 {
        still.step(TICK, SETTINGS);
        tick_with(&mut batch, |batch| {
            if tick % 4 == 3 {
                let mut particles = batch.particles_mut(1).expect("a substep");
                particles.add_velocity(100, Vec3::Z);
            }
        });
    }
    assert!(still.snapshot(0) == batch.snapshot(0));
}

#[test]
fn impulses_and_forces_of_users_move_the_cloth() {
    let fabric = free();
    for particles in [0..fabric.particle_count(), 60..fabric.particle_count()] {
        let mut batch = in_space(&fabric);
        batch.step(TICK, SETTINGS);
        let masses = particles.clone().map(|at| fabric.particle_areas()[at]).sum::<f32>();
        let expected = Vec3::new(1.0, 0.5, 2.0) * (masses / fabric.area());
        let mut given = false;
        tick_with(&mut batch, |batch| {
            let mut of_cloth = batch.particles_mut(0).expect("a substep");
            for at in particles.clone().filter(|_| !given) {
                of_cloth.add_velocity(at, Vec3::new(1.0, 0.5, 2.0));
            }
            given = true;
        });
        for _ in 0..30 {
            batch.step(TICK, SETTINGS);
        }
        let moved = mean_velocity(&batch);
        assert!(moved.distance(expected) < 0.02 * expected.length(), "{moved} for {expected}");
    }
    let mut batch = in_space(&fabric);
    for _ in 0..3 {
        batch.step(TICK, SETTINGS);
    }
    let mut state = batch.snapshot(0);
    (0..fabric.particle_count()).for_each(|at| state.add_velocity(at, Vec3::Z));
    batch.restore(0, &state).expect("its own state");
    for _ in 0..30 {
        batch.step(TICK, SETTINGS);
    }
    let moved = mean_velocity(&batch);
    assert!(moved.distance(Vec3::Z) < 1e-3, "{moved} after an impulse between ticks");
    let mut batch = in_space(&fabric);
    for _ in 0..30 {
        tick_with(&mut batch, |batch| {
            let mut particles = batch.particles_mut(0).expect("a substep");
            (0..particles.count()).for_each(|at| particles.add_acceleration(at, Vec3::X * 3.0));
        });
    }
    let speed = mean_velocity(&batch).x;
    assert!((speed - 1.5).abs() < 0.01, "{speed} m/s by 3 m/s² in half a second");
}

/// A sheet that starts across a wind is carried along as fast as a grid of as many particles is.
#[test]
fn the_air_is_that_of_a_grid() {
    let speed = |fabric: &Arc<Fabric>| {
        let mut batch = in_space(fabric);
        let wind = Vec3::new(0.0, 1.0, 4.0);
        batch.drive(0, Drive { wind, gravity: Vec3::ZERO, ..Drive::default() }).expect("a lane");
        (0..20).for_each(|_| batch.step(TICK, SETTINGS));
        mean_velocity(&batch)
    };
    let grid = FabricBuilder::grid(Grid::new(13, 13, 1.0, 1.0)).build().expect("a good grid");
    let expected = speed(&Arc::new(grid));
    assert!(expected.z > 2.0, "{expected}");
    let error = speed(&free()).distance(expected) / expected.length();
    assert!(error < 0.01, "{error}");
}

/// A sheet that flies at 3 m/s goes on when the scheme changes, and changes back.
#[test]
fn a_mesh_flies_on_after_another_scheme() {
    let fabric = free();
    let velocity = Vec3::new(1.0, 2.0, 2.0);
    for lanes in [LaneCount::One, LaneCount::Eight] {
        let mut batch = ClothBatch::new(Arc::clone(&fabric), lanes);
        let mut start = ClothSnapshot::at_rest(&fabric);
        start.velocities.fill(velocity);
        batch.insert(&start, MATERIAL).expect("room");
        let space = Drive { gravity: Vec3::ZERO, air_density: 0.0, ..Drive::default() };
        batch.drive(0, space).expect("a lane");
        let schemes = [SETTINGS, StepSettings::gauss_seidel(4), SETTINGS];
        for tick in 0..30_u8 {
            batch.step(TICK, schemes[usize::from(tick / 10)]);
        }
        for (from, to) in fabric.rest_positions().iter().zip(batch.snapshot(0).positions) {
            let off = (to - *from).distance(0.5 * velocity);
            assert!(off < 1e-4, "{off} m, {lanes:?}");
        }
    }
}
