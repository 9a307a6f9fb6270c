//! Yarns: the distance constraints along one path solved together, exactly.
//!
//! The XPBD system of a yarn, (J M⁻¹ Jᵀ + α̃) Δλ = −C − α̃ λ, is tridiagonal: with the links'
//! directions frozen its diagonal is wᵢ + wᵢ₊₁ + α̃ᵢ and its off-diagonal −wᵢ₊₁ nᵢ·nᵢ₊₁. Each row is
//! multiplied by its |d|, and the unknowns are λ/|d|: so d stands for n, and a link costs a single
//! division. One elimination down the yarn and one substitution back up solve it for about the price
//! of a Gauss–Seidel sweep (Thomas's algorithm).
//! What a sweep leaves behind, a hidden compliance of h²/(k m) that grows with the mesh, is gone: a
//! hanging cloth has its material's own strain. Goldenthal 2007 constrains warp and weft, Deul 2018
//! solves rods so.

use crate::fabric::{ABREAST, LinkFamily, Strand, StrandLink};
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::vector::{Pack3, V3};

/// What the elimination leaves for the substitution, for one link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Knot<P: Pack> {
    /// This multiplier's share in the one before.
    share: P,
    /// The change of this multiplier, but for the share of the next.
    change: P,
}

impl<P: Pack> Knot<P> {
    pub fn new() -> Self {
        Self { share: P::splat(0.0), change: P::splat(0.0) }
    }
}

impl<P: Pack> LaneBatch<P> {
    /// Solves warp, weft, bias, then warp and weft again for each pass.
    ///
    /// The bias must not come last: what it moves is large against the strain of warp and weft.
    pub fn solve_yarns(&mut self, passes: u32) {
        self.solve_families(Visit::First);
        self.solve_families(Visit::Bias);
        for _ in 0..passes {
            self.solve_families(Visit::Again);
        }
    }

    fn solve_families(&mut self, visit: Visit) {
        for colour in self.fabric.strand_colours() {
            if (colour.family == LinkFamily::Bias) != (visit == Visit::Bias) {
                continue;
            }
            P::run(Yarns {
                strands: &self.fabric.strands()[colour.strands.clone()],
                visit,
                weights: &self.weights,
                compliance: &self.parameters.link_compliance,
                knots: &mut self.knots,
                multiplier: &mut self.link_multiplier,
                position: &mut self.position,
            });
        }
    }
}

/// When in a substep yarns are solved. Multipliers of warp and weft are kept from visit to visit.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Visit {
    First,
    Bias,
    Again,
}

/// The yarns of one colour.
struct Yarns<'a, P: Pack> {
    strands: &'a [Strand],
    visit: Visit,
    weights: &'a [f32],
    compliance: &'a [P],
    knots: &'a mut [Knot<P>],
    multiplier: &'a mut [P],
    position: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Yarns<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        match self.visit {
            Visit::First => self.solve_all::<L, false, true>(token),
            Visit::Bias => self.solve_all::<L, false, false>(token),
            Visit::Again => self.solve_all::<L, true, true>(token),
        }
    }
}

