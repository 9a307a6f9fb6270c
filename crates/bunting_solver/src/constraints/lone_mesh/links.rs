//! Links of a lone mesh, eight at once.

use fearless_simd::{Simd, f32x8};

use super::in_order::packs_in_order;
use crate::constraints::direction::sweep_order;
use crate::constraints::mesh_sweep::link_pull;
use crate::constraints::vector_particles::VectorParticles;
use crate::fabric::Fabric;
use crate::simd::lane::{Lane, Pack};
use crate::simd::registers::Pack8;

/// Links that share no particle. Lanes without a link repeat the first one.
#[derive(Clone, Debug)]
pub(super) struct LinkPack {
    /// The particles of the links, first all first ends.
    particles: [[u32; Pack8::WIDTH]; 2],
    /// m.
    rest_length: Pack8,
    /// Index of the compliance of each link.
    classes: [u32; Pack8::WIDTH],
    /// Number of links: the first lanes have them.
    count: usize,
}

/// The links of a fabric in packs.
pub(super) fn link_packs(fabric: &Fabric) -> Vec<LinkPack> {
    let links = fabric.links();
    let particles = links.iter().map(|link| &link.particles[..]);
    let packs = packs_in_order(Pack8::WIDTH, fabric.particle_count(), particles);
    let link_pack = |pack: &Vec<usize>| {
        let link = |lane: usize| &links[*pack.get(lane).unwrap_or(&pack[0])];
        let mut rest_length = Pack8::splat(0.0);
        for (lane, length) in rest_length.lanes_mut().iter_mut().enumerate() {
            *length = link(lane).rest_length;
        }
        LinkPack {
            particles: [0, 1].map(|end| core::array::from_fn(|lane| link(lane).particles[end])),
            rest_length,
            classes: core::array::from_fn(|lane| link(lane).class),
            count: pack.len(),
        }
    };
    packs.iter().map(link_pack).collect()
}

/// Solves each link once, from the first to the last or backwards.
pub(super) struct SweepLinks<'a> {
    pub packs: &'a [LinkPack],
    pub is_backwards: bool,
    /// Compliance of each class, 1/m².
    pub compliance: &'a [f32],
    pub particles: VectorParticles<'a>,
}

impl SweepLinks<'_> {
    #[inline(always)]
    pub fn run<S: Simd>(mut self, token: S) {
        for index in sweep_order(self.packs.len(), self.is_backwards) {
            self.solve(token, &self.packs[index]);
        }
    }

    #[inline(always)]
    fn solve<S: Simd>(&mut self, token: S, pack: &LinkPack) {
        let mut compliance = Pack8::splat(0.0);
        for (compliance, &class) in compliance.lanes_mut().iter_mut().zip(&pack.classes) {
            *compliance = self.compliance[class as usize];
        }
        let compliance: f32x8<S> = Lane::load(token, &compliance);
        let rest_length = Lane::load(token, &pack.rest_length);
        let [a, b] = &pack.particles;
        let mass_a = self.particles.inverse_masses(token, a);
        let mass_b = self.particles.inverse_masses(token, b);
        let along = self.particles.gather(token, b) - self.particles.gather(token, a);
        let pull = link_pull(token, along, mass_a + mass_b + compliance, rest_length);
        self.particles.scatter(token, &a[..pack.count], along, pull * mass_a);
        let zero = <f32x8<S> as Lane>::splat(token, 0.0);
        self.particles.scatter(token, &b[..pack.count], along, zero - pull * mass_b);
    }
}
