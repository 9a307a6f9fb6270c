//! Linearly implicit Euler (Baraff and Witkin 1998, "Large steps in cloth simulation", equation 6):
//! (M + h²K) Δv = h (f − h K v), K the stiffness matrix without the compressed links' negative part.
//!
//! The matrix is factored by faer's sparse Cholesky; its pattern is analysed once.

use faer::{
    Mat, Side,
    linalg::solvers::Solve,
    sparse::{
        Argsort, Pair, SparseColMat, SymbolicSparseColMat,
        linalg::solvers::{Llt, SymbolicLlt},
    },
};
use glam::{Mat3, Vec3};

use super::{sheet::Sheet, stepper::Stepper};

/// A mass-spring cloth under implicit Euler.
#[derive(Debug)]
pub struct ImplicitEuler {
    /// Index of each vertex among the free vertices; none where pinned.
    free: Vec<Option<usize>>,
    pattern: SymbolicSparseColMat<usize>,
    order: Argsort<usize>,
    factors: SymbolicLlt<usize>,
    entries: Vec<f64>,
    forces: Vec<Vec3>,
    right_side: Mat<f64>,
}

impl ImplicitEuler {
    /// The method, initialised for a sheet.
    #[must_use]
    pub fn new(sheet: &Sheet) -> Self {
        let mut count = 0;
        let free: Vec<Option<usize>> = sheet
            .inverse_masses
            .iter()
            .map(|w| {
                (*w > 0.0).then(|| {
                    count += 1;
                    count - 1
                })
            })
            .collect();
        let mut pairs = Vec::new();
        visit_blocks(sheet, &free, 0.0, |row, column, _| {
            for k in 0..9 {
                pairs.push(Pair { row: 3 * row + k % 3, col: 3 * column + k / 3 });
            }
        });
        let (pattern, order) =
            SymbolicSparseColMat::try_new_from_indices(3 * count, 3 * count, &pairs)
                .expect("indices lie within the matrix");
        let factors =
            SymbolicLlt::try_new(pattern.as_ref(), Side::Lower).expect("a symmetric pattern");
        Self {
            entries: Vec::with_capacity(pairs.len()),
            forces: vec![Vec3::ZERO; sheet.positions.len()],
            right_side: Mat::zeros(3 * count, 1),
            free,
            pattern,
            order,
            factors,
        }
    }
}

impl Stepper for ImplicitEuler {
    fn substep(&mut self, sheet: &mut Sheet, h: f32) {
        sheet.apply_outer_forces(h);
        self.entries.clear();
        visit_blocks(sheet, &self.free, h, |_, _, block| {
            self.entries.extend(block.to_cols_array().map(f64::from));
        });
        let matrix =
            SparseColMat::new_from_argsort(self.pattern.clone(), &self.order, &self.entries)
                .expect("as many entries as the pattern has");
        self.gather_impulses(sheet, h);
        let Ok(factored) =
            Llt::try_new_with_symbolic(self.factors.clone(), matrix.as_ref(), Side::Lower)
        else {
            // Positions that are not finite are kept, so that the observer reports them.
            return;
        };
        factored.solve_in_place(&mut self.right_side);
        for (k, index) in self.free.iter().enumerate() {
            if let Some(index) = index {
                let change = [0, 1, 2].map(|axis| self.right_side[(3 * index + axis, 0)] as f32);
                sheet.velocities[k] += Vec3::from(change);
                sheet.positions[k] += sheet.velocities[k] * h;
            }
        }
    }
}

impl ImplicitEuler {
    /// Right side h (f − h K v): the elastic force extrapolated by the present velocities, times h.
    fn gather_impulses(&mut self, sheet: &Sheet, h: f32) {
        self.forces.fill(Vec3::ZERO);
        sheet.add_elastic_forces(&mut self.forces);
        let velocities = &sheet.velocities;
        for link in &sheet.links {
            let stiffness = link_stiffness(sheet, link.a, link.b, link.rest, link.stiffness);
            let resist = stiffness * (velocities[link.b] - velocities[link.a]) * h;
            self.forces[link.a] += resist;
            self.forces[link.b] -= resist;
        }
        for bend in &sheet.bends {
            let resist = bend.value(velocities) * (bend.stiffness * h);
            for (v, weight) in bend.vertices.into_iter().zip(bend.weights) {
                self.forces[v] -= resist * weight;
            }
        }
        for twist in &sheet.twists {
            let resist = twist.value(velocities) * (twist.stiffness * h);
            for (v, weight) in twist.vertices.into_iter().zip(twist.weights) {
                self.forces[v] -= resist * weight;
            }
        }
        for (index, force) in self.free.iter().zip(&self.forces) {
            if let Some(index) = index {
                for axis in 0..3 {
                    self.right_side[(3 * index + axis, 0)] = f64::from(force[axis] * h);
                }
            }
        }
    }
}

/// Stiffness block of a link. The transverse part of a compressed link is left out, so that the matrix stays
/// definite.
fn link_stiffness(sheet: &Sheet, a: usize, b: usize, rest: f32, stiffness: f32) -> Mat3 {
    let d = sheet.positions[b] - sheet.positions[a];
    let length = d.length_squared().sqrt();
    let n = d / length;
    let along = Mat3::from_cols(n * n.x, n * n.y, n * n.z);
    let transverse = (1.0 - rest / length).max(0.0);
    (along + (Mat3::IDENTITY - along) * transverse) * stiffness
}

/// Visits the blocks (row, column, block) that add up to M + h²K over the free vertices.
fn visit_blocks(
    sheet: &Sheet,
    free: &[Option<usize>],
    h: f32,
    mut visit: impl FnMut(usize, usize, Mat3),
) {
    for (index, mass) in free.iter().zip(&sheet.masses) {
        if let Some(index) = *index {
            visit(index, index, Mat3::from_diagonal(Vec3::splat(*mass)));
        }
    }
    let mut visit_element = |vertices: &[usize], weights: &[f32], stiffness: Mat3| {
        for (p, wp) in vertices.iter().zip(weights) {
            for (q, wq) in vertices.iter().zip(weights) {
                if let (Some(row), Some(column)) = (free[*p], free[*q]) {
                    visit(row, column, stiffness * (h * h * wp * wq));
                }
            }
        }
    };
    for link in &sheet.links {
        let stiffness = link_stiffness(sheet, link.a, link.b, link.rest, link.stiffness);
        visit_element(&[link.a, link.b], &[1.0, -1.0], stiffness);
    }
    for bend in &sheet.bends {
        visit_element(&bend.vertices, &bend.weights, Mat3::IDENTITY * bend.stiffness);
    }
    for twist in &sheet.twists {
        visit_element(&twist.vertices, &twist.weights, Mat3::IDENTITY * twist.stiffness);
    }
}
