//! The Laplacian of linear functions on triangles, as a sparse matrix. Two functions at a time are solved for, as they share the
//! matrix.

use core::ops::Range;

use glam::{BVec2, DVec2};

/// Most steps of conjugate gradients.
const STEPS: usize = 3000;

/// How much less accurate a rough solution is. Larger: it tells less of the accurate one. Smaller: it takes as long.
const ROUGH: f64 = 1e4;

/// A row for each corner of triangles: the sum over its neighbours of a weight times the difference of both values.
pub(super) struct Laplacian {
    /// Rows of as many neighbours, so that loops over these have a length that processors predict.
    groups: Vec<RowGroup>,
    /// The neighbours of the rows, group by group.
    neighbours: Vec<u32>,
    /// The weight of each neighbour.
    weights: Vec<f64>,
    /// Sum of the weights of each row.
    diagonal: Vec<f64>,
}

/// Rows with the same number of neighbours.
struct RowGroup {
    length: usize,
    /// In ascending order.
    rows: Vec<u32>,
    /// Indices of their neighbours, row by row.
    neighbours: Range<usize>,
}

#[derive(Clone, Copy)]
struct Neighbour {
    row: u32,
    weight: f64,
}

impl Laplacian {
    /// The matrix of triangles, each with a weight for the side opposite to each of its corners.
    pub fn of(triangles: &[[u32; 3]], weights: impl Fn(usize) -> [f64; 3], count: usize) -> Self {
        let mut rows: Vec<Vec<Neighbour>> = vec![Vec::new(); count];
        for (index, corners) in triangles.iter().enumerate() {
            for (at, weight) in weights(index).into_iter().enumerate() {
                let [one, other] = [1, 2].map(|by| corners[(at + by) % 3]);
                for [row, neighbour] in [[one, other], [other, one]] {
                    let row = &mut rows[row as usize];
                    match row.iter_mut().find(|known| known.row == neighbour) {
                        Some(known) => known.weight += weight,
                        None => row.push(Neighbour { row: neighbour, weight }),
                    }
                }
            }
        }
        let mut order: Vec<u32> = (0..count as u32).collect();
        let length = |row: u32| rows[row as usize].len();
        order.sort_by_key(|&row| length(row));
        let mut end = 0;
        let groups = order.chunk_by(|&one, &other| length(one) == length(other)).map(|grouped| {
            let (length, start) = (length(grouped[0]), end);
            end += length * grouped.len();
            RowGroup { length, rows: grouped.to_vec(), neighbours: start..end }
        });
        let all = || order.iter().flat_map(|&row| &rows[row as usize]);
        let sum = |row: &Vec<Neighbour>| row.iter().map(|neighbour| neighbour.weight).sum();
        Self {
            groups: groups.filter(|group| group.length > 0).collect(),
            neighbours: all().map(|neighbour| neighbour.row).collect(),
            weights: all().map(|neighbour| neighbour.weight).collect(),
            diagonal: rows.iter().map(sum).collect(),
        }
    }

    /// Finds the products with two vectors, and returns the scalar products of both with these.
    fn multiply(&self, vectors: &[DVec2], products: &mut [DVec2]) -> DVec2 {
        for RowGroup { length, rows, neighbours } in &self.groups {
            let weights = self.weights[neighbours.clone()].chunks_exact(*length);
            let neighbours = self.neighbours[neighbours.clone()].chunks_exact(*length);
            for ((&row, neighbours), weights) in rows.iter().zip(neighbours).zip(weights) {
                let values = vectors[row as usize];
                let terms = neighbours.iter().zip(weights);
                let terms = terms.map(|(&at, weight)| weight * (values - vectors[at as usize]));
                products[row as usize] = terms.sum();
            }
        }
        vectors.iter().zip(products).map(|(value, product)| *value * *product).sum()
    }

