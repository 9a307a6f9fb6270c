//! Garments at random: panels that are sewn along their borders where these are not open.

use bunting_solver::FabricBuilder;
use glam::{DVec2, IVec2, Vec2, Vec3};

use super::pieces::largest_piece;
use crate::meshes::{CANDIDATES, Random, delaunay, farthest, uneven};

/// The cells of a lattice that are cloth, and which sides are open.
struct Outline {
    columns: i32,
    rows: i32,
    is_cloth: Vec<bool>,
    /// Whether the upper, the lower and the outer sides are open.
    open: [bool; 3],
}

/// A panel in the plane, in cells.
struct Panel {
    places: Vec<Vec2>,
    triangles: Vec<[usize; 3]>,
}

/// A garment of quads, some of them moved at random and cut either way.
pub fn of_quads(random: &mut Random) -> FabricBuilder {
    let outline = Outline::at_random(random);
    let shift = [0.0, random.within(0.0, 0.3) as f32][random.below(2)];
    let panel = outline.quads(shift, random);
    outline.sewn(&panel, random)
}

/// A garment of Delaunay triangles, all of about one size or of areas that vary fourfold.
pub fn of_triangles(random: &mut Random) -> FabricBuilder {
    let outline = Outline::at_random(random);
    let is_even = random.next() < 0.5;
    let panel = outline.delaunay(random, |at| if is_even { 1.0 } else { uneven(at) });
    outline.sewn(&panel, random)
}

impl Outline {
    fn at_random(random: &mut Random) -> Self {
        let [columns, rows] = [6 + random.below(12) as i32, 8 + random.below(16) as i32];
        let kind = random.below(5);
        let [across, down] =
            [columns, rows].map(|cells| 2 + random.below(cells as usize / 2) as i32);
        let hole =
            IVec2::new(random.below(columns as usize) as i32, random.below(rows as usize) as i32);
        let radius = [0.0, random.within(1.0, 3.0)][random.below(2)];
        let cells =
            (0..rows).flat_map(|row| (0..columns).map(move |column| IVec2::new(column, row)));
        let is_cloth = cells.map(|cell| {
            let from_middle = (2 * cell.x + 1 - columns).abs();
            let in_shape = match kind {
                // Trousers, a shirt, a cross, a bag, a coat that is open below.
                0 => cell.y < down || from_middle > 1,
                1 => cell.y < down || from_middle < across,
                2 => from_middle < across || (cell.y - rows / 2).abs() < down / 2 + 1,
                3 => true,
                _ => cell.y < down || (from_middle - across).abs() > 1,
            };
            in_shape && (cell - hole).as_dvec2().length() >= radius
        });
        let is_cloth = is_cloth.collect();
        let open = [0; 3].map(|_| random.next() < 0.6);
        Self { columns, rows, is_cloth, open }.largest_piece()
    }

    /// The cells of the largest piece.
    fn largest_piece(self) -> Self {
        let beside = |cell: usize| {
            let [column, row] = [cell as i32 % self.columns, cell as i32 / self.columns];
            let around = [[1, 0], [-1, 0], [0, 1], [0, -1]];
            let around = around.map(|[right, down]| [column + right, row + down]);
            let joined =
                around.into_iter().filter(|next| self.is_cloth[cell] && self.is_cloth(*next));
            joined.map(|[column, row]| (row * self.columns + column) as usize).collect()
        };
        let is_cloth = largest_piece(self.is_cloth.len(), beside);
        Self { is_cloth, ..self }
    }

    fn is_cloth(&self, [column, row]: [i32; 2]) -> bool {
        (0..self.columns).contains(&column)
            && (0..self.rows).contains(&row)
            && self.is_cloth[(row * self.columns + column) as usize]
    }

