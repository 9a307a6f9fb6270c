//! The single-mesh layout: one mesh with a background grid across the lanes.
//!
//! A pack holds consecutive particles. Operations on single particles need no more; air and normals gather the corners
//! of eight patches at once. Stretch, shear and bending are solved on the background grid, which lies across the lanes,
//! too (`batch/background_grid.rs`). Gathers, and the interpolation between particles and nodes, read positions as
//! vectors of x, y, z and zero, as neither the corners of patches nor nodes and particles are neighbours in memory.

mod heights;
mod patches;
mod positions;
mod vectors;

use core::ops::Range;
use std::sync::Arc;

use glam::Vec3;

pub(crate) use self::heights::{AddHeightPacks, HeightPacks};
pub(crate) use self::patches::PatchPacks;
pub(crate) use self::positions::MeshPositions;
pub(crate) use self::vectors::{
    pack_constants, pack_count, read_packs, read_vectors, write_packs, write_vectors,
};
use crate::batch::layout::{Layout, OfCloth, Order};
use crate::batch::single_cloth::SingleCloth;
use crate::batch::single_tethers::TetherPacks;
use crate::batch::tether_pack::TetherPack;
use crate::constraints::factors::Factors;
use crate::constraints::stiffness::Stiffness;
use crate::fabric::{BendLine, Chains, Fabric, Ribbon};
use crate::simd::lane::Pack;
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::vec3::Pack3;

/// One mesh across the lanes. It has no chains, lines or ribbons of its own.
#[derive(Clone, Debug)]
pub(crate) struct SingleMesh {
    particles: usize,
    chains: Chains<Pack8>,
    factors: Factors<Pack8, Pack8>,
    /// Tethers to the farthest pins, and to the nearest pins.
    tethers: [TetherPacks<Pack8>; 2],
    patches: PatchPacks,
    /// Velocities as vectors, m/s.
    velocity: Vec<Pack4>,
}

impl SingleMesh {
    /// Velocities as vectors, m/s, of which nothing is kept.
    pub fn velocities_mut(&mut self) -> &mut [Pack4] {
        &mut self.velocity
    }
}

/// The pack and the lane of a particle.
#[inline]
pub(crate) fn locate(particle: usize) -> (usize, usize) {
    (particle / Pack8::WIDTH, particle % Pack8::WIDTH)
}

impl SingleMesh {
    /// The layout of a fabric; none unless it has a background grid or a net that can lie across the lanes.
    pub fn of(fabric: &Arc<Fabric>) -> Option<Self> {
        let grid = &fabric.background()?.fabric;
        if !grid.is_net() {
            SingleCloth::<Pack8>::of(grid)?;
        }
        let particles = fabric.particle_count();
        let tethers = [fabric.far_tethers(), fabric.tethers()]
            .map(|tethers| TetherPacks::new(tethers, |at| locate(at as usize), |pack| pack as u32));
        Some(Self {
            particles,
            chains: Chains::none(),
            factors: Factors {
                link_compliance: Vec::new(),
                bending: Vec::new(),
                twist: Vec::new(),
                resists_twist: Pack8::splat(0.0),
            },
            tethers,
            patches: PatchPacks::new(fabric.patches(), particles),
            velocity: vec![Pack4::splat(0.0); pack_count(particles) * Pack8::WIDTH],
        })
    }
}

impl Layout<Pack8> for SingleMesh {
    type Constant = Pack8;
    type Positions = MeshPositions;
    type Tether = TetherPack<Pack8>;
    type Triangles<'a> = &'a mut PatchPacks;

    const CLOTHS: usize = 1;

    fn lanes(_: usize) -> Range<usize> {
        0..Pack8::WIDTH
    }

    fn pack_count(&self) -> usize {
        pack_count(self.particles)
    }

    #[inline]
    fn locate(&self, particle: usize, _: usize) -> (usize, usize) {
        locate(particle)
    }

    fn read(&self, packs: &[Pack3<Pack8>], _: usize, into: &mut Vec<Vec3>) {
        read_packs(packs, self.particles, into);
    }

    fn write(&self, packs: &mut [Pack3<Pack8>], cloths: &[OfCloth]) {
        write_packs(packs, cloths);
    }

    fn constants(&self, of_particles: &[f32]) -> Vec<Pack8> {
        pack_constants(of_particles)
    }

    /// All packs add to the first partial sum, whose lanes are the partial sums of the cloth.
    fn partial_sums(&self) -> Vec<u8> {
        vec![0; self.pack_count()]
    }

    fn positions(&self, packs: Vec<Pack3<Pack8>>) -> MeshPositions {
        MeshPositions::new(packs)
    }

    fn chains<'a>(&'a self, _: &'a Fabric) -> &'a Chains<Pack8> {
        &self.chains
    }

    fn order_of_chains(&self, _: usize) -> Order {
        Order::RowMajor
    }

    fn linked(&self) -> &[Pack8] {
        &[]
    }

    fn bend_lines<'a>(&'a self, _: &'a Fabric) -> impl Iterator<Item = (Order, &'a [BendLine])> {
        core::iter::empty()
    }

    fn ribbons<'a>(&'a self, _: &'a Fabric) -> (Order, &'a [Ribbon]) {
        (Order::RowMajor, &[])
    }

    fn tethers<'a>(&'a self, _: &'a Fabric) -> [&'a [TetherPack<Pack8>]; 2] {
        self.tethers.each_ref().map(|tethers| &tethers.packs[..])
    }

    fn factors(&self) -> &Factors<Pack8, Pack8> {
        &self.factors
    }

    /// Has nothing to compute: all stiffness is that of the background grid.
    fn set_stiffness(&mut self, _: usize, _: &Fabric, _: &Stiffness) {}

    fn set_pins(&mut self, _: usize, _: &Fabric, positions: &[Vec3]) {
        self.tethers.iter_mut().for_each(|tethers| tethers.set_pins(positions));
    }

    fn triangles<'a>(&'a mut self, _: &'a Fabric) -> &'a mut PatchPacks {
        &mut self.patches
    }

    fn moving_triangles<'a>(
        &'a mut self,
        _: &'a Fabric,
        velocity: &'a [Pack3<Pack8>],
    ) -> (&'a mut PatchPacks, &'a [Pack4]) {
        read_vectors(velocity, &mut self.velocity);
        (&mut self.patches, &self.velocity)
    }
}
