//! Twist along the ribbons of a grid, each ribbon exactly: C = x₀₀ − x₁₀ − x₀₁ + x₁₁ in every cell, of
//! stiffness 2 B/(Δx Δy).
//!
//! The XPBD system of a ribbon is tridiagonal, constant, and the same for x, y and z. Cell by cell it
//! would take as many sweeps as a strip has cells to hold it on edge.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::{Cloths, Constant, Places};
use crate::batch::single_cloth::Weave;
use crate::constants::GRAVITY;
use crate::fabric::{Fabric, FabricMaterial, Ribbon};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::TwistFactors;

/// Γ = σ g L³/B from which on cloth is limp: held level by its edge, it reaches out by a twentieth of its
/// length, and twist is small beside its weight. A flag of a metre has 100,000.
const LIMP: f32 = 1000.0;

/// Whether cloth is stiff enough to be seen to resist twist.
pub(crate) fn resists_twist(fabric: &Fabric, material: &FabricMaterial) -> bool {
    let Some(grid) = fabric.grid() else { return false };
    let length = grid.width.max(grid.height);
    material.area_density * GRAVITY * length.powi(3) < LIMP * material.bend_stiffness
}

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Solves every ribbon once.
    pub fn solve_twist(&mut self) {
        if !self.parameters.twists() {
            return;
        }
        if C::SIDE > 1
            && let Some(weave) = self.woven()
        {
            weave.solve_twist();
            return;
        }
        P::run(Twist {
            ribbons: self.fabric.ribbons(),
            factors: &self.parameters.twist_factors,
            moments: &mut self.moments,
            places: Cloths::new(&self.lane_weights, &mut self.position),
        });
    }
}

impl<P: Pack> Weave<P> {
    fn solve_twist(&mut self) {
        self.sheets.turn(self.ribbons.facing);
        P::run(Twist {
            ribbons: &self.ribbons.ribbons,
            factors: &self.ribbons.factors,
            moments: &mut self.moments,
            places: self.sheets.threads(&self.present),
        });
    }
}

struct Twist<'a, P: Pack, S: Places<P>> {
    ribbons: &'a [Ribbon],
    factors: &'a [TwistFactors<P, S::Constant>],
    moments: &'a mut [Pack3<P>],
    places: S,
}

impl<P: Pack, S: Places<P>> Kernel<P> for Twist<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        for ribbon in self.ribbons {
            let factors = &self.factors[ribbon.profile as usize];
            self.solve_ribbon::<L>(token, &ribbon.pairs, factors);
        }
    }
}

impl<P: Pack, S: Places<P>> Twist<'_, P, S> {
    #[inline(always)]
    fn solve_ribbon<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        pairs: &[[u32; 2]],
        factors: &TwistFactors<P, S::Constant>,
    ) {
        let zero = V3::<L>::splat(token, 0.0);

        // Along the ribbon: L y = −C.
        let mut across: V3<L> = self.across(token, pairs[0]);
        let mut last = zero;
        for (cell, (factor, &pair)) in factors.cells.iter().zip(&pairs[1..]).enumerate() {
            let next = self.across(token, pair);
            last = (across - next).minus_scaled(last, L::load(token, &factor.near));
            last.store(&mut self.moments[cell]);
            across = next;
        }

        // And back: D Lᵀ λ = y, and Δx = W Cᵀ λ: each pair is turned by the cells on either side.
        let mut beyond = zero;
        let mut near = L::splat(token, 0.0);
        for (cell, factor) in factors.cells.iter().enumerate().rev() {
            let y: V3<L> = V3::load(token, &self.moments[cell]);
            let moment = (y * L::load(token, &factor.inverse)).minus_scaled(beyond, near);
            self.turn(token, pairs[cell + 1], moment - beyond, factors.weights[cell + 1]);
            (beyond, near) = (moment, L::load(token, &factor.near));
        }
        self.turn(token, pairs[0], zero - beyond, factors.weights[0]);
    }

    /// From one of a pair to the other.
    #[inline(always)]
    fn across<L: Lane<Pack = P>>(&self, token: L::Token, [from, to]: [u32; 2]) -> V3<L> {
        self.places.position::<L>(token, to) - self.places.position(token, from)
    }

    /// Moves a pair apart.
    #[inline(always)]
    fn turn<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        [from, to]: [u32; 2],
        moment: V3<L>,
        weights: [S::Constant; 2],
    ) {
        let [here, there] = weights;
        let moved = self.places.position(token, from).minus_scaled(moment, here.load(token));
        self.places.set_position(from, moved);
        let moved = self.places.position(token, to).plus_scaled(moment, there.load(token));
        self.places.set_position(to, moved);
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::constraints::bench::{cloth_at, positions, soft_step};
    use crate::fabric::{Fabric, FabricBuilder, FabricMaterial, Grid};
    use crate::geometry::energy::twist;

    const STIFF: FabricMaterial =
        FabricMaterial { bend_stiffness: 1e-3, ..FabricMaterial::FLAG_POLYESTER };

    fn twisted(fabric: &Fabric) -> Vec<Vec3> {
        let twist = |at: &Vec3| *at + Vec3::Z * (0.3 * at.x * at.y + 0.1 * at.x * at.x * at.y);
        fabric.rest_positions().iter().map(twist).collect()
    }

    #[test]
    fn a_soft_step_follows_the_gradient() {
        for (columns, rows) in [(2, 7), (7, 2), (5, 6)] {
            let grid = FabricBuilder::grid(Grid::new(columns, rows, 0.2, 0.2));
            let fabric = grid.pin([0, 1]).build().expect("good");
            let start = twisted(&fabric);
            let soft = FabricMaterial { bend_stiffness: 1e-5, area_density: 0.1, ..STIFF };
            let expected = soft_step(&fabric, &soft, &start, |at| {
                0.5 * twist(&fabric, at) * f64::from(soft.bend_stiffness)
            });
            let mut batch = cloth_at(&fabric, soft, &start);
            batch.solve_twist();
            let largest = expected.iter().map(|step| step.length()).fold(0.0, f32::max);
            for ((end, start), expected) in positions(&batch).iter().zip(&start).zip(&expected) {
                let moved = *end - *start;
                assert!(moved.distance(*expected) < 0.03 * largest, "{moved} {expected}");
            }
        }
    }

    #[test]
    fn a_stiff_ribbon_is_untwisted_and_keeps_its_momentum() {
        let fabric = FabricBuilder::grid(Grid::new(2, 9, 0.1, 0.8)).build().expect("good");
        let start = twisted(&fabric);
        let mut batch = cloth_at(&fabric, FabricMaterial { bend_stiffness: 1e3, ..STIFF }, &start);
        batch.solve_twist();
        let end = positions(&batch);
        assert!(twist(&fabric, &end) < 1e-4 * twist(&fabric, &start));
        let centre = |at: &[Vec3]| -> Vec3 {
            at.iter().zip(fabric.particle_areas()).map(|(at, &area)| *at * area).sum()
        };
        assert!(centre(&end).distance(centre(&start)) < 1e-6);
    }
}