impl<P: Pack> Yarns<'_, P> {
    /// `HAS` multipliers of an earlier visit; `KEEP` them for a later one.
    #[inline(always)]
    fn solve_all<L: Lane<Pack = P>, const HAS: bool, const KEEP: bool>(&mut self, token: L::Token) {
        for strand in self.strands {
            match strand.count {
                ABREAST => self.solve::<L, ABREAST, HAS, KEEP>(token, strand),
                _ => self.solve::<L, 1, HAS, KEEP>(token, strand),
            }
        }
    }

    /// Solves a strand of `SIDE` yarns.
    #[inline(always)]
    fn solve<L: Lane<Pack = P>, const SIDE: usize, const HAS: bool, const KEEP: bool>(
        &mut self,
        token: L::Token,
        strand: &Strand,
    ) {
        let weights = self.weights;
        let weight = |particle: u32| -> L { L::splat(token, weights[particle as usize]) };
        let side = |row: &[u32; ABREAST]| -> [u32; SIDE] { core::array::from_fn(|at| row[at]) };
        let zero = L::splat(token, 0.0);
        let one = L::splat(token, 1.0);
        // A link without length has no direction: its row is 0 = 0, and its change none.
        let least = L::splat(token, f32::MIN_POSITIVE);
        let none = V3::<L>::splat(token, 0.0);
        let (knots, _) = self.knots.as_chunks_mut::<SIDE>();

        let begin = side(&strand.particles[0]);
        let mut end: [V3<L>; SIDE] =
            begin.map(|particle| V3::load(token, &self.position[particle as usize]));
        let mut end_weight = begin.map(weight);
        let mut last = [none; SIDE];
        let mut inverse = [zero; SIDE];
        let mut change = [zero; SIDE];
        for ((links, particles), knots) in
            strand.links.iter().zip(&strand.particles[1..]).zip(knots.iter_mut())
        {
            for (at, particle) in side(particles).into_iter().enumerate() {
                let StrandLink { link, class, rest_length } = links[at];
                let next: V3<L> = V3::load(token, &self.position[particle as usize]);
                let next_weight = weight(particle);
                let along = next - end[at];
                let squared = along.dot(along);
                let compliance = L::load(token, &self.compliance[class as usize]);
                let length = squared.sqrt();
                let mut excess = squared - L::splat(token, rest_length) * length;
                if HAS {
                    let held = L::load(token, &self.multiplier[link as usize]);
                    excess = excess + compliance * held * length;
                }
                let coupling = -(end_weight[at] * last[at].dot(along));
                let share = coupling * inverse[at];
                let diagonal = (end_weight[at] + next_weight + compliance) * squared + least;
                inverse[at] = one / (diagonal - coupling * share);
                change[at] = -(excess + coupling * change[at]) * inverse[at];
                share.store(&mut knots[at].share);
                change[at].store(&mut knots[at].change);
                (last[at], end[at], end_weight[at]) = (along, next, next_weight);
            }
        }

        // Back up the yarn, each particle taking the pull of its two links at once. What lies behind
        // has not moved yet, so the links still are what they were on the way down.
        let mut share = [zero; SIDE];
        let mut found = [zero; SIDE];
        let mut pull = [none; SIDE];
        let rows = strand.particles.windows(2).zip(&strand.links);
        for ((particles, links), knots) in rows.zip(knots).rev() {
            let (near, far) = (side(&particles[0]), side(&particles[1]));
            for at in 0..SIDE {
                let change = L::load(token, &knots[at].change) - share[at] * found[at];
                (share[at], found[at]) = (L::load(token, &knots[at].share), change);
                let next: V3<L> = V3::load(token, &self.position[near[at] as usize]);
                let along = end[at] - next;
                let tension = along * change;
                if KEEP {
                    let multiplier = &mut self.multiplier[links[at].link as usize];
                    let gained = along.dot(along).sqrt() * change;
                    let held = if HAS { L::load(token, multiplier) + gained } else { gained };
                    held.store(multiplier);
                }
                let moved = (tension - pull[at]) * weight(far[at]);
                (end[at] + moved).store(&mut self.position[far[at] as usize]);
                (pull[at], end[at]) = (tension, next);
            }
        }
        for at in 0..SIDE {
            let moved = pull[at] * weight(begin[at]);
            (end[at] - moved).store(&mut self.position[begin[at] as usize]);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::constraints::bench::{cloth_at, positions};
    use crate::fabric::{FabricBuilder, FabricMaterial, Grid};

    /// A narrow strip, stretched evenly: the links' directions do not change, so that the linear
    /// system is the whole truth, and one solve is exact.
    #[test]
    fn a_straight_yarn_is_solved_at_once() {
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
        batch.solve_yarns(1);
        for (end, rest) in positions(&batch).iter().zip(fabric.rest_positions()) {
            // But for the compliance that even the stiffest link has.
            assert!((end.x - rest.x).abs() < 2e-4, "{end} {rest}");
        }
    }

    #[test]
    fn a_yarn_pulls_as_much_as_it_is_pulled() {
        let fabric = FabricBuilder::grid(Grid::new(9, 7, 1.0, 0.7)).build().expect("good");
        let crumpled: Vec<Vec3> = fabric
            .rest_positions()
            .iter()
            .map(|at| *at * 1.1 + Vec3::Z * 0.1 * libm::sinf(9.0 * at.x + 5.0 * at.y))
            .collect();
        let mut batch = cloth_at(&fabric, FabricMaterial::SILK, &crumpled);
        batch.solve_yarns(2);
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
        // Directions are those of when each yarn is solved, so only nearly.
        assert!(turn.length() < 0.02 * moved, "{turn} {moved}");
    }

    #[test]
    fn collapsed_and_inextensible_yarns_stay_finite() {
        let grid = FabricBuilder::grid(Grid::new(5, 5, 1.0, 1.0));
        let fabric = grid.pin_where(|_, uv| uv.x == 0.0 || uv.x == 1.0).build().expect("good");
        let stiff = FabricMaterial { warp_stiffness: f32::INFINITY, ..FabricMaterial::SILK };
        let point = vec![Vec3::splat(0.3); 25];
        for start in [point, fabric.rest_positions().to_vec()] {
            let mut batch = cloth_at(&fabric, stiff, &start);
            batch.solve_yarns(2);
            batch.polish();
            assert!(positions(&batch).iter().all(|position| position.is_finite()));
        }
    }
}
