//! How much of each cell of a grid a mesh covers.

use glam::Vec2;

use crate::fabric::grid::Grid;

/// Greatest part of a cell that a mesh may cover. Larger: a mesh that overlaps itself counts as flat.
const COVERED_ONCE: f32 = 1.01;

/// Least part of a grid that a mesh must cover to fill it. Smaller: nodes outside the mesh.
const FILLED: f32 = 0.995;

/// Least part of a cell that counts as cloth where there is any. Smaller: nodes beyond the border, which the particles
/// there follow, hang by links without stiffness.
const LEAST_COVERAGE: f32 = 0.1;

/// Least part of a cell in which there is cloth. Smaller: rounding.
const LEAST_CLOTH: f32 = 1e-5;

/// Least area of half a cell between moved nodes, in units of cells. Smaller: cells that are turned over.
const LEAST_HALF: f32 = 0.02;

/// Least distance of a triangle from a cell in which it covers nothing, in cells. Smaller: rounding.
const BESIDE: f32 = 0.01;

/// Most corners of a triangle that is clipped by the four sides of a cell: seven, and more where rounding makes it not convex.
const MOST_CORNERS: usize = 12;

/// The cells of a grid under a mesh.
#[derive(Clone)]
pub(super) struct Coverage {
    /// The part of each cell that counts as cloth.
    pub parts: Vec<f32>,
    /// Whether the mesh fills the grid.
    pub is_filled: bool,
    /// Whether there is cloth in each cell.
    pub has_cloth: Vec<bool>,
    /// The triangles in each cell.
    pub triangles: Vec<Vec<u32>>,
}

/// How much of each cell is cloth, given the places of the nodes if some are moved; none if the triangles cover a
/// cell by more than its area, or if cells between moved nodes are turned over.
pub(super) fn once(
    positions: &[Vec2],
    triangles: &[[u32; 3]],
    grid: &Grid,
    moved: Option<&[Vec2]>,
) -> Option<Coverage> {
    let spacing = Vec2::from(grid.spacing());
    let cells = [grid.columns - 1, grid.rows - 1];
    let between = |places: &[Vec2]| -> Option<Vec<MovedCell>> {
        let corners = grid.cells().map(|(corners, _)| corners);
        let places = corners.map(|corners| corners.map(|at| places[at as usize] / spacing));
        places.map(MovedCell::between).collect()
    };
    let moved_cells = match moved {
        Some(places) => between(places)?,
        None => Vec::new(),
    };
    // Nodes are moved by up to half a cell.
    let reach = if moved.is_some() { 1.0 } else { 0.0 };
    let mut covered = vec![0.0; (cells[0] * cells[1]) as usize];
    let mut in_cell = vec![Vec::new(); covered.len()];
    for (index, triangle) in (0..).zip(triangles) {
        // In units of cells.
        let corners = triangle.map(|corner| positions[corner as usize] / spacing);
        let low = corners[0].min(corners[1]).min(corners[2]);
        let high = corners[0].max(corners[1]).max(corners[2]);
        let range = |low: f32, high: f32, count: u32| {
            let (low, high) = ((low - reach).max(0.0) as u32, (high + reach).max(0.0) as u32);
            low.min(count - 1)..(high + 1).min(count)
        };
        for row in range(low.y, high.y, cells[1]) {
            for column in range(low.x, high.x, cells[0]) {
                let cell = (row * cells[0] + column) as usize;
                let corner = Vec2::new(column as f32, row as f32);
                let area = match moved_cells.get(cell) {
                    Some(cell) if cell.is_beside(low, high) => 0.0,
                    Some(cell) => cell.part_within(&corners),
                    None => Convex::cell(corner).area_within(&corners),
                };
                covered[cell] += area;
                if area > LEAST_CLOTH {
                    in_cell[cell].push(index);
                }
            }
        }
    }
    let is_once = covered.iter().all(|&part| part < COVERED_ONCE);
    let is_filled = covered.iter().sum::<f32>() > FILLED * covered.len() as f32;
    let has_cloth: Vec<bool> =
        covered.iter().map(|&part| is_filled || part > LEAST_CLOTH).collect();
    let part =
        |(part, has_cloth): (f32, &bool)| if *has_cloth { part.max(LEAST_COVERAGE) } else { 0.0 };
    is_once.then(|| Coverage {
        parts: covered.into_iter().zip(&has_cloth).map(part).collect(),
        is_filled,
        has_cloth,
        triangles: in_cell,
    })
}

