//! Yarns: the distance constraints along one path solved together, exactly.
//!
//! The XPBD system of a yarn, (J M⁻¹ Jᵀ + α̃) Δλ = −C − α̃ λ, is tridiagonal. What stands for λ here
//! is a link's target, the length that it has under the tension found so far, l − α̃ λ. With the links'
//! directions frozen its diagonal is wᵢ + wᵢ₊₁ + α̃ᵢ and its off-diagonal −wᵢ₊₁ nᵢ·nᵢ₊₁. Each row is
//! multiplied by its |d|, and the unknowns are λ/|d|: so d stands for n, and a link costs a single
//! division. One elimination down the yarn and one substitution back up solve it for about the price
//! of a Gauss–Seidel sweep (Thomas's algorithm).
//! What a sweep leaves behind, a hidden compliance of h²/(k m) that grows with the mesh, is gone: a
//! hanging cloth has its material's own strain. Goldenthal 2007 constrains warp and weft, Deul 2018
//! solves rods so.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::{Cloths, Constant, Places};
use crate::batch::single_cloth::Weave;
use crate::fabric::{CHAINS_PER_PAIR, ChainLink, ChainPair, Chains, LinkFamily};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

/// What the elimination leaves for the substitution, for one link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Knot<P: Pack> {
    /// d, m.
    along: Pack3<P>,
    /// This multiplier's share in the one before.
    share: P,
    /// The change of this multiplier, but for the share of the next.
    change: P,
    /// What the link's target gives way by for a unit change of the multiplier, m.
    give: P,
}

impl<P: Pack> Knot<P> {
    pub fn new() -> Self {
        let nothing = P::splat(0.0);
        Self { along: [nothing; 3], share: nothing, change: nothing, give: nothing }
    }
}

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Solves warp, weft, bias, then warp and weft again for each pass. The bias of a grid is told what its
    /// cells are stretched by.
    ///
    /// The bias must not come last: what it moves is large against the strain of warp and weft.
    pub fn solve_yarns(&mut self, passes: u32) {
        self.visit_yarns(Visit::First);
        if self.fabric.has_shear_cells() {
            if self.clock.done == 1 {
                self.square_cells();
            }
            self.overlook(-1.0);
            self.visit_yarns(Visit::Sheared);
            self.overlook(1.0);
        } else {
            self.visit_yarns(Visit::Only);
        }
        // After the last pass only the polish asks for targets, and there is none with a single pass.
        let visit = if passes > 1 { Visit::Again } else { Visit::Last };
        for _ in 0..passes {
            self.visit_yarns(visit);
        }
    }

    fn visit_yarns(&mut self, visit: Visit) {
        if C::SIDE > 1
            && let Some(weave) = self.woven()
        {
            weave.visit_yarns(visit);
            return;
        }
        let Chains { pairs, colours, .. } = self.fabric.chains();
        for colour in colours.iter().filter(|colour| visit.is_to(colour.family)) {
            P::run(Yarns {
                strands: &pairs[colour.pairs.clone()],
                visit,
                compliance: &self.parameters.link_compliance,
                knots: &mut self.knots,
                target: &mut self.link_target,
                places: Cloths::new(&self.lane_weights, &mut self.position),
            });
        }
    }
}

impl<P: Pack> Weave<P> {
    fn visit_yarns(&mut self, visit: Visit) {
        for colour in 0..self.strands.colours.len() {
            if visit.is_to(self.strands.colours[colour].family) {
                self.sheets.turn(self.facings[colour]);
                P::run(Yarns {
                    strands: &self.strands.pairs[self.strands.colours[colour].pairs.clone()],
                    visit,
                    compliance: &self.compliance,
                    knots: &mut self.knots,
                    target: &mut self.target,
                    places: self.sheets.threads(&self.present),
                });
            }
        }
    }
}

/// Which visit to a yarn in a substep it is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Visit {
    /// To warp and weft, whose links are as long as at rest until their tension is known.
    First,
    /// To warp and weft.
    Again,
    /// To warp and weft; nobody asks for their targets afterwards.
    Last,
    /// To the bias. Nobody asks for its targets.
    Only,
    /// To the bias of a grid, whose targets are known.
    Sheared,
}

impl Visit {
    fn is_to(self, family: LinkFamily) -> bool {
        (family == LinkFamily::Diagonal) == matches!(self, Self::Only | Self::Sheared)
    }
}

/// The yarns of one colour.
struct Yarns<'a, P: Pack, S: Places<P>> {
    strands: &'a [ChainPair<S::Constant>],
    visit: Visit,
    compliance: &'a [P],
    knots: &'a mut [Knot<P>],
    target: &'a mut [P],
    places: S,
}

impl<P: Pack, S: Places<P>> Kernel<P> for Yarns<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        match self.visit {
            Visit::First => self.solve_all::<L, false, true>(token),
            Visit::Again => self.solve_all::<L, true, true>(token),
            Visit::Only => self.solve_all::<L, false, false>(token),
            Visit::Last | Visit::Sheared => self.solve_all::<L, true, false>(token),
        }
    }
}

