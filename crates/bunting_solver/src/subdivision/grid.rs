//! Subdivision of grids: the four-point scheme along rows and columns (Dyn, Levin and Gregory 1987), whose limit has
//! continuous tangents.

use glam::Vec3;

use crate::simd::level::dispatch;
use crate::subdivision::stencils::Stencils;

/// Square of a length below which a normal counts as none.
const LEAST_SQUARE: f32 = f32::MIN_POSITIVE;

/// Buffers that are kept from cloth to cloth: the coordinates x, y and z apart, so that rows fill vectors.
#[derive(Clone, Debug, Default)]
pub struct GridPlanes {
    planes: [Vec<f32>; 3],
    /// A plane whose rows are refined.
    wide: Vec<f32>,
    /// Slopes along rows, slopes along columns, and normals.
    slopes: [[Vec<f32>; 3]; 3],
}

/// A grid whose cells are halved several times.
#[derive(Clone, Copy, Debug)]
pub(super) struct GridScheme {
    columns: usize,
    rows: usize,
    steps: u32,
}

impl GridScheme {
    pub fn new(columns: u32, rows: u32, steps: u32) -> Self {
        Self { columns: columns as usize, rows: rows as usize, steps }
    }

    /// Number of drawn columns and rows.
    pub fn drawn(&self) -> [usize; 2] {
        [self.columns, self.rows].map(|count| ((count - 1) << self.steps) + 1)
    }

    /// The drawn vertex of each particle.
    pub fn kept(&self) -> Vec<u32> {
        let [width, _] = self.drawn();
        (0..self.rows)
            .flat_map(|row| (0..self.columns).map(move |column| (column, row)))
            .map(|(column, row)| ((row * width + column) << self.steps) as u32)
            .collect()
    }

    /// Bilinear weights of the particles at each drawn vertex.
    pub fn bilinear(&self) -> Stencils {
        let [width, height] = self.drawn();
        let cells = 1 << self.steps;
        let ends = |at: usize, count: usize| {
            let (left, part) = (at / cells, (at % cells) as f32 / cells as f32);
            [(left, 1.0 - part), ((left + 1).min(count - 1), part)]
        };
        let mut stencils = Stencils::default();
        for down in (0..height).map(|row| ends(row, self.rows)) {
            for across in (0..width).map(|column| ends(column, self.columns)) {
                let terms = down.into_iter().flat_map(|(row, by)| {
                    across
                        .map(|(column, weight)| ((row * self.columns + column) as u32, weight * by))
                });
                stencils.push(terms.filter(|term| term.1 > 0.0));
            }
        }
        stencils
    }