    fn cells(&self) -> impl Iterator<Item = [i32; 2]> {
        let cells =
            (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| [column, row]));
        cells.filter(|cell| self.is_cloth(*cell))
    }

    /// How many of the four cells around a corner are cloth.
    fn cells_around(&self, [column, row]: [i32; 2]) -> usize {
        let around = [[-1, -1], [0, -1], [-1, 0], [0, 0]];
        around.iter().filter(|[right, down]| self.is_cloth([column + right, row + down])).count()
    }

    fn corners(&self) -> impl Iterator<Item = [i32; 2]> {
        let corners =
            (0..=self.rows).flat_map(|row| (0..=self.columns).map(move |column| [column, row]));
        corners.filter(|corner| self.cells_around(*corner) > 0)
    }

    fn quads(&self, shift: f32, random: &mut Random) -> Panel {
        let corners: Vec<[i32; 2]> = self.corners().collect();
        let place = |corner: &[i32; 2]| {
            let moved = (2.0 * random.place() - 1.0).as_vec2() * shift;
            let is_inside = self.cells_around(*corner) == 4;
            Vec2::new(corner[0] as f32, corner[1] as f32)
                + if is_inside { moved } else { Vec2::ZERO }
        };
        let places = corners.iter().map(place).collect();
        let number = |at: [i32; 2]| {
            corners.iter().position(|corner| *corner == at).expect("a corner of a cell")
        };
        let triangles = self.cells().flat_map(|[column, row]| {
            let corners =
                [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[right, down]| [column + right, row + down]);
            // A diagonal from a corner of the panel, since the triangle that another would cut off has nothing but seams.
            let ends_at_corner =
                |ends: [usize; 2]| ends.iter().any(|end| self.cells_around(corners[*end]) == 1);
            let falls = shift > 0.0 && random.next() < 0.5;
            let falls = (falls || ends_at_corner([0, 3])) && !ends_at_corner([1, 2]);
            let [a, b, c, d] = corners.map(number);
            if falls { [[a, c, d], [a, d, b]] } else { [[a, c, b], [b, c, d]] }
        });
        Panel { places, triangles: triangles.collect() }
    }

    /// Delaunay triangles, given how far apart their corners are to be at a place of the unit square, over those of the border.
    fn delaunay(&self, random: &mut Random, length: impl Fn(DVec2) -> f64) -> Panel {
        let (inner, border): (Vec<_>, Vec<_>) =
            self.corners().partition(|corner| self.cells_around(*corner) == 4);
        let in_plane = |[column, row]: &[i32; 2]| DVec2::new(f64::from(*column), f64::from(*row));
        let mut places: Vec<DVec2> = border.iter().map(in_plane).collect();
        let size = DVec2::new(f64::from(self.columns), f64::from(self.rows));
        for _ in inner {
            let is_inside = |at: &DVec2| {
                let corners = [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]].map(DVec2::from);
                let cell = |by: DVec2| (*at + by).floor().as_ivec2().to_array();
                corners.into_iter().all(|by| self.is_cloth(cell(by)))
            };
            let candidates = (0..2 * CANDIDATES).map(|_| random.place() * size).filter(is_inside);
            places.extend(farthest(candidates, &places, |at| length(at / size)));
        }
        // Shifted a little, so that no four of them lie on one circle.
        let shifted: Vec<DVec2> = places.iter().map(|at| *at + 1e-5 * random.place()).collect();
        let is_cloth = |corners: &[usize; 3]| {
            let [a, b, c] = corners.map(|at| places[at]);
            let middle = (a + b + c) / 3.0;
            self.is_cloth(middle.floor().as_ivec2().to_array())
                && ((b - a).perp_dot(c - a)).abs() > 1e-3
        };
        let triangles = delaunay::triangulate(&shifted).into_iter().filter(is_cloth);
        // The second axis points down, which turns the triangles over.
        let triangles = triangles.map(|[a, b, c]| [a, c, b]).collect();
        Panel { places: places.iter().map(|at| at.as_vec2()).collect(), triangles }
    }

    /// Distance of a place from the sides that are sewn, in cells.
    fn distance_to_seams(&self, place: Vec2) -> f32 {
        let mut least = f32::INFINITY;
        let [upper, lower, outer] = self.open;
        for [column, row] in self.cells() {
            let (x, y) = (column as f32, row as f32);
            let sides = [
                ([0, -1], [x, y], [x + 1.0, y], upper && row == 0),
                ([0, 1], [x, y + 1.0], [x + 1.0, y + 1.0], lower && row == self.rows - 1),
                ([-1, 0], [x, y], [x, y + 1.0], outer && column == 0),
                ([1, 0], [x + 1.0, y], [x + 1.0, y + 1.0], outer && column == self.columns - 1),
            ];
            for ([right, down], from, to, is_open) in sides {
                if is_open || self.is_cloth([column + right, row + down]) {
                    continue;
                }
                let (from, to) = (Vec2::from(from), Vec2::from(to));
                let along = (place - from).dot(to - from).clamp(0.0, 1.0);
                least = least.min(place.distance(from + (to - from) * along));
            }
        }
        least
    }

    /// A front and a back of a panel, sewn along the sides that are not open, or a single one.
    fn sewn(&self, panel: &Panel, random: &mut Random) -> FabricBuilder {
        let size = random.within(0.5, 1.5) as f32 / (self.columns.max(self.rows)) as f32;
        let bulge = random.within(1.0, 3.0) as f32;
        let depths: Vec<f32> = panel
            .places
            .iter()
            .map(|place| {
                let part = (self.distance_to_seams(*place) / 3.0).min(1.0);
                bulge * (1.0 - (1.0 - part).powi(2))
            })
            .collect();
        let sides: &[f32] = if random.next() < 0.8 { &[1.0, -1.0] } else { &[1.0] };
        let (mut positions, mut uv, mut indices) = (Vec::new(), Vec::new(), Vec::new());
        for &side in sides {
            let first = positions.len() as u32;
            for (place, depth) in panel.places.iter().zip(&depths) {
                positions.push(Vec3::new(place.x, -place.y, side * depth) * size);
                uv.push(Vec2::new(side * place.x, place.y) * size);
            }
            // Corners that are cut off have three vertices on seams, and their inner sides would be those of four triangles.
            let cut_off = |corners: &&[usize; 3]| corners.iter().all(|at| depths[*at] < 1e-3);
            for &[a, b, c] in panel.triangles.iter().filter(|corners| !cut_off(corners)) {
                let corners = if side > 0.0 { [a, b, c] } else { [a, c, b] };
                indices.extend(corners.map(|at| first + at as u32));
            }
        }
        let used = used_vertices(positions.len(), &mut indices);
        let positions = used.iter().map(|&vertex| positions[vertex]).collect();
        let uv = used.iter().map(|&vertex| uv[vertex]).collect();
        let mesh = FabricBuilder::new(positions, indices);
        let mesh = if random.next() < 0.5 { mesh.uv(uv) } else { mesh };
        mesh.weld_distance(1e-4 * size)
    }
}

/// The vertices of triangles, in their order; the triangles' corners become places in this list.
fn used_vertices(vertices: usize, corners: &mut [u32]) -> Vec<usize> {
    let mut is_used = vec![false; vertices];
    corners.iter().for_each(|&corner| is_used[corner as usize] = true);
    let used: Vec<usize> = (0..vertices).filter(|&vertex| is_used[vertex]).collect();
    for corner in corners {
        *corner = used.partition_point(|&vertex| vertex < *corner as usize) as u32;
    }
    used
}
