//! Damping that leaves the rigid motion alone (thesis, appendix A), for cloth without pins.
//!
//! The thesis takes centre, momentum and inertia of the whole cloth and pulls each velocity towards
//! v_cm + ω × r. The rigid motion of a pinned cloth is that of its frame, towards which
//! [`integrate`](crate::integrate) damps.

use crate::constants::INERTIA_RIDGE;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Mask, Pack};
use crate::parameters::Parameters;
use crate::places::{Constant, PARTS};
use crate::vector::{Pack3, V3};

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Damps what is not rigid motion, in the lanes whose material asks for it.
    pub fn damp_internally(&mut self) {
        if self.parameters.keep_internal.lanes().iter().all(|&keep| keep == 1.0) {
            return;
        }
        P::run(DampInternally {
            area: self.fabric.area(),
            areas: &self.packs.areas,
            parts: &self.parts,
            parameters: &self.parameters,
            position: &self.position,
            velocity: &mut self.velocity,
        });
    }
}

struct DampInternally<'a, P: Pack, C> {
    /// Of the whole cloth, m².
    area: f32,
    areas: &'a [C],
    /// Into which part of the sums each pack goes.
    parts: &'a [u8],
    parameters: &'a Parameters<P>,
    position: &'a [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
}

impl<P: Pack, C: Constant<P>> Kernel<P> for DampInternally<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let zero = V3::<L>::splat(token, 0.0);
        let (mut centres, mut drifts) = ([zero; PARTS], [zero; PARTS]);
        for (((position, velocity), area), &part) in
            self.position.iter().zip(&*self.velocity).zip(self.areas).zip(self.parts)
        {
            let area: L = area.load(token);
            let part = part as usize % PARTS;
            centres[part] = centres[part] + V3::load(token, position) * area;
            drifts[part] = drifts[part] + V3::load(token, velocity) * area;
        }
        let per_area = L::splat(token, 1.0) / L::splat(token, self.area);
        let centre = total::<L, C>(token, &centres) * per_area;
        let drift = total::<L, C>(token, &drifts) * per_area;

        // L = Σ m r × v and I = Σ m (|r|² 1 − r rᵀ) (thesis, eq. A.3 and A.5).
        let mut spins = [zero; PARTS];
        let (mut squares, mut products) = ([zero; PARTS], [zero; PARTS]);
        for (((position, velocity), area), &part) in
            self.position.iter().zip(&*self.velocity).zip(self.areas).zip(self.parts)
        {
            let area: L = area.load(token);
            let part = part as usize % PARTS;
            let arm = V3::load(token, position) - centre;
            let weighted = arm * area;
            spins[part] = spins[part] + weighted.cross(V3::load(token, velocity) - drift);
            squares[part] = squares[part]
                + V3 { x: weighted.x * arm.x, y: weighted.y * arm.y, z: weighted.z * arm.z };
            products[part] = products[part]
                + V3 { x: weighted.y * arm.z, y: weighted.z * arm.x, z: weighted.x * arm.y };
        }
        let spin = total::<L, C>(token, &spins);
        let squares = total::<L, C>(token, &squares);
        let products = total::<L, C>(token, &products);
        let turning = solve_inertia(token, squares, products, spin);

        let keep = L::load(token, &self.parameters.keep_internal);
        let damps = keep.lt(L::splat(token, 1.0));
        if !damps.any() {
            return;
        }
        for (position, velocity) in self.position.iter().zip(self.velocity) {
            let v: V3<L> = V3::load(token, velocity);
            let rigid = drift + turning.cross(V3::load(token, position) - centre);
            (rigid + (v - rigid) * keep).or_where_not(damps, v).store(velocity);
        }
    }
}

/// A sum over all particles, given those of its parts.
#[inline(always)]
fn total<L: Lane, C: Constant<L::Pack>>(token: L::Token, parts: &[V3<L>; PARTS]) -> V3<L> {
    let mut sums = [[L::splat(token, 0.0); PARTS]; 3];
    for (part, sum) in parts.iter().enumerate() {
        (sums[0][part], sums[1][part], sums[2][part]) = (sum.x, sum.y, sum.z);
    }
    V3 { x: C::total(token, sums[0]), y: C::total(token, sums[1]), z: C::total(token, sums[2]) }
}

/// ω = I⁻¹ L by Cramer's rule, with a ridge: the inertia of a line or a point has no inverse.
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
