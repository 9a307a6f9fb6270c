//! Tests that cloth without pins, on which nothing acts, keeps its momentum and angular momentum.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, Grid, LaneCount,
    Scheme, StepSettings,
};
use glam::Vec3;

const TICK: f32 = 1.0 / 60.0;

/// Relative change of a cloth's momentum in a second by rounding: corrections are rounded to a unit in the
/// last place of a position, 6e-8 m at 1 m, in each of 240 substeps. Smaller: the test fails by rounding.
/// Larger: it passes although a constraint pushes one particle more than another.
const MOMENTUM_ROUNDING: f32 = 1e-3;

/// Relative change of the angular momentum about the centre in a second, of a crumpled sheet, by rounding. Where it
/// is not given back the sheet loses 0.10.
const SPIN_ROUNDING: f32 = 1e-4;

/// The same with Gauss–Seidel: the directions of links are those before a solve and not those after it. Measured: 0.05.
const SPIN_ERROR_OF_GAUSS_SEIDEL: f32 = 0.06;

/// Polyester without damping.
const UNDAMPED: FabricMaterial =
    FabricMaterial { damping: 0.0, internal_damping: 0.0, ..FabricMaterial::FLAG_POLYESTER };

/// The default settings, and Gauss–Seidel.
fn schemes() -> [StepSettings; 2] {
    [StepSettings::default(), StepSettings::gauss_seidel(4)]
}

fn sheet(n: u32) -> Arc<Fabric> {
    let builder = FabricBuilder::grid(Grid::new(n, n, 1.0, 1.0));
    Arc::new(builder.build().expect("a good fabric"))
}

/// A sheet that is crumpled, flies and turns.
fn crumpled(fabric: &Fabric) -> ClothSnapshot {
    let crumple =
        |position: Vec3| Vec3::new(0.0, 0.0, 0.1 * libm::sinf(7.0 * position.x + 3.0 * position.y));
    let mut start = ClothSnapshot::at_rest(fabric);
    for (position, velocity) in start.positions.iter_mut().zip(&mut start.velocities) {
        *velocity = Vec3::new(0.3, -0.2, 0.1)
            + Vec3::new(0.0, 0.5, 2.0).cross(*position)
            + crumple(*position) * 5.0;
        *position += crumple(*position);
    }
    start
}

fn mass_weighted(fabric: &Fabric, value: impl Fn(usize) -> Vec3) -> Vec3 {
    fabric.particle_areas().iter().enumerate().map(|(particle, &area)| value(particle) * area).sum()
}

fn momentum(fabric: &Fabric, state: &ClothSnapshot) -> Vec3 {
    mass_weighted(fabric, |i| state.velocities[i])
}

/// Angular momentum about the centre of mass, in units of the density, m⁴/s.
fn spin(fabric: &Fabric, state: &ClothSnapshot) -> Vec3 {
    let centre = mass_weighted(fabric, |i| state.positions[i]) / fabric.area();
    mass_weighted(fabric, |i| (state.positions[i] - centre).cross(state.velocities[i]))
}

#[test]
fn free_cloth_keeps_its_momenta() {
    let fabric = sheet(7);
    let start = crumpled(&fabric);
    let material = FabricMaterial { internal_damping: 2.0, ..UNDAMPED };
    for settings in schemes() {
        let mut batch = ClothBatch::new(fabric.clone(), LaneCount::One);
        batch.insert(&start, material).expect("a free lane");
        batch.drive(0, Drive::NONE).expect("a good drive");
        for _ in 0..60 {
            batch.step(TICK, settings);
        }
        let end = batch.snapshot(0);
        let (before, after) = (momentum(&fabric, &start), momentum(&fabric, &end));
        let change = (after - before).length() / before.length();
        assert!(change < MOMENTUM_ROUNDING, "{settings:?}: {before} {after}");
        let (before, after) = (spin(&fabric, &start), spin(&fabric, &end));
        let change = (after - before).length() / before.length();
        let most = match settings.scheme {
            Scheme::Yarns => SPIN_ROUNDING,
            Scheme::GaussSeidel => SPIN_ERROR_OF_GAUSS_SEIDEL,
        };
        assert!(change < most, "{settings:?}: {before} {after}");
    }
}

