//! The layout of cloths of different fabrics side by side: grids of one topology.
//!
//! A pack holds the same particle of each cloth, one cloth a lane, as in [`SideBySide`]. Rest lengths, areas and all
//! other numbers of the fabrics differ from lane to lane. Lists of constraints are those of the fabrics, in the
//! same order, so that a lane has the bits that its cloth has among cloths of its own fabric.
//!
//! Fabrics of one topology need not have the same classes and profiles, which depend on rounding. So each link is a
//! class of its own, numbered as its target length, and each line and ribbon a profile of its own.
//!
//! [`SideBySide`]: crate::batch::side_by_side::SideBySide

use core::ops::Range;

use glam::Vec3;

use crate::batch::layout::{Layout, OfCloth, Order};
use crate::batch::masses::Masses;
use crate::batch::side_by_side::{Packs, partial_sums, read_lane, write_lanes};
use crate::batch::tether_pack::TetherPack;
use crate::constraints::bend_factors::BendFactors;
use crate::constraints::factors::{ClothFactors, Factors};
use crate::constraints::stiffness::Stiffness;
use crate::constraints::twist_factors::TwistFactors;
use crate::fabric::{BendLine, Chains, Fabric, Patch, Ribbon, Tether};
use crate::geometry::corners::PatchSums;
use crate::simd::constant::PerLane;
use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, set_lane3, splat3};

/// Cloths of different fabrics side by side.
#[derive(Clone, Debug)]
pub(crate) struct Mixed<P: Pack> {
    /// Particles in a row.
    columns: usize,
    chains: Chains<PerLane<P>>,
    bend_lines: Vec<BendLine>,
    ribbons: Vec<Ribbon>,
    factors: Factors<P, PerLane<P>>,
    patches: Vec<Patch<PerLane<P>>>,
    /// Tethers to the farthest pins and to the nearest, one for each free particle; lanes without a tether have an
    /// infinite length.
    tethers: [Vec<TetherPack<P>>; 2],
    /// Index among the tethers of each particle that is free.
    tether_indices: Vec<u32>,
    /// Scratch row of the contributions of a row of cells to the particles below it.
    below: Vec<Pack3<P>>,
}

impl<P: Pack> Mixed<P> {
    /// The layout of fabrics with the topology of this one, which is in all lanes; none of fabrics that have no
    /// [`topology`](Fabric::topology).
    pub fn of(fabric: &Fabric) -> Option<Self> {
        fabric.topology()?;
        let columns = fabric.patch_grid_columns()?;
        let profile = |index: usize| index as u32;
        let lines = fabric.bend_lines().iter().enumerate();
        let ribbons = fabric.ribbons().iter().enumerate();
        let bending = fabric.bend_lines().iter().map(|line| {
            let of_line = &fabric.bend_profiles()[line.profile as usize];
            BendFactors::new(&vec![Some(of_line); P::WIDTH])
        });
        let twist = fabric.ribbons().iter().map(|ribbon| {
            let of_ribbon = &fabric.ribbon_profiles()[ribbon.profile as usize];
            TwistFactors::new(&vec![Some(of_ribbon); P::WIDTH])
        });
        let particles = 0..fabric.particle_count();
        let free = || particles.clone().filter(|&particle| !fabric.is_pinned(particle));
        let tethers: Vec<TetherPack<P>> =
            free().map(|particle| TetherPack::empty(particle as u32)).collect();
        let mut tether_indices = vec![u32::MAX; particles.len()];
        (0..).zip(free()).for_each(|(index, particle)| tether_indices[particle] = index);
        let chains = fabric.chains().with_a_class_for_each_link(PerLane::splat);
        let patch = |patch: &Patch| Patch {
            corners: patch.corners,
            corner_areas: patch.corner_areas.map(PerLane::splat),
        };
        let mut layout = Self {
            columns,
            bend_lines: lines
                .map(|(index, line)| BendLine { profile: profile(index), ..line.clone() })
                .collect(),
            ribbons: ribbons
                .map(|(index, ribbon)| Ribbon { profile: profile(index), ..ribbon.clone() })
                .collect(),
            factors: Factors {
                link_compliance: vec![P::splat(0.0); chains.target_count()],
                bending: bending.collect(),
                twist: twist.collect(),
                resists_twist: P::splat(0.0),
            },
            chains,
            patches: fabric.patches().iter().map(patch).collect(),
            tethers: [tethers.clone(), tethers],
            tether_indices,
            below: vec![splat3(Vec3::ZERO); columns],
        };
        (0..P::WIDTH).for_each(|lane| layout.set_tether_lengths(lane, fabric));
        Some(layout)
    }

    /// Takes over the lengths of a lane's tethers.
    fn set_tether_lengths(&mut self, lane: usize, fabric: &Fabric) {
        for (packs, tethers) in self.tethers.iter_mut().zip(tethers_of(fabric)) {
            packs.iter_mut().for_each(|pack| pack.lengths.lanes_mut()[lane] = f32::INFINITY);
            for tether in tethers {
                let index = self.tether_indices[tether.particle as usize] as usize;
                packs[index].lengths.lanes_mut()[lane] = tether.length;
            }
        }
    }
}

/// Tethers to the farthest pins, and to the nearest.
fn tethers_of(fabric: &Fabric) -> [&[Tether]; 2] {
    [fabric.far_tethers(), fabric.tethers()]
}