impl<P: Pack, S: Places<P>> Yarns<'_, P, S> {
    /// `RECALL` the targets of the visit before, and `KEEP` them for the next.
    #[inline(always)]
    fn solve_all<L: Lane<Pack = P>, const RECALL: bool, const KEEP: bool>(
        &mut self,
        token: L::Token,
    ) {
        for strand in self.strands {
            match strand.count {
                CHAINS_PER_PAIR => self.solve::<L, CHAINS_PER_PAIR, RECALL, KEEP>(token, strand),
                _ => self.solve::<L, 1, RECALL, KEEP>(token, strand),
            }
        }
    }

    /// Solves a strand of `SIDE` yarns.
    #[inline(always)]
    fn solve<L: Lane<Pack = P>, const SIDE: usize, const RECALL: bool, const KEEP: bool>(
        &mut self,
        token: L::Token,
        strand: &ChainPair<S::Constant>,
    ) {
        let places = &mut self.places;
        let (knots, _) = self.knots.as_chunks_mut::<SIDE>();
        let (targets, _) = self.target[strand.targets.clone()].as_chunks_mut::<SIDE>();
        let zero = L::splat(token, 0.0);
        // A link without length has no direction: its row is 0 = 0, and its change none.
        let least = L::splat(token, f32::MIN_POSITIVE);
        let none = V3::<L>::splat(token, 0.0);

        let begin: &[u32; SIDE] = side(&strand.particles[0]);
        let (mut end, mut end_weight) = ([none; SIDE], [zero; SIDE]);
        for (at, &particle) in begin.iter().enumerate() {
            end[at] = places.position(token, particle);
            end_weight[at] = places.weight(token, particle);
        }
        let mut last = [none; SIDE];
        let mut inverse = [zero; SIDE];
        let mut change = [zero; SIDE];
        let rows = strand.links.iter().zip(&strand.particles[1..]);
        for (((links, particles), targets), knots) in rows.zip(&*targets).zip(knots.iter_mut()) {
            for (at, &particle) in side::<SIDE>(particles).iter().enumerate() {
                let ChainLink { class, rest_length } = links[at];
                let compliance = L::load(token, &self.compliance[class as usize]);
                let target =
                    if RECALL { L::load(token, &targets[at]) } else { rest_length.load(token) };
                let next: V3<L> = places.position(token, particle);
                let next_weight = places.weight(token, particle);
                let along = next - end[at];
                let squared = along.dot(along);
                let length = squared.sqrt();
                // −C |d|, C being the excess of length over the target.
                let lack = (-squared).plus_product(target, length);
                let coupling = end_weight[at] * last[at].dot(along);
                let share = coupling * inverse[at];
                let diagonal =
                    least.plus_product(end_weight[at] + next_weight + compliance, squared);
                inverse[at] =
                    places.one::<L>(token, class) / diagonal.minus_product(coupling, share);
                change[at] = lack.plus_product(coupling, change[at]) * inverse[at];
                along.store(&mut knots[at].along);
                share.store(&mut knots[at].share);
                change[at].store(&mut knots[at].change);
                if KEEP {
                    (compliance * length).store(&mut knots[at].give);
                }
                (last[at], end[at], end_weight[at]) = (along, next, next_weight);
            }
        }

        // Back up the yarn, each particle taking the pull of its two links at once.
        let mut share = [zero; SIDE];
        let mut found = [zero; SIDE];
        let mut pull = [none; SIDE];
        let rows = strand.links.iter().zip(&strand.particles[1..]).zip(targets).zip(knots);
        for (((links, particles), targets), knots) in rows.rev() {
            for (at, &particle) in side::<SIDE>(particles).iter().enumerate() {
                let change = L::load(token, &knots[at].change).plus_product(share[at], found[at]);
                (share[at], found[at]) = (L::load(token, &knots[at].share), change);
                if KEEP {
                    let give = L::load(token, &knots[at].give);
                    let target = if RECALL {
                        L::load(token, &targets[at])
                    } else {
                        links[at].rest_length.load(token)
                    };
                    target.minus_product(give, change).store(&mut targets[at]);
                }
                let tension = V3::load(token, &knots[at].along) * change;
                let moved = places
                    .position(token, particle)
                    .plus_scaled(tension - pull[at], places.weight(token, particle));
                places.set_position(particle, moved);
                pull[at] = tension;
            }
        }
        for (at, &particle) in begin.iter().enumerate() {
            let moved = places
                .position(token, particle)
                .minus_scaled(pull[at], places.weight(token, particle));
            places.set_position(particle, moved);
        }
    }
}

/// The first columns of a row of particles.
#[inline(always)]
fn side<const SIDE: usize>(row: &[u32; CHAINS_PER_PAIR]) -> &[u32; SIDE] {
    row.first_chunk().expect("no more yarns than lie abreast")
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
