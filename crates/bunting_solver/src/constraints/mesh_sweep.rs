//! A Gauss–Seidel sweep over the links of a mesh that is curved at rest, or has laid yarns.
//!
//! Where cloth snaps like a whip, or folds within a cell, such links may be far longer or shorter than those of the background
//! grid, as their particles are interpolated and raised above the nodes, or than those of laid yarns, between which they lie.
//! The links have a small part of the material's stiffness, so that grid or yarns carry the load. The constraint is that of
//! `gauss_seidel/distance.rs`.

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Particles, Positions};
use crate::batch::side_by_side::SideBySide;
use crate::constants::LEAST_LENGTH;
use crate::constraints::corrections::CorrectedParticles;
use crate::fabric::Link;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{V3, splat3};

/// Strain up to which links are left to the background grid. Smaller: links take part of the load from the grid,
/// whatever their stiffness, as a sweep moves light particles all the way. Larger: single edges are drawn longer in
/// wind.
pub(super) const SLACK: f32 = 0.01;

impl<P: Pack> LaneBatch<P, SideBySide<P>> {
    /// Solves each link of the mesh once, from the first to the last or backwards, and adds to the sums of corrections.
    pub(super) fn sweep_mesh(&mut self, is_backwards: bool) {
        let compliance = &self.layout.factors().link_compliance;
        // Laid yarns do not hold the cloth at their ends.
        let slack = 0.0;
        if let Some(mesh) = &mut self.lone_mesh {
            mesh.sweep_links(is_backwards, slack, compliance.iter().map(|pack| pack.lanes()[0]));
            return;
        }
        P::run(SweepMesh {
            links: self.fabric.links(),
            is_backwards,
            slack,
            compliance,
            particles: CorrectedParticles {
                inverse_masses: &self.masses.inverse,
                predicted: self.positions.packs(),
                correction: &mut self.correction,
            },
        });
    }

    /// Solves each strained link of a mesh with a background grid once, and writes the corrections to `stretch_shift`.
    pub(super) fn sweep_strained_links(&mut self) {
        let Self { positions, stretch_shift: correction, .. } = self;
        correction.clear();
        correction.resize(positions.packs().len(), splat3(Vec3::ZERO));
        let compliance = &self.layout.factors().link_compliance;
        if let Some(mesh) = &mut self.lone_mesh {
            mesh.place(positions.packs(), &self.masses.inverse);
            mesh.sweep_links(false, SLACK, compliance.iter().map(|pack| pack.lanes()[0]));
            mesh.read_corrections(correction);
            return;
        }
        P::run(SweepMesh {
            links: self.fabric.links(),
            is_backwards: false,
            slack: SLACK,
            compliance,
            particles: CorrectedParticles {
                inverse_masses: &self.masses.inverse,
                predicted: positions.packs(),
                correction,
            },
        });
    }
}

struct SweepMesh<'a, P: Pack> {
    links: &'a [Link],
    is_backwards: bool,
    /// Strain up to which links do not resist.
    slack: f32,
    compliance: &'a [P],
    particles: CorrectedParticles<'a, P>,
}

impl<P: Pack> Kernel<P> for SweepMesh<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        let zero = L::splat(token, 0.0);
        let slack = L::splat(token, self.slack);
        let count = self.links.len();
        for at in 0..count {
            let link = &self.links[if self.is_backwards { count - 1 - at } else { at }];
            let [a, b] = link.particles;
            let mass_a: L = self.particles.inverse_mass(token, a);
            let mass_b: L = self.particles.inverse_mass(token, b);
            let compliance = L::load(token, &self.compliance[link.class as usize]);
            let from: V3<L> = self.particles.position(token, a);
            let to: V3<L> = self.particles.position(token, b);
            let along = to - from;
            let rest_length = L::splat(token, link.rest_length);
            let pull = link_pull(token, along, mass_a + mass_b + compliance, rest_length, slack);
            self.particles.correct(token, a, from, (along, pull * mass_a));
            self.particles.correct(token, b, to, (along, zero - pull * mass_b));
        }
    }
}

/// −Δλ/|d| of a link along d (m), given the sum of its inverse masses and its compliance (1/m²), its length at rest
/// (m), and the strain up to which it does not resist.
#[inline(always)]
pub(super) fn link_pull<L: Lane>(
    token: L::Token,
    along: V3<L>,
    denominator: L,
    rest_length: L,
    slack: L,
) -> L {
    let length = along.dot(along).sqrt().max(L::splat(token, LEAST_LENGTH));
    let (change, slack) = (length - rest_length, slack * rest_length);
    let beyond = change - change.min(slack).max(L::splat(token, 0.0) - slack);
    // One division: the length of d is part of the denominator.
    beyond / (denominator * length)
}
