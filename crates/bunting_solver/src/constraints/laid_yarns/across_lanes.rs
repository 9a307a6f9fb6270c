//! Laid yarns of a cloth that is alone: yarns of one colour in the lanes.
//!
//! Neighbouring nodes are no neighbours in memory, so particles are vectors, of which eight are gathered at once.

use core::ops::Range;

use fearless_simd::{Simd, f32x4, f32x8};

use super::{
    BandRow, FARTHER, SolveLaidYarns, TightenLinks, YarnLink, YarnParticles, compliance,
    sum_couplings,
};
use crate::constraints::vector_particles::{VectorParticle, VectorParticles};
use crate::fabric::{BAND, Fabric, LaidYarn, LaidYarns, Node, YARNS_AT_ONCE};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::level::dispatch;
use crate::simd::registers::{Pack1, Pack4, Pack8};
use crate::simd::transpose::{joined, split};
use crate::simd::vec3::V3;

/// The laid yarns of a single cloth, those of each colour in a pack.
#[derive(Clone, Debug)]
pub(crate) struct YarnPacks {
    /// The nodes of each pack of yarns.
    packs: Vec<Vec<NodePack>>,
    /// The pack of each colour.
    colours: Vec<Range<usize>>,
    links: Vec<YarnLink<Pack8>>,
    rows: Vec<BandRow<Pack8>>,
    /// Scratch array of the sums of corrections before the first pass, m.
    before: Vec<Pack4>,
    /// Inverse masses of the particles in the substep before, 1/m².
    inverse_masses: Vec<Pack1>,
}

const _: () = assert!(YARNS_AT_ONCE == Pack8::WIDTH);

/// A node of each yarn of a pack. A lane whose yarn has ended repeats its last node, so that its links have no length,
/// and a lane without a yarn repeats one node.
#[derive(Clone, Debug)]
pub(super) struct NodePack {
    nodes: [Node; Pack8::WIDTH],
    /// Inverse masses of the particles of each node, times their parts, 1/m².
    factors: [[f32; 2]; Pack8::WIDTH],
    /// Number of lanes whose yarn has this node: the first ones, as yarns are sorted by length.
    count: usize,
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
        Some(Self {
            links: vec![YarnLink::new(); packs.iter().map(|nodes| nodes.len() - 1).sum()],
            rows: vec![BandRow::new(); yarns.longest()],
            before: Vec::new(),
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
        factors: [[0.0; 2]; Pack8::WIDTH],
        count: yarns.iter().filter(|yarn| at < yarn.nodes.len()).count(),
    };
    (0..yarns[0].nodes.len()).map(pack).collect()
}

impl NodePack {
    /// Takes over the inverse masses of the particles, 1/m².
    fn set_masses(&mut self, inverse_masses: &[Pack1]) {
        for (node, factors) in self.nodes.iter().zip(&mut self.factors) {
            for ((particle, part), factor) in node.particles.iter().zip(node.parts).zip(factors) {
                *factor = inverse_masses[*particle as usize].lanes()[0] * part;
            }
        }
    }
}

impl YarnPacks {
    /// Solves all yarns, given the compliance of a square of each family, σ/(Y h²), 1/m².
    pub(in crate::constraints) fn solve(
        &mut self,
        yarns: &LaidYarns,
        compliance: [f32; 3],
        passes: u32,
        mut particles: VectorParticles<'_>,
    ) {
        let mut has_new_masses = false;
        for (at, copy) in (0..).zip(&mut self.inverse_masses) {
            let inverse_mass = particles.inverse_mass(at);
            has_new_masses |= copy.lanes()[0] != inverse_mass;
            *copy = Pack1::splat(inverse_mass);
        }
        let Self { packs, links, inverse_masses, .. } = self;
        if has_new_masses {
            packs.iter_mut().flatten().for_each(|pack| pack.set_masses(inverse_masses));
        }
        Pack1::run(BeginLinks {
            yarns,
            inverse_masses,
            has_new_masses,
            compliance: &compliance.map(Pack1::splat),
            links,
        });
        if passes > 1 {
            self.before.clear();
            self.before.extend(particles.0.iter().map(|particle| particle.correction));
            self.run_yarns(1, &mut particles);
            dispatch!(token => go_farther(token, &self.before, particles.0));
            Pack8::run(TightenLinks(&mut self.links));
        }
        self.run_yarns(passes.max(2) - 1, &mut particles);
    }

    fn run_yarns(&mut self, passes: u32, VectorParticles(particles): &mut VectorParticles<'_>) {
        let Self { packs, colours, links, rows, .. } = self;
        let particles = VectorParticles(particles);
        let solve = SolveLaidYarns { yarns: packs, colours, passes, links, rows, particles };
        dispatch!(token => solve_across(token, solve));
    }
}

/// Moves particles farther by a part of what a pass has moved them, given the sums of corrections before it, m.
#[inline(always)]
fn go_farther<S: Simd>(token: S, before: &[Pack4], particles: &mut [VectorParticle]) {
    let farther = <f32x4<S> as Lane>::splat(token, FARTHER);
    for (VectorParticle { correction, .. }, before) in particles.iter_mut().zip(before) {
        let now = <f32x4<S> as Lane>::load(token, correction);
        let moved = now - <f32x4<S> as Lane>::load(token, before);
        now.plus_product(moved, farther).store(correction);
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
                    link.rest_length.lanes_mut()[lane] = laid.rest_length;
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

/// Eight yarns of one colour, whose nodes are gathered.
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
        joined(at)
    }

    #[inline(always)]
    fn pull_node(&mut self, token: S, pack: &NodePack, pull: V3<f32x8<S>>) {
        let nodes = pack.nodes[..pack.count].iter().zip(&pack.factors);
        for ((node, factors), pull) in nodes.zip(split(token, pull)) {
            for (&particle, &factor) in node.particles.iter().zip(factors) {
                self.correct(token, particle, pull, factor);
            }
        }
    }
}
