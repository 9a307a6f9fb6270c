//! A Gauss–Seidel sweep over the links of a mesh that does not fill a background grid.
//!
//! Where cloth snaps like a whip, such links may be far longer than those of the grid, as their particles are raised above
//! the nodes, or extrapolated from them; or longer than those of laid yarns, between which they lie. The links have a small
//! part of the material's stiffness, so that grid or yarns carry the load. The constraint is that of
//! `gauss_seidel/distance.rs`.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::batch::side_by_side::SideBySide;
use crate::constants::LEAST_LENGTH;
use crate::fabric::Link;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

impl<P: Pack> LaneBatch<P, SideBySide<P>> {
    /// Solves each link of the mesh once, from the first to the last or backwards.
    pub(super) fn sweep_mesh(&mut self, is_backwards: bool) {
        P::run(SweepMesh {
            links: self.fabric.links(),
            is_backwards,
            inverse_masses: &self.masses.inverse,
            compliance: &self.layout.factors().link_compliance,
            position: self.positions.packs_mut(),
        });
    }
}

struct SweepMesh<'a, P: Pack> {
    links: &'a [Link],
    is_backwards: bool,
    inverse_masses: &'a [P],
    compliance: &'a [P],
    position: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for SweepMesh<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let least = L::splat(token, LEAST_LENGTH);
        let count = self.links.len();
        for at in 0..count {
            let link = &self.links[if self.is_backwards { count - 1 - at } else { at }];
            let [a, b] = link.particles.map(|particle| particle as usize);
            let mass_a = L::load(token, &self.inverse_masses[a]);
            let mass_b = L::load(token, &self.inverse_masses[b]);
            let compliance = L::load(token, &self.compliance[link.class as usize]);
            let from: V3<L> = V3::load(token, &self.position[a]);
            let to: V3<L> = V3::load(token, &self.position[b]);
            let along = to - from;
            let length = along.dot(along).sqrt().max(least);
            let excess = length - L::splat(token, link.rest_length);
            // −Δλ/|d| with one division: the length of d is part of the denominator.
            let pull = excess / ((mass_a + mass_b + compliance) * length);
            from.plus_scaled(along, pull * mass_a).store(&mut self.position[a]);
            to.minus_scaled(along, pull * mass_b).store(&mut self.position[b]);
        }
    }
}
