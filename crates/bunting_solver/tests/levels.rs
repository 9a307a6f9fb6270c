//! State moved from level to level.

use bunting_solver::{ClothSnapshot, Fabric, FabricBuilder, Grid, LevelTransfer, TransferError};
use glam::Vec3;

fn fabric(columns: u32, rows: u32) -> Fabric {
    FabricBuilder::grid(Grid::new(columns, rows, 1.2, 0.8)).build().expect("a good fabric")
}

fn bent(fabric: &Fabric) -> ClothSnapshot {
    let mut state = ClothSnapshot::at_rest(fabric);
    for (index, (position, velocity)) in
        state.positions.iter_mut().zip(&mut state.velocities).enumerate()
    {
        position.z += libm::sinf(index as f32);
        *velocity = Vec3::new(libm::cosf(index as f32), 1.0, 0.1 * index as f32);
    }
    state
}

#[test]
fn up_takes_means_and_down_keeps_what_is_shared() {
    let (fine, coarse) = (fabric(9, 5), fabric(5, 3));
    let transfer = LevelTransfer::between(&fine, &coarse).expect("nested");
    let state = bent(&coarse);
    let up = transfer.prolong(&state);
    assert_eq!(up.positions.len(), 45);
    // Node (1, 1) of the fine grid lies amid four coarse ones, (1, 0) between two.
    let mean = |values: &[Vec3], nodes: &[usize]| {
        nodes.iter().map(|&node| values[node]).sum::<Vec3>() / nodes.len() as f32
    };
    assert!(up.velocities[10].distance(mean(&state.velocities, &[0, 1, 5, 6])) < 1e-6);
    assert!(up.positions[1].distance(mean(&state.positions, &[0, 1])) < 1e-6);
    assert_eq!(transfer.restrict(&up), state);
}

#[test]
fn levels_that_are_not_nested_are_refused() {
    let refused = LevelTransfer::between(&fabric(9, 5), &fabric(5, 5)).expect_err("not nested");
    assert_eq!(refused, TransferError::NotNested { fine: (9, 5), coarse: (5, 5) });
}