impl<P: Pack> Layout<P> for Mixed<P> {
    type Constant = PerLane<P>;
    type Positions = Packs<P, PerLane<P>>;
    type Tether = TetherPack<P>;
    type Triangles<'a> = PatchSums<'a, P, PerLane<P>>;

    const CLOTHS: usize = P::WIDTH;
    const FABRICS: usize = P::WIDTH;

    fn lanes(cloth: usize) -> Range<usize> {
        cloth..cloth + 1
    }

    fn pack_count(&self) -> usize {
        self.tether_indices.len()
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

    fn constants(&self, of_particles: &[f32]) -> Vec<PerLane<P>> {
        of_particles.iter().map(|&value| PerLane::splat(value)).collect()
    }

    fn partial_sums(&self) -> Vec<u8> {
        partial_sums(self.pack_count(), self.columns)
    }

    fn positions(&self, packs: Vec<Pack3<P>>) -> Packs<P, PerLane<P>> {
        Packs::new(packs)
    }

    fn chains<'a>(&'a self, _: &'a Fabric) -> &'a Chains<PerLane<P>> {
        &self.chains
    }

    fn order_of_chains(&self, _: usize) -> Order {
        Order::RowMajor
    }

    fn linked(&self) -> &[P] {
        &[]
    }

    fn bend_lines<'a>(&'a self, _: &'a Fabric) -> impl Iterator<Item = (Order, &'a [BendLine])> {
        core::iter::once((Order::RowMajor, &self.bend_lines[..]))
    }

    fn ribbons<'a>(&'a self, _: &'a Fabric) -> (Order, &'a [Ribbon]) {
        (Order::RowMajor, &self.ribbons)
    }

    fn tethers<'a>(&'a self, _: &'a Fabric) -> [&'a [TetherPack<P>]; 2] {
        self.tethers.each_ref().map(|tethers| &tethers[..])
    }

    fn factors(&self) -> &Factors<P, PerLane<P>> {
        &self.factors
    }

    fn set_fabric(&mut self, lane: usize, fabric: &Fabric, masses: &mut Masses<P, PerLane<P>>) {
        let areas = masses.areas.iter_mut().zip(fabric.particle_areas());
        let inverse_areas = masses.inverse_areas.iter_mut().zip(fabric.inverse_areas());
        areas.chain(inverse_areas).for_each(|(pack, &value)| pack.set_lane(lane, value));
        for (pair, of_fabric) in self.chains.pairs.iter_mut().zip(&fabric.chains().pairs) {
            let links = pair.links.as_flattened_mut().iter_mut();
            for (link, of_fabric) in links.zip(of_fabric.links.as_flattened()) {
                link.rest_length.set_lane(lane, of_fabric.rest_length);
            }
        }
        for (patch, of_fabric) in self.patches.iter_mut().zip(fabric.patches()) {
            for (pack, &area) in patch.corner_areas.iter_mut().zip(&of_fabric.corner_areas) {
                pack.set_lane(lane, area);
            }
        }
        for (factors, line) in self.factors.bending.iter_mut().zip(fabric.bend_lines()) {
            factors.set_profile(lane, &fabric.bend_profiles()[line.profile as usize]);
        }
        for (factors, ribbon) in self.factors.twist.iter_mut().zip(fabric.ribbons()) {
            factors.set_profile(lane, &fabric.ribbon_profiles()[ribbon.profile as usize]);
        }
        self.set_tether_lengths(lane, fabric);
    }

    fn set_stiffness(&mut self, lane: usize, fabric: &Fabric, stiffness: &Stiffness) {
        let of_cloth = ClothFactors::new(fabric, stiffness);
        self.factors.set_resists_twist(lane..lane + 1, &of_cloth);
        let Factors { link_compliance, bending, twist, .. } = &mut self.factors;
        for (target, class) in fabric.chains().classes() {
            let compliance = of_cloth.link_compliance[class as usize];
            link_compliance[target as usize].lanes_mut()[lane] = compliance;
        }
        for (factors, line) in bending.iter_mut().zip(fabric.bend_lines()) {
            factors.set_lane(lane, &of_cloth.bending[line.profile as usize]);
        }
        for (factors, ribbon) in twist.iter_mut().zip(fabric.ribbons()) {
            factors.set_lane(lane, &of_cloth.twist[ribbon.profile as usize]);
        }
    }

    fn set_pins(&mut self, lane: usize, fabric: &Fabric, positions: &[Vec3]) {
        for (packs, tethers) in self.tethers.iter_mut().zip(tethers_of(fabric)) {
            for tether in tethers {
                let index = self.tether_indices[tether.particle as usize] as usize;
                set_lane3(&mut packs[index].pins, lane, positions[tether.pin as usize]);
            }
        }
    }

    fn triangles<'a>(&'a mut self, _: &'a Fabric) -> PatchSums<'a, P, PerLane<P>> {
        PatchSums {
            patches: &self.patches,
            grid_columns: Some(self.columns),
            below: &mut self.below,
        }
    }

    fn moving_triangles<'a>(
        &'a mut self,
        fabric: &'a Fabric,
        velocity: &'a [Pack3<P>],
    ) -> (PatchSums<'a, P, PerLane<P>>, &'a [Pack3<P>]) {
        (self.triangles(fabric), velocity)
    }
}