/// What acts from outside for a tick turns a free sheet at the rate that its moment gives, although the sheet's own
/// angular momentum is kept before, between and after.
#[test]
fn a_free_cloth_takes_up_the_moment_of_a_users_force() {
    const ACCELERATION: f32 = 30.0;
    let fabric = sheet(7);
    let centre = Vec3::new(0.5, -0.5, 0.0);
    let mut batch = ClothBatch::new(fabric.clone(), LaneCount::One);
    batch.insert(&ClothSnapshot::at_rest(&fabric), UNDAMPED).expect("a free lane");
    batch.drive(0, Drive::NONE).expect("a good drive");
    let settings = StepSettings::yarns(2);
    let mut expected = Vec3::ZERO;
    for tick in 0..60 {
        batch.begin_tick(TICK, settings);
        for _ in 0..settings.substeps {
            batch.integrate();
            if tick == 10 || tick == 30 {
                let mut particles = batch.particles_mut(0).expect("a cloth");
                for (particle, &area) in fabric.particle_areas().iter().enumerate() {
                    let arm = particles.position(particle) - centre;
                    let push = ACCELERATION * Vec3::Z.cross(arm);
                    particles.add_acceleration(particle, push);
                    expected += TICK / settings.substeps as f32 * area * arm.cross(push);
                }
            }
            batch.solve_constraints();
            batch.update_velocities();
        }
    }
    let end = batch.snapshot(0);
    let spin = spin(&fabric, &end);
    let change = (spin - expected).length() / expected.length();
    assert!(change < 1e-3, "{spin} for {expected}");
}

#[test]
fn internal_damping_leaves_a_rigid_spin_and_stops_a_wobble() {
    let fabric = sheet(5);
    let material = FabricMaterial { internal_damping: 10.0, ..UNDAMPED };
    let mut start = ClothSnapshot::at_rest(&fabric);
    let centre = Vec3::new(0.5, -0.5, 0.0);
    for (index, (position, velocity)) in
        start.positions.iter().zip(&mut start.velocities).enumerate()
    {
        let wobble = [0.2, -0.2, 0.0, -0.2, 0.2][index % 5];
        *velocity = Vec3::X + Vec3::Z.cross(*position - centre) + Vec3::Z * wobble;
    }
    for settings in schemes() {
        let mut batch = ClothBatch::new(fabric.clone(), LaneCount::One);
        batch.insert(&start, material).expect("a free lane");
        batch.drive(0, Drive::NONE).expect("a good drive");
        for _ in 0..60 {
            batch.step(TICK, settings);
        }
        let end = batch.snapshot(0);
        // The sheet has an area of 1 m².
        let drift = momentum(&fabric, &end);
        let lost = (drift - momentum(&fabric, &start)).length();
        assert!(lost < MOMENTUM_ROUNDING, "{settings:?}: {drift}");
        let wobbles = end.velocities.iter().map(|velocity| (velocity.z - drift.z).abs());
        let wobble = wobbles.fold(0.0, f32::max);
        assert!(wobble < 0.01, "{settings:?}: {wobble} m/s");
        let centre = mass_weighted(&fabric, |i| end.positions[i]);
        let spin = (end.velocities[0] - drift).length() / (end.positions[0] - centre).length();
        assert!((spin - 1.0).abs() < 0.05, "{settings:?}: {spin} rad/s");
    }
}

#[test]
fn angular_momentum_is_given_back_with_the_same_bits_at_every_width() {
    let fabric = sheet(7);
    let start = crumpled(&fabric);
    let windy = Drive { wind: Vec3::new(3.0, 1.0, 5.0), ..Drive::default() };
    let fly = |lanes: LaneCount, drives: &[Drive]| -> Vec<ClothSnapshot> {
        let mut batch = ClothBatch::new(fabric.clone(), lanes);
        for (lane, &drive) in drives.iter().enumerate() {
            batch.insert(&start, UNDAMPED).expect("a free lane");
            batch.drive(lane, drive).expect("a good drive");
        }
        (0..60).for_each(|_| batch.step(TICK, StepSettings::default()));
        (0..drives.len()).map(|lane| batch.snapshot(lane)).collect()
    };
    let together = fly(LaneCount::Eight, &[windy, Drive::NONE, windy]);
    for (drive, state) in [(windy, &together[0]), (Drive::NONE, &together[1])] {
        assert!(fly(LaneCount::One, &[drive])[0] == *state, "{drive:?}");
    }
}
