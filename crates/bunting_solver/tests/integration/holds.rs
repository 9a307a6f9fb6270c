//! Particles that are held by springs and on rails.

use std::sync::Arc;

use bunting_solver::{
    BatchError, ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, Grid,
    Hold, Holder, LaneCount, StepSettings,
};
use glam::{Quat, Vec3};

use crate::common::net;

const TICK: f32 = 1.0 / 60.0;
const COLUMNS: u32 = 17;

/// A sheet without pins: a grid, or a mesh with about as many particles.
fn sheet(is_grid: bool) -> Arc<Fabric> {
    let grid = FabricBuilder::grid(Grid::new(COLUMNS, COLUMNS, 1.0, 1.0));
    if is_grid {
        return Arc::new(grid.build().expect("a good sheet"));
    }
    net(&FabricBuilder::new(grid.positions().to_vec(), grid.indices().to_vec()))
}

/// A batch of one cloth with the given damping, 1/s.
fn batch(fabric: &Arc<Fabric>, lanes: LaneCount, damping: f32) -> ClothBatch {
    let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
    let material = FabricMaterial { damping, ..FabricMaterial::FLAG_POLYESTER };
    batch.insert(&ClothSnapshot::at_rest(fabric), material).expect("a good cloth");
    batch.drive(0, Drive { air_density: 0.0, ..Drive::default() }).expect("good");
    batch
}

/// Weight of a sheet, N.
fn weight(fabric: &Fabric) -> f32 {
    9.81 * FabricMaterial::FLAG_POLYESTER.area_density * fabric.area()
}

/// Springs from the particles of the upper edge to their places at rest, with a given stiffness of all together, N/m.
fn springs(fabric: &Fabric, stiffness: f32, max_force: f32) -> Vec<Hold> {
    let upper = upper(fabric);
    let share = 1.0 / upper.len() as f32;
    let spring = |particle: u32| {
        let place = [fabric.rest_positions()[particle as usize]; 2];
        let by =
            Holder::Spring { place, stiffness: share * stiffness, max_force: share * max_force };
        Hold { particle, by }
    };
    upper.into_iter().map(spring).collect()
}

/// The particles of the upper edge.
fn upper(fabric: &Fabric) -> Vec<u32> {
    let particles = (0..).zip(fabric.rest_positions());
    particles.filter(|(_, rest)| rest.y > -1e-5).map(|(particle, _)| particle).collect()
}

/// Mean of the upper edge's positions, m.
fn edge(batch: &ClothBatch) -> Vec3 {
    let positions = batch.snapshot(0).positions;
    let upper = upper(batch.fabric());
    upper.iter().map(|at| positions[*at as usize]).sum::<Vec3>() / upper.len() as f32
}

#[test]
fn a_spring_is_stretched_by_force_over_stiffness() {
    for (is_grid, stiffness, lanes) in [
        (true, 10.0, LaneCount::Eight),
        (true, 100.0, LaneCount::One),
        (true, 1000.0, LaneCount::Eight),
        (false, 100.0, LaneCount::One),
        (false, 100.0, LaneCount::Eight),
    ] {
        let fabric = sheet(is_grid);
        let mut batch = batch(&fabric, lanes, 3.0);
        let at_rest = edge(&batch);
        batch.hold(0, springs(&fabric, stiffness, f32::INFINITY)).expect("good holds");
        for _ in 0..1200 {
            batch.step(TICK, StepSettings::default());
        }
        let (found, expected) = (at_rest.y - edge(&batch).y, weight(&fabric) / stiffness);
        let error = found / expected - 1.0;
        assert!(error.abs() < 0.01, "{is_grid} {stiffness} {lanes:?}: {found} m for {expected} m");
        let impulse: Vec3 = batch.hold_impulses(0).iter().sum();
        let error = impulse.y / TICK / -weight(&fabric) - 1.0;
        assert!(error.abs() < 0.01, "{is_grid} {stiffness} {lanes:?}: {impulse} N s");
    }
}

#[test]
fn a_spring_with_a_greatest_force_yields() {
    let fabric = sheet(true);
    let [mut holds, mut yields] = [1.5, 0.5].map(|part| {
        let mut batch = batch(&fabric, LaneCount::Eight, 3.0);
        batch.hold(0, springs(&fabric, 1000.0, part * weight(&fabric))).expect("good holds");
        batch
    });
    for _ in 0..120 {
        holds.step(TICK, StepSettings::default());
        yields.step(TICK, StepSettings::default());
    }
    assert!(edge(&holds).y > -0.01, "{}", edge(&holds));
    assert!(edge(&yields).y < -1.0, "{}", edge(&yields));
    let impulse: Vec3 = yields.hold_impulses(0).iter().sum();
    let part = -impulse.y / TICK / weight(&fabric);
    assert!((part - 0.5).abs() < 0.02, "{part} of the weight");
}

