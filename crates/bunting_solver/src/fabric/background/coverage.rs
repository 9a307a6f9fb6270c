//! How much of each cell of a grid a mesh covers.

use glam::Vec2;

use crate::fabric::grid::Grid;

/// Greatest part of a cell that a mesh may cover. Larger: a mesh that overlaps itself counts as flat.
const COVERED_ONCE: f32 = 1.01;

/// Part of a cell by which rounding may change what a mesh covers.
const ROUNDED: f32 = 0.01;

/// Least part of a cell that counts as cloth if all of its nodes lie in the mesh. Smaller: links without stiffness.
const LEAST_COVERAGE: f32 = 0.1;

/// Least area that the particles around a node must give to it, as a part of a cell's, where all is cloth. Smaller: nodes
/// between which few particles lie count, too.
const LEAST_MOVED: f32 = 0.3;

/// Greatest part of the nodes within the cloth that may move less. Random triangles of even size leave up to 6 %, a ring of 27
/// quads around and 24 across 30 %. Larger: nodes that no particle shows move by themselves, and rings never rest.
const MOST_UNSEEN: f32 = 0.15;

/// The part of each cell that triangles cover; none if a part of a cell is covered twice.
pub(super) fn covered_once(
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
    covered.iter().all(|&part| part < COVERED_ONCE).then_some(covered)
}

/// How much cloth each cell stands for that has all of its nodes in the mesh: its own, and what cells next to it that
/// have not, at the border, give to it.
pub(super) fn given_to_whole_cells(
    covered: &[f32],
    grid: &Grid,
    in_mesh: impl Fn(u32) -> bool,
) -> Vec<f32> {
    let columns = (grid.columns - 1) as usize;
    let is_whole: Vec<bool> =
        grid.cells().map(|(corners, _)| corners.iter().all(|&corner| in_mesh(corner))).collect();
    let whole_neighbours = |cell: usize| {
        let (row, column) = (cell / columns, cell % columns);
        let sides = [
            (column > 0).then(|| cell - 1),
            (column + 1 < columns).then(|| cell + 1),
            (row > 0).then(|| cell - columns),
            Some(cell + columns),
        ];
        let is_whole = |cell: &usize| is_whole.get(*cell).copied().unwrap_or(false);
        sides.into_iter().flatten().filter(is_whole).collect::<Vec<usize>>()
    };
    let mut given = vec![0.0; covered.len()];
    for (cell, &part) in covered.iter().enumerate() {
        if is_whole[cell] {
            given[cell] += part;
            continue;
        }
        let neighbours = whole_neighbours(cell);
        for &neighbour in &neighbours {
            given[neighbour] += part / neighbours.len() as f32;
        }
    }
    // A cell that has all of its nodes joins them, however little cloth it has.
    for (given, is_whole) in given.iter_mut().zip(is_whole) {
        if is_whole {
            *given = given.max(LEAST_COVERAGE);
        }
    }
    given
}

/// Whether the particles lie evenly enough to show how nodes move, given the area that each node moves, m².
pub(super) fn shows_nodes(covered: &[f32], grid: &Grid, moved: &[f32]) -> bool {
    let cell = Vec2::from(grid.spacing()).element_product();
    let mut cloth = vec![0.0; moved.len()];
    for ((corners, _), part) in grid.cells().zip(covered) {
        corners.iter().for_each(|&corner| cloth[corner as usize] += 0.25 * part);
    }
    let within = cloth.iter().zip(moved).filter(|(part, _)| **part > 1.0 - ROUNDED);
    let [mut all, mut unseen] = [0; 2];
    for (_, area) in within {
        all += 1;
        unseen += usize::from(*area < LEAST_MOVED * cell);
    }
    unseen as f32 <= MOST_UNSEEN * all as f32
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
