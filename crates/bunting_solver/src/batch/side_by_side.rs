//! The side-by-side layout: a pack holds the same particle of each cloth, with one cloth in each lane.

use core::marker::PhantomData;
use core::ops::Range;

use glam::Vec3;

use crate::batch::layout::{Layout, OfCloth, Order, Particles, Positions};
use crate::constraints::bend_factors::BendFactors;
use crate::constraints::factors::{ClothFactors, Factors};
use crate::constraints::stiffness::Stiffness;
use crate::constraints::twist_factors::TwistFactors;
use crate::fabric::{BendLine, Chains, Fabric, Ribbon, Tether};
use crate::geometry::corners::PatchSums;
use crate::simd::constant::{Constant, PARTIAL_SUMS};
use crate::simd::lane::{Lane, Pack};
use crate::simd::vec3::{Pack3, V3, lane3, set_lane3, splat3};

/// Cloths side by side, solved in the order of the fabric's own lists.
#[derive(Clone, Debug)]
pub(crate) struct SideBySide<P: Pack> {
    /// Particles in a row of the grid; all particles of a mesh that is no grid.
    columns: usize,
    particles: usize,
    factors: Factors<P, f32>,
    /// Compliance of each class of hinges, σ/(k h²), 1/m⁴.
    pub hinge_compliance: Vec<P>,
    /// XPBD multiplier of each hinge, kept from pass to pass of a substep.
    pub hinge_multiplier: Vec<P>,
    /// Contributions of the cells of a grid's row to the particles below the row.
    below: Vec<Pack3<P>>,
}

impl<P: Pack> SideBySide<P> {
    /// The layout of a fabric.
    pub fn new(fabric: &Fabric) -> Self {
        let zero = P::splat(0.0);
        let particles = fabric.particle_count();
        let bending = fabric.bend_profiles().iter();
        let twist = fabric.ribbon_profiles().iter();
        Self {
            columns: fabric.grid().map_or(particles, |grid| grid.columns as usize),
            particles,
            factors: Factors {
                link_compliance: vec![zero; fabric.link_classes().len()],
                bending: bending.map(|profile| BendFactors::new(&[Some(profile)])).collect(),
                twist: twist.map(|profile| TwistFactors::new(&[Some(profile)])).collect(),
                resists_twist: P::splat(0.0),
            },
            hinge_compliance: vec![zero; fabric.hinge_classes().len()],
            hinge_multiplier: vec![zero; fabric.hinges().len()],
            below: vec![splat3(Vec3::ZERO); fabric.patch_grid_columns().unwrap_or(0)],
        }
    }
}

impl<P: Pack> Layout<P> for SideBySide<P> {
    type Constant = f32;
    type Positions = Packs<P>;
    type Tether = Tether;
    type Triangles<'a> = PatchSums<'a, P, f32>;

    const CLOTHS: usize = P::WIDTH;

    fn lanes(cloth: usize) -> Range<usize> {
        cloth..cloth + 1
    }

    fn pack_count(&self) -> usize {
        self.particles
    }

    #[inline]
    fn locate(&self, particle: usize, cloth: usize) -> (usize, usize) {
        (particle, cloth)
    }

    fn read(&self, packs: &[Pack3<P>], cloth: usize, into: &mut Vec<Vec3>) {
        read_lane(packs, cloth, into);
    }

    fn write(&self, packs: &mut [Pack3<P>], cloths: &[OfCloth]) {
        write_lanes(packs, cloths);
    }

    fn constants(&self, of_particles: &[f32]) -> Vec<f32> {
        of_particles.to_vec()
    }

    fn partial_sums(&self) -> Vec<u8> {
        partial_sums(self.particles, self.columns)
    }

    fn positions(&self, packs: Vec<Pack3<P>>) -> Packs<P> {
        Packs::new(packs)
    }

    fn chains<'a>(&'a self, fabric: &'a Fabric) -> &'a Chains {
        fabric.chains()
    }

    fn order_of_chains(&self, _: usize) -> Order {
        Order::RowMajor
    }

    fn linked(&self) -> &[P] {
        &[]
    }