/// A cell between moved nodes, in two triangles.
struct MovedCell {
    halves: [Convex<3>; 2],
    area: f32,
    /// The corners of its bounding rectangle.
    low: Vec2,
    high: Vec2,
}

impl MovedCell {
    /// The cell between four corners, row by row, cut along a diagonal that lies in it; none if there is none.
    fn between([a, b, c, d]: [Vec2; 4]) -> Option<Self> {
        let area = |[a, b, c]: [Vec2; 3]| 0.5 * (b - a).perp_dot(c - a);
        let halves = [[[a, b, d], [a, d, c]], [[a, b, c], [b, d, c]]];
        let is_good = |halves: &[[Vec2; 3]; 2]| halves.iter().all(|half| area(*half) > LEAST_HALF);
        let halves = halves.into_iter().find(is_good)?;
        Some(Self {
            area: halves.map(area).iter().sum(),
            halves: halves.map(Convex::triangle),
            low: a.min(b).min(c).min(d),
            high: a.max(b).max(c).max(d),
        })
    }

    /// Whether it lies beside the bounding rectangle of a triangle.
    fn is_beside(&self, low: Vec2, high: Vec2) -> bool {
        low.cmpgt(self.high + BESIDE).any() || high.cmplt(self.low - BESIDE).any()
    }

    fn part_within(&self, triangle: &[Vec2; 3]) -> f32 {
        self.halves.iter().map(|half| half.area_within(triangle)).sum::<f32>() / self.area
    }
}

/// A convex polygon, in units of cells.
struct Convex<const SIDES: usize> {
    origin: Vec2,
    /// Normals of the sides, inwards, and distances of the origin from them.
    sides: [(Vec2, f32); SIDES],
}

impl Convex<4> {
    /// The cell with a corner.
    const fn cell(corner: Vec2) -> Self {
        let sides = [(Vec2::X, 0.0), (Vec2::NEG_X, 1.0), (Vec2::Y, 0.0), (Vec2::NEG_Y, 1.0)];
        Self { origin: corner, sides }
    }
}

impl Convex<3> {
    fn triangle([a, b, c]: [Vec2; 3]) -> Self {
        let side = |from: Vec2, to: Vec2| {
            let normal = (to - from).perp();
            (normal, normal.dot(a - from))
        };
        Self { origin: a, sides: [side(a, b), side(b, c), side(c, a)] }
    }
}

impl<const SIDES: usize> Convex<SIDES> {
    /// The area that is within a triangle (Sutherland and Hodgman 1974).
    fn area_within(&self, triangle: &[Vec2; 3]) -> f32 {
        let mut polygon = [Vec2::ZERO; MOST_CORNERS];
        polygon[..3].copy_from_slice(&triangle.map(|at| at - self.origin));
        let mut count = 3;
        for (normal, offset) in self.sides {
            let inside = |at: Vec2| normal.dot(at) + offset;
            let mut clipped = [Vec2::ZERO; MOST_CORNERS];
            let mut kept = 0;
            let mut push = |at: Vec2| {
                if let Some(corner) = clipped.get_mut(kept) {
                    *corner = at;
                    kept += 1;
                }
            };
            for (index, &from) in polygon[..count].iter().enumerate() {
                let to = polygon[(index + 1) % count];
                let (here, there) = (inside(from), inside(to));
                if here >= 0.0 {
                    push(from);
                }
                if (here >= 0.0) != (there >= 0.0) {
                    push(from.lerp(to, here / (here - there)));
                }
            }
            (polygon, count) = (clipped, kept);
        }
        let polygon = &polygon[..count];
        let next = polygon.iter().cycle().skip(1);
        let doubled = polygon.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f32>();
        0.5 * doubled.abs()
    }
}
