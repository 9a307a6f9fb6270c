//! Damping of all but the rigid motion (thesis, appendix A), for cloth without pins.
//!
//! Mean velocity v_cm and angular velocity ω follow from momentum, angular momentum and inertia of the whole
//! cloth, and each velocity is damped towards v_cm + ω × r. The rigid motion of a pinned cloth is that of its
//! frame, towards which the prediction damps.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::Parameters;
use crate::step::rigid_motion::RigidMotion;

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
        let per_area = L::splat(token, 1.0) / L::load(token, self.area);
        let masses = (self.areas, self.partial_sums);
        let motion = RigidMotion::<L>::of(token, per_area, masses, self.position, &*self.velocity);
        let RigidMotion { centre, drift, spin, .. } = motion;
        let turning = motion.turning(token, spin);

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
