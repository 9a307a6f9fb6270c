//! The single-net layout: the net of one mesh across the lanes.
//!
//! A pack of the state holds consecutive nodes. Lines of a net are no neighbours in memory, and differ in length: eight
//! lines that share no node are solved in one pack, whose nodes are gathered as vectors of x, y, z and zero. Where a lane's
//! line has ended, the lane holds a vector that nothing moves (`node_packs.rs`). A line's nodes are gathered before it is solved, and
//! scattered afterwards; diagonals are gathered link by link. The kernels are those of cloths side by side, and every line has the bits
//! of scalar code.

mod bend_lines;
mod chains;
mod in_order;
mod lane_indices;
mod node_packs;
mod pack_lanes;
mod patches;
mod positions;
mod vectors;

use core::ops::Range;
use std::sync::Arc;

use glam::Vec3;

use self::bend_lines::BendLinePacks;
use self::chains::ChainPacks;
use self::lane_indices::{LaneIndices, NO_INDEX};
use self::node_packs::{NodePack, NodePacks};
use self::patches::PatchPacks;
use self::positions::NetPositions;
use self::vectors::{pack_constants, pack_count, read_packs, read_vectors, write_packs};
use crate::batch::layout::{Layout, OfCloth, Order};
use crate::batch::single_tethers::TetherPacks;
use crate::batch::tether_pack::TetherPack;
use crate::constraints::bend_factors::BendFactors;
use crate::constraints::factors::{ClothFactors, Factors};
use crate::constraints::stiffness::Stiffness;
use crate::fabric::{BendLine, Chains, Fabric, RestBends, Ribbon};
use crate::simd::constant::Constant;
use crate::simd::lane::Pack;
use crate::simd::registers::{Pack4, Pack8};
use crate::simd::vec3::Pack3;

/// One net across the lanes, with its lines in packs.
#[derive(Clone, Debug)]
pub(crate) struct SingleNet {
    particles: usize,
    /// The nodes of each pack that constraints gather.
    nodes: Arc<[NodePack]>,
    chains: ChainPacks,
    /// For each class of links, one in lanes that have a link, zero in others.
    linked: Vec<Pack8>,
    bend_lines: BendLinePacks,
    /// For each pack of nodes, the packs of their neighbours: before and after them in their rows, above and below them.
    neighbours: Vec<[u32; 4]>,
    factors: Factors<Pack8, Pack8>,
    /// Tethers to the farthest pins, and to the nearest pins.
    tethers: [TetherPacks<Pack8>; 2],
    patches: PatchPacks,
    /// Velocities as vectors, m/s.
    velocity: Vec<Pack4>,
}

impl SingleNet {
    /// The layout of a fabric; none unless it is a net.
    pub fn of(fabric: &Fabric) -> Option<Self> {
        let rest = fabric.rest_bends()?;
        let particles = fabric.particle_count();
        let mut nodes = NodePacks::new(particles);
        let chains = ChainPacks::new(fabric, &mut nodes);
        let bend_lines = BendLinePacks::new(fabric, &mut nodes);
        let neighbours = (0..pack_count(particles)).map(|pack| {
            [0, 1, 2, 3].map(|side| {
                nodes.index_of(core::array::from_fn(|lane| {
                    rest.neighbours.get(pack * Pack8::WIDTH + lane).map(|near| near[side])
                }))
            })
        });
        let neighbours = neighbours.collect();
        let linked = |of_lanes: &LaneIndices| {
            <Pack8 as Constant<Pack8>>::of(|lane| f32::from(of_lanes[lane] != NO_INDEX))
        };
        let bending = bend_lines
            .profiles
            .iter()
            .map(|of_lanes| BendFactors::new(&of_lanes_in(of_lanes, fabric.bend_profiles())));
        Some(Self {
            particles,
            factors: Factors {
                link_compliance: vec![Pack8::splat(0.0); chains.classes.len()],
                bending: bending.collect(),
                twist: Vec::new(),
                resists_twist: Pack8::splat(0.0),
            },
            linked: chains.classes.iter().map(linked).collect(),
            tethers: [fabric.far_tethers(), fabric.tethers()].map(|tethers| {
                TetherPacks::new(tethers, |at| locate(at as usize), |pack| pack as u32)
            }),
            patches: PatchPacks::new(fabric.patches(), particles),
            velocity: vec![Pack4::splat(0.0); pack_count(particles) * Pack8::WIDTH],
            nodes: nodes.of.into(),
            chains,
            bend_lines,
            neighbours,
        })
    }
}

/// The pack and the lane of a particle.
#[inline]
fn locate(particle: usize) -> (usize, usize) {
    (particle / Pack8::WIDTH, particle % Pack8::WIDTH)
}

/// The elements of a list of the fabric that the lanes' indices refer to.
fn of_lanes_in<'a, T>(of_lanes: &LaneIndices, list: &'a [T]) -> Vec<Option<&'a T>> {
    of_lanes.iter().map(|&index| list.get(index as usize)).collect()
}

