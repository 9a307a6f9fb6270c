//! Laid yarns of a cloth that is alone: yarns of one colour in the lanes.
//!
//! Neighbouring nodes are no neighbours in memory, so particles are vectors, of which eight are gathered at once.

use core::ops::Range;

use fearless_simd::{Simd, SimdCombine, SimdSplit, f32x4, f32x8};
use glam::Vec3;

use super::{BandRow, SolveLaidYarns, YarnLink, YarnParticles, compliance, sum_couplings};
use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Positions;
use crate::fabric::{BAND, Fabric, LaidYarn, LaidYarns, Node, YARNS_AT_ONCE};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::level::dispatch;
use crate::simd::registers::{Pack1, Pack4, Pack8};
use crate::simd::transpose::{coordinates, vectors};
use crate::simd::vec3::{V3, lane3, set_lane3};

/// The laid yarns of a single cloth, those of each colour in a pack.
#[derive(Clone, Debug)]
pub(crate) struct YarnPacks {
    /// The nodes of each pack of yarns.
    packs: Vec<Vec<NodePack>>,
    /// The pack of each colour.
    colours: Vec<Range<usize>>,
    links: Vec<YarnLink<Pack8>>,
    rows: Vec<BandRow<Pack8>>,
    particles: Vec<VectorParticle>,
    /// Inverse masses, 1/m².
    inverse_masses: Vec<Pack1>,
}

const _: () = assert!(YARNS_AT_ONCE == Pack8::WIDTH);

/// A node of each yarn of a pack. A lane whose yarn has ended repeats its last node, so that its links have no length,
/// and a lane without a yarn repeats one node.
#[derive(Clone, Debug)]
struct NodePack {
    nodes: [Node; Pack8::WIDTH],
    /// Number of lanes whose yarn has this node: the first ones, as yarns are sorted by length.
    count: usize,
}

/// A particle while corrections are summed: vectors of x, y, z and a fourth number.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
struct VectorParticle {
    /// Position before the corrections, m, and the inverse mass, 1/m².
    predicted: Pack4,
    /// Sum of the corrections, m, and zero.
    correction: Pack4,
}

impl YarnPacks {
    /// The laid yarns of a fabric; none if it has none.
    pub fn of(fabric: &Fabric) -> Option<Self> {
        let yarns = fabric.laid_yarns();
        if yarns.list.is_empty() {
            return None;
        }
        let colours = yarns.colours.ranges().iter();
        let packs: Vec<Vec<NodePack>> =
            colours.map(|colour| nodes(&yarns.list[colour.clone()])).collect();
        let zero = Pack4::splat(0.0);
        let particle = VectorParticle { predicted: zero, correction: zero };
        Some(Self {
            links: vec![YarnLink::new(); packs.iter().map(|nodes| nodes.len() - 1).sum()],
            rows: vec![BandRow::new(); yarns.longest()],
            particles: vec![particle; fabric.particle_count()],
            inverse_masses: vec![Pack1::splat(0.0); fabric.particle_count()],
            colours: (0..packs.len()).map(|pack| pack..pack + 1).collect(),
            packs,
        })
    }
}

/// The nodes of a pack of yarns, of which the first is the longest.
fn nodes(yarns: &[LaidYarn]) -> Vec<NodePack> {
    let node = |lane: usize, at: usize| match yarns.get(lane) {
        Some(yarn) => yarn.nodes[at.min(yarn.links.len())],
        None => yarns[0].nodes[0],
    };
    let pack = |at: usize| NodePack {
        nodes: core::array::from_fn(|lane| node(lane, at)),
        count: yarns.iter().filter(|yarn| at < yarn.nodes.len()).count(),
    };
    (0..yarns[0].nodes.len()).map(pack).collect()
}

impl<P: Pack> LaneBatch<P> {
    /// Solves the yarns of the cloth in the first lane.
    pub(super) fn solve_yarns_across_lanes(&mut self, passes: u32) {
        let Some(packs) = &mut self.yarn_packs else { return };
        let YarnPacks { packs, colours, links, rows, particles, inverse_masses } = &mut **packs;
        let state = self.positions.packs().iter().zip(&self.correction).zip(&self.masses.inverse);
        let mut has_new_masses = false;
        let copies = particles.iter_mut().zip(&mut *inverse_masses);
        for ((particle, copy), ((position, correction), inverse_mass)) in copies.zip(state) {
            let inverse_mass = inverse_mass.lanes()[0];
            let [x, y, z] = lane3(position, 0).to_array();
            particle.predicted.lanes_mut().copy_from_slice(&[x, y, z, inverse_mass]);
            let [x, y, z] = lane3(correction, 0).to_array();
            particle.correction.lanes_mut().copy_from_slice(&[x, y, z, 0.0]);
            has_new_masses |= copy.lanes()[0] != inverse_mass;
            *copy = Pack1::splat(inverse_mass);
        }
        Pack1::run(BeginLinks {
            yarns: self.fabric.laid_yarns(),
            inverse_masses,
            has_new_masses,
            compliance: &self.layout.modulus_compliance.map(|pack| Pack1::splat(pack.lanes()[0])),
            links,
        });
        let solve = SolveLaidYarns {
            yarns: packs,
            colours,
            passes,
            links,
            rows,
            particles: VectorParticles(particles),
        };
        dispatch!(token => solve_across(token, solve));
        for (correction, particle) in self.correction.iter_mut().zip(particles) {
            let [x, y, z, _] = particle.correction.vector();
            set_lane3(correction, 0, Vec3::new(x, y, z));
        }
    }
}

