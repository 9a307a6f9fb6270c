//! The block tridiagonal system of a strip: its blocks, and the elimination of one row after the other.

use crate::simd::lane::Lane;
use crate::simd::vec3::V3;

/// Least pivot of the elimination, as a part of the diagonal. Smaller: rounding makes pivots of inextensible strips
/// negative. Larger: stiff strips yield.
const LEAST_PIVOT: f32 = 1e-6;

/// Unknowns of a row: the multipliers of the link across, of those along both lines, and of the shear.
pub(super) const UNKNOWNS: usize = 4;

/// A block of the system.
pub(super) type Block<L> = [[L; UNKNOWNS]; UNKNOWNS];

/// The constraints of a row as they are linearised.
#[derive(Clone, Copy)]
pub(super) struct Linearised<L> {
    /// Directions of the link across, of those along both lines, and of both diagonals; zero where there is none.
    pub directions: [V3<L>; 5],
    /// −C − α̃ λ, m.
    pub right: [L; UNKNOWNS],
    /// 1/m²; one where there is no constraint.
    pub compliance: [L; UNKNOWNS],
}

/// J M⁻¹ Jᵀ + α̃ among the constraints of a row, given the inverse masses of its particles and of the next row's. The
/// lower triangle.
#[inline(always)]
pub(super) fn diagonal<L: Lane>(
    token: L::Token,
    constraints: &Linearised<L>,
    [first, second]: [L; 2],
    [next_first, next_second]: [L; 2],
) -> Block<L> {
    let zero = L::splat(token, 0.0);
    let [c, a, b, falling, rising] = constraints.directions;
    let [across, along_first, along_second, shear] = constraints.compliance;
    // Squares of directions are one, or zero where there is no constraint.
    [
        [across.plus_product(first + second, c.dot(c)), zero, zero, zero],
        [first * c.dot(a), along_first.plus_product(first + next_first, a.dot(a)), zero, zero],
        [
            -(second * c.dot(b)),
            zero,
            along_second.plus_product(second + next_second, b.dot(b)),
            zero,
        ],
        [
            (first * c.dot(falling)).plus_product(second, c.dot(rising)),
            (first * a.dot(falling)).minus_product(next_first, a.dot(rising)),
            (next_second * b.dot(falling)).minus_product(second, b.dot(rising)),
            shear
                .plus_product(first + next_second, falling.dot(falling))
                .plus_product(second + next_first, rising.dot(rising)),
        ],
    ]
}

/// J M⁻¹ Jᵀ between the constraints of a row and those of the next, given the inverse masses of the next row's
/// particles.
#[inline(always)]
pub(super) fn coupling<L: Lane>(
    token: L::Token,
    before: &[V3<L>; 5],
    next: &[V3<L>; 5],
    [first, second]: [L; 2],
) -> Block<L> {
    let zero = L::splat(token, 0.0);
    let [_, a, b, falling, rising] = *before;
    let [next_c, next_a, next_b, next_falling, next_rising] = *next;
    [
        [zero; UNKNOWNS],
        [-(first * a.dot(next_c)), -(first * a.dot(next_a)), zero, -(first * a.dot(next_falling))],
        [second * b.dot(next_c), zero, -(second * b.dot(next_b)), second * b.dot(next_rising)],
        [
            (first * rising.dot(next_c)).plus_product(second, falling.dot(next_c)),
            first * rising.dot(next_a),
            -(second * falling.dot(next_b)),
            (first * rising.dot(next_falling)).plus_product(second, falling.dot(next_rising)),
        ],
    ]
}

/// A block L D Lᵀ of the eliminated system.
#[derive(Clone, Copy)]
struct Factors<L> {
    /// Below the diagonal.
    lower: Block<L>,
    /// One over D.
    inverse: [L; UNKNOWNS],
}

#[expect(clippy::needless_range_loop, reason = "linear algebra is read by its indices")]
impl<L: Lane> Factors<L> {
    /// Factorises a block, given its lower triangle.
    #[inline(always)]
    fn of(token: L::Token, block: Block<L>) -> Self {
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let least = L::splat(token, LEAST_PIVOT);
        let mut factors = Self { lower: block, inverse: [zero; UNKNOWNS] };
        let mut pivots = [zero; UNKNOWNS];
        for column in 0..UNKNOWNS {
            let mut pivot = block[column][column];
            for inner in 0..column {
                let lower = factors.lower[column][inner];
                pivot = pivot.minus_product(lower * lower, pivots[inner]);
            }
            let pivot = pivot.max(least * block[column][column]);
            pivots[column] = pivot;
            factors.inverse[column] = one / pivot;
            for row in column + 1..UNKNOWNS {
                let mut value = block[row][column];
                for inner in 0..column {
                    let product = factors.lower[column][inner] * pivots[inner];
                    value = value.minus_product(factors.lower[row][inner], product);
                }
                factors.lower[row][column] = value * factors.inverse[column];
            }
        }
        factors
    }

    /// Solves L D Lᵀ x = y.
    #[inline(always)]
    fn solve(&self, mut right: [L; UNKNOWNS]) -> [L; UNKNOWNS] {
        for row in 0..UNKNOWNS {
            for inner in 0..row {
                right[row] = right[row].minus_product(self.lower[row][inner], right[inner]);
            }
        }
        for row in 0..UNKNOWNS {
            right[row] = right[row] * self.inverse[row];
        }
        for row in (0..UNKNOWNS).rev() {
            for inner in row + 1..UNKNOWNS {
                right[row] = right[row].minus_product(self.lower[inner][row], right[inner]);
            }
        }
        right
    }
}

/// The eliminated system of a row.
#[derive(Clone, Copy)]
pub(super) struct Solved<L> {
    factors: Factors<L>,
    /// The row's unknowns, less their part in the next row's.
    pub unknowns: [L; UNKNOWNS],
}

impl<L: Lane> Solved<L> {
    /// The row before the first row, without constraints.
    #[inline(always)]
    pub fn first(token: L::Token) -> Self {
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let factors = Factors { lower: [[zero; UNKNOWNS]; UNKNOWNS], inverse: [one; UNKNOWNS] };
        Self { factors, unknowns: [zero; UNKNOWNS] }
    }

    /// The system S of the next row, S = D − Eᵀ S₀⁻¹ E with S₀ that of this one, and the next row's part in this row's
    /// unknowns, S₀⁻¹ E; given the coupling E of both rows, and D and the right side of the next.
    #[inline(always)]
    pub fn followed_by(
        &self,
        token: L::Token,
        coupling: Block<L>,
        mut block: Block<L>,
        mut right: [L; UNKNOWNS],
    ) -> (Block<L>, Self) {
        let mut part = coupling;
        for column in 0..UNKNOWNS {
            let mut of_column = right;
            for (value, row) in of_column.iter_mut().zip(&coupling) {
                *value = row[column];
            }
            let of_column = self.factors.solve(of_column);
            for (row, value) in part.iter_mut().zip(of_column) {
                row[column] = value;
            }
        }
        for ((coupling, part), unknown) in coupling.iter().zip(&part).zip(self.unknowns) {
            for ((block, right), &coupling) in block.iter_mut().zip(&mut right).zip(coupling) {
                for (value, &part) in block.iter_mut().zip(part) {
                    *value = value.minus_product(coupling, part);
                }
                *right = right.minus_product(coupling, unknown);
            }
        }
        let factors = Factors::of(token, block);
        (part, Self { factors, unknowns: factors.solve(right) })
    }
}
