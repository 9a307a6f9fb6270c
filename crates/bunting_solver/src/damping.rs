//! Damping that leaves the rigid motion alone (thesis, appendix A), for cloth without pins.
//!
//! The thesis takes centre, momentum and inertia of the whole cloth and pulls each velocity towards
//! v_cm + ω × r. The rigid motion of a pinned cloth is that of its frame, towards which
//! [`integrate`](crate::integrate) damps.

use crate::constants::INERTIA_RIDGE;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Mask, Pack};
use crate::parameters::Parameters;
use crate::vector::{Pack3, V3};

impl<P: Pack> LaneBatch<P> {
    /// Damps what is not rigid motion, in the lanes whose material asks for it.
    pub fn damp_internally(&mut self) {
        if self.parameters.keep_internal.lanes().iter().all(|&keep| keep == 1.0) {
            return;
        }
        P::run(DampInternally {
            areas: self.fabric.particle_areas(),
            parameters: &self.parameters,
            position: &self.position,
            velocity: &mut self.velocity,
        });
    }
}

struct DampInternally<'a, P: Pack> {
    areas: &'a [f32],
    parameters: &'a Parameters<P>,
    position: &'a [Pack3<P>],
    velocity: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for DampInternally<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let zero = V3::<L>::splat(token, 0.0);
        let area = L::splat(token, self.areas.iter().sum());
        let (mut centre, mut drift) = (zero, zero);
        for ((position, velocity), &area) in
            self.position.iter().zip(&*self.velocity).zip(self.areas)
        {
            let area = L::splat(token, area);
            centre = centre + V3::load(token, position) * area;
            drift = drift + V3::load(token, velocity) * area;
        }
        let per_area = L::splat(token, 1.0) / area;
        let (centre, drift) = (centre * per_area, drift * per_area);

        // L = Σ m r × v and I = Σ m (|r|² 1 − r rᵀ) (thesis, eq. A.3 and A.5).
        let mut spin = zero;
        let (mut squares, mut products) = (zero, zero);
        for ((position, velocity), &area) in
            self.position.iter().zip(&*self.velocity).zip(self.areas)
        {
            let area = L::splat(token, area);
            let arm = V3::load(token, position) - centre;
            let weighted = arm * area;
            spin = spin + weighted.cross(V3::load(token, velocity) - drift);
            squares = squares
                + V3 { x: weighted.x * arm.x, y: weighted.y * arm.y, z: weighted.z * arm.z };
            products = products
                + V3 { x: weighted.y * arm.z, y: weighted.z * arm.x, z: weighted.x * arm.y };
        }
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
