//! Triangle meshes that are no grids, for trials of what artists model.

pub(crate) mod changes;
pub(crate) mod clothes;
pub(crate) mod delaunay;
mod graded;
mod rings;

use std::{f32::consts::TAU, f64, sync::Arc};

use bunting_solver::{Fabric, FabricBuilder, FabricError, Resampled, Resolution};
use glam::{DVec2, Vec2, Vec3};

pub(crate) use rings::{around, ball_with_poles, moebius, sphere, torus};

/// How the triangles of a rectangle lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Triangulation {
    /// Delaunay triangles of points at random, not too close to one another, and of a regular border.
    Delaunay,
    /// Cells whose corners are moved at random, each cut along one of its diagonals at random.
    Quads,
    /// Delaunay triangles as well, as of a scan: the area around a point varies smoothly over the sheet, by a factor of
    /// four.
    Scan,
}

/// A rectangle of triangles from the origin to (width, −height).
#[derive(Clone, Debug)]
pub struct Sheet {
    /// Positions, m.
    pub positions: Vec<Vec3>,
    /// Three vertices per triangle.
    pub indices: Vec<u32>,
}

/// Candidates of which the one farthest from all points becomes the next (Mitchell 1991).
pub(crate) const CANDIDATES: usize = 8;
/// Greatest shift of a cell's corner along each axis, in cells.
const SHIFT: f64 = 0.2;

/// Greatest relative departure of the distance between a scan's points from that on its border, as candidates at random are
/// asked for: with so few of them, areas vary by a factor of four instead of six.
const UNEVENNESS: f64 = 0.42;

/// The fabric of a mesh, of about as many particles as the mesh has vertices.
///
/// # Panics
///
/// When the mesh is no cloth.
#[must_use]
pub fn net(mesh: &FabricBuilder) -> Arc<Fabric> {
    resampled(mesh).expect("a cloth").fabric
}

/// The same with how the mesh follows.
///
/// # Errors
///
/// The mesh is no cloth.
pub fn resampled(mesh: &FabricBuilder) -> Result<Resampled, FabricError> {
    mesh.resampled(Resolution::Particles(mesh.particle_count() as u32))
}

/// Numbers from 0 to 1, one after the other (xorshift, Marsaglia 2003).
pub(crate) struct Random(u64);

