//! The quads of a mesh, which edges halve into triangles.

use core::f32::consts::FRAC_PI_2;

use super::cell::Cell;
use crate::fabric::mesh::RestMesh;
use crate::fabric::topology::Edge;

/// Greatest departure of an angle of a quad from a right one, rad. Larger: the lines of a net of random triangles zigzag.
const MOST_DEPARTURE: f32 = 0.7;

/// The cells of a mesh: the best quads first, then the triangles that are left. None if two triangles face opposite ways.
pub(super) fn cells(mesh: &RestMesh, edges: &[Edge]) -> Option<Vec<Cell>> {
    if edges.iter().any(|edge| edge.other_side.is_some() && quad(mesh, edge).is_none()) {
        return None;
    }
    let halved = edges.iter().filter_map(|edge| {
        let cell = quad(mesh, edge)?;
        let departure = departure(mesh, &cell);
        (departure < MOST_DEPARTURE).then_some((departure, cell))
    });
    let mut quads: Vec<(f32, Cell)> = halved.collect();
    quads.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut is_free = vec![true; mesh.triangles.len()];
    let mut cells = Vec::new();
    for (_, cell) in quads {
        if cell.triangles.iter().all(|at| is_free[*at as usize]) {
            cell.triangles.iter().for_each(|at| is_free[*at as usize] = false);
            cells.push(cell);
        }
    }
    let left = (0..).zip(&mesh.triangles).zip(&is_free).filter(|(_, is_free)| **is_free);
    cells.extend(left.map(|((triangle, corners), _)| Cell {
        nodes: corners.to_vec(),
        triangles: vec![triangle],
    }));
    Some(cells)
}

/// The quad that an edge between two triangles halves, if both face the same way.
fn quad(mesh: &RestMesh, edge: &Edge) -> Option<Cell> {
    let other = edge.other_side?;
    let [one, two] = [edge.side, other].map(|side| {
        let corners = mesh.triangles[side.triangle as usize];
        let first = corners.iter().position(|at| *at == side.opposite).unwrap_or_default();
        [0, 1, 2].map(|by| corners[(first + by) % 3])
    });
    let faces_alike = [one[1], one[2]] == [two[2], two[1]];
    faces_alike.then(|| Cell {
        nodes: vec![one[0], one[1], two[0], one[2]],
        triangles: vec![edge.side.triangle, other.triangle],
    })
}

/// The greatest departure of an angle from a right one, rad.
fn departure(mesh: &RestMesh, cell: &Cell) -> f32 {
    let angle = |at: usize| {
        let [before, here, after] =
            mesh.positions_of([3, 0, 1].map(|by| cell.nodes[(at + by) % 4]));
        (before - here).angle_between(after - here)
    };
    (0..4).map(|at| (angle(at) - FRAC_PI_2).abs()).fold(0.0, f32::max)
}
