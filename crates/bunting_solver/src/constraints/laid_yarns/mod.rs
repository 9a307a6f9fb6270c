//! Yarns laid across the triangles of a mesh: the distance constraints along one yarn solved at once, exactly.
//!
//! The system is that of `chain.rs`, (J M⁻¹ Jᵀ + α̃) Δλ = −C − α̃ λ, with rows multiplied by |d| and unknowns λ/|d|.
//! Each node moves with the two particles of an edge, so that a particle moves up to [`BAND`] + 1 links in succession,
//! and the matrix is a band. It is factorised as L D Lᵀ while it is assembled.
//!
//! Cloths side by side have the same yarn in every lane (`side_by_side`). A cloth that is alone has eight yarns of one
//! colour in the lanes (`across_lanes`). Both have the same bits.

mod across_lanes;
mod side_by_side;

use core::ops::Range;

pub(crate) use self::across_lanes::YarnPacks;
use crate::fabric::{BAND, Coupling, LaidLink};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

/// Least pivot of a yarn's system, as a part of its diagonal element. Smaller: links whose nodes almost coincide move
/// particles by rounding errors. Larger: inextensible yarns stretch.
const LEAST_PIVOT: f32 = 1e-4;

/// Part by which the first of several passes goes farther than it found.
///
/// A pass leaves a part t of a mode's error, 0 ≤ t ≤ 1, and two passes t². With a first pass that goes 1 + f times as
/// far they leave t ((1 + f) t − f): still nothing of what the yarns solve by themselves (t = 0), and of what the
/// families hardly agree on (t near 1) as little as 2 + f passes do, in the time of two. Between them the cloth goes
/// too far, by f²/4 (1 + f) at most. Smaller: stiff curved meshes stretch too far, by 40 to 60 % for 10⁻⁴ with 0.
/// Larger: flat ones too little, by 12 % with 1.
const FARTHER: f32 = 0.5;

/// A link of a laid yarn in a substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct YarnLink<P: Pack> {
    /// Sums of the inverse masses that couple its row to itself and to the rows before, 1/m².
    couplings: [P; BAND + 1],
    /// σ l/(Y w h²), with the width w of cloth that the link stands for, 1/m².
    compliance: P,
    /// m.
    rest_length: P,
    /// Length under the tension found so far in the substep, m.
    target: P,
}

impl<P: Pack> YarnLink<P> {
    /// A link that does nothing.
    pub fn new() -> Self {
        let zero = P::splat(0.0);
        Self { couplings: [zero; BAND + 1], compliance: zero, rest_length: zero, target: zero }
    }
}

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

/// The links take up the tension with which a pass goes farther.
struct TightenLinks<'a, P: Pack>(&'a mut [YarnLink<P>]);

impl<P: Pack> Kernel<P> for TightenLinks<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let farther = L::splat(token, FARTHER);
        for link in self.0 {
            let target = L::load(token, &link.target);
            let stretch = target - L::load(token, &link.rest_length);
            target.plus_product(stretch, farther).store(&mut link.target);
        }
    }
}

/// Particles as laid yarns move them.
trait YarnParticles<L: Lane> {
    /// A node of a yarn in each lane.
    type Node;

    /// Positions of a node, m.
    fn node(&self, token: L::Token, node: &Self::Node) -> V3<L>;

    /// Moves a node's particles by a pull on it.
    fn pull_node(&mut self, token: L::Token, node: &Self::Node, pull: V3<L>);
}

/// Sums of the inverse masses that couple a link to itself and to those before, times their factors. Takes the link's
/// couplings off the front of those of its yarn.
#[inline(always)]
fn sum_couplings<L: Lane>(
    token: L::Token,
    link: &LaidLink,
    of_yarn: &mut &[Coupling],
    inverse_masses: &[L::Pack],
) -> [L; BAND + 1] {
    let mut sums = [L::splat(token, 0.0); BAND + 1];
    for (&count, sum) in link.couplings.iter().zip(&mut sums) {
        let (couplings, rest) = of_yarn.split_at(usize::from(count));
        *of_yarn = rest;
        for coupling in couplings {
            let inverse_mass = L::load(token, &inverse_masses[coupling.particle as usize]);
            *sum = sum.plus_product(inverse_mass, L::splat(token, coupling.factor));
        }
    }
    sums
}

/// The compliance of a link, given that of a square of each family, 1/m².
#[inline(always)]
fn compliance<L: Lane>(token: L::Token, link: &LaidLink, of_squares: &[L::Pack; 3]) -> L {
    let of_square = L::load(token, &of_squares[link.family as usize]);
    of_square * L::splat(token, link.slenderness)
}

