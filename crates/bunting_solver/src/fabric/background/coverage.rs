//! How much of each cell of a grid a mesh covers.

use glam::Vec2;

use crate::fabric::grid::Grid;

/// Greatest part of a cell that a mesh may cover. Larger: a mesh that overlaps itself counts as flat.
const COVERED_ONCE: f32 = 1.01;

/// Least part of a grid that a mesh must cover to fill it. Smaller: nodes outside the mesh.
const FILLED: f32 = 0.995;

/// Least part of a cell that counts as cloth. Smaller: links without stiffness.
const LEAST_COVERAGE: f32 = 0.1;

/// The part of each cell that counts as cloth; none if the triangles cover a part of a cell twice, or do not fill the grid.
pub(super) fn filled_once(
    positions: &[Vec2],
    triangles: &[[u32; 3]],
    grid: &Grid,
) -> Option<Vec<f32>> {
    let spacing = Vec2::from(grid.spacing());
    let cells = [grid.columns - 1, grid.rows - 1];
    let mut covered = vec![0.0; (cells[0] * cells[1]) as usize];
    for triangle in triangles {
        // In units of cells.
        let corners = triangle.map(|corner| positions[corner as usize] / spacing);
        let low = corners[0].min(corners[1]).min(corners[2]);
        let high = corners[0].max(corners[1]).max(corners[2]);
        let range = |low: f32, high: f32, count: u32| {
            (low.max(0.0) as u32).min(count - 1)..(high.max(0.0) as u32 + 1).min(count)
        };
        for row in range(low.y, high.y, cells[1]) {
            for column in range(low.x, high.x, cells[0]) {
                let corner = Vec2::new(column as f32, row as f32);
                covered[(row * cells[0] + column) as usize] += area_in_cell(&corners, corner);
            }
        }
    }
    let is_once = covered.iter().all(|&part| part < COVERED_ONCE);
    let is_filled = covered.iter().sum::<f32>() > FILLED * covered.len() as f32;
    (is_once && is_filled)
        .then(|| covered.into_iter().map(|part| part.max(LEAST_COVERAGE)).collect())
}

/// Area of a triangle within the unit square at a corner (Sutherland and Hodgman 1974).
fn area_in_cell(triangle: &[Vec2; 3], corner: Vec2) -> f32 {
    let mut polygon: Vec<Vec2> = triangle.iter().map(|&at| at - corner).collect();
    for (normal, offset) in [(Vec2::X, 0.0), (Vec2::NEG_X, 1.0), (Vec2::Y, 0.0), (Vec2::NEG_Y, 1.0)]
    {
        let inside = |at: Vec2| normal.dot(at) + offset;
        let mut clipped = Vec::with_capacity(polygon.len() + 1);
        for (index, &from) in polygon.iter().enumerate() {
            let to = polygon[(index + 1) % polygon.len()];
            let (here, there) = (inside(from), inside(to));
            if here >= 0.0 {
                clipped.push(from);
            }
            if (here >= 0.0) != (there >= 0.0) {
                clipped.push(from.lerp(to, here / (here - there)));
            }
        }
        polygon = clipped;
    }
    let next = polygon.iter().cycle().skip(1);
    0.5 * polygon.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f32>().abs()
}
