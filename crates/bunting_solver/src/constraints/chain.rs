//! Chains: the distance constraints along one yarn solved at once, exactly.
//!
//! The XPBD system of a chain, (J M⁻¹ Jᵀ + α̃) Δλ = −C − α̃ λ, is tridiagonal. In place of λ each link's
//! target is stored: the length that the link has under the tension found so far, l − α̃ λ. With the links'
//! directions n frozen, the diagonal is wᵢ + wᵢ₊₁ + α̃ᵢ and the off-diagonal −wᵢ₊₁ nᵢ·nᵢ₊₁. Each row is
//! multiplied by its |d|, and the unknowns are λ/|d|, so that d = n |d| replaces n, and each link needs a
//! single division. One elimination along the chain and one substitution back (Thomas's algorithm) take about
//! the time of a Gauss–Seidel sweep.
//!
//! A sweep leaves a numerical compliance of h²/(k m), which grows with the resolution of the mesh. Chains
//! have none: a hanging cloth has its material's own strain. Goldenthal 2007 constrains warp and weft, and
//! Deul 2018 solves rods in this way.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Particles, Positions};
use crate::constraints::tridiagonal::TridiagonalRow;
use crate::fabric::{CHAINS_PER_PAIR, ChainLink, ChainPair, LinkFamily};
use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::V3;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves warp, weft and diagonals, then warp and weft again in each pass: the lines of a grid, whose diagonals carry shear
    /// alone. The diagonals' targets follow from the first solution of warp and weft.
    ///
    /// Diagonals must not come last, since they move particles far compared with the strain of warp and weft.
    pub(super) fn solve_lines(&mut self, passes: u32) {
        self.solve_warp_and_weft(Pass::First);
        if self.clock.begun == 1 {
            self.find_diagonal_targets();
        }
        self.solve_diagonals();
        for _ in 0..passes {
            self.solve_warp_and_weft(Pass::Again);
            self.solve_contacts_of_pass();
        }
    }

    /// Solves warp and weft once, and returns whether [`Pass::Overlong`] solved any chain.
    pub(super) fn solve_warp_and_weft(&mut self, pass: Pass) -> bool {
        let colours = 0..self.colour_count();
        self.solve_colours(colours, pass, |family| family != LinkFamily::Diagonal)
    }

    fn solve_diagonals(&mut self) {
        let colours = 0..self.colour_count();
        self.solve_colours(colours, Pass::Diagonals, |family| family == LinkFamily::Diagonal);
    }

    /// Number of colours of chains.
    pub(super) fn colour_count(&self) -> usize {
        self.layout.chains(&self.fabric).colours.len()
    }

    /// Solves those of some colours that are of some families, and returns whether [`Pass::Overlong`] solved any chain.
    pub(super) fn solve_colours(
        &mut self,
        colours: impl Iterator<Item = usize>,
        pass: Pass,
        is_solved: impl Fn(LinkFamily) -> bool,
    ) -> bool {
        let mut is_any_overlong = false;
        for colour in colours {
            if is_solved(self.layout.chains(&self.fabric).colours[colour].family) {
                self.solve_colour(colour, pass, &mut is_any_overlong);
            }
        }
        is_any_overlong
    }

    /// Solves the chains of one colour, which share no particle.
    fn solve_colour(&mut self, colour: usize, pass: Pass, is_any_overlong: &mut bool) {
        let chains = self.layout.chains(&self.fabric);
        if chains.colours[colour].are_swept_diagonals() {
            self.sweep_colour(colour);
            return;
        }
        let order = self.layout.order_of_chains(colour);
        let (masses, linked) = (&self.masses.inverse, self.layout.linked());
        P::run(SolveChains {
            pairs: &chains.pairs[chains.colours[colour].pairs.clone()],
            pass,
            is_any_overlong,
            compliance: &self.layout.factors().link_compliance,
            rows: &mut self.rows,
            target: &mut self.link_target,
            by_closing: &mut self.by_closing,
            particles: self.positions.lines(order, masses, linked),
        });
    }
}

