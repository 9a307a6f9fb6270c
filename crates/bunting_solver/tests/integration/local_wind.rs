//! Tests of wind that differs from particle to particle.

use std::sync::Arc;

use bunting_solver::{
    BatchError, ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, Grid,
    LaneCount, StepSettings,
};
use glam::Vec3;

use crate::common::{irregular, net};

const TICK: f32 = 1.0 / 60.0;

const WIND: Vec3 = Vec3::new(0.2, 0.0, 1.5);

/// A curtain of 1 m as a grid, or as an irregular mesh.
fn curtain(is_grid: bool) -> Arc<Fabric> {
    if !is_grid {
        return net(&irregular(17, 0.0));
    }
    let grid = FabricBuilder::grid(Grid::new(17, 17, 1.0, 1.0));
    Arc::new(grid.pin_where(|at, _| at.y == 0.0).build().expect("a good fabric"))
}

/// Positions of a curtain after some ticks, in the last of the given lanes, in a wind, and in another at each particle.
fn after(
    ticks: usize,
    fabric: &Arc<Fabric>,
    lanes: LaneCount,
    wind: Vec3,
    local: impl Fn(Vec3) -> Vec3,
) -> Vec<Vec3> {
    let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
    let winds: Vec<Vec3> = fabric.rest_positions().iter().map(|&at| local(at)).collect();
    let mut last = 0;
    for _ in 0..lanes.get() {
        let start = ClothSnapshot::at_rest(fabric);
        last = batch.insert(&start, FabricMaterial::COTTON).expect("a free lane");
        batch.drive(last, Drive { wind, ..Drive::default() }).expect("a good drive");
    }
    batch.set_local_wind(last, winds).expect("good winds");
    (0..ticks).for_each(|_| batch.step(TICK, StepSettings::default()));
    batch.snapshot(last).positions
}

fn apart(one: &[Vec3], other: &[Vec3]) -> f32 {
    one.iter().zip(other).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
}

#[test]
fn a_local_wind_that_is_the_same_everywhere_is_a_wind() {
    for (is_grid, lanes) in [
        (true, LaneCount::One),
        (true, LaneCount::Eight),
        (false, LaneCount::One),
        (false, LaneCount::Eight),
    ] {
        let fabric = &curtain(is_grid);
        let flown = |wind: Vec3, local: Vec3| after(30, fabric, lanes, wind, |_| local);
        let calm = flown(Vec3::ZERO, Vec3::ZERO);
        let expected = flown(WIND, Vec3::ZERO);
        assert!(apart(&expected, &calm) > 0.05, "the wind is felt");
        let mixed = flown(0.25 * WIND, 0.75 * WIND);
        let error = apart(&mixed, &expected);
        assert!(error < 2e-3, "{error} m, grid {is_grid}, {} lanes", lanes.get());
    }
}

#[test]
fn a_wind_at_one_half_moves_that_half() {
    for (is_grid, lanes) in [(true, LaneCount::One), (false, LaneCount::One)] {
        let right = |at: Vec3| if at.x > 0.5 { WIND } else { Vec3::ZERO };
        let fabric = &curtain(is_grid);
        let blown = after(30, fabric, lanes, Vec3::ZERO, right);
        let corner = |x: f32| {
            let is_there = |rest: &Vec3| rest.distance(Vec3::new(x, -1.0, 0.0)) < 1e-5;
            let at = fabric.rest_positions().iter().position(is_there).expect("a corner");
            blown[at].z.abs()
        };
        let (left, right) = (corner(0.0), corner(1.0));
        // The left corner moves by 5 % of the right one's way, as the cloth hangs together. In one wind both move alike.
        assert!(right > 0.05 && left < 0.1 * right, "{left} and {right} m, grid {is_grid}");
    }
}

#[test]
fn winds_that_do_not_fit_are_refused() {
    let fabric = &curtain(true);
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
    let start = ClothSnapshot::at_rest(fabric);
    let lane = batch.insert(&start, FabricMaterial::COTTON).expect("a free lane");
    let count = fabric.particle_count();
    let short = batch.set_local_wind(lane, vec![Vec3::ZERO; count - 1]);
    assert_eq!(short, Err(BatchError::ParticleCount { given: count - 1, expected: count }));
    let nan = batch.set_local_wind(lane, vec![Vec3::NAN; count]);
    assert_eq!(nan, Err(BatchError::Drive { name: "local wind" }));
    assert_eq!(batch.set_local_wind(lane, Vec::new()), Ok(()));
}
