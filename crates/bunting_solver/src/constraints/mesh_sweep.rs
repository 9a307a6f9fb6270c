//! A Gauss–Seidel sweep over the links of a mesh with laid yarns.
//!
//! Where cloth snaps like a whip, such links may be far longer than those of the yarns, between which they lie. They
//! have a small part of the material's stiffness, so that the yarns carry the load. The constraint is that of
//! `gauss_seidel/distance.rs`.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Particles, Positions};
use crate::batch::side_by_side::SideBySide;
use crate::constants::LEAST_LENGTH;
use crate::constraints::corrections::CorrectedParticles;
use crate::constraints::direction::sweep_order;
use crate::fabric::Link;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::V3;

impl<P: Pack> LaneBatch<P, SideBySide<P>> {
    /// Solves each link of the mesh once, from the first to the last or backwards, and adds to the sums of corrections.
    pub(super) fn sweep_mesh(&mut self, is_backwards: bool) {
        let compliance = &self.layout.factors().link_compliance;
        if let Some(mesh) = &mut self.lone_mesh {
            mesh.sweep_links(is_backwards, compliance.iter().map(|pack| pack.lanes()[0]));
            return;
        }
        P::run(SweepMesh {
            links: self.fabric.links(),
            is_backwards,
            compliance,
            particles: CorrectedParticles {
                inverse_masses: &self.masses.inverse,
                predicted: self.positions.packs(),
                correction: &mut self.correction,
            },
        });
    }
}

struct SweepMesh<'a, P: Pack> {
    links: &'a [Link],
    is_backwards: bool,
    compliance: &'a [P],
    particles: CorrectedParticles<'a, P>,
}

impl<P: Pack> Kernel<P> for SweepMesh<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        let zero = L::splat(token, 0.0);
        for index in sweep_order(self.links.len(), self.is_backwards) {
            let link = &self.links[index];
            let [a, b] = link.particles;
            let mass_a: L = self.particles.inverse_mass(token, a);
            let mass_b: L = self.particles.inverse_mass(token, b);
            let compliance = L::load(token, &self.compliance[link.class as usize]);
            let from: V3<L> = self.particles.position(token, a);
            let to: V3<L> = self.particles.position(token, b);
            let along = to - from;
            let rest_length = L::splat(token, link.rest_length);
            let pull = link_pull(token, along, mass_a + mass_b + compliance, rest_length);
            self.particles.correct(token, a, from, (along, pull * mass_a));
            self.particles.correct(token, b, to, (along, zero - pull * mass_b));
        }
    }
}

/// −Δλ/|d| of a link along d (m), given the sum of its inverse masses its compliance (1/m²) and its length at rest
/// (m).
#[inline(always)]
pub(super) fn link_pull<L: Lane>(
    token: L::Token,
    along: V3<L>,
    denominator: L,
    rest_length: L,
) -> L {
    let length = along.dot(along).sqrt().max(L::splat(token, LEAST_LENGTH));
    // One division: the length of d is part of the denominator.
    (length - rest_length) / (denominator * length)
}