/// Position of a pass over chains in a substep, which decides which targets it reads and stores.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Pass {
    /// The first pass: there is no tension yet, and the targets are the lengths at rest.
    First,
    /// A further pass, which starts from the stored targets.
    Again,
    /// The pass over diagonals that carry shear alone: it starts from the stored targets and stores none, as nothing
    /// reads them.
    Diagonals,
    /// A further pass over the chains that have overlong links: only their rows are solved.
    Overlong,
}

impl Pass {
    /// Whether the pass starts from the stored targets.
    #[inline(always)]
    fn is_warm(self) -> bool {
        self != Self::First
    }

    /// The target of a link before the pass, m, given the stored one and the length at rest.
    #[inline(always)]
    pub(super) fn target<L: Lane>(
        self,
        token: L::Token,
        stored: &L::Pack,
        rest_length: &impl Constant<L::Pack>,
    ) -> L {
        if self.is_warm() { L::load(token, stored) } else { rest_length.load(token) }
    }

    /// Whether the pass stores the new targets.
    #[inline(always)]
    pub(super) fn stores_targets(self) -> bool {
        self != Self::Diagonals
    }
}

/// The chains of one colour, in pairs.
pub(super) struct SolveChains<'a, P: Pack, S: Particles<P>> {
    pairs: &'a [ChainPair<S::Constant>],
    pass: Pass,
    /// Set by [`Pass::Overlong`] where any link is overlong.
    pub(super) is_any_overlong: &'a mut bool,
    pub(super) compliance: &'a [P],
    pub(super) rows: &'a mut [TridiagonalRow<P>],
    pub(super) target: &'a mut [P],
    /// Scratch array of the closing links' parts in the unknowns of closed chains.
    pub(super) by_closing: &'a mut [P],
    pub(super) particles: S,
}

impl<P: Pack, S: Particles<P>> Kernel<P> for SolveChains<'_, P, S> {
    /// Each arm is compiled by itself, with its pass as a constant; the few chains without a second one have one arm.
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        const TWO: usize = CHAINS_PER_PAIR;
        for pair in self.pairs {
            self.particles.bring::<L, TWO>(token, &pair.particles, pair.count);
            match (pair.count, self.pass) {
                (TWO, Pass::First) => self.solve::<L, TWO>(token, pair, Pass::First),
                (TWO, Pass::Again) => self.solve::<L, TWO>(token, pair, Pass::Again),
                (TWO, Pass::Diagonals) => self.solve::<L, TWO>(token, pair, Pass::Diagonals),
                (TWO, Pass::Overlong) => self.solve_overlong::<L, TWO>(token, pair),
                (_, Pass::Overlong) => self.solve_overlong::<L, 1>(token, pair),
                (_, pass) => self.solve::<L, 1>(token, pair, pass),
            }
        }
    }
}