impl Random {
    /// The numbers of a seed.
    pub fn of_seed(seed: u64) -> Self {
        let mut random = Self((seed + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
        // Seeds that differ in few bits give numbers alike at first.
        for _ in 0..8 {
            random.next();
        }
        random
    }

    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A place in the unit square.
    pub fn place(&mut self) -> DVec2 {
        DVec2::new(self.next(), self.next())
    }

    /// A number between two others.
    pub fn within(&mut self, least: f64, greatest: f64) -> f64 {
        least + (greatest - least) * self.next()
    }

    /// A whole number from 0 on, less than `end`.
    pub fn below(&mut self, end: usize) -> usize {
        ((self.next() * end as f64) as usize).min(end - 1)
    }
}

impl Sheet {
    /// A sheet with about as many vertices as a grid of `columns` × `rows`. Those of the first columns of the grid, as
    /// many as are `kept`, and of its border are vertices of the sheet.
    #[must_use]
    pub fn new(
        triangulation: Triangulation,
        [columns, rows]: [usize; 2],
        size: DVec2,
        kept: usize,
    ) -> Self {
        let mut random = Random(17);
        let cells = DVec2::new((columns - 1) as f64, (rows - 1) as f64);
        let is_kept = |column: usize, row: usize| {
            column < kept || column.is_multiple_of(columns - 1) || row.is_multiple_of(rows - 1)
        };
        let grid = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        let place = |(column, row): (usize, usize)| DVec2::new(column as f64, row as f64);
        let (points, triangles) = match triangulation {
            Triangulation::Delaunay | Triangulation::Scan => {
                let border = grid.filter(|&(column, row)| is_kept(column, row)).map(place);
                let mut points: Vec<DVec2> = border.collect();
                let length = |at: DVec2| match triangulation {
                    Triangulation::Scan => uneven(at / cells),
                    _ => 1.0,
                };
                while points.len() < columns * rows {
                    let candidate = |_| 0.5 + random.place() * (cells - 1.0);
                    points.extend(farthest((0..CANDIDATES).map(candidate), &points, length));
                }
                let triangles = delaunay::triangulate(&points);
                (points, triangles)
            }
            Triangulation::Quads => {
                let points = grid.map(|at| {
                    let shift = random.place() * 2.0 - 1.0;
                    let moves = !is_kept(at.0, at.1);
                    place(at) + if moves { shift * SHIFT } else { DVec2::ZERO }
                });
                (points.collect(), cut_cells(columns, rows, &mut random))
            }
        };
        let in_space = |at: &DVec2| (*at / cells * size).as_vec2();
        let positions = points.iter().map(in_space).map(|at| Vec3::new(at.x, -at.y, 0.0));
        // The second axis points down, which turns the triangles over.
        let front = triangles.into_iter().flat_map(|[a, b, c]| [a, c, b]);
        Self { positions: positions.collect(), indices: front.map(|at| at as u32).collect() }
    }

    /// The sheet as a fabric of two pieces that share a seam halfway down, with pins. The warp of the upper one runs
    /// along the rows, that of the lower one down the columns.
    ///
    /// # Panics
    ///
    /// When it is not a cloth.
    #[must_use]
    pub fn of_two_pieces(&self, is_pinned: impl Fn(Vec3) -> bool) -> Arc<Fabric> {
        let height = self.positions.iter().map(|at| -at.y).fold(0.0, f32::max);
        let (mut positions, mut uv) = (Vec::new(), Vec::new());
        for corners in self.indices.chunks_exact(3) {
            let corners = [0, 1, 2].map(|corner| self.positions[corners[corner] as usize]);
            let is_low = corners.iter().map(|at| -at.y).sum::<f32>() > 1.5 * height;
            for at in corners {
                positions.push(at);
                uv.push(if is_low {
                    Vec2::new(at.y - height, at.x)
                } else {
                    Vec2::new(at.x, at.y)
                });
            }
        }
        let indices = (0..positions.len() as u32).collect();
        let builder = FabricBuilder::new(positions, indices).uv(uv).weld_distance(1e-6 * height);
        net(&builder.pin_where(|at, _| is_pinned(at)))
    }

    /// The sheet as a fabric whose warp runs at an angle to its rows, rad, with pins.
    ///
    /// # Panics
    ///
    /// When it is not a cloth.
    #[must_use]
    pub fn fabric(&self, warp: f32, is_pinned: impl Fn(Vec3) -> bool) -> Arc<Fabric> {
        net(&self.builder(warp, is_pinned))
    }

    /// The builder of that fabric.
    pub fn builder(&self, warp: f32, is_pinned: impl Fn(Vec3) -> bool) -> FabricBuilder {
        let (sin, cos) = warp.sin_cos();
        let turned = |at: &Vec3| Vec2::new(cos * at.x - sin * at.y, sin * at.x + cos * at.y);
        let uv = self.positions.iter().map(turned).collect();
        let builder = FabricBuilder::new(self.positions.clone(), self.indices.clone()).uv(uv);
        builder.pin_where(|at, _| is_pinned(at))
    }
}

impl Sheet {
    /// A sheet of a metre with a hole of the given radius, m, in its middle.
    #[must_use]
    pub fn with_hole(&self, radius: f32) -> FabricBuilder {
        let middle = Vec3::new(0.5, -0.5, 0.0);
        let is_cloth = |corner: &u32| self.positions[*corner as usize].distance(middle) > radius;
        let kept = self.indices.chunks_exact(3).filter(|corners| corners.iter().all(is_cloth));
        let corners: Vec<Vec3> =
            kept.flatten().map(|&corner| self.positions[corner as usize]).collect();
        let indices = (0..corners.len() as u32).collect();
        FabricBuilder::new(corners, indices)
    }

    /// The sheet with a slit a thousandth as wide as the sheet is high, along edges of triangles from the middle of its lower side to
    /// its centre.
    #[must_use]
    pub fn with_slit(&self) -> Self {
        let Self { mut positions, mut indices } = self.clone();
        let height = -self.positions.iter().map(|at| at.y).fold(0.0, f32::min);
        let slit = self.path_up(height);
        if slit.len() < 2 {
            return self.clone();
        }
        let places: Vec<Vec3> = slit.iter().map(|&at| self.positions[at as usize]).collect();
        // The place of the slit at a height.
        let middle = |y: f32| {
            let piece = places.windows(2).find(|ends| y <= ends[1].y);
            let (from, to) = piece.map_or((places[0], places[1]), |ends| (ends[0], ends[1]));
            from.x + (to.x - from.x) * (y - from.y) / (to.y - from.y)
        };
        let opened = &slit[..slit.len() - 1];
        let first = positions.len() as u32;
        let gap = Vec3::X * (5e-4 * height);
        for &vertex in opened {
            let at = positions[vertex as usize];
            positions.push(at + gap);
            positions[vertex as usize] = at - gap;
        }
        for corners in indices.chunks_exact_mut(3) {
            let centre = corners.iter().map(|&at| self.positions[at as usize]).sum::<Vec3>() / 3.0;
            for corner in corners {
                let in_slit = opened.iter().position(|at| at == corner);
                if let Some(at) = in_slit.filter(|_| centre.x > middle(centre.y)) {
                    *corner = first + at as u32;
                }
            }
        }
        Self { positions, indices }
    }

    /// Vertices from the middle of the lower side up to the centre, each joined to the next by an edge.
    fn path_up(&self, height: f32) -> Vec<u32> {
        let width = self.positions.iter().map(|at| at.x).fold(0.0, f32::max);
        let centre = Vec3::new(0.5 * width, -0.5 * height, 0.0);
        let place = |vertex: u32| self.positions[vertex as usize];
        let nearest = |vertices: &mut dyn Iterator<Item = u32>, to: Vec3| {
            vertices.min_by(|a, b| place(*a).distance(to).total_cmp(&place(*b).distance(to)))
        };
        let count = self.positions.len() as u32;
        let start = nearest(&mut (0..count), centre.with_y(-height));
        let next = |&from: &u32| {
            let beside = self.indices.chunks_exact(3).filter(|corners| corners.contains(&from));
            let above = |vertex: &u32| place(*vertex).y > place(from).y;
            let mut above = beside.flatten().copied().filter(above);
            nearest(&mut above, centre).filter(|vertex| place(*vertex).y < centre.y)
        };
        std::iter::successors(start, next).collect()
    }

    /// The positions of a sheet of a metre drawn out to a disk about the origin, of a radius, m.
    #[must_use]
    pub fn round(&self, radius: f32) -> Vec<Vec3> {
        let to_disk = |at: &Vec3| {
            let (x, y) = (2.0 * at.x - 1.0, 2.0 * at.y + 1.0);
            Vec3::new(x * (1.0 - 0.5 * y * y).sqrt(), y * (1.0 - 0.5 * x * x).sqrt(), 0.0) * radius
        };
        self.positions.iter().map(to_disk).collect()
    }

    /// The positions of the sheet bent about a vertical axis, to a radius, m.
    #[must_use]
    pub fn bent(&self, radius: f32) -> Vec<Vec3> {
        let around = |at: &Vec3| {
            let (sin, cos) = (at.x / radius).sin_cos();
            Vec3::new(radius * sin, at.y, radius * cos)
        };
        self.positions.iter().map(around).collect()
    }

    /// The sheet rolled up about a vertical axis until its sides meet, where its texture has a seam; with pins.
    ///
    /// # Panics
    ///
    /// When it is not a cloth.
    #[must_use]
    pub fn rolled_up(&self, is_pinned: impl Fn(Vec3) -> bool) -> Arc<Fabric> {
        let width = self.positions.iter().map(|at| at.x).fold(0.0, f32::max);
        let positions = self.bent(width / TAU);
        let uv = self.positions.iter().map(|at| Vec2::new(at.x, -at.y)).collect();
        let builder = FabricBuilder::new(positions, self.indices.clone()).uv(uv);
        net(&builder.weld_distance(1e-5 * width).pin_where(|at, _| is_pinned(at)))
    }
}

/// Distance between the points of a scan at a place of the unit square, over that on its border.
pub(crate) fn uneven(at: DVec2) -> f64 {
    let [x, y] = at.to_array().map(|part| libm::sin(f64::consts::TAU * part));
    1.0 + UNEVENNESS * x * y
}

/// The candidate that is farthest from all points, over the length that points at its place are to be apart; none if there is
/// none.
pub(crate) fn farthest(
    candidates: impl Iterator<Item = DVec2>,
    points: &[DVec2],
    length: impl Fn(DVec2) -> f64,
) -> Option<DVec2> {
    let nearest = |at: DVec2| {
        let squares = points.iter().map(|point| point.distance_squared(at));
        squares.fold(f64::INFINITY, f64::min) / length(at).powi(2)
    };
    candidates.max_by(|a, b| nearest(*a).total_cmp(&nearest(*b)))
}

/// Two triangles for each cell, counter-clockwise if the second axis points up.
fn cut_cells(columns: usize, rows: usize, random: &mut Random) -> Vec<[usize; 3]> {
    let mut triangles = Vec::new();
    for (row, column) in (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |at| (row, at))) {
        let corner = |right: usize, up: usize| (row + up) * columns + column + right;
        let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
        triangles.extend(if random.next() < 0.5 {
            [[a, d, c], [a, b, d]]
        } else {
            [[a, b, c], [b, d, c]]
        });
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_around_the_points_of_a_scan_vary_fourfold() {
        let sheet = Sheet::new(Triangulation::Scan, [33, 33], DVec2::ONE, 1);
        let within = |x: f32, y: f32| {
            let middle = Vec3::new(x, -y, 0.0);
            sheet.positions.iter().filter(|at| at.distance(middle) < 0.12).count()
        };
        let dense = within(0.75, 0.25) + within(0.25, 0.75);
        let sparse = within(0.25, 0.25) + within(0.75, 0.75);
        // Around the middles of the quarters, where areas are least and largest; in the mean of these disks a ratio of 4 is 2.8.
        assert!((2.4..3.4).contains(&(dense as f64 / sparse as f64)), "{dense}, {sparse}");
        assert_eq!(sheet.positions.len(), 33 * 33);
    }
}