    /// The two vectors whose products with this matrix are the right sides, but in rows with fixed values, where they are zero; by
    /// conjugate gradients (Hestenes and Stiefel 1952), until the squares of the residuals over the diagonal are `accurate`.
    /// None if that is not reached, or not wanted after a rough solution.
    pub fn solve(
        &self,
        right_sides: Vec<DVec2>,
        is_fixed: impl Fn(usize) -> BVec2,
        accurate: DVec2,
        goes_on: impl FnOnce(&[DVec2]) -> bool,
    ) -> Option<Vec<DVec2>> {
        let inverse_of = |(row, &diagonal): (usize, &f64)| {
            let inverse = if diagonal > 0.0 { 1.0 / diagonal } else { 0.0 };
            DVec2::select(is_fixed(row), DVec2::ZERO, DVec2::splat(inverse))
        };
        let inverses: Vec<DVec2> = self.diagonal.iter().enumerate().map(inverse_of).collect();
        let mut solutions = vec![DVec2::ZERO; right_sides.len()];
        let mut residuals = right_sides;
        let scaled = residuals.iter().zip(&inverses).map(|(residual, inverse)| residual * inverse);
        let mut steps: Vec<DVec2> = scaled.collect();
        let mut sizes: DVec2 = residuals.iter().zip(&steps).map(|(a, b)| a * b).sum();
        let mut changes = vec![DVec2::ZERO; steps.len()];
        let mut goes_on = Some(goes_on);
        for _ in 0..STEPS {
            let is_open = !sizes.cmple(accurate);
            if !is_open.any() {
                return Some(solutions);
            }
            if sizes.cmple(ROUGH * accurate).all()
                && let Some(goes_on) = goes_on.take()
                && !goes_on(&solutions)
            {
                return None;
            }
            let along = self.multiply(&steps, &mut changes);
            // The vector that is found first stays.
            let lengths = DVec2::select(is_open, sizes / along, DVec2::ZERO);
            let mut next = DVec2::ZERO;
            for row in 0..steps.len() {
                solutions[row] += steps[row] * lengths;
                residuals[row] -= changes[row] * lengths;
                next += residuals[row] * (residuals[row] * inverses[row]);
            }
            let growth = DVec2::select(is_open, next / sizes, DVec2::ZERO);
            sizes = DVec2::select(is_open, next, sizes);
            for row in 0..steps.len() {
                steps[row] = residuals[row] * inverses[row] + steps[row] * growth;
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use glam::{BVec2, DVec2};

    use super::Laplacian;

    /// Of two triangles side by side.
    fn laplacian() -> Laplacian {
        let weights = [[0.5, 0.2, 0.3], [0.1, 0.7, 0.4]];
        Laplacian::of(&[[0, 1, 2], [2, 1, 3]], |triangle| weights[triangle], 4)
    }

    /// Values of which the first one and, of the second vector, the last one is known to be zero.
    const WANTED: [DVec2; 4] =
        [DVec2::new(0.0, 3.0), DVec2::new(3.0, -1.0), DVec2::new(-1.0, 0.5), DVec2::new(0.5, 0.0)];

    fn is_fixed(row: usize) -> BVec2 {
        BVec2::new(row == 0, row == 3)
    }

    #[test]
    fn right_sides_are_solved_for() {
        let laplacian = laplacian();
        let mut right_sides = vec![DVec2::ZERO; 4];
        laplacian.multiply(&WANTED, &mut right_sides);
        let solve = |accurate: f64, goes_on: bool| {
            let right_sides = right_sides.clone();
            laplacian.solve(right_sides, is_fixed, DVec2::splat(accurate), |_| goes_on)
        };
        let found = solve(1e-20, true).expect("a solution");
        assert!(found.iter().zip(WANTED).all(|(found, wanted)| found.distance(wanted) < 1e-8));
        assert!(solve(1e-2, true).is_some() && solve(1e-2, false).is_none(), "after a rough one");
    }

    #[test]
    fn a_right_side_that_is_no_product_is_refused() {
        // A constant changes no product, so that the rows of every product have no sum.
        let right_sides = vec![DVec2::new(0.0, 1.0); 4];
        let found = laplacian().solve(right_sides, |_| BVec2::FALSE, DVec2::splat(1e-20), |_| true);
        assert!(found.is_none());
    }
}