impl<P: Pack, S: Particles<P>> SolveChains<'_, P, S> {
    /// Solves `N` chains side by side.
    #[inline(always)]
    pub(super) fn solve<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
        pass: Pass,
    ) {
        if pair.is_closed {
            self.solve_closed::<L, N>(token, pair, pass);
        } else if let ([ends, other_ends], [links]) = (&pair.particles[..], &pair.links[..]) {
            let ends = [first_of::<N>(ends), first_of::<N>(other_ends)];
            self.solve_links::<L, N>(token, ends, links, &pair.targets, pass);
        } else {
            self.eliminate::<L, N>(token, pair, pass);
            self.substitute::<L, N>(token, pair, pass);
        }
        self.particles.put_back::<L, CHAINS_PER_PAIR>(token, &pair.particles, N);
    }

    /// Eliminates the unknowns of `N` chains side by side, from their first links to their last.
    #[inline(always)]
    fn eliminate<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
        pass: Pass,
    ) {
        let stores = pass.stores_targets();
        let particles = &self.particles;
        let (rows, _) = self.rows.as_chunks_mut::<N>();
        let (targets, _) = self.target[pair.targets.clone()].as_chunks::<N>();
        let (zero, zero3) = (L::splat(token, 0.0), V3::<L>::splat(token, 0.0));
        // A link of zero length has no direction: its row becomes 0 = 0, and its unknown zero.
        let least = L::splat(token, f32::MIN_POSITIVE);

        let (mut end, mut end_mass) = ([zero3; N], [zero; N]);
        for (at, &particle) in first_of::<N>(&pair.particles[0]).iter().enumerate() {
            end[at] = particles.position(token, particle);
            end_mass[at] = particles.inverse_mass(token, particle);
        }
        let mut last = [zero3; N];
        let (mut inverse, mut unknown) = ([zero; N], [zero; N]);
        let links = pair.links.iter().zip(&pair.particles[1..]);
        for (((links, ends), targets), rows) in links.zip(targets).zip(rows) {
            for (at, &particle) in first_of::<N>(ends).iter().enumerate() {
                let ChainLink { class, rest_length } = links[at];
                let compliance = L::load(token, &self.compliance[class as usize]);
                let target: L = pass.target(token, &targets[at], &rest_length);
                let next: V3<L> = particles.position(token, particle);
                let next_mass = particles.inverse_mass(token, particle);
                let along = next - end[at];
                let squared = along.dot(along);
                let length = squared.sqrt();
                // The right side is −C |d|, with C the length minus the target.
                let right = (-squared).plus_product(target, length);
                let coupling = end_mass[at] * last[at].dot(along);
                let multiplier = coupling * inverse[at];
                let diagonal = least.plus_product(end_mass[at] + next_mass + compliance, squared);
                let one = particles.one_if_linked::<L>(token, class);
                let one = if pass == Pass::Overlong {
                    one * L::load(token, &rows[at].unknown)
                } else {
                    one
                };
                inverse[at] = one / diagonal.minus_product(coupling, multiplier);
                unknown[at] = right.plus_product(coupling, unknown[at]) * inverse[at];
                along.store(&mut rows[at].along);
                multiplier.store(&mut rows[at].multiplier);
                unknown[at].store(&mut rows[at].unknown);
                if stores {
                    (compliance * length).store(&mut rows[at].target_change);
                }
                (last[at], end[at], end_mass[at]) = (along, next, next_mass);
            }
        }
    }

    /// Substitutes from the last links to the first, and moves each particle by the tensions of its two links
    /// at once.
    #[inline(always)]
    fn substitute<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
        pass: Pass,
    ) {
        let stores = pass.stores_targets();
        let particles = &mut self.particles;
        let (rows, _) = self.rows.as_chunks::<N>();
        let (targets, _) = self.target[pair.targets.clone()].as_chunks_mut::<N>();
        let (zero, zero3) = (L::splat(token, 0.0), V3::<L>::splat(token, 0.0));
        let (mut multiplier, mut unknown) = ([zero; N], [zero; N]);
        let mut next_tension = [zero3; N];
        let links = pair.links.iter().zip(&pair.particles[1..]);
        for (((links, ends), targets), rows) in links.zip(targets).zip(rows).rev() {
            for (at, &particle) in first_of::<N>(ends).iter().enumerate() {
                let row = &rows[at];
                unknown[at] =
                    L::load(token, &row.unknown).plus_product(multiplier[at], unknown[at]);
                multiplier[at] = L::load(token, &row.multiplier);
                if stores {
                    let target_change = L::load(token, &row.target_change);
                    let target: L = pass.target(token, &targets[at], &links[at].rest_length);
                    target.minus_product(target_change, unknown[at]).store(&mut targets[at]);
                }
                let tension = V3::load(token, &row.along) * unknown[at];
                let inverse_mass = particles.inverse_mass(token, particle);
                let position = particles.position(token, particle);
                let pull = tension - next_tension[at];
                particles.correct(token, particle, position, (pull, inverse_mass));
                next_tension[at] = tension;
            }
        }
        for (at, &particle) in first_of::<N>(&pair.particles[0]).iter().enumerate() {
            let inverse_mass: L = particles.inverse_mass(token, particle);
            let position = particles.position(token, particle);
            particles.correct(token, particle, position, (next_tension[at], -inverse_mass));
        }
    }
}