#[test]
fn particles_that_are_let_go_fall_freely() {
    let fabric = sheet(true);
    let mut batch = batch(&fabric, LaneCount::Eight, 0.0);
    batch.hold(0, springs(&fabric, 100.0, f32::INFINITY)).expect("good holds");
    (0..300).for_each(|_| batch.step(TICK, StepSettings::default()));
    batch.hold(0, Vec::new()).expect("good");
    let mean = |batch: &ClothBatch| {
        let velocities = batch.snapshot(0).velocities;
        let masses = velocities.iter().zip(fabric.particle_areas());
        masses.map(|(velocity, &area)| velocity.y * area).sum::<f32>() / fabric.area()
    };
    let before = mean(&batch);
    (0..6).for_each(|_| batch.step(TICK, StepSettings::default()));
    let change = mean(&batch) - before;
    // The first substeps still extrapolate the pull: half a substep of twelve.
    assert!((change / (-9.81 * 6.0 * TICK) - 1.0).abs() < 0.05, "{change} m/s");
    assert!(batch.hold_impulses(0).is_empty());
}

#[test]
fn a_ring_slides_down_an_inclined_rail() {
    const ANGLE: f32 = 0.4;
    for (is_grid, friction) in [(true, 0.0), (false, 0.0), (true, 0.2)] {
        let fabric = sheet(is_grid);
        let mut batch = batch(&fabric, LaneCount::Eight, 0.0);
        let along = Vec3::new(libm::cosf(ANGLE), -libm::sinf(ANGLE), 0.0);
        let turned = Quat::from_rotation_z(-ANGLE);
        let mut state = ClothSnapshot::at_rest(&fabric);
        state.positions.iter_mut().for_each(|at| *at = turned * *at);
        batch.restore(0, &state).expect("good");
        let rail: Arc<[Vec3]> = Arc::new([-10.0 * along, 100.0 * along]);
        let pose = [(Vec3::ZERO, Quat::IDENTITY); 2];
        let ring = |particle| Hold {
            particle,
            by: Holder::Ring { rail: Arc::clone(&rail), pose, mass: 0.005, friction },
        };
        batch.hold(0, upper(&fabric).into_iter().map(ring).collect()).expect("good holds");
        let start = edge(&batch);
        const TICKS: u32 = 120;
        (0..TICKS).for_each(|_| batch.step(TICK, StepSettings::default()));
        let seconds = TICKS as f32 * TICK;
        let rate = libm::sinf(ANGLE) - friction * libm::cosf(ANGLE);
        let expected = 0.5 * 9.81 * rate * seconds * seconds;
        let found = (edge(&batch) - start).dot(along);
        let error = found / expected - 1.0;
        assert!(error.abs() < 0.01, "{is_grid} {friction}: {found} m for {expected} m");
        let off = (edge(&batch) - start).reject_from(along).length();
        assert!(off < 1e-3, "{off} m off the rail");
    }
}

#[test]
fn held_cloths_have_the_same_bits_in_every_batch() {
    let fabric = sheet(true);
    let run = |lanes: LaneCount, others: usize| {
        let mut batch = batch(&fabric, lanes, 0.1);
        for _ in 0..others {
            let state = ClothSnapshot::at_rest(&fabric);
            batch.insert(&state, FabricMaterial::DENIM).expect("a lane");
        }
        for tick in 0..60 {
            let mut holds = springs(&fabric, 50.0, 2.0);
            let swing = Vec3::X * libm::sinf(0.1 * tick as f32);
            for hold in &mut holds {
                if let Holder::Spring { place, .. } = &mut hold.by {
                    place.iter_mut().for_each(|at| *at += swing);
                }
            }
            batch.hold(0, if tick < 40 { holds } else { Vec::new() }).expect("good holds");
            batch.step(TICK, StepSettings::default());
        }
        batch.snapshot(0)
    };
    let alone = run(LaneCount::One, 0);
    assert_eq!(run(LaneCount::Eight, 5), alone);
    // Without AVX-512 a batch has eight lanes.
    assert_eq!(run(LaneCount::Sixteen, 7), alone);
}

#[test]
fn bad_holds_are_refused() {
    let fabric = sheet(true);
    let mut batch = batch(&fabric, LaneCount::One, 0.0);
    let spring = |particle, stiffness| Hold {
        particle,
        by: Holder::Spring { place: [Vec3::ZERO; 2], stiffness, max_force: f32::INFINITY },
    };
    for bad in [spring(1000, 1.0), spring(3, f32::NAN), spring(3, -1.0)] {
        let particle = bad.particle;
        assert_eq!(batch.hold(0, vec![bad]), Err(BatchError::Hold { particle }));
    }
    let pose = [(Vec3::ZERO, Quat::IDENTITY); 2];
    let by = Holder::Ring { rail: Arc::new([]), pose, mass: 0.1, friction: 0.0 };
    assert!(batch.hold(0, vec![Hold { particle: 0, by }]).is_err());
}