    /// Two triangles a drawn cell, whose diagonals alternate.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let [width, height] = self.drawn().map(|count| count as u32);
        let cells = (0..height - 1).flat_map(|row| (0..width - 1).map(move |column| (column, row)));
        cells
            .flat_map(|(column, row)| {
                let at = row * width + column;
                let [a, b, c, d] = [at, at + 1, at + width, at + width + 1];
                if (column + row).is_multiple_of(2) {
                    [[a, c, d], [a, d, b]]
                } else {
                    [[a, c, b], [b, c, d]]
                }
            })
            .collect()
    }

    /// Number of drawn vertices over which differences are taken on either side, for `count` of them: one cell of the
    /// particles. Normals at particles then hardly depend on how finely the surface is drawn, and the shading does
    /// not show what lies between particles by chance.
    fn reach(&self, count: usize) -> usize {
        (1 << self.steps).min((count - 1) / 2)
    }

    /// Writes positions and normals of the drawn vertices.
    pub fn evaluate(
        &self,
        positions: &[Vec3],
        buffers: &mut GridPlanes,
        drawn: &mut [[f32; 3]],
        normals: &mut [[f32; 3]],
    ) {
        dispatch!(_ => {
            self.refine(positions, buffers);
            self.write(buffers, drawn, normals);
        });
    }

    #[inline(always)]
    fn refine(&self, positions: &[Vec3], buffers: &mut GridPlanes) {
        let GridPlanes { planes, wide, .. } = buffers;
        for (axis, plane) in planes.iter_mut().enumerate() {
            plane.clear();
            plane.extend(positions.iter().map(|position| position[axis]));
            let (mut columns, mut rows) = (self.columns, self.rows);
            for _ in 0..self.steps {
                let [width, height] = [columns, rows].map(|count| 2 * count - 1);
                wide.resize(width * rows, 0.0);
                for (from, to) in plane.chunks_exact(columns).zip(wide.chunks_exact_mut(width)) {
                    refine_row(from, to);
                }
                plane.resize(width * height, 0.0);
                refine_columns(wide, plane, width, rows);
                (columns, rows) = (width, height);
            }
        }
    }

    #[inline(always)]
    fn write(&self, buffers: &mut GridPlanes, drawn: &mut [[f32; 3]], normals: &mut [[f32; 3]]) {
        let [width, height] = self.drawn();
        let [reach, reach_down] = [width, height].map(|count| self.reach(count));
        let GridPlanes { planes, slopes: [along, across, normal], .. } = buffers;
        for buffer in along.iter_mut().chain(&mut *across).chain(&mut *normal) {
            buffer.resize(width * height, 0.0);
        }
        // Whole planes: rows are too short for their remainders not to count.
        for ((plane, along), across) in planes.iter().zip(&mut *along).zip(&mut *across) {
            slopes_along_rows(plane, width, reach, along);
            slopes_along_columns(plane, width, reach_down, across);
        }
        cross(across, along, normal);
        interleave(planes, drawn);
        interleave(normal, normals);
    }
}

/// Halves the intervals of a row. In the first and the last interval a parabola replaces the cubic.
#[inline(always)]
fn refine_row(from: &[f32], to: &mut [f32]) {
    let count = from.len();
    for (pair, near) in to[2..].chunks_exact_mut(2).zip(from.windows(4)) {
        pair[0] = near[1];
        pair[1] = 0.5625 * (near[1] + near[2]) - 0.0625 * (near[0] + near[3]);
    }
    to[0] = from[0];
    to[2 * count - 2] = from[count - 1];
    if count == 2 {
        to[1] = 0.5 * (from[0] + from[1]);
        return;
    }
    to[2 * count - 4] = from[count - 2];
    to[1] = parabola(from[0], from[1], from[2]);
    to[2 * count - 3] = parabola(from[count - 1], from[count - 2], from[count - 3]);
}

/// Halves the intervals of all columns.
#[inline(always)]
fn refine_columns(from: &[f32], to: &mut [f32], width: usize, rows: usize) {
    let row = |at: usize| &from[at * width..(at + 1) * width];
    for at in 0..rows {
        let (kept, between) = to[2 * at * width..].split_at_mut(width);
        kept.copy_from_slice(row(at));
        if at + 1 == rows {
            break;
        }
        let between = &mut between[..width];
        if rows == 2 {
            for ((to, a), b) in between.iter_mut().zip(row(0)).zip(row(1)) {
                *to = 0.5 * (a + b);
            }
        } else if at == 0 || at + 2 == rows {
            let [end, middle, far] =
                if at == 0 { [0, 1, 2] } else { [rows - 1, rows - 2, rows - 3] };
            let three = row(end).iter().zip(row(middle)).zip(row(far));
            for (to, ((a, b), c)) in between.iter_mut().zip(three) {
                *to = parabola(*a, *b, *c);
            }
        } else {
            let inner = row(at).iter().zip(row(at + 1));
            let outer = row(at - 1).iter().zip(row(at + 2));
            for (to, ((b, c), (a, d))) in between.iter_mut().zip(inner.zip(outer)) {
                *to = 0.5625 * (b + c) - 0.0625 * (a + d);
            }
        }
    }
}

