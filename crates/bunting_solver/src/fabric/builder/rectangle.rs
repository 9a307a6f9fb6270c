//! Flat rectangles, however their triangles lie: they are simulated as grids, at a grid's speed.

use std::collections::{BTreeMap, BTreeSet};

use glam::{Vec2, Vec3};

use super::on_surface::OnSurface;
use super::source::FabricBuilder;
use crate::fabric::directions::Towards;
use crate::fabric::error::FabricError;
use crate::fabric::fabric::Fabric;
use crate::fabric::grid::Grid;
use crate::fabric::interpolation::{Interpolation, Term};
use crate::fabric::mesh::RestMesh;
use crate::fabric::regions::MaterialRegion;
use crate::fabric::remesh::{OnNodes, Source};

/// Greatest distance of a vertex from the plane, and of one at the border from the nearest side, as a part of the longer side.
/// Larger: shapes that are no rectangles become ones.
const OFF: f32 = 1e-4;

/// Least length of the mean of the directions of warp, which are unit vectors at twice their angle. Smaller: pieces with warps
/// of their own share one direction.
const ALIKE: f32 = 0.999;

/// Least difference of cos² from one of rows that do not run along the warp: rounding.
const ALONG: f32 = 1e-5;

/// Least number of cells along a side: a single one cannot bend across it.
const FEWEST: f32 = 2.0;

/// Least weight of pinned vertices in a node that is pinned. Smaller: nodes beside a pinned vertex are pinned, too.
const PINNED: f32 = 0.99;

/// Least weight of a node at a pinned vertex that must be pinned, too. Smaller: vertices at nodes that are off by rounding are held by
/// nothing. Larger: pins beside nodes are.
const HELD: f32 = 0.05;

/// Greatest distance of a vertex from a node that is put there, in cells.
const AT_NODE: f32 = 1e-4;

/// How far outside of a triangle a node may lie that is interpolated in it, as a part of the triangle: rounding.
const OUTSIDE: f32 = -0.02;

/// A rectangle in space with the grid that is laid onto it.
pub(super) struct Rectangle {
    pub grid: Grid,
    /// The corner at which the grid begins, m.
    origin: Vec3,
    /// Unit vectors along rows and columns.
    along: [Vec3; 2],
    /// cos² of the angle between rows and warp.
    warp_cos2: f32,
}

impl Rectangle {
    /// The rectangle that a mesh fills, with cells of about a size, m; none if the mesh is no flat rectangle of one warp.
    pub fn of(mesh: &RestMesh, source: &Source, size: f32) -> Option<Self> {
        let border: Vec<[u32; 2]> = source
            .edges
            .iter()
            .filter(|edge| edge.other_side.is_none())
            .map(|edge| edge.ends)
            .collect();
        let vector = |ends: [u32; 2]| {
            let [from, to] = mesh.positions_of(ends);
            to - from
        };
        let length = |ends: &&[u32; 2]| vector(**ends).length_squared();
        let longest = border.iter().max_by(|one, other| length(one).total_cmp(&length(other)))?;
        let twice_areas = mesh.triangles.iter().map(|corners| {
            let [a, b, c] = mesh.positions_of(*corners);
            (b - a).cross(c - a)
        });
        let twice_areas: Vec<Vec3> = twice_areas.collect();
        let normal = twice_areas.iter().sum::<Vec3>().try_normalize()?;
        let side = vector(*longest).reject_from(normal).try_normalize()?;
        let other = normal.cross(side);
        let places = mesh.positions.iter().map(|at| at.dot(normal));
        let (lowest, highest) = extent(places);
        let [(left, right), (bottom, top)] =
            [side, other].map(|axis| extent(mesh.positions.iter().map(|at| at.dot(axis))));
        let off = OFF * (right - left).max(top - bottom);
        let at_side = |at: Vec3| {
            let (x, y) = (at.dot(side), at.dot(other));
            [x - left, right - x, y - bottom, top - y].into_iter().any(|away| away < off)
        };
        let is_filled = || {
            let area = 0.5 * twice_areas.iter().map(|area| area.length()).sum::<f32>();
            let expected = (right - left) * (top - bottom);
            (area - expected).abs() < OFF * expected
        };
        let on_sides = border.as_flattened().iter().all(|at| at_side(mesh.positions[*at as usize]));
        if highest - lowest > off || !on_sides || !is_filled() || !is_one_loop(&border) {
            return None;
        }
        let (mut sum, mut total) = (Vec2::ZERO, 0.0);
        for (triangle, area) in (0..).zip(&twice_areas) {
            let warp = source.directions.of_triangle(triangle, Towards::Warp);
            let warp = Vec2::new(warp.dot(side), warp.dot(other));
            let size = area.length();
            sum += warp.rotate(warp) * size;
            total += size;
        }
        if sum.length() < ALIKE * total {
            return None;
        }
        // Rows run along the side that is nearer to the warp.
        let along_side = 0.5 * (1.0 + sum.x / sum.length());
        let row = if along_side >= 0.5 { side } else { other };
        let cos2 = along_side.max(1.0 - along_side);
        let column = row.cross(normal);
        let [rows, columns] =
            [row, column].map(|axis| extent(mesh.positions.iter().map(|at| at.dot(axis))));
        let (width, height) = (rows.1 - rows.0, columns.1 - columns.0);
        let count = |length: f32| (length / size).round().max(FEWEST) as u32 + 1;
        Some(Self {
            grid: Grid::new(count(width), count(height), width, height),
            origin: row * rows.0 + column * columns.0 + normal * (0.5 * (lowest + highest)),
            along: [row, column],
            warp_cos2: if cos2 > 1.0 - ALONG { 1.0 } else { cos2 },
        })
    }

