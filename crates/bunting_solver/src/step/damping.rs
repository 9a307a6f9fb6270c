//! Damping of all but the rigid motion (thesis, appendix A), for cloth without pins.
//!
//! Mean velocity v_cm and angular velocity ω follow from momentum, angular momentum and inertia of the whole
//! cloth, and each velocity is damped towards v_cm + ω × r. The rigid motion of a pinned cloth is that of its
//! frame, towards which the prediction damps.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::constants::INERTIA_RIDGE;
use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::sum::Sum;
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Damps all but the rigid motion, in lanes whose material has internal damping.
    pub fn damp_internally(&mut self) {
        if self.parameters.internal_damping_factor.lanes().iter().all(|&factor| factor == 1.0) {
            return;
        }
        P::run(DampInternally {
            area: &self.numbers.area,
            areas: &self.masses.areas,
            partial_sums: &self.partial_sums,
            parameters: &self.parameters,
            position: self.positions.packs(),
            velocity: &mut self.velocity,
        });
    }
}

struct DampInternally<'a, P: Pack, C> {
    /// Area of each whole cloth, m².
    area: &'a P,
    areas: &'a [C],
    partial_sums: &'a [u8],
    parameters: &'a Parameters<P>,
    position: &'a [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
}

impl<P: Pack, C: Constant<P>> Kernel<P> for DampInternally<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let mut centre = V3::<Sum<L>>::sums(token);
        let mut drift = V3::<Sum<L>>::sums(token);
        for (((position, velocity), area), &partial_sum) in
            self.position.iter().zip(&*self.velocity).zip(self.areas).zip(self.partial_sums)
        {
            let area: L = area.load(token);
            centre.add_term(partial_sum, V3::load(token, position) * area);
            drift.add_term(partial_sum, V3::load(token, velocity) * area);
        }
        let per_area = L::splat(token, 1.0) / L::load(token, self.area);
        let centre = centre.total::<C>(token) * per_area;
        let drift = drift.total::<C>(token) * per_area;

        // L = Σ m r × v and I = Σ m (|r|² 1 − r rᵀ) (thesis, eq. A.3 and A.5).
        let mut spin = V3::<Sum<L>>::sums(token);
        let mut squares = V3::<Sum<L>>::sums(token);
        let mut products = V3::<Sum<L>>::sums(token);
        for (((position, velocity), area), &partial_sum) in
            self.position.iter().zip(&*self.velocity).zip(self.areas).zip(self.partial_sums)
        {
            let area: L = area.load(token);
            let arm = V3::load(token, position) - centre;
            let weighted = arm * area;
            let (x, y, z) = (weighted.x, weighted.y, weighted.z);
            spin.add_term(partial_sum, weighted.cross(V3::load(token, velocity) - drift));
            squares.add_term(partial_sum, V3 { x: x * arm.x, y: y * arm.y, z: z * arm.z });
            products.add_term(partial_sum, V3 { x: y * arm.z, y: z * arm.x, z: x * arm.y });
        }
        let squares = squares.total::<C>(token);
        let products = products.total::<C>(token);
        let turning = solve_inertia(token, squares, products, spin.total::<C>(token));

        let factor = L::load(token, &self.parameters.internal_damping_factor);
        let damps = factor.lt(L::splat(token, 1.0));
        if !damps.any() {
            return;
        }
        for (position, velocity) in self.position.iter().zip(self.velocity) {
            let v: V3<L> = V3::load(token, velocity);
            let rigid = drift + turning.cross(V3::load(token, position) - centre);
            (rigid + (v - rigid) * factor).or_where_not(damps, v).store(velocity);
        }
    }
}

/// ω = I⁻¹ L by Cramer's rule, from sums such as Σ m x², sums such as Σ m y z, and L. A ridge is added to the
/// diagonal, since the inertia of a line or a point has no inverse.
#[inline(always)]
fn solve_inertia<L: Lane>(token: L::Token, squares: V3<L>, products: V3<L>, spin: V3<L>) -> V3<L> {
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