/// The middle of the first interval of a parabola through three values.
#[inline(always)]
fn parabola(end: f32, middle: f32, far: f32) -> f32 {
    0.375 * end + 0.75 * middle - 0.125 * far
}

/// Slopes along rows, each times a length: central differences, and at the ends of a row the slopes of a parabola.
#[inline(always)]
fn slopes_along_rows(plane: &[f32], width: usize, reach: usize, to: &mut [f32]) {
    differences(plane, reach, to);
    let last = width - 1;
    for (row, to) in plane.chunks_exact(width).zip(to.chunks_exact_mut(width)) {
        for at in 1..reach {
            to[at] = row[2 * at] - row[0];
            to[last - at] = row[last] - row[last - 2 * at];
        }
        to[0] = 4.0 * row[reach] - 3.0 * row[0] - row[2 * reach];
        to[last] = 3.0 * row[last] - 4.0 * row[last - reach] + row[last - 2 * reach];
    }
}

/// Slopes along columns, as [`slopes_along_rows`].
#[inline(always)]
fn slopes_along_columns(plane: &[f32], width: usize, reach: usize, to: &mut [f32]) {
    differences(plane, reach * width, to);
    let row = |at: usize| &plane[at * width..(at + 1) * width];
    let last = plane.len() / width - 1;
    for at in 1..reach {
        difference([row(0), row(2 * at)], &mut to[at * width..]);
        difference([row(last - 2 * at), row(last)], &mut to[(last - at) * width..]);
    }
    one_sided([row(0), row(reach), row(2 * reach)], 1.0, to);
    let end = [row(last), row(last - reach), row(last - 2 * reach)];
    one_sided(end, -1.0, &mut to[last * width..]);
}

/// Differences of the values `reach` places after and before each; none where there are no such places.
#[inline(always)]
fn differences(plane: &[f32], reach: usize, to: &mut [f32]) {
    difference([plane, &plane[2 * reach..]], &mut to[reach..]);
}

/// The second values less the first.
#[inline(always)]
fn difference([before, after]: [&[f32]; 2], to: &mut [f32]) {
    for (to, (before, after)) in to.iter_mut().zip(before.iter().zip(after)) {
        *to = after - before;
    }
}

/// Slopes at the first of three rows, times a length and a sign.
#[inline(always)]
fn one_sided([first, second, third]: [&[f32]; 3], sign: f32, to: &mut [f32]) {
    for (to, ((a, b), c)) in to.iter_mut().zip(first.iter().zip(second).zip(third)) {
        *to = sign * (4.0 * b - 3.0 * a - c);
    }
}

/// The unit vectors along the products of vectors.
#[inline(always)]
fn cross(a: &[Vec<f32>; 3], b: &[Vec<f32>; 3], to: &mut [Vec<f32>; 3]) {
    let count = to[0].len();
    let [ax, ay, az] = [&a[0][..count], &a[1][..count], &a[2][..count]];
    let [bx, by, bz] = [&b[0][..count], &b[1][..count], &b[2][..count]];
    let [x, y, z] = to;
    let [x, y, z] = [&mut x[..count], &mut y[..count], &mut z[..count]];
    for at in 0..count {
        let nx = ay[at] * bz[at] - az[at] * by[at];
        let ny = az[at] * bx[at] - ax[at] * bz[at];
        let nz = ax[at] * by[at] - ay[at] * bx[at];
        let square = nx * nx + ny * ny + nz * nz;
        let square = if square > LEAST_SQUARE { square } else { LEAST_SQUARE };
        let scale = 1.0 / square.sqrt();
        x[at] = nx * scale;
        y[at] = ny * scale;
        z[at] = nz * scale;
    }
}

/// Writes vectors.
#[inline(always)]
fn interleave([x, y, z]: &[Vec<f32>; 3], to: &mut [[f32; 3]]) {
    let count = to.len();
    let (x, y, z) = (&x[..count], &y[..count], &z[..count]);
    for (at, to) in to.iter_mut().enumerate() {
        *to = [x[at], y[at], z[at]];
    }
}