#[inline(always)]
fn solve_across<S: Simd>(
    token: S,
    solve: SolveLaidYarns<'_, Pack8, Vec<NodePack>, VectorParticles<'_>>,
) {
    solve.solve_all::<f32x8<S>>(token);
}

/// Computes what holds of the links in a substep.
struct BeginLinks<'a> {
    yarns: &'a LaidYarns,
    inverse_masses: &'a [Pack1],
    /// Whether inverse masses differ from those of the substep before.
    has_new_masses: bool,
    /// Compliance of a square of each family, σ/(Y h²), 1/m².
    compliance: &'a [Pack1; 3],
    links: &'a mut [YarnLink<Pack8>],
}

impl Kernel<Pack1> for BeginLinks<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack1>>(self, token: L::Token) {
        let mut first = 0;
        for colour in self.yarns.colours.ranges() {
            let yarns = &self.yarns.list[colour.clone()];
            for (lane, yarn) in yarns.iter().enumerate() {
                let links = &mut self.links[first..first + yarn.links.len()];
                if self.has_new_masses {
                    couple::<L>(token, lane, yarn, links, self.inverse_masses);
                }
                for (laid, link) in yarn.links.iter().zip(links) {
                    let compliance: L = compliance(token, laid, self.compliance);
                    store_lane(compliance, &mut link.compliance, lane);
                    link.target.lanes_mut()[lane] = laid.rest_length;
                }
            }
            first += yarns[0].links.len();
        }
    }
}

/// Sums the inverse masses that couple the links of a yarn.
#[inline(always)]
fn couple<L: Lane<Pack = Pack1>>(
    token: L::Token,
    lane: usize,
    yarn: &LaidYarn,
    links: &mut [YarnLink<Pack8>],
    inverse_masses: &[Pack1],
) {
    let mut couplings = yarn.couplings.as_slice();
    for (laid, link) in yarn.links.iter().zip(links) {
        let sums: [L; BAND + 1] = sum_couplings(token, laid, &mut couplings, inverse_masses);
        for (sum, stored) in sums.into_iter().zip(&mut link.couplings) {
            store_lane(sum, stored, lane);
        }
    }
}

#[inline(always)]
fn store_lane<L: Lane<Pack = Pack1>>(value: L, pack: &mut Pack8, lane: usize) {
    let mut single = Pack1::splat(0.0);
    value.store(&mut single);
    pack.lanes_mut()[lane] = single.lanes()[0];
}

/// Particles of which the nodes of eight yarns are gathered.
struct VectorParticles<'a>(&'a mut [VectorParticle]);

impl<S: Simd> YarnParticles<f32x8<S>> for VectorParticles<'_> {
    type Node = NodePack;

    #[inline(always)]
    fn node(&self, token: S, pack: &NodePack) -> V3<f32x8<S>> {
        let mut at = [<f32x4<S> as Lane>::splat(token, 0.0); Pack8::WIDTH];
        for (at, node) in at.iter_mut().zip(&pack.nodes) {
            let [a, b] = node.particles;
            let (a, b) = (self.position(token, a), self.position(token, b));
            let [part_a, part_b] = node.parts;
            let of_a = a * <f32x4<S> as Lane>::splat(token, part_a);
            *at = of_a.plus_product(b, Lane::splat(token, part_b));
        }
        let [a, b, c, d, e, f, g, h] = at;
        let (low, high) = (coordinates([a, b, c, d]), coordinates([e, f, g, h]));
        V3 { x: low[0].combine(high[0]), y: low[1].combine(high[1]), z: low[2].combine(high[2]) }
    }

    #[inline(always)]
    fn pull_node(&mut self, token: S, pack: &NodePack, pull: V3<f32x8<S>>) {
        let ((x, x_high), (y, y_high), (z, z_high)) =
            (pull.x.split(), pull.y.split(), pull.z.split());
        let low = vectors(token, [x, y, z]);
        let high = vectors(token, [x_high, y_high, z_high]);
        let pulls = low.into_iter().chain(high);
        for (node, pull) in pack.nodes[..pack.count].iter().zip(pulls) {
            for (&particle, &part) in node.particles.iter().zip(&node.parts) {
                let VectorParticle { predicted, correction } = &mut self.0[particle as usize];
                let factor = predicted.vector()[3] * part;
                let sum = <f32x4<S> as Lane>::load(token, correction);
                sum.plus_product(pull, Lane::splat(token, factor)).store(correction);
            }
        }
    }
}

impl VectorParticles<'_> {
    #[inline(always)]
    fn position<S: Simd>(&self, token: S, particle: u32) -> f32x4<S> {
        let VectorParticle { predicted, correction } = &self.0[particle as usize];
        let predicted = <f32x4<S> as Lane>::load(token, predicted);
        predicted + <f32x4<S> as Lane>::load(token, correction)
    }
}
