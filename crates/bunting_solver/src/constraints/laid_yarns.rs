//! Yarns laid across the triangles of a mesh: the distance constraints along one yarn solved at once, exactly.
//!
//! The system is that of `chain.rs`, (J M⁻¹ Jᵀ + α̃) Δλ = −C − α̃ λ, with rows multiplied by |d| and unknowns λ/|d|. Each
//! node moves with the two particles of an edge, so that a particle moves up to [`BAND`] + 1 links in succession, and the
//! matrix is a band. It is factorised as L D Lᵀ while it is assembled.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Particles, Positions};
use crate::constraints::corrections::CorrectedParticles;
use crate::fabric::{BAND, LaidYarn};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

/// Least pivot of a yarn's system, as a part of its diagonal element. Smaller: links whose nodes almost coincide move
/// particles by rounding errors. Larger: inextensible yarns stretch.
const LEAST_PIVOT: f32 = 1e-4;

/// A row of a yarn's system, for one link: values that the elimination stores for the substitution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BandRow<P: Pack> {
    /// Vector d from the link's first node to its second, m.
    pub along: Pack3<P>,
    /// Row of L left of its diagonal: the k-th element is that of the link k + 1 links before.
    pub lower: [P; BAND],
    /// Unknown of this row, λ/|d|, without its terms in the unknowns after it.
    pub unknown: P,
    /// Change of the link's target for a unit change of the unknown, α̃ |d|, m.
    pub target_change: P,
}

impl<P: Pack> BandRow<P> {
    /// A row of zeros.
    pub fn new() -> Self {
        let zero = P::splat(0.0);
        Self { along: [zero; 3], lower: [zero; BAND], unknown: zero, target_change: zero }
    }
}

impl<P: Pack> LaneBatch<P> {
    /// Solves all yarns forwards and then backwards in each pass, and adds to the sums of corrections.
    pub fn solve_laid_yarns(&mut self, passes: u32) {
        let yarns = &self.fabric.laid_yarns().list;
        let inverse_masses = &self.masses.inverse;
        P::run(SumCouplings { yarns, inverse_masses, sums: &mut self.couplings });
        P::run(SolveLaidYarns {
            yarns,
            passes,
            couplings: &self.couplings,
            compliance: &self.layout.modulus_compliance,
            rows: &mut self.band_rows,
            target: &mut self.link_target,
            particles: CorrectedParticles {
                inverse_masses: &self.masses.inverse,
                predicted: self.positions.packs(),
                correction: &mut self.correction,
            },
        });
    }
}

/// Sums the inverse masses that couple the rows of the yarns' systems, times their factors.
struct SumCouplings<'a, P: Pack> {
    yarns: &'a [LaidYarn],
    inverse_masses: &'a [P],
    sums: &'a mut [[P; BAND + 1]],
}

impl<P: Pack> Kernel<P> for SumCouplings<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let mut sums = self.sums.iter_mut();
        for yarn in self.yarns {
            let mut couplings = yarn.couplings.iter();
            for (link, sums) in yarn.links.iter().zip(&mut sums) {
                for (&count, sum) in link.couplings.iter().zip(sums) {
                    let mut of_links = L::splat(token, 0.0);
                    for coupling in couplings.by_ref().take(usize::from(count)) {
                        let inverse_mass =
                            L::load(token, &self.inverse_masses[coupling.particle as usize]);
                        let factor = L::splat(token, coupling.factor);
                        of_links = of_links.plus_product(inverse_mass, factor);
                    }
                    of_links.store(sum);
                }
            }
        }
    }
}

struct SolveLaidYarns<'a, P: Pack> {
    yarns: &'a [LaidYarn],
    passes: u32,
    /// For each link the sums of inverse masses that couple its row to itself and to the rows before.
    couplings: &'a [[P; BAND + 1]],
    /// Compliance of a square of each family, σ/(Y h²), 1/m².
    compliance: &'a [P; 3],
    rows: &'a mut [BandRow<P>],
    target: &'a mut [P],
    particles: CorrectedParticles<'a, P>,
}

impl<P: Pack> Kernel<P> for SolveLaidYarns<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        let yarns = self.yarns;
        for pass in 0..self.passes {
            let mut first_target = 0;
            for (index, yarn) in yarns.iter().enumerate() {
                // A pass begins with the yarn that ended the pass before, which is not solved again.
                if pass == 0 || index > 0 {
                    self.solve::<L>(token, yarn, first_target, pass == 0);
                }
                first_target += yarn.links.len();
            }
            for (index, yarn) in yarns.iter().enumerate().rev() {
                first_target -= yarn.links.len();
                if index + 1 < yarns.len() {
                    self.solve::<L>(token, yarn, first_target, false);
                }
            }
        }
    }
}

