//! Tests of the quantities that a change of level conserves: momentum, energy, shape.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::LevelTransfer;
use crate::batch::ClothBatch;
use crate::batch::lane_count::LaneCount;
use crate::batch::snapshot::ClothSnapshot;
use crate::fabric::{Fabric, FabricBuilder, FabricMaterial, Grid};
use crate::geometry::energy::{area_moment, elastic};
use crate::step::{Drive, StepSettings};

const GRAVITY: Vec3 = Vec3::new(0.0, -9.81, 0.0);
const MATERIAL: FabricMaterial = FabricMaterial::FLAG_POLYESTER;
const TICK: f32 = 1.0 / 60.0;

fn fabric(columns: u32, rows: u32, pinned: bool) -> Arc<Fabric> {
    let grid = FabricBuilder::grid(Grid::new(columns, rows, 1.2, 0.8));
    Arc::new(grid.pin_where(|_, uv| pinned && uv.x == 0.0).build().expect("a good fabric"))
}

/// Two neighbouring levels and the transfer between them.
fn levels(pinned: bool) -> (Arc<Fabric>, Arc<Fabric>, LevelTransfer) {
    let (fine, coarse) = (fabric(17, 9, pinned), fabric(9, 5, pinned));
    let transfer = LevelTransfer::between(&fine, &coarse).expect("nested");
    (fine, coarse, transfer)
}

fn batch_of(fabric: &Arc<Fabric>, state: &ClothSnapshot) -> ClothBatch {
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
    batch.insert(state, MATERIAL).expect("a good state");
    batch
}

/// A flag after a second in wind and gravity.
fn flown(fabric: &Arc<Fabric>) -> ClothSnapshot {
    let mut batch = batch_of(fabric, &ClothSnapshot::at_rest(fabric));
    batch
        .drive(0, Drive { wind: Vec3::new(7.0, 0.0, 3.0), ..Drive::default() })
        .expect("a good drive");
    (0..60).for_each(|_| batch.step(TICK, StepSettings::default()));
    batch.snapshot(0)
}

/// Kinetic, elastic and gravitational energy, J.
fn energies(fabric: &Fabric, state: &ClothSnapshot) -> [f64; 3] {
    let density = f64::from(MATERIAL.area_density);
    let moving = fabric.particle_areas().iter().zip(&state.velocities);
    let kinetic: f64 =
        moving.map(|(&area, v)| f64::from(area) * v.as_dvec3().length_squared()).sum();
    let height = -area_moment(fabric, &state.positions).dot(GRAVITY.as_dvec3());
    [0.5 * density * kinetic, elastic(fabric, &MATERIAL, &state.positions), density * height]
}

#[test]
fn momentum_is_kept_and_energy_does_not_grow() {
    for pinned in [true, false] {
        let (fine, coarse, transfer) = levels(pinned);
        let (above, below) = (flown(&fine), flown(&coarse));
        for (from, before, to, after) in [
            (&fine, &above, &coarse, transfer.restrict(&above, &MATERIAL, GRAVITY)),
            (&coarse, &below, &fine, transfer.prolong(&below, &MATERIAL, GRAVITY)),
        ] {
            let momentum = |fabric, state: &ClothSnapshot| area_moment(fabric, &state.velocities);
            let (had, has) = (momentum(from, before), momentum(to, &after));
            assert!(had.distance(has) < 1e-5 * had.length(), "pinned {pinned}: {had} {has}");
            let (had, has) = (energies(from, before), energies(to, &after));
            let sum = |energies: [f64; 3]| energies.iter().sum::<f64>();
            // The sum is rounded like its largest term.
            let rounding = 1e-6 * had.map(f64::abs).iter().sum::<f64>();
            assert!(sum(has) < sum(had) + rounding, "pinned {pinned}: {had:?} {has:?}");
        }
    }
}

/// A restriction over several levels conserves the same quantities as one over a single level.
#[test]
fn several_levels_are_crossed_at_once_without_strain() {
    let fabrics = [(17, 9), (9, 5), (5, 3)].map(|(columns, rows)| fabric(columns, rows, true));
    let between =
        |pair: &[Arc<Fabric>]| LevelTransfer::between(&pair[0], &pair[1]).expect("nested");
    let chain: Vec<LevelTransfer> = fabrics.windows(2).map(between).collect();
    let [finest, _, coarsest] = &fabrics;
    let before = flown(finest);
    let after = LevelTransfer::restrict_through(&chain, &before, &MATERIAL, GRAVITY);
    assert_eq!(after.positions.len(), coarsest.particle_count());
    let (had, has) =
        (area_moment(finest, &before.velocities), area_moment(coarsest, &after.velocities));
    assert!(had.distance(has) < 1e-5 * had.length(), "{had} {has}");
    let (had, has) = (energies(finest, &before), energies(coarsest, &after));
    let rounding = 1e-6 * had.map(f64::abs).iter().sum::<f64>();
    assert!(has.iter().sum::<f64>() < had.iter().sum::<f64>() + rounding, "{had:?} {has:?}");
    assert!(has[1] < had[1] + 0.1 * had[0], "strain is left: {had:?} {has:?}");
}