impl Layout<Pack8> for SingleNet {
    type Constant = Pack8;
    type Positions = NetPositions;
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

    fn neighbours_of_pack(&self, pack: usize, _: &[usize], _: &RestBends) -> [u32; 4] {
        self.neighbours[pack]
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

    fn positions(&self, packs: Vec<Pack3<Pack8>>) -> NetPositions {
        NetPositions::new(packs, Arc::clone(&self.nodes))
    }

    fn chains<'a>(&'a self, _: &'a Fabric) -> &'a Chains<Pack8> {
        &self.chains.chains
    }

    fn particle_at(&self, _: Order, index: u32, lane: usize) -> Option<u32> {
        let node = self.nodes[index as usize][lane];
        ((node as usize) < self.particles).then_some(node)
    }

    fn order_of_chains(&self, _: usize) -> Order {
        Order::RowMajor
    }

    fn linked(&self) -> &[Pack8] {
        &self.linked
    }

    fn bend_lines<'a>(&'a self, _: &'a Fabric) -> impl Iterator<Item = (Order, &'a [BendLine])> {
        core::iter::once((Order::RowMajor, &self.bend_lines.lines[..]))
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

    fn set_stiffness(&mut self, _: usize, fabric: &Fabric, stiffness: &Stiffness) {
        let of_cloth = ClothFactors::new(fabric, stiffness);
        let Factors { link_compliance, bending, .. } = &mut self.factors;
        for (pack, classes) in link_compliance.iter_mut().zip(&self.chains.classes) {
            let of_class = |class: u32| of_cloth.link_compliance.get(class as usize);
            *pack = <Pack8 as Constant<Pack8>>::of(|lane| {
                of_class(classes[lane]).copied().unwrap_or(0.0)
            });
        }
        for (factors, profiles) in bending.iter_mut().zip(&self.bend_lines.profiles) {
            for (lane, rows) in of_lanes_in(profiles, &of_cloth.bending).iter().enumerate() {
                rows.iter().for_each(|rows| factors.set_lane(lane, rows));
            }
        }
    }

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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec3;

    use crate::batch::cloth_batch::ClothBatch;
    use crate::batch::lane_count::LaneCount;
    use crate::batch::snapshot::ClothSnapshot;
    use crate::fabric::{Fabric, FabricBuilder, FabricMaterial, Resolution};
    use crate::simd::level::with_every_instruction_set;
    use crate::step::{Drive, StepSettings};

    /// Two cones from a waist, whose rings of nodes have different lengths.
    fn skirt() -> Arc<Fabric> {
        const AROUND: u32 = 36;
        let place = |column: u32, row: u32| {
            let (sin, cos) = libm::sincosf(core::f32::consts::TAU * column as f32 / AROUND as f32);
            let radius = 0.1 + 0.02 * row as f32;
            Vec3::new(radius * sin, -0.03 * row as f32, radius * cos)
        };
        let index = |column: u32, row: u32| row * AROUND + column % AROUND;
        let corners = (0..9).flat_map(|row| (0..AROUND).map(move |column| (column, row)));
        let corners = corners.flat_map(|(column, row)| {
            let [a, b] = [0, 1].map(|by| index(column + by, row));
            let [c, d] = [0, 1].map(|by| index(column + by, row + 1));
            [a, c, d, a, d, b]
        });
        let places = (0..10).flat_map(|row| (0..AROUND).map(move |column| (column, row)));
        let positions = places.map(|(column, row)| place(column, row)).collect();
        let builder = FabricBuilder::new(positions, corners.collect()).pin(0..AROUND);
        builder.resampled(Resolution::Particles(10 * AROUND)).expect("a good mesh").fabric
    }

    #[test]
    fn a_net_has_the_same_bits_alone_and_side_by_side() {
        let fabric = skirt();
        let rings = fabric.yarns().iter().filter(|yarn| yarn.is_ring());
        let mut lengths: Vec<usize> = rings.map(|yarn| yarn.links.len()).collect();
        lengths.dedup();
        assert!(lengths.iter().any(|it| it % 2 == 0) && lengths.iter().any(|it| it % 2 == 1));
        let blown = |lanes: LaneCount| {
            let mut batch = ClothBatch::new(Arc::clone(&fabric), lanes);
            let at_rest = ClothSnapshot::at_rest(&fabric);
            batch.insert(&at_rest, FabricMaterial::NYLON).expect("a free lane");
            let wind = Vec3::new(6.0, 0.0, 2.0);
            batch.drive(0, Drive { wind, ..Drive::default() }).expect("a good drive");
            (0..20).for_each(|_| batch.step(1.0 / 60.0, StepSettings::default()));
            batch.snapshot(0)
        };
        let all = with_every_instruction_set(|| [LaneCount::One, LaneCount::Eight].map(blown));
        for [alone, side_by_side] in &all {
            assert!(alone == side_by_side, "other bits");
        }
    }
}
