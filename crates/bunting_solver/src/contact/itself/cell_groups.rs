//! Eight cells whose triangles join their particles in the same way: their cones are computed at once, one cell in each
//! lane, and a particle is gathered once for all triangles of its cell.

use core::ops::Range;

use fearless_simd::{Simd, f32x8};
use glam::Vec3;

use crate::constants::LEAST_AREA_SQUARED;
use crate::contact::itself::flat::{Cone, compute_cones};
use crate::contact::itself::patches::Cell;
use crate::simd::lane::{Lane, Pack};
use crate::simd::level::dispatch;
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::vec3::{V3, lane3};

/// Most particles of a cell in a group: those of eight triangles in a strip.
const MOST_PARTICLES: usize = 10;

/// Eight cells in succession.
#[derive(Clone, Debug)]
struct CellGroup {
    first: usize,
    /// The particles of the cells, one cell in each lane.
    particles: Vec<[u32; Pack8::WIDTH]>,
    /// Indices of each triangle's corners among the particles of its cell, the same in all cells.
    triangles: Vec<[u8; 3]>,
}

/// The cells of a mesh in groups, as far as they are alike.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct CellGroups {
    groups: Vec<CellGroup>,
    /// Indices of all other cells, in runs.
    others: Vec<Range<usize>>,
}

impl CellGroups {
    pub fn of(cells: &[Cell]) -> Self {
        let corners: Vec<Option<Vec<[u8; 3]>>> = cells.iter().map(corners_in_cell).collect();
        let mut all = Self::default();
        let mut first = 0;
        while first < cells.len() {
            let group = first..first + Pack8::WIDTH;
            let is_alike = |at: usize| corners.get(at) == corners.get(first);
            match &corners[first] {
                Some(triangles) if group.clone().all(is_alike) => {
                    let of_slot = |slot: usize| {
                        core::array::from_fn(|lane| cells[first + lane].particles[slot])
                    };
                    let particles = (0..cells[first].particles.len()).map(of_slot).collect();
                    all.groups.push(CellGroup { first, particles, triangles: triangles.clone() });
                    first = group.end;
                }
                _ => {
                    match all.others.last_mut() {
                        Some(run) if run.end == first => run.end += 1,
                        _ => all.others.push(first..first + 1),
                    }
                    first += 1;
                }
            }
        }
        all
    }

    /// Computes the cones about the normals of all cells at the end of the substep, given the positions of all particles then, m.
    pub fn compute_cones(&self, cells: &[Cell], ends: &[Pack4], cones: &mut [Cone]) {
        dispatch!(token => compute_groups(token, &self.groups, ends, cones));
        for run in &self.others {
            compute_cones(&cells[run.clone()], ends, &mut cones[run.clone()]);
        }
    }
}

#[inline(always)]
fn compute_groups<S: Simd>(token: S, groups: &[CellGroup], ends: &[Pack4], cones: &mut [Cone]) {
    for group in groups {
        group.compute_cones(token, ends, &mut cones[group.first..group.first + Pack8::WIDTH]);
    }
}

/// Indices of the corners of a cell's triangles among its particles; none if it has too many particles.
fn corners_in_cell(cell: &Cell) -> Option<Vec<[u8; 3]>> {
    if cell.particles.len() > MOST_PARTICLES {
        return None;
    }
    let index = |lane: usize, corner: usize| {
        cell.particles.binary_search(&cell.corners[corner][lane]).ok().map(|at| at as u8)
    };
    (0..cell.triangles.len())
        .map(|lane| Some([index(lane, 0)?, index(lane, 1)?, index(lane, 2)?]))
        .collect()
}

impl CellGroup {
    #[inline(always)]
    fn compute_cones<S: Simd>(&self, token: S, ends: &[Pack4], cones: &mut [Cone]) {
        let zero = V3::<f32x8<S>>::splat(token, 0.0);
        let mut at = [zero; MOST_PARTICLES];
        for (at, particles) in at.iter_mut().zip(&self.particles) {
            *at = V3::gather(token, ends, particles);
        }
        let least = <f32x8<S> as Lane>::splat(token, LEAST_AREA_SQUARED);
        let one = <f32x8<S> as Lane>::splat(token, 1.0);
        let mut normals = [zero; Pack8::WIDTH];
        let mut sum = zero;
        for (normal, corners) in normals.iter_mut().zip(&self.triangles) {
            let [a, b, c] = corners.map(|corner| at[corner as usize]);
            let across = (b - a).cross(c - a);
            let length = Lane::sqrt(Lane::max(across.dot(across), least));
            *normal = across * (one / length);
            sum = sum + *normal;
        }
        // A sum that is almost zero has no axis, and a cosine that is too small.
        let axis = sum * (one / Lane::sqrt(Lane::max(sum.dot(sum), least)));
        let mut cosine = one;
        for normal in &normals[..self.triangles.len()] {
            cosine = Lane::min(cosine, normal.dot(axis));
        }
        let (sums, axes) = (lanes_of(sum), lanes_of(axis));
        let mut cosines = Pack8::splat(0.0);
        cosine.store(&mut cosines);
        let of_lanes = sums.into_iter().zip(axes).zip(cosines.lanes());
        for (cone, ((sum, axis), &cosine)) in cones.iter_mut().zip(of_lanes) {
            *cone = Cone::new(sum, axis, cosine);
        }
    }
}

/// The vector in each lane.
#[inline(always)]
fn lanes_of<S: Simd>(vectors: V3<f32x8<S>>) -> [Vec3; Pack8::WIDTH] {
    let mut stored = [Pack8::splat(0.0); 3];
    vectors.store(&mut stored);
    core::array::from_fn(|lane| lane3(&stored, lane))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::itself::mesh::ContactMesh;
    use crate::contact::itself::points::vector;
    use crate::fabric::{FabricBuilder, Grid};

    #[test]
    fn groups_have_the_cones_of_their_cells() {
        let fabric = FabricBuilder::grid(Grid::new(33, 33, 1.0, 1.0)).build().expect("a good grid");
        let mesh = ContactMesh::of(&fabric);
        assert!(mesh.cell_groups.groups.len() * Pack8::WIDTH > mesh.cells.len() / 2);
        // Waves that are shorter to the right, where they fold.
        let waved = |at: &Vec3| *at + 0.1 * Vec3::Z * libm::sinf(40.0 * at.x * at.x + 3.0 * at.y);
        let rest = fabric.rest_positions().iter();
        let ends: Vec<Pack4> = rest.map(|at| vector(waved(at))).collect();
        let [mut one_by_one, mut at_once] = [(); 2].map(|()| vec![Cone::ALL; mesh.cells.len()]);
        compute_cones(&mesh.cells, &ends, &mut one_by_one);
        mesh.cell_groups.compute_cones(&mesh.cells, &ends, &mut at_once);
        let flat = one_by_one.iter().filter(|cone| cone.is_flat()).count();
        assert!((mesh.cells.len() / 4..mesh.cells.len()).contains(&flat), "{flat} are flat");
        for (one, other) in one_by_one.iter().zip(&at_once) {
            assert!(one.is_near(other, 1e-5), "{one:?} and {other:?}");
        }
    }
}