/// All particles of the cloth, pins included, move at the velocity of the frame.
#[test]
fn a_uniform_velocity_stays_uniform() {
    let (fine, coarse, transfer) = levels(true);
    let speed = Vec3::new(20.0, -3.0, 5.0);
    let moving = |fabric: &Fabric| {
        let rest = ClothSnapshot::at_rest(fabric);
        ClothSnapshot::new(rest.positions, vec![speed; fabric.particle_count()])
    };
    for state in [
        transfer.restrict(&moving(&fine), &MATERIAL, GRAVITY),
        transfer.prolong(&moving(&coarse), &MATERIAL, GRAVITY),
    ] {
        assert!(state.velocities.iter().all(|v| v.distance(speed) < 1e-4));
    }
}

#[test]
fn prolongation_and_restriction_give_back_the_velocities() {
    let (_, coarse, transfer) = levels(true);
    let state = flown(&coarse);
    let up: Vec<Vec3> = transfer.smooth.interpolate(&state.velocities).collect();
    for (down, before) in transfer.gather_velocities(&up).iter().zip(&state.velocities) {
        assert!(down.distance(*before) < 1e-5, "{down} {before}");
    }
}

/// The motion of fine particles between the shared ones is not lost.
#[test]
fn velocities_are_gathered_from_all_particles() {
    let (fine, _, transfer) = levels(false);
    let is_shared = |particle: usize| transfer.shared.contains(&(particle as u32));
    let velocities: Vec<Vec3> = (0..fine.particle_count())
        .map(|particle| if is_shared(particle) { Vec3::ZERO } else { Vec3::X })
        .collect();
    let gathered = transfer.gather_velocities(&velocities);
    assert!(gathered.iter().all(|v| (0.3..1.0).contains(&v.x)), "{gathered:?}");
}

/// The wave is eight coarse cells long: straight lines between shared particles would cut off 7 % of its
/// height.
#[test]
fn folds_are_not_flattened() {
    let (fine, coarse, transfer) = levels(false);
    let wave = |rest: &Vec3| rest.with_z(0.1 * libm::sinf(core::f32::consts::TAU / 1.2 * rest.x));
    let bent: Vec<Vec3> = coarse.rest_positions().iter().map(wave).collect();
    let error = |positions: &mut dyn Iterator<Item = Vec3>| {
        let exact = fine.rest_positions().iter().map(wave);
        positions.zip(exact).map(|(at, exact)| at.distance(exact)).fold(0.0, f32::max)
    };
    let smooth = error(&mut transfer.smooth.interpolate(&bent));
    let flat = error(&mut transfer.spread(&bent));
    assert!(smooth < 0.4 * flat, "{smooth} {flat}");
}

/// Particles interpolated on a fold lie farther apart than at rest. Settling removes this strain, which would
/// become velocity in the next substep.
#[test]
fn little_strain_is_left() {
    let (fine, coarse, transfer) = levels(true);
    let (above, below) = (flown(&fine), flown(&coarse));
    let stored = |fabric, state: &ClothSnapshot| elastic(fabric, &MATERIAL, &state.positions);
    let bare: Vec<Vec3> = transfer.smooth.interpolate(&below.positions).collect();
    let up = stored(&fine, &transfer.prolong(&below, &MATERIAL, GRAVITY));
    assert!(
        up < 1.02 * stored(&coarse, &below) && up < 0.1 * elastic(&fine, &MATERIAL, &bare),
        "{up}"
    );
    let bare: Vec<Vec3> = transfer.pick(&above.positions);
    let down = stored(&coarse, &transfer.restrict(&above, &MATERIAL, GRAVITY));
    assert!(down < 0.1 * elastic(&coarse, &MATERIAL, &bare), "{down}");
}

/// Cloth that no viewer sees is relaxed by sweeps: it stays nearly where it was, and is not thrown when it is simulated
/// again.
#[test]
fn relaxed_cloth_is_not_thrown() {
    let fabrics =
        [(33, 33), (17, 17), (9, 9), (5, 5)].map(|(columns, rows)| fabric(columns, rows, true));
    let between =
        |pair: &[Arc<Fabric>]| LevelTransfer::between(&pair[0], &pair[1]).expect("nested");
    let chain: Vec<LevelTransfer> = fabrics.windows(2).map(between).collect();
    let [finest, .., coarsest] = &fabrics;
    let before = flown(finest);
    let mut bare = ClothSnapshot::new(before.positions, before.velocities);
    for transfer in &chain {
        bare = bare.of(transfer.shared());
    }
    let relaxed = chain[2].relax(bare.clone());
    assert_eq!(relaxed.velocities, bare.velocities);
    for (at, was) in relaxed.positions.iter().zip(&bare.positions) {
        assert!(at.distance(*was) < 0.2, "{at} {was}");
    }
    let thrown = |state: &ClothSnapshot| {
        let mut batch = batch_of(coarsest, state);
        batch.step(TICK, StepSettings { passes: 2, ..StepSettings::yarns(1) });
        let [had, has] = [state, &batch.snapshot(0)].map(|state| energies(coarsest, state)[0]);
        has / had
    };
    let ratios = [&bare, &relaxed].map(thrown);
    assert!(ratios[0] > 2.0 && ratios[1] < 1.2, "{ratios:?}");
}

