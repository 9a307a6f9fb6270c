//! A garment of quads.

use bunting_solver::FabricBuilder;
use glam::Vec3;

/// Trousers of a front and a back of quads, sewn along their sides, which hang by the waist. Their sides bulge.
pub fn trousers() -> FabricBuilder {
    const CELL: f32 = 0.04;
    let is_cloth = |column: i32, row: i32| {
        (0..25).contains(&row)
            && (-6..6).contains(&column)
            && (row < 7 || !(-1..1).contains(&column))
    };
    let bulge = |column: i32, row: i32| {
        let is_cloth = |across, down: i32| is_cloth(column + across, (row + down).clamp(0, 24));
        let is_within =
            |by: i32| (-by..by).all(|across| (-by..by).all(|down| is_cloth(across, down)));
        [0.0, 0.06, 0.08][(1..3).filter(|by| is_within(*by)).count()]
    };
    let cells = (0..25).flat_map(|row| (-6..6).map(move |column| (column, row)));
    let cells = cells.filter(|(column, row)| is_cloth(*column, *row));
    let corners = cells.flat_map(|(column, row)| {
        [1.0, -1.0].into_iter().flat_map(move |side| {
            let right_and_down = match side > 0.0 {
                true => [(0, 0), (0, 1), (1, 1), (1, 0)],
                false => [(1, 0), (1, 1), (0, 1), (0, 0)],
            };
            right_and_down.map(|(right, down)| {
                let (column, row) = (column + right, row + down);
                let at = Vec3::new(column as f32, -row as f32, 0.0) * CELL;
                at + Vec3::Z * side * bulge(column, row)
            })
        })
    });
    let positions: Vec<Vec3> = corners.collect();
    let quads = (0..positions.len() as u32).step_by(4);
    let indices = quads.flat_map(|at| [0, 1, 2, 0, 2, 3].map(|by| at + by)).collect();
    let builder = FabricBuilder::new(positions, indices).weld_distance(1e-4);
    builder.pin_where(|at, _| at.y == 0.0)
}
