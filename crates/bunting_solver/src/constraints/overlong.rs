//! Chains with links that are still too long after the passes of a substep, solved again.
//!
//! Where cloth snaps or folds sharply, links turn far within a substep, and the directions that a pass freezes are
//! wrong: two passes leave a few links of a flag in wind too long by tens of percent, in one tick of thirty. More
//! passes over all chains would take several times as long. Instead all lengths are compared with their targets, and
//! chains with a link beyond tolerance are solved again, warp and weft in turn, until there are none. Whether a chain is
//! solved depends on that chain alone, so that the bits of a cloth depend on no other cloth.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Particles};
use crate::constraints::chain::{Pass, SolveChains, first_of};
use crate::fabric::ChainPair;
use crate::simd::lane::{Lane, Mask, Pack};
use crate::simd::vec3::V3;

/// Part of its target by which a link may be longer. Smaller: flags in a light wind are solved again, too. Larger: the
/// longest links of flags are seen.
const TOLERANCE: f32 = 0.05;

/// Square of the greatest length over that of the target.
const LONGEST: f32 = (1.0 + TOLERANCE) * (1.0 + TOLERANCE);

/// Most rounds over warp and weft in a substep. Fewer: light cloth in a storm is stretched by tens of percent. More: a
/// substep of such cloth takes more than three times as long as one of calm cloth.
const MOST_ROUNDS: u32 = 16;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves the chains of warp and weft that have overlong links, until there are none.
    pub(super) fn solve_overlong_chains(&mut self) {
        for _ in 0..MOST_ROUNDS {
            if !self.solve_warp_and_weft(Pass::Overlong) {
                break;
            }
        }
    }
}

impl<P: Pack, S: Particles<P>> SolveChains<'_, P, S> {
    /// Solves those of `N` chains side by side that have overlong links.
    #[inline(always)]
    pub(super) fn solve_overlong<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
    ) {
        // Mostly no link is overlong, and the first comparison, which stores nothing, is the last.
        for stores in [false, true] {
            let mut is_any_overlong = false;
            for excess in self.excess::<L, N>(token, pair, stores) {
                is_any_overlong |= L::splat(token, 0.0).lt(excess).any();
            }
            if !is_any_overlong {
                return;
            }
        }
        *self.is_any_overlong = true;
        self.mark::<L, N>(token, pair);
        self.solve::<L, N>(token, pair, Pass::Overlong);
    }

    /// Greatest difference of a squared length and the square of the longest that is within tolerance, in each of `N`
    /// chains, m²; zero where all links are within tolerance. With `stores`, each row gets the greatest so far of its
    /// yarn: in the single-cloth layout a chain has several yarns one after the other, with no link between them.
    #[inline(always)]
    fn excess<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
        stores: bool,
    ) -> [L; N] {
        let particles = &self.particles;
        let (rows, _) = self.rows.as_chunks_mut::<N>();
        let (targets, _) = self.target[pair.targets.clone()].as_chunks::<N>();
        let longest = L::splat(token, LONGEST);
        let mut greatest = [L::splat(token, 0.0); N];
        let mut greatest_of_yarn = greatest;
        let mut end = [V3::<L>::splat(token, 0.0); N];
        for (at, &particle) in first_of::<N>(&pair.particles[0]).iter().enumerate() {
            end[at] = particles.position(token, particle);
        }
        let links = pair.links.iter().zip(&pair.particles[1..]);
        for (((links, ends), targets), rows) in links.zip(targets).zip(rows) {
            for (at, &particle) in first_of::<N>(ends).iter().enumerate() {
                let target = L::load(token, &targets[at]);
                let next: V3<L> = particles.position(token, particle);
                let along = next - end[at];
                let over = along.dot(along).minus_product(longest, target * target);
                let one = particles.one_if_linked::<L>(token, links[at].class);
                greatest[at] = greatest[at].max(one * over);
                if stores {
                    greatest_of_yarn[at] = one * greatest_of_yarn[at].max(over);
                    greatest_of_yarn[at].store(&mut rows[at].unknown);
                }
                end[at] = next;
            }
        }
        greatest
    }

    /// Marks the rows of yarns with overlong links by one and all others by zero, given the excess of each row's yarn
    /// up to the row.
    #[inline(always)]
    fn mark<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        token: L::Token,
        pair: &ChainPair<S::Constant>,
    ) {
        let (rows, _) = self.rows.as_chunks_mut::<N>();
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let mut greatest = [zero; N];
        for (links, rows) in pair.links.iter().zip(rows).rev() {
            for at in 0..N {
                let linked = self.particles.one_if_linked::<L>(token, links[at].class);
                let excess = L::load(token, &rows[at].unknown);
                greatest[at] = linked * greatest[at].max(excess);
                one.or_where_not(zero.lt(greatest[at]), zero).store(&mut rows[at].unknown);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::TOLERANCE;
    use crate::constraints::bench::{cloth_at, positions};
    use crate::fabric::{Fabric, FabricBuilder, FabricMaterial, Grid, LinkFamily};

    fn sheet() -> Fabric {
        let grid = FabricBuilder::grid(Grid::new(17, 17, 1.0, 1.0));
        grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric")
    }

    /// Greatest strain of warp and weft.
    fn greatest_strain(fabric: &Fabric, at: &[Vec3]) -> f32 {
        let links = fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal);
        let strains = links.map(|link| {
            let [from, to] = link.particles.map(|particle| at[particle as usize]);
            from.distance(to) / link.rest_length - 1.0
        });
        strains.fold(0.0, f32::max)
    }

    #[test]
    fn a_folded_corner_is_within_tolerance_afterwards() {
        let fabric = sheet();
        let folded: Vec<Vec3> = (fabric.rest_positions().iter())
            .map(|at| if at.x > 0.8 && at.y < -0.8 { Vec3::new(0.7, -0.3, 0.2) } else { *at })
            .collect();
        // Stiff, as a link's target is longer than at rest by the strain of its tension.
        let stiff = FabricMaterial {
            warp_stiffness: 1e6,
            weft_stiffness: 1e6,
            ..FabricMaterial::FLAG_POLYESTER
        };
        let mut batch = cloth_at(&fabric, stiff, &folded);
        batch.solve_lines(2);
        let before = greatest_strain(&fabric, &positions(&batch));
        batch.solve_overlong_chains();
        let after = greatest_strain(&fabric, &positions(&batch));
        assert!(before > 2.0 * TOLERANCE && after < 1.01 * TOLERANCE, "{before}, then {after}");
    }

    #[test]
    fn chains_within_tolerance_are_left_alone() {
        let fabric = sheet();
        let stretched: Vec<Vec3> = fabric.rest_positions().iter().map(|at| *at * 1.04).collect();
        let mut batch = cloth_at(&fabric, FabricMaterial::FLAG_POLYESTER, &stretched);
        batch.solve_lines(2);
        let before = positions(&batch);
        batch.solve_overlong_chains();
        assert_eq!(positions(&batch), before);
    }
}
