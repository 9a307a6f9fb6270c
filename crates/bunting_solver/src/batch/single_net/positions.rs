//! Positions of a single net: in packs, and as vectors that constraints gather and scatter.

use std::sync::Arc;

use glam::Vec3;

use super::node_packs::NodePack;
use super::vectors::{read_vectors, write_vectors};
use crate::batch::layout::{Order, Particles, Positions};
use crate::simd::lane::{Lane, Pack};
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::vec3::{Pack3, V3, splat3};

/// Positions of a single net, m. They are valid in the packs or in the vectors.
#[derive(Clone, Debug)]
pub(crate) struct NetPositions {
    packs: Vec<Pack3<Pack8>>,
    /// One of each node, and the one of lanes without a node.
    vectors: Vec<Pack4>,
    /// Whether the vectors hold the valid positions.
    are_vectors_valid: bool,
    /// The nodes of each pack that is gathered.
    nodes: Arc<[NodePack]>,
    /// Inverse masses per unit area density of each pack that is gathered, 1/m².
    inverse_masses: Vec<Pack8>,
    /// Positions in each pack that is gathered while its line is solved, m.
    brought: Vec<Pack3<Pack8>>,
}

impl NetPositions {
    pub(super) fn new(packs: Vec<Pack3<Pack8>>, nodes: Arc<[NodePack]>) -> Self {
        Self {
            vectors: vec![Pack4::splat(0.0); packs.len() * Pack8::WIDTH + 1],
            packs,
            are_vectors_valid: false,
            inverse_masses: vec![Pack8::splat(0.0); nodes.len()],
            brought: vec![splat3(Vec3::ZERO); nodes.len()],
            nodes,
        }
    }
}

impl Positions<Pack8> for NetPositions {
    type Constant = Pack8;
    type Particles<'a> = NetParticles<'a>;
    type Lines<'a> = NetLines<'a>;
    type Field = [Pack4];

    fn packs(&self) -> &[Pack3<Pack8>] {
        debug_assert!(!self.are_vectors_valid, "constraints have the positions");
        &self.packs
    }

    fn packs_mut(&mut self) -> &mut Vec<Pack3<Pack8>> {
        if self.are_vectors_valid {
            write_vectors(&self.vectors, &mut self.packs);
            self.are_vectors_valid = false;
        }
        &mut self.packs
    }

    fn overwritten(&mut self) -> &mut [Pack3<Pack8>] {
        self.are_vectors_valid = false;
        &mut self.packs
    }

    fn particles<'a>(
        &'a mut self,
        _: Order,
        _: &'a [Pack8],
        linked: &'a [Pack8],
    ) -> NetParticles<'a> {
        self.field();
        self.are_vectors_valid = true;
        let Self { vectors, nodes, inverse_masses, .. } = self;
        NetParticles { vectors, nodes, inverse_masses, linked }
    }

    fn lines<'a>(&'a mut self, _: Order, _: &'a [Pack8], linked: &'a [Pack8]) -> NetLines<'a> {
        self.field();
        self.are_vectors_valid = true;
        let Self { vectors, nodes, inverse_masses, brought, .. } = self;
        NetLines { vectors, nodes, inverse_masses, linked, brought }
    }

    fn field(&mut self) -> &[Pack4] {
        if !self.are_vectors_valid {
            read_vectors(&self.packs, &mut self.vectors);
        }
        &self.vectors
    }

    fn set_inverse_masses(&mut self, of_particles: &[f32]) {
        for (masses, nodes) in self.inverse_masses.iter_mut().zip(&*self.nodes) {
            for (mass, node) in masses.lanes_mut().iter_mut().zip(nodes) {
                *mass = of_particles.get(*node as usize).copied().unwrap_or(0.0);
            }
        }
    }

    fn clear(&mut self) {
        self.vectors.fill(Pack4::splat(0.0));
        self.are_vectors_valid = false;
    }
}

/// Nodes that are gathered, eight at once.
pub(crate) struct NetParticles<'a> {
    vectors: &'a mut [Pack4],
    nodes: &'a [NodePack],
    inverse_masses: &'a [Pack8],
    linked: &'a [Pack8],
}

impl Particles<Pack8> for NetParticles<'_> {
    type Constant = Pack8;

    #[inline(always)]
    fn position<L: Lane<Pack = Pack8>>(&self, token: L::Token, at: u32) -> V3<L> {
        V3::gather(token, self.vectors, &self.nodes[at as usize])
    }

    #[inline(always)]
    fn set_position<L: Lane<Pack = Pack8>>(&mut self, token: L::Token, at: u32, position: V3<L>) {
        position.scatter(token, self.vectors, &self.nodes[at as usize]);
    }

    #[inline(always)]
    fn inverse_mass<L: Lane<Pack = Pack8>>(&self, token: L::Token, at: u32) -> L {
        L::load(token, &self.inverse_masses[at as usize])
    }

    #[inline(always)]
    fn one_if_linked<L: Lane<Pack = Pack8>>(&self, token: L::Token, class: u32) -> L {
        L::load(token, &self.linked[class as usize])
    }
}

/// Nodes of lines, which are gathered before a line is solved and scattered afterwards. Each node of a line is in one place of it, but
/// for the first one of a ring and those of rows without a link, which no link moves.
pub(crate) struct NetLines<'a> {
    vectors: &'a mut [Pack4],
    nodes: &'a [NodePack],
    inverse_masses: &'a [Pack8],
    linked: &'a [Pack8],
    brought: &'a mut [Pack3<Pack8>],
}

impl Particles<Pack8> for NetLines<'_> {
    type Constant = Pack8;

    #[inline(always)]
    fn bring<L: Lane<Pack = Pack8>, const N: usize>(
        &mut self,
        token: L::Token,
        rows: &[[u32; N]],
        columns: usize,
    ) {
        for row in rows {
            for &at in &row[..columns] {
                let nodes = &self.nodes[at as usize];
                V3::<L>::gather(token, self.vectors, nodes).store(&mut self.brought[at as usize]);
            }
        }
    }

    #[inline(always)]
    fn put_back<L: Lane<Pack = Pack8>, const N: usize>(
        &mut self,
        token: L::Token,
        rows: &[[u32; N]],
        columns: usize,
    ) {
        for row in rows {
            for &at in &row[..columns] {
                let position = V3::<L>::load(token, &self.brought[at as usize]);
                position.scatter(token, self.vectors, &self.nodes[at as usize]);
            }
        }
    }

    #[inline(always)]
    fn position<L: Lane<Pack = Pack8>>(&self, token: L::Token, at: u32) -> V3<L> {
        V3::load(token, &self.brought[at as usize])
    }

    #[inline(always)]
    fn set_position<L: Lane<Pack = Pack8>>(&mut self, _: L::Token, at: u32, position: V3<L>) {
        position.store(&mut self.brought[at as usize]);
    }

    #[inline(always)]
    fn inverse_mass<L: Lane<Pack = Pack8>>(&self, token: L::Token, at: u32) -> L {
        L::load(token, &self.inverse_masses[at as usize])
    }

    #[inline(always)]
    fn one_if_linked<L: Lane<Pack = Pack8>>(&self, token: L::Token, class: u32) -> L {
        L::load(token, &self.linked[class as usize])
    }
}
