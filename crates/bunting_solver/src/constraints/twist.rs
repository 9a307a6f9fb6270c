//! Twist along the ribbons of a grid, each ribbon solved exactly: C = x₀₀ − x₁₀ − x₀₁ + x₁₁ in every cell, of
//! stiffness 2 B/(Δx Δy).
//!
//! The XPBD system of a ribbon is tridiagonal, constant, and the same for x, y and z (see
//! `twist_factors.rs`). Gauss–Seidel, cell by cell, would need as many sweeps as a strip has cells to hold
//! the strip on edge.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Particles, Positions};
use crate::constraints::twist_factors::TwistFactors;
use crate::fabric::Ribbon;
use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves every ribbon once, unless no cloth resists twist.
    pub fn solve_twist(&mut self) {
        if !self.layout.factors().resist_twist() {
            return;
        }
        let (order, ribbons) = self.layout.ribbons(&self.fabric);
        let (masses, linked) = (&self.masses.inverse, self.layout.linked());
        P::run(Twist {
            ribbons,
            factors: &self.layout.factors().twist,
            moments: &mut self.moments,
            particles: self.positions.particles(order, masses, linked),
        });
    }
}

struct Twist<'a, P: Pack, S: Particles<P>> {
    ribbons: &'a [Ribbon],
    factors: &'a [TwistFactors<P, S::Constant>],
    moments: &'a mut [Pack3<P>],
    particles: S,
}

impl<P: Pack, S: Particles<P>> Kernel<P> for Twist<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        for ribbon in self.ribbons {
            let factors = &self.factors[ribbon.profile as usize];
            self.solve_ribbon::<L>(token, &ribbon.pairs, factors);
        }
    }
}

impl<P: Pack, S: Particles<P>> Twist<'_, P, S> {
    #[inline(always)]
    fn solve_ribbon<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        pairs: &[[u32; 2]],
        factors: &TwistFactors<P, S::Constant>,
    ) {
        let zero = V3::<L>::splat(token, 0.0);

        // Forwards along the ribbon: L y = −C.
        let mut across: V3<L> = self.across(token, pairs[0]);
        let mut last = zero;
        for (cell, (row, &pair)) in factors.rows.iter().zip(&pairs[1..]).enumerate() {
            let next = self.across(token, pair);
            last = (across - next).minus_scaled(last, L::load(token, &row.lower));
            last.store(&mut self.moments[cell]);
            across = next;
        }

        // Backwards: D Lᵀ λ = y. Each pair is moved by the moments of the cells on either side, W Jᵀ λ.
        let mut next = zero;
        let mut upper = L::splat(token, 0.0);
        for (cell, row) in factors.rows.iter().enumerate().rev() {
            let y: V3<L> = V3::load(token, &self.moments[cell]);
            let moment = (y * L::load(token, &row.inverse_diagonal)).minus_scaled(next, upper);
            let inverse_masses = factors.inverse_masses[cell + 1];
            self.move_apart(token, pairs[cell + 1], moment - next, inverse_masses);
            (next, upper) = (moment, L::load(token, &row.lower));
        }
        self.move_apart(token, pairs[0], zero - next, factors.inverse_masses[0]);
    }

    /// The vector from the first particle of a pair to the second, m.
    #[inline(always)]
    fn across<L: Lane<Pack = P>>(&self, token: L::Token, [from, to]: [u32; 2]) -> V3<L> {
        self.particles.position::<L>(token, to) - self.particles.position(token, from)
    }

    /// Moves the particles of a pair apart, each by a moment times its inverse mass.
    #[inline(always)]
    fn move_apart<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        [from, to]: [u32; 2],
        moment: V3<L>,
        [mass_from, mass_to]: [S::Constant; 2],
    ) {
        let position = self.particles.position(token, from);
        let moved = position.minus_scaled(moment, mass_from.load(token));
        self.particles.set_position(token, from, moved);
        let position = self.particles.position(token, to);
        let moved = position.plus_scaled(moment, mass_to.load(token));
        self.particles.set_position(token, to, moved);
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
        for (columns, rows) in [(2, 2), (2, 7), (7, 2), (5, 6)] {
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