/// The first columns of a row of particles.
#[inline(always)]
pub(super) fn first_of<const N: usize>(row: &[u32; CHAINS_PER_PAIR]) -> &[u32; N] {
    row.first_chunk().expect("no more chains than are solved side by side")
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::constraints::bench::{cloth_at, positions};
    use crate::fabric::{FabricBuilder, FabricMaterial, Grid};

    /// In a uniformly stretched strip the links' directions do not change, so that the system is linear and
    /// one solve is exact.
    #[test]
    fn a_straight_chain_is_solved_at_once() {
        let fabric = FabricBuilder::grid(Grid::new(33, 2, 1.0, 0.03))
            .pin_where(|_, uv| uv.x == 0.0)
            .build()
            .expect("good");
        let material = FabricMaterial {
            warp_stiffness: f32::INFINITY,
            weft_stiffness: f32::INFINITY,
            ..FabricMaterial::COTTON
        };
        let stretched: Vec<Vec3> =
            fabric.rest_positions().iter().map(|at| *at * Vec3::new(1.2, 1.0, 1.0)).collect();
        let mut batch = cloth_at(&fabric, material, &stretched);
        batch.solve_lines(1);
        for (end, rest) in positions(&batch).iter().zip(fabric.rest_positions()) {
            // The tolerance is the least compliance of a link.
            assert!((end.x - rest.x).abs() < 2e-4, "{end} {rest}");
        }
    }

    #[test]
    fn a_chain_keeps_momentum_and_nearly_angular_momentum() {
        let fabric = FabricBuilder::grid(Grid::new(9, 7, 1.0, 0.7)).build().expect("good");
        let crumpled: Vec<Vec3> = fabric
            .rest_positions()
            .iter()
            .map(|at| *at * 1.1 + Vec3::Z * 0.1 * libm::sinf(9.0 * at.x + 5.0 * at.y))
            .collect();
        let mut batch = cloth_at(&fabric, FabricMaterial::SILK, &crumpled);
        batch.solve_lines(2);
        let areas = fabric.particle_areas();
        let centre = |at: &[Vec3]| -> Vec3 {
            at.iter().zip(areas).map(|(at, &area)| *at * area).sum::<Vec3>() / fabric.area()
        };
        let end = positions(&batch);
        assert!(centre(&end).distance(centre(&crumpled)) < 1e-6);
        let turn: Vec3 = end
            .iter()
            .zip(&crumpled)
            .zip(areas)
            .map(|((end, start), &area)| start.cross(*end - *start) * area)
            .sum();
        let moved: f32 =
            end.iter().zip(&crumpled).zip(areas).map(|((e, s), &a)| e.distance(*s) * a).sum();
        // Angular momentum is kept only nearly, since each chain finds particles that other chains have
        // moved.
        assert!(turn.length() < 0.02 * moved, "{turn} {moved}");
    }

    #[test]
    fn collapsed_and_inextensible_chains_stay_finite() {
        let grid = FabricBuilder::grid(Grid::new(5, 5, 1.0, 1.0));
        let fabric = grid.pin_where(|_, uv| uv.x == 0.0 || uv.x == 1.0).build().expect("good");
        let stiff = FabricMaterial { warp_stiffness: f32::INFINITY, ..FabricMaterial::SILK };
        let point = vec![Vec3::splat(0.3); 25];
        for start in [point, fabric.rest_positions().to_vec()] {
            let mut batch = cloth_at(&fabric, stiff, &start);
            batch.solve_lines(2);
            batch.sweep_links(false);
            assert!(positions(&batch).iter().all(|position| position.is_finite()));
        }
    }
}