    fn bend_lines<'a>(
        &'a self,
        fabric: &'a Fabric,
    ) -> impl Iterator<Item = (Order, &'a [BendLine])> {
        core::iter::once((Order::RowMajor, fabric.bend_lines()))
    }

    fn ribbons<'a>(&'a self, fabric: &'a Fabric) -> (Order, &'a [Ribbon]) {
        (Order::RowMajor, fabric.ribbons())
    }

    fn tethers<'a>(&'a self, fabric: &'a Fabric) -> [&'a [Tether]; 2] {
        [fabric.far_tethers(), fabric.tethers()]
    }

    fn factors(&self) -> &Factors<P, f32> {
        &self.factors
    }

    fn set_stiffness(&mut self, cloth: usize, fabric: &Fabric, stiffness: &Stiffness) {
        let lane = cloth;
        let of_cloth = ClothFactors::new(fabric, stiffness);
        self.factors.set_resists_twist(lane..lane + 1, &of_cloth);
        let Factors { link_compliance, bending, twist, .. } = &mut self.factors;
        for (pack, compliance) in link_compliance.iter_mut().zip(of_cloth.link_compliance) {
            pack.lanes_mut()[lane] = compliance;
        }
        for (factors, rows) in bending.iter_mut().zip(&of_cloth.bending) {
            factors.set_lane(lane, rows);
        }
        for (factors, rows) in twist.iter_mut().zip(&of_cloth.twist) {
            factors.set_lane(lane, rows);
        }
        let hinges = stiffness.of_hinges(fabric);
        for (pack, compliance) in self.hinge_compliance.iter_mut().zip(hinges) {
            pack.lanes_mut()[lane] = compliance;
        }
    }

    fn set_pins(&mut self, _: usize, _: &Fabric, _: &[Vec3]) {}

    fn triangles<'a>(&'a mut self, fabric: &'a Fabric) -> PatchSums<'a, P, f32> {
        PatchSums {
            patches: fabric.patches(),
            grid_columns: fabric.patch_grid_columns(),
            below: &mut self.below,
        }
    }

    fn moving_triangles<'a>(
        &'a mut self,
        fabric: &'a Fabric,
        velocity: &'a [Pack3<P>],
    ) -> (PatchSums<'a, P, f32>, &'a [Pack3<P>]) {
        (self.triangles(fabric), velocity)
    }
}

/// Reads the vectors of one lane.
pub(super) fn read_lane<P: Pack>(packs: &[Pack3<P>], lane: usize, into: &mut Vec<Vec3>) {
    // Checked once, and not for every number.
    assert!(lane < P::WIDTH, "lanes of the batch");
    into.resize(packs.len(), Vec3::ZERO);
    for (value, pack) in into.iter_mut().zip(packs) {
        *value = lane3(pack, lane);
    }
}

/// Writes pack by pack, so that each is fetched once for all cloths.
pub(super) fn write_lanes<P: Pack>(packs: &mut [Pack3<P>], cloths: &[OfCloth]) {
    for (particle, pack) in packs.iter_mut().enumerate() {
        for &(lane, values) in cloths {
            let value = values.and_then(|values| values.get(particle));
            set_lane3(pack, lane, value.copied().unwrap_or(Vec3::ZERO));
        }
    }
}

/// For each particle, to which partial sum it adds: by its column.
pub(super) fn partial_sums(particles: usize, columns: usize) -> Vec<u8> {
    (0..particles).map(|at| (at % columns % PARTIAL_SUMS) as u8).collect()
}

/// Positions in packs alone, m: constraints move them where they are. Numbers of the fabric are of the type `C`.
#[derive(Clone, Debug)]
pub(crate) struct Packs<P: Pack, C = f32>(Vec<Pack3<P>>, PhantomData<C>);

impl<P: Pack, C> Packs<P, C> {
    /// Positions in packs, m.
    pub fn new(packs: Vec<Pack3<P>>) -> Self {
        Self(packs, PhantomData)
    }
}

impl<P: Pack, C: Constant<P>> Positions<P> for Packs<P, C> {
    type Constant = C;
    type Particles<'a> = PackParticles<'a, P, C>;
    type Lines<'a> = PackParticles<'a, P, C>;
    type Field = [Pack3<P>];

    fn packs(&self) -> &[Pack3<P>] {
        &self.0
    }

    fn packs_mut(&mut self) -> &mut Vec<Pack3<P>> {
        &mut self.0
    }

    fn particles<'a>(
        &'a mut self,
        _: Order,
        inverse_masses: &'a [P],
        _: &'a [P],
    ) -> PackParticles<'a, P, C> {
        PackParticles { inverse_masses, position: &mut self.0, constant: PhantomData }
    }

    fn lines<'a>(
        &'a mut self,
        order: Order,
        inverse_masses: &'a [P],
        linked: &'a [P],
    ) -> Self::Lines<'a> {
        self.particles(order, inverse_masses, linked)
    }

    fn field(&mut self) -> &[Pack3<P>] {
        &self.0
    }

    fn set_inverse_masses(&mut self, _: &[f32]) {}

    fn clear(&mut self) {}
}

/// Particles in packs, each the same of all cloths.
pub(crate) struct PackParticles<'a, P: Pack, C> {
    inverse_masses: &'a [P],
    position: &'a mut [Pack3<P>],
    constant: PhantomData<C>,
}

impl<P: Pack, C: Constant<P>> Particles<P> for PackParticles<'_, P, C> {
    type Constant = C;

    #[inline(always)]
    fn position<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> V3<L> {
        V3::load(token, &self.position[at as usize])
    }

    #[inline(always)]
    fn set_position<L: Lane<Pack = P>>(&mut self, _: L::Token, at: u32, position: V3<L>) {
        position.store(&mut self.position[at as usize]);
    }

    #[inline(always)]
    fn inverse_mass<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> L {
        L::load(token, &self.inverse_masses[at as usize])
    }

    #[inline(always)]
    fn one_if_linked<L: Lane<Pack = P>>(&self, token: L::Token, _: u32) -> L {
        L::splat(token, 1.0)
    }
}