/// Solves yarns `Y` that move particles `S`.
struct SolveLaidYarns<'a, P: Pack, Y, S> {
    yarns: &'a [Y],
    /// Yarns of one colour share no particle.
    colours: &'a [Range<usize>],
    passes: u32,
    /// The links, yarn by yarn.
    links: &'a mut [YarnLink<P>],
    rows: &'a mut [BandRow<P>],
    particles: S,
}

impl<P: Pack, Y, S> SolveLaidYarns<'_, P, Y, S> {
    #[inline(always)]
    fn solve_all<L: Lane<Pack = P>>(mut self, token: L::Token)
    where
        S: YarnParticles<L>,
        Y: AsRef<[S::Node]>,
    {
        let (yarns, colours) = (self.yarns, self.colours);
        for pass in 0..self.passes {
            let mut at = 0;
            for (index, colour) in colours.iter().enumerate() {
                for yarn in &yarns[colour.clone()] {
                    let nodes = yarn.as_ref();
                    let links = at..at + nodes.len() - 1;
                    at = links.end;
                    // A pass begins with the colour that ended the pass before, which is not solved again.
                    if pass == 0 || index > 0 {
                        self.solve(token, nodes, links);
                    }
                }
            }
            for (index, colour) in colours.iter().enumerate().rev() {
                for yarn in yarns[colour.clone()].iter().rev() {
                    let nodes = yarn.as_ref();
                    let links = at + 1 - nodes.len()..at;
                    at = links.start;
                    if index + 1 < colours.len() {
                        self.solve(token, nodes, links);
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn solve<L: Lane<Pack = P>>(&mut self, token: L::Token, nodes: &[S::Node], links: Range<usize>)
    where
        S: YarnParticles<L>,
    {
        self.eliminate(token, nodes, links.clone());
        self.substitute(token, nodes, links);
    }

    #[inline(always)]
    fn eliminate<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        nodes: &[S::Node],
        links: Range<usize>,
    ) where
        S: YarnParticles<L>,
    {
        let zero = L::splat(token, 0.0);
        let least = L::splat(token, f32::MIN_POSITIVE);
        // Of the rows before, the last one first: directions, rows of L, inverse pivots, right sides.
        let mut along = [V3::splat(token, 0.0); BAND];
        let mut lower = [[zero; BAND]; BAND];
        let mut inverse = [zero; BAND];
        let mut right_sides = [zero; BAND];
        let particles = &self.particles;
        let mut from = particles.node(token, &nodes[0]);
        let links = nodes[1..].iter().zip(&self.links[links]);
        for ((node, link), row) in links.zip(self.rows.iter_mut()) {
            let to = particles.node(token, node);
            let d = to - from;
            let squared = d.dot(d);
            let length = squared.sqrt();
            let compliance = L::load(token, &link.compliance);
            let own = L::load(token, &link.couplings[0]) + compliance;
            let diagonal = least.plus_product(own, squared);
            // u is the row of L D, from the farthest link to the nearest.
            let mut u = [zero; BAND];
            for back in 0..BAND {
                u[back] = L::load(token, &link.couplings[back + 1]) * d.dot(along[back]);
            }
            for back in (0..BAND).rev() {
                for farther in back + 1..BAND {
                    u[back] = u[back].minus_product(u[farther], lower[back][farther - back - 1]);
                }
            }
            let mut pivot = diagonal;
            let mut right = L::load(token, &link.target) * length - squared;
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

    /// Substitutes from the last links to the first, and moves the particles of each node by the tensions of its two
    /// links.
    #[inline(always)]
    fn substitute<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        nodes: &[S::Node],
        links: Range<usize>,
    ) where
        S: YarnParticles<L>,
    {
        let zero = L::splat(token, 0.0);
        let mut unknowns = [zero; BAND];
        let mut lower = [[zero; BAND]; BAND];
        let mut next_tension = V3::splat(token, 0.0);
        let rows = self.rows[..links.len()].iter().zip(&mut self.links[links]);
        for ((row, link), node) in rows.zip(&nodes[1..]).rev() {
            let mut unknown = L::load(token, &row.unknown);
            for after in 0..BAND {
                unknown = unknown.minus_product(lower[after][after], unknowns[after]);
            }
            let change = L::load(token, &row.target_change);
            let target = L::load(token, &link.target).minus_product(change, unknown);
            target.store(&mut link.target);
            let tension = V3::load(token, &row.along) * unknown;
            self.particles.pull_node(token, node, tension - next_tension);
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
        let pull = V3::splat(token, 0.0) - next_tension;
        self.particles.pull_node(token, &nodes[0], pull);
    }
}
