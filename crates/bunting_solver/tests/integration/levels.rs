//! Tests of states moved from level to level.

use std::sync::Arc;

use bunting_solver::{
    ClothSnapshot, Fabric, FabricBuilder, FabricMaterial, Grid, LevelTransfer, TransferError,
};
use glam::Vec3;

fn fabric(columns: u32, rows: u32) -> Arc<Fabric> {
    Arc::new(FabricBuilder::grid(Grid::new(columns, rows, 1.2, 0.8)).build().expect("good"))
}

#[test]
fn a_cloth_at_rest_stays_where_it_is() {
    let (fine, coarse) = (fabric(9, 5), fabric(5, 3));
    let transfer = LevelTransfer::between(&fine, &coarse).expect("nested");
    let rest = [&fine, &coarse].map(|fabric| ClothSnapshot::at_rest(fabric));
    let material = FabricMaterial::COTTON;
    let moved = [
        transfer.prolong(&rest[1], &material, Vec3::ZERO),
        transfer.restrict(&rest[0], &material, Vec3::ZERO),
    ];
    for (moved, rest) in moved.iter().zip(&rest) {
        assert_eq!(moved.velocities, rest.velocities);
        for (moved, rest) in moved.positions.iter().zip(&rest.positions) {
            assert!(moved.distance(*rest) < 1e-6, "{moved} {rest}");
        }
    }
}

#[test]
fn levels_that_are_not_nested_are_refused() {
    let refused = LevelTransfer::between(&fabric(9, 5), &fabric(5, 5)).expect_err("not nested");
    assert_eq!(refused, TransferError::NotNested { fine: (9, 5), coarse: (5, 5) });
}
