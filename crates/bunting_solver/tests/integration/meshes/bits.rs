//! The bits of a mesh, whatever its lane, and whatever flies beside it.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricMaterial, LaneCount, StepLimits,
};
use glam::Vec3;

use super::shapes::*;
use super::{GRAVITY, TICK};
use crate::common::{irregular, net, trousers};

/// Positions of the last of some cloths, each in its own wind, m/s, after half a second.
fn flown(
    fabric: &Arc<Fabric>,
    material: FabricMaterial,
    lanes: LaneCount,
    winds: &[f32],
) -> Vec<Vec3> {
    let settings = StepLimits::default().of_fabric(fabric, TICK, GRAVITY);
    let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
    for &wind in winds {
        let lane = batch.insert(&ClothSnapshot::at_rest(fabric), material).expect("room");
        let wind = Vec3::new(wind, 0.0, 4.0);
        batch.drive(lane, Drive { wind, ..Drive::default() }).expect("a lane");
    }
    for _ in 0..30 {
        batch.step(TICK, settings);
    }
    let mut positions = Vec::new();
    batch.copy_positions(winds.len() - 1, &mut positions);
    positions
}

#[test]
fn a_mesh_has_the_same_bits_at_every_width() {
    let limp = FabricMaterial::FLAG_POLYESTER;
    // Stiff enough to be bent at positions that contain the displacement by stretch, and to resist twist.
    let stiff = FabricMaterial { bend_stiffness: 10.0, ..limp };
    let flat = irregular(21, 0.0);
    let fabrics = [
        irregular(13, 0.0),
        irregular(30, 0.5),
        with_a_hole(&flat),
        bent(&with_a_hole(&flat), 0.3),
        disk(&flat),
        bent(&disk(&flat), 0.4),
        cap(&flat),
        of_two_pieces(&flat, |at| at.y == 0.0),
        with_a_slit(&flat, |at| at.y == 0.0),
        unpinned(&with_a_slit(&flat, |at| at.y == 0.0)),
        trousers(),
        bent(&with_a_hole(&flat), CLOSED),
        ribbon(),
        bent(&flat, 0.3),
        bent_with(&irregular(12, 0.0), CLOSED, Vec::new()),
        funnel(&irregular(20, 0.0), [CLOSED, 2.0 * CLOSED]),
    ];
    for fabric in fabrics.iter().map(net) {
        for material in [limp, stiff] {
            let alone = flown(&fabric, material, LaneCount::One, &[6.0]);
            assert!(alone.iter().all(|at| at.is_finite()));
            let [eight, sixteen] = [LaneCount::Eight, LaneCount::Sixteen];
            assert_eq!(alone, flown(&fabric, material, eight, &[3.0, -2.0, 6.0]));
            assert_eq!(alone, flown(&fabric, material, sixteen, &[9.0, 6.0]));
        }
    }
}

#[test]
fn a_mesh_that_moves_to_another_batch_keeps_its_bits() {
    let flat = irregular(21, 0.0);
    let untextured = bent_with(&irregular(12, 0.0), CLOSED, Vec::new());
    let funnel = funnel(&irregular(20, 0.0), [CLOSED, 2.0 * CLOSED]);
    let holed = with_a_hole(&flat);
    let bent_holed = bent(&holed, 0.3);
    let pieces = of_two_pieces(&flat, |at| at.y == 0.0);
    let slit = with_a_slit(&flat, |at| at.y == 0.0);
    let closed_holed = bent(&holed, CLOSED);
    let (plane, bent) = (irregular(13, 0.0), bent(&flat, 0.3));
    let disk = disk(&flat);
    let curved = [cap(&flat), bent, bent_holed, closed_holed, untextured, funnel];
    for fabric in [plane, holed, disk, pieces, unpinned(&slit), slit, trousers()]
        .into_iter()
        .chain(curved)
        .map(|mesh| net(&mesh))
    {
        let settings = StepLimits::default().of_fabric(&fabric, TICK, GRAVITY);
        let wind = Vec3::new(6.0, 0.0, 4.0);
        let drive = || Drive { wind, ..Drive::default() };
        let mut stays = ClothBatch::new(Arc::clone(&fabric), LaneCount::One);
        let rest = ClothSnapshot::at_rest(&fabric);
        stays.insert(&rest, FabricMaterial::FLAG_POLYESTER).expect("room");
        stays.drive(0, drive()).expect("a lane");
        for _ in 0..20 {
            stays.step(TICK, settings);
        }
        let mut other = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
        for snapshot in [rest, stays.snapshot(0)] {
            let lane = other.insert(&snapshot, FabricMaterial::FLAG_POLYESTER).expect("room");
            other.drive(lane, drive()).expect("a lane");
        }
        for _ in 0..10 {
            stays.step(TICK, settings);
            other.step(TICK, settings);
        }
        assert_eq!(stays.snapshot(0), other.snapshot(1));
    }
}