impl<P: Pack> SolveLaidYarns<'_, P> {
    #[inline(always)]
    fn solve<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        yarn: &LaidYarn,
        first_target: usize,
        is_first: bool,
    ) {
        self.eliminate::<L>(token, yarn, first_target, is_first);
        self.substitute::<L>(token, yarn, first_target);
    }

    #[inline(always)]
    fn eliminate<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        yarn: &LaidYarn,
        first_target: usize,
        is_first: bool,
    ) {
        let zero = L::splat(token, 0.0);
        let least = L::splat(token, f32::MIN_POSITIVE);
        // Of the rows before, the last one first: directions, rows of L, inverse pivots, right sides.
        let mut along = [V3::splat(token, 0.0); BAND];
        let mut lower = [[zero; BAND]; BAND];
        let mut inverse = [zero; BAND];
        let mut right_sides = [zero; BAND];
        let own = first_target..first_target + yarn.links.len();
        let couplings = &self.couplings[own.clone()];
        let targets = &mut self.target[own];
        let particles = &self.particles;
        let mut from = particles.node::<L>(token, &yarn.nodes[0].particles, &yarn.nodes[0].parts);
        let links = yarn.links.iter().zip(&yarn.nodes[1..]);
        let links = links.zip(couplings).zip(targets).zip(self.rows.iter_mut());
        for ((((link, node), coupling), target), row) in links {
            if is_first {
                *target = P::splat(link.rest_length);
            }
            let to = particles.node::<L>(token, &node.particles, &node.parts);
            let d = to - from;
            let squared = d.dot(d);
            let length = squared.sqrt();
            let of_square = L::load(token, &self.compliance[link.family as usize]);
            let compliance = of_square * L::splat(token, link.slenderness);
            let own = L::load(token, &coupling[0]) + compliance;
            let diagonal = least.plus_product(own, squared);
            // u is the row of L D, from the farthest link to the nearest.
            let mut u = [zero; BAND];
            for back in 0..BAND {
                u[back] = L::load(token, &coupling[back + 1]) * d.dot(along[back]);
            }
            for back in (0..BAND).rev() {
                for farther in back + 1..BAND {
                    u[back] = u[back].minus_product(u[farther], lower[back][farther - back - 1]);
                }
            }
            let mut pivot = diagonal;
            let mut right = L::load(token, target) * length - squared;
            let mut of_row = [zero; BAND];
            for back in 0..BAND {
                of_row[back] = u[back] * inverse[back];
                pivot = pivot.minus_product(u[back], of_row[back]);
                right = right.minus_product(of_row[back], right_sides[back]);
            }
            let pivot = pivot.max(diagonal * L::splat(token, LEAST_PIVOT));
            let one_over = L::splat(token, 1.0) / pivot;
            d.store(&mut row.along);
            for (lower, stored) in of_row.into_iter().zip(&mut row.lower) {
                lower.store(stored);
            }
            (right * one_over).store(&mut row.unknown);
            (compliance * length).store(&mut row.target_change);
            for back in (1..BAND).rev() {
                along[back] = along[back - 1];
                lower[back] = lower[back - 1];
                inverse[back] = inverse[back - 1];
                right_sides[back] = right_sides[back - 1];
            }
            (along[0], lower[0], inverse[0], right_sides[0]) = (d, of_row, one_over, right);
            from = to;
        }
    }

    /// Substitutes from the last links to the first, and moves the particles of each node by the tensions of its two links.
    #[inline(always)]
    fn substitute<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        yarn: &LaidYarn,
        first_target: usize,
    ) {
        let zero = L::splat(token, 0.0);
        let mut unknowns = [zero; BAND];
        let mut lower = [[zero; BAND]; BAND];
        let mut next_tension = V3::splat(token, 0.0);
        let count = yarn.links.len();
        let targets = &mut self.target[first_target..first_target + count];
        let rows = self.rows[..count].iter().zip(targets);
        for ((row, target), node) in rows.zip(&yarn.nodes[1..]).rev() {
            let mut unknown = L::load(token, &row.unknown);
            for after in 0..BAND {
                unknown = unknown.minus_product(lower[after][after], unknowns[after]);
            }
            let change = L::load(token, &row.target_change);
            let new_target = L::load(token, target).minus_product(change, unknown);
            new_target.store(target);
            let tension = V3::load(token, &row.along) * unknown;
            self.particles.pull_node(token, &node.particles, &node.parts, tension - next_tension);
            for after in (1..BAND).rev() {
                unknowns[after] = unknowns[after - 1];
                lower[after] = lower[after - 1];
            }
            unknowns[0] = unknown;
            for (lower, stored) in lower[0].iter_mut().zip(&row.lower) {
                *lower = L::load(token, stored);
            }
            next_tension = tension;
        }
        let node = &yarn.nodes[0];
        let pull = V3::splat(token, 0.0) - next_tension;
        self.particles.pull_node(token, &node.particles, &node.parts, pull);
    }
}

impl<P: Pack> CorrectedParticles<'_, P> {
    /// Position of a node, m.
    #[inline(always)]
    fn node<L: Lane<Pack = P>>(
        &self,
        token: L::Token,
        [a, b]: &[u32; 2],
        parts: &[f32; 2],
    ) -> V3<L> {
        let a: V3<L> = self.position(token, *a);
        let b: V3<L> = self.position(token, *b);
        (a * L::splat(token, parts[0])).plus_scaled(b, L::splat(token, parts[1]))
    }

    /// Moves a node's particles by a pull on it.
    #[inline(always)]
    fn pull_node<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        particles: &[u32; 2],
        parts: &[f32; 2],
        pull: V3<L>,
    ) {
        for (&particle, &part) in particles.iter().zip(parts) {
            let inverse_mass: L = self.inverse_mass(token, particle);
            let factor = inverse_mass * L::splat(token, part);
            self.correct(token, particle, pull, (pull, factor));
        }
    }
}
