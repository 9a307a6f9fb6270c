//! Positions of a single mesh: in packs, and as vectors for whatever gathers them.

use super::vectors::{read_vectors, write_vectors};
use crate::batch::layout::{Order, Positions};
use crate::batch::side_by_side::{PackParticles, Packs};
use crate::simd::lane::Pack;
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::vec3::Pack3;

/// Positions of a single mesh, m. The packs are valid; the vectors are a copy for a phase of a substep.
#[derive(Clone, Debug)]
pub(crate) struct MeshPositions {
    packs: Packs<Pack8, Pack8>,
    vectors: Vec<Pack4>,
}

impl MeshPositions {
    pub fn new(packs: Vec<Pack3<Pack8>>) -> Self {
        let vectors = vec![Pack4::splat(0.0); packs.len() * Pack8::WIDTH];
        Self { packs: Packs::new(packs), vectors }
    }

    /// The positions as vectors, m.
    pub fn read_vectors(&mut self) -> &mut [Pack4] {
        read_vectors(self.packs.packs(), &mut self.vectors);
        &mut self.vectors
    }

    /// The vectors as they were last read or changed.
    pub fn vectors_mut(&mut self) -> &mut [Pack4] {
        &mut self.vectors
    }

    /// Overwrites the positions by the vectors.
    pub fn write_vectors(&mut self) {
        write_vectors(&self.vectors, self.packs.packs_mut());
    }
}

impl Positions<Pack8> for MeshPositions {
    type Constant = Pack8;
    type Particles<'a> = PackParticles<'a, Pack8, Pack8>;
    type Lines<'a> = PackParticles<'a, Pack8, Pack8>;
    type Field = [Pack4];

    fn packs(&self) -> &[Pack3<Pack8>] {
        self.packs.packs()
    }

    fn packs_mut(&mut self) -> &mut Vec<Pack3<Pack8>> {
        self.packs.packs_mut()
    }

    fn particles<'a>(
        &'a mut self,
        order: Order,
        inverse_masses: &'a [Pack8],
        linked: &'a [Pack8],
    ) -> PackParticles<'a, Pack8, Pack8> {
        self.packs.particles(order, inverse_masses, linked)
    }

    fn lines<'a>(
        &'a mut self,
        order: Order,
        inverse_masses: &'a [Pack8],
        linked: &'a [Pack8],
    ) -> Self::Lines<'a> {
        self.particles(order, inverse_masses, linked)
    }

    fn field(&mut self) -> &[Pack4] {
        self.read_vectors()
    }

    fn set_inverse_masses(&mut self, _: &[f32]) {}

    fn clear(&mut self) {}
}