    /// The fabric of the grid and how the mesh follows; none if a pinned vertex is at no node, and not among pinned ones.
    ///
    /// # Errors
    ///
    /// Those of the grid.
    pub fn laid(
        &self,
        mesh: &RestMesh,
        regions: Vec<MaterialRegion>,
        tethered: bool,
    ) -> Result<Option<OnSurface>, FabricError> {
        let Self { grid, .. } = self;
        let cells: Vec<Vec2> = mesh.positions.iter().map(|at| self.in_cells(*at)).collect();
        let Some(within) = self.nodes_in_triangles(mesh, &cells) else { return Ok(None) };
        let mut positions = Vec::with_capacity(within.len());
        let mut pinned = BTreeSet::new();
        for (node, terms) in (0..).zip(&within) {
            let held = terms.iter().filter(|term| mesh.is_pinned(term.from));
            if held.map(|term| term.weight).sum::<f32>() > PINNED {
                pinned.insert(node);
            }
            let heaviest = Term::heaviest(terms).map_or(0, |term| term.from);
            let away = cells[heaviest as usize] - self.node(node);
            // A node at a vertex is exactly there.
            positions.push(match away.abs().max_element() < AT_NODE {
                true => mesh.positions[heaviest as usize],
                false => self.position(self.node(node)),
            });
        }
        if !self.are_held(mesh, &cells, &pinned) {
            return Ok(None);
        }
        let uv = within
            .iter()
            .map(|terms| terms.iter().map(|term| mesh.uv[term.from as usize] * term.weight).sum());
        let builder =
            FabricBuilder { uv: uv.collect(), positions, pinned, ..FabricBuilder::grid(*grid) };
        let (nodes, surface) = builder.rest_mesh()?;
        let corners: Vec<Vec<Term>> = within.iter().map(|terms| terms.to_vec()).collect();
        // Their weights are those of the mesh's places.
        let builder = FabricBuilder { regions, ..builder };
        let variation = builder.variation_of_grid(&nodes, &surface, grid, || corners.clone());
        let mut rows = Interpolation::default();
        cells.iter().for_each(|at| rows.push(self.around(*at)));
        let fabric = Fabric::of_grid(nodes, &surface, *grid, self.warp_cos2, &variation, tethered);
        let of_place = |row: &[Term]| Term::heaviest(row).map_or(0, |term| term.from);
        let particles = rows.rows().map(of_place).collect();
        let on_nodes = OnNodes { rows, ..OnNodes::default() };
        Ok(Some(OnSurface { fabric, on_nodes, particles, corners }))
    }

    /// Position of a place given in cells, m.
    fn position(&self, at: Vec2) -> Vec3 {
        let [row, column] = self.along;
        let at = at * Vec2::from(self.grid.spacing());
        self.origin + row * at.x + column * at.y
    }

