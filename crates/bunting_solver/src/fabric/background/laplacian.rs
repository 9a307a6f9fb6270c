//! The Laplacian of linear functions on triangles, as a sparse matrix.

/// Most steps of conjugate gradients.
const STEPS: usize = 3000;

/// A row for each corner of triangles: the sum over its neighbours of a weight times the difference of both values.
pub(super) struct Laplacian {
    /// For each row the index of its first neighbour, and one beyond the last row.
    starts: Vec<u32>,
    neighbours: Vec<Neighbour>,
    /// Sum of the weights of each row.
    diagonal: Vec<f64>,
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
        let mut starts = vec![0];
        starts.extend(rows.iter().scan(0, |end, row| {
            *end += row.len() as u32;
            Some(*end)
        }));
        let sum = |row: &Vec<Neighbour>| row.iter().map(|neighbour| neighbour.weight).sum();
        let diagonal = rows.iter().map(sum).collect();
        Self { starts, neighbours: rows.concat(), diagonal }
    }

    /// The product with a vector.
    fn times(&self, values: &[f64]) -> Vec<f64> {
        let rows = values.iter().zip(self.starts.windows(2));
        rows.map(|(value, ends)| {
            let neighbours = &self.neighbours[ends[0] as usize..ends[1] as usize];
            let terms = neighbours.iter().map(|it| it.weight * (value - values[it.row as usize]));
            terms.sum::<f64>()
        })
        .collect()
    }

    /// The vector whose product with this matrix is the right side, but in rows with fixed values, where it is zero; by
    /// conjugate gradients (Hestenes and Stiefel 1952), until the square of the residual over the diagonal is `accurate`.
    /// None if that is not reached.
    pub fn solve(
        &self,
        right_side: Vec<f64>,
        is_fixed: impl Fn(usize) -> bool,
        accurate: f64,
    ) -> Option<Vec<f64>> {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let is_solved = |(row, diagonal): &(usize, &f64)| !is_fixed(*row) && **diagonal > 0.0;
        let inverse_of = |entry| if is_solved(&entry) { 1.0 / entry.1 } else { 0.0 };
        let inverse: Vec<f64> = self.diagonal.iter().enumerate().map(inverse_of).collect();
        let conditioned = |residual: &[f64]| -> Vec<f64> {
            residual.iter().zip(&inverse).map(|(value, inverse)| value * inverse).collect()
        };
        let mut solution = vec![0.0; right_side.len()];
        let mut residual = right_side;
        let mut step = conditioned(&residual);
        let mut size = dot(&residual, &step);
        for _ in 0..STEPS {
            if size <= accurate {
                return Some(solution);
            }
            let change = self.times(&step);
            let length = size / dot(&step, &change);
            for (value, step) in solution.iter_mut().zip(&step) {
                *value += step * length;
            }
            for (residual, change) in residual.iter_mut().zip(&change) {
                *residual -= change * length;
            }
            let scaled = conditioned(&residual);
            let before = core::mem::replace(&mut size, dot(&residual, &scaled));
            for (step, scaled) in step.iter_mut().zip(scaled) {
                *step = scaled + *step * (size / before);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::Laplacian;

    /// Of two triangles side by side.
    fn laplacian() -> Laplacian {
        let weights = [[0.5, 0.2, 0.3], [0.1, 0.7, 0.4]];
        Laplacian::of(&[[0, 1, 2], [2, 1, 3]], |triangle| weights[triangle], 4)
    }

    #[test]
    fn a_right_side_is_solved_for() {
        let laplacian = laplacian();
        let wanted = [0.0, 3.0, -1.0, 0.5];
        let right_side = laplacian.times(&wanted);
        let found = laplacian.solve(right_side, |row| row == 0, 1e-20).expect("a solution");
        assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-8));
    }

    #[test]
    fn a_right_side_that_is_no_product_is_refused() {
        // A constant changes no product, so that the rows of every product have no sum.
        assert!(laplacian().solve(vec![1.0; 4], |_| false, 1e-20).is_none());
    }
}