/// Soft cloth that is stretched by its weight keeps its stretch in a change of level.
#[test]
fn stretch_by_weight_is_kept() {
    let material = FabricMaterial {
        warp_stiffness: 20.0,
        weft_stiffness: 20.0,
        shear_stiffness: 5.0,
        ..MATERIAL
    };
    let hung = |columns: u32| {
        let grid = FabricBuilder::grid(Grid::new(columns, columns, 1.0, 1.0));
        Arc::new(grid.pin_where(|_, uv| uv.y == 0.0).build().expect("a good fabric"))
    };
    let (fine, coarse) = (hung(17), hung(9));
    let transfer = LevelTransfer::between(&fine, &coarse).expect("nested");
    let hang = |rest: &Vec3| {
        let load = material.area_density * 9.81 / material.weft_stiffness;
        rest.with_y(rest.y - load * (-rest.y - 0.5 * rest.y * rest.y))
    };
    let state = |fabric: &Fabric| {
        let positions = fabric.rest_positions().iter().map(hang).collect();
        ClothSnapshot::new(positions, vec![Vec3::ZERO; fabric.particle_count()])
    };
    let low = |state: &ClothSnapshot| state.positions.last().expect("a corner").y;
    let hanging = low(&state(&fine));
    assert!(hanging < -1.02, "{hanging}");
    for moved in [
        transfer.restrict(&state(&fine), &material, GRAVITY),
        transfer.prolong(&state(&coarse), &material, GRAVITY),
    ] {
        assert!((low(&moved) - hanging).abs() < 1e-3, "{} {hanging}", low(&moved));
    }
}

/// A swing changes its level in every tick for ten seconds.
#[test]
fn a_change_in_every_tick_conserves_momentum_and_adds_no_energy() {
    let (fine, coarse, transfer) = levels(true);
    let fabrics = [fine, coarse];
    let mut batches =
        fabrics.each_ref().map(|fabric| batch_of(fabric, &ClothSnapshot::at_rest(fabric)));
    let mut level = 0;
    let start: f64 = energies(&fabrics[0], &batches[0].snapshot(0)).iter().sum();
    let fall = 0.5 * 9.81 * f64::from(MATERIAL.area_density * fabrics[0].area()) * 1.2;
    for tick in 0..600 {
        batches[level].step(TICK, StepSettings::default());
        let state = batches[level].snapshot(0);
        let moved = if level == 0 {
            transfer.restrict(&state, &MATERIAL, GRAVITY)
        } else {
            transfer.prolong(&state, &MATERIAL, GRAVITY)
        };
        let momentum = |level: usize, state: &ClothSnapshot| -> DVec3 {
            area_moment(&fabrics[level], &state.velocities)
        };
        let (had, has) = (momentum(level, &state), momentum(1 - level, &moved));
        assert!(had.distance(has) < 1e-5 * had.length().max(1e-2), "tick {tick}: {had} {has}");
        level = 1 - level;
        batches[level].restore(0, &moved).expect("a good state");
        let now: f64 = energies(&fabrics[level], &moved).iter().sum();
        assert!(now < start + 0.01 * fall, "tick {tick}: {now} {start}");
    }
}

/// The transfers of a chain are the same whether their neighbours share a settler or not.
#[test]
fn a_chain_of_transfers_shares_its_settlers() {
    let builder = FabricBuilder::grid(Grid::new(17, 9, 1.2, 0.8)).pin_where(|_, uv| uv.x == 0.0);
    let middle = builder.coarser().expect("a level");
    let coarse = middle.builder.coarser().expect("a level");
    let [fine, between, last] = [&builder, &middle.builder, &coarse.builder]
        .map(|builder| Arc::new(builder.clone().build().expect("a good fabric")));
    let first = LevelTransfer::between(&fine, &between).expect("nested");
    let second = first.then(&last).expect("nested");
    assert!(first.shares_settler_with(&second));
    let apart = LevelTransfer::between(&between, &last).expect("nested");
    assert!(!first.shares_settler_with(&apart));
    let state = flown(&between);
    let restricted =
        [&second, &apart].map(|transfer| transfer.restrict(&state, &MATERIAL, GRAVITY));
    assert_eq!(restricted[0], restricted[1]);
    let state = flown(&last);
    let prolonged = [&second, &apart].map(|transfer| transfer.prolong(&state, &MATERIAL, GRAVITY));
    assert_eq!(prolonged[0], prolonged[1]);
}