    /// Columns and rows of a place, which are whole at nodes.
    fn in_cells(&self, at: Vec3) -> Vec2 {
        let [row, column] = self.along;
        let away = at - self.origin;
        Vec2::new(away.dot(row), away.dot(column)) / Vec2::from(self.grid.spacing())
    }

    /// Column and row of a node.
    fn node(&self, node: u32) -> Vec2 {
        Vec2::new((node % self.grid.columns) as f32, (node / self.grid.columns) as f32)
    }

    /// The nodes around a place given in cells, with their weights.
    fn around(&self, at: Vec2) -> [Term; 4] {
        let Grid { columns, rows, .. } = self.grid;
        let last = Vec2::new((columns - 2) as f32, (rows - 2) as f32);
        let cell = at.floor().clamp(Vec2::ZERO, last);
        let part = (at - cell).clamp(Vec2::ZERO, Vec2::ONE);
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[right, down]| {
            let of = |part: f32, far: u32| if far == 1 { part } else { 1.0 - part };
            Term {
                from: self.grid.index(cell.x as u32 + right, cell.y as u32 + down),
                weight: of(part.x, right) * of(part.y, down),
            }
        })
    }

    /// For each node the corners of the triangle that it lies in, with their weights, given the vertices in cells; none if a
    /// node lies in no triangle.
    fn nodes_in_triangles(&self, mesh: &RestMesh, cells: &[Vec2]) -> Option<Vec<[Term; 3]>> {
        let Grid { columns, rows, .. } = self.grid;
        let mut best: Vec<Option<(f32, [Term; 3])>> = vec![None; (columns * rows) as usize];
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|corner| cells[corner as usize]);
            let double_area = (b - a).perp_dot(c - a);
            // A hundredth of a cell wider than the triangle, as nodes on the border are off by rounding.
            let low = (a.min(b).min(c) - 0.01).ceil().max(Vec2::ZERO);
            let high = a.max(b).max(c) + 0.01;
            for row in low.y as u32..=(high.y as u32).min(rows - 1) {
                for column in low.x as u32..=(high.x as u32).min(columns - 1) {
                    let node = self.grid.index(column, row);
                    let at = self.node(node);
                    let weights = [
                        (b - at).perp_dot(c - at) / double_area,
                        (c - at).perp_dot(a - at) / double_area,
                        (a - at).perp_dot(b - at) / double_area,
                    ];
                    let least = weights[0].min(weights[1]).min(weights[2]);
                    let known = &mut best[node as usize];
                    if known.is_none_or(|(greatest, _)| least > greatest) {
                        let term = |at: usize| Term { from: corners[at], weight: weights[at] };
                        *known = Some((least, [0, 1, 2].map(term)));
                    }
                }
            }
        }
        best.into_iter().map(|of| of.filter(|(least, _)| *least > OUTSIDE).map(|it| it.1)).collect()
    }

    /// Whether the nodes around each pinned vertex are pinned.
    fn are_held(&self, mesh: &RestMesh, cells: &[Vec2], pinned: &BTreeSet<u32>) -> bool {
        let mut held = (0..).zip(cells).filter(|(place, _)| mesh.is_pinned(*place));
        held.all(|(_, at)| {
            let mut near = self.around(*at).into_iter().filter(|term| term.weight > HELD);
            near.all(|term| pinned.contains(&term.from))
        })
    }
}

/// The least and the greatest of some numbers.
fn extent(values: impl Iterator<Item = f32>) -> (f32, f32) {
    values.fold((f32::INFINITY, f32::NEG_INFINITY), |(least, greatest), value| {
        (least.min(value), greatest.max(value))
    })
}

/// Whether edges at a border are one closed path.
fn is_one_loop(border: &[[u32; 2]]) -> bool {
    let mut at: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &[one, other] in border {
        at.entry(one).or_default().push(other);
        at.entry(other).or_default().push(one);
    }
    if at.values().any(|near| near.len() != 2) {
        return false;
    }
    let Some((&first, near)) = at.first_key_value() else { return false };
    let (mut before, mut here, mut count) = (first, near[0], 1);
    while here != first {
        let next = at[&here].iter().copied().find(|next| *next != before);
        (before, here, count) = (here, next.unwrap_or(first), count + 1);
    }
    count == border.len()
}
