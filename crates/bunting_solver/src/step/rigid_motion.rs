//! The rigid motion of whole cloths (thesis, appendix A).

use crate::constants::INERTIA_RIDGE;
use crate::simd::constant::Constant;
use crate::simd::lane::Lane;
use crate::simd::sum::Sum;
use crate::simd::vec3::{Pack3, V3};

/// Sums over the particles of each cloth, in registers, in units of the density.
pub(crate) struct RigidMotion<L> {
    /// Centre of mass, m.
    pub centre: V3<L>,
    /// Velocity of the centre of mass, m/s.
    pub drift: V3<L>,
    /// Angular momentum about the centre of mass, Σ m r × v (thesis, eq. A.3), m⁴/s.
    pub spin: V3<L>,
    /// Sums such as Σ m x² of the inertia, m⁴.
    squares: V3<L>,
    /// Sums such as Σ m y z of the inertia, m⁴.
    products: V3<L>,
}

impl<L: Lane> RigidMotion<L> {
    /// Sums over the particles, given their areas, m², and one over the area of the whole cloth, 1/m².
    #[inline(always)]
    pub fn of<C: Constant<L::Pack>>(
        token: L::Token,
        per_area: L,
        (areas, partial_sums): (&[C], &[u8]),
        position: &[Pack3<L::Pack>],
        velocity: &[Pack3<L::Pack>],
    ) -> Self {
        let mut centre = V3::<Sum<L>>::sums(token);
        let mut drift = V3::<Sum<L>>::sums(token);
        for (((position, velocity), area), &partial_sum) in
            position.iter().zip(velocity).zip(areas).zip(partial_sums)
        {
            let area: L = area.load(token);
            centre.add_term(partial_sum, V3::load(token, position) * area);
            drift.add_term(partial_sum, V3::load(token, velocity) * area);
        }
        let centre = centre.total::<C>(token) * per_area;
        let drift = drift.total::<C>(token) * per_area;

        let mut spin = V3::<Sum<L>>::sums(token);
        let mut squares = V3::<Sum<L>>::sums(token);
        let mut products = V3::<Sum<L>>::sums(token);
        for (((position, velocity), area), &partial_sum) in
            position.iter().zip(velocity).zip(areas).zip(partial_sums)
        {
            let area: L = area.load(token);
            let arm = V3::load(token, position) - centre;
            let weighted = arm * area;
            let (x, y, z) = (weighted.x, weighted.y, weighted.z);
            spin.add_term(partial_sum, weighted.cross(V3::load(token, velocity) - drift));
            squares.add_term(partial_sum, V3 { x: x * arm.x, y: y * arm.y, z: z * arm.z });
            products.add_term(partial_sum, V3 { x: y * arm.z, y: z * arm.x, z: x * arm.y });
        }
        Self {
            centre,
            drift,
            spin: spin.total::<C>(token),
            squares: squares.total::<C>(token),
            products: products.total::<C>(token),
        }
    }

    /// The angular velocity ω = I⁻¹ L, rad/s, of a rigid turn with the angular momentum L, m⁴/s, by Cramer's rule,
    /// where I = Σ m (|r|² 1 − r rᵀ) (thesis, eq. A.5). A ridge is added to the diagonal, since the inertia of a line
    /// or a point has no inverse.
    #[inline(always)]
    pub fn turning(&self, token: L::Token, spin: V3<L>) -> V3<L> {
        let Self { squares, products, .. } = self;
        let trace = squares.x + squares.y + squares.z;
        let ridge = trace * L::splat(token, INERTIA_RIDGE) + L::splat(token, f32::MIN_POSITIVE);
        let (xx, yy, zz) = (
            squares.y + squares.z + ridge,
            squares.z + squares.x + ridge,
            squares.x + squares.y + ridge,
        );
        let (yz, zx, xy) = (-products.x, -products.y, -products.z);
        let row_x = V3 { x: xx, y: xy, z: zx };
        let row_y = V3 { x: xy, y: yy, z: yz };
        let row_z = V3 { x: zx, y: yz, z: zz };
        let (to_x, to_y, to_z) = (row_y.cross(row_z), row_z.cross(row_x), row_x.cross(row_y));
        let determinant = row_x.dot(to_x).max(L::splat(token, f32::MIN_POSITIVE));
        let one_over = L::splat(token, 1.0) / determinant;
        (to_x * spin.x + to_y * spin.y + to_z * spin.z) * one_over
    }
}
