//! Bending along the lines of a grid, each line exactly: C = (x₋ − 2x + x₊)/l at every inner
//! particle, of stiffness B × width/l.
//!
//! The XPBD system (D W Dᵀ + α̃) λ = −C of a line is pentadiagonal, constant, and the same for x, y
//! and z: it is factorised once as L D Lᵀ. Solved before stretch it passes the heavy cantilever with
//! three substeps, where Gauss–Seidel needs hundreds.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::{Cloths, Constant, Places};
use crate::batch::single_cloth::Weave;
use crate::fabric::BendLine;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};
use crate::step::parameters::BendFactors;

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Solves every line once.
    pub fn solve_bending(&mut self) {
        if C::SIDE > 1
            && let Some(weave) = self.woven()
        {
            weave.solve_bending();
            return;
        }
        P::run(Bending {
            lines: self.fabric.bend_lines(),
            factors: &self.parameters.bend_factors,
            moments: &mut self.moments,
            places: Cloths::new(&self.lane_weights, &mut self.position),
        });
    }
}

impl<P: Pack> Weave<P> {
    fn solve_bending(&mut self) {
        for (facing, lines) in &self.bend_lines {
            self.sheets.turn(*facing);
            P::run(Bending {
                lines,
                factors: &self.bend_factors,
                moments: &mut self.moments,
                places: self.sheets.threads(&self.present),
            });
        }
    }
}

struct Bending<'a, P: Pack, S: Places<P>> {
    lines: &'a [BendLine],
    factors: &'a [BendFactors<P, S::Constant>],
    moments: &'a mut [Pack3<P>],
    places: S,
}

impl<P: Pack, S: Places<P>> Kernel<P> for Bending<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        for line in self.lines {
            let factors = &self.factors[line.profile as usize];
            self.solve_line::<L>(token, &line.particles, factors);
        }
    }
}

impl<P: Pack, S: Places<P>> Bending<'_, P, S> {
    #[inline(always)]
    fn solve_line<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        particles: &[u32],
        factors: &BendFactors<P, S::Constant>,
    ) {
        let zero = V3::<L>::splat(token, 0.0);
        let two = L::splat(token, 2.0);
        let inner = factors.rows.len();

        // Down the line: L y = −l C. What is left out is made up for when the moments act.
        let mut at: V3<L> = self.places.position(token, particles[1]);
        let mut edge = at - self.places.position(token, particles[0]);
        let (mut last, mut before_last) = (zero, zero);
        for (row, (factor, &next)) in factors.rows.iter().zip(&particles[2..]).enumerate() {
            let next: V3<L> = self.places.position(token, next);
            let next_edge = next - at;
            let y = (edge - next_edge)
                .minus_scaled(last, L::load(token, &factor.near))
                .minus_scaled(before_last, L::load(token, &factor.far));
            y.store(&mut self.moments[row]);
            (before_last, last) = (last, y);
            (at, edge) = (next, next_edge);
        }

        // Back up: D Lᵀ λ = y, and Δx = W Dᵀ λ: each particle takes the moments of its own stencil and
        // of its neighbours'.
        let (mut above, mut above_that) = (zero, zero);
        let (mut near, mut far) = (L::splat(token, 0.0), L::splat(token, 0.0));
        let mut next_far = L::splat(token, 0.0);
        for row in (0..inner).rev() {
            let factor = &factors.rows[row];
            let y: V3<L> = V3::load(token, &self.moments[row]);
            let moment = (y * L::load(token, &factor.inverse))
                .minus_scaled(above, near)
                .minus_scaled(above_that, far);
            let moved = (moment + above_that).minus_scaled(above, two);
            self.shift::<L>(token, particles[row + 2], moved, factors.weights[row + 2]);
            (above_that, above) = (above, moment);
            near = L::load(token, &factor.near);
            far = next_far;
            next_far = L::load(token, &factor.far);
        }
        let moved = above_that.minus_scaled(above, two);
        self.shift::<L>(token, particles[1], moved, factors.weights[1]);
        self.shift::<L>(token, particles[0], above, factors.weights[0]);
    }

    /// Moves a particle of a line by the difference of moments that acts on it.
    #[inline(always)]
    fn shift<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        particle: u32,
        moments: V3<L>,
        weight: S::Constant,
    ) {
        let position = self.places.position(token, particle);
        self.places.set_position(particle, position.plus_scaled(moments, weight.load(token)));
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::constraints::bench::{cloth_at, positions, soft_step};
    use crate::fabric::{BendLine, Fabric, FabricBuilder, FabricMaterial, Grid};

    /// ½ B Σ width/l |C|² over some lines.
    fn energy(fabric: &Fabric, lines: &[BendLine], bend_stiffness: f32, at: &[Vec3]) -> f64 {
        let of_line = |line: &BendLine| -> f64 {
            let profile = &fabric.bend_profiles()[line.profile as usize];
            let bends = line.particles.windows(3).zip(&profile.coefficients);
            bends
                .map(|(three, &weight)| {
                    let [a, b, c] = [0, 1, 2].map(|i| at[three[i] as usize].as_dvec3());
                    let bend = (a - 2.0 * b + c) * f64::from(profile.inverse_spacing);
                    0.5 * f64::from(weight * bend_stiffness) * bend.length_squared()
                })
                .sum()
        };
        lines.iter().map(of_line).sum()
    }

    fn wavy(fabric: &Fabric) -> Vec<Vec3> {
        let wave = |at: &Vec3| *at + Vec3::Z * 0.05 * libm::sinf(5.0 * at.x + 3.0 * at.y);
        fabric.rest_positions().iter().map(wave).collect()
    }

    #[test]
    fn a_soft_step_follows_the_gradient() {
        let grid = FabricBuilder::grid(Grid::new(6, 5, 1.0, 0.8));
        let fabric = grid.pin([0, 6]).build().expect("good");
        let material = FabricMaterial { bend_stiffness: 1e-5, ..FabricMaterial::COTTON };
        let start = wavy(&fabric);
        let expected = soft_step(&fabric, &material, &start, |at| {
            energy(&fabric, fabric.bend_lines(), material.bend_stiffness, at)
        });
        let mut batch = cloth_at(&fabric, material, &start);
        batch.solve_bending();
        let largest = expected.iter().map(|step| step.length()).fold(0.0, f32::max);
        for ((end, start), expected) in positions(&batch).iter().zip(&start).zip(&expected) {
            let moved = *end - *start;
            assert!(moved.distance(*expected) < 0.03 * largest, "{moved} {expected}");
        }
    }

    #[test]
    fn a_stiff_line_becomes_straight_and_keeps_its_momentum() {
        let fabric = FabricBuilder::grid(Grid::new(8, 3, 1.0, 0.3)).build().expect("good");
        let material = FabricMaterial { bend_stiffness: 1e3, ..FabricMaterial::COTTON };
        let start = wavy(&fabric);
        let mut batch = cloth_at(&fabric, material, &start);
        batch.solve_bending();
        let end = positions(&batch);
        // Columns are solved last, and bend the rows again.
        let columns = &fabric.bend_lines()[3..];
        let ratio = energy(&fabric, columns, 1.0, &end) / energy(&fabric, columns, 1.0, &start);
        assert!(ratio < 1e-4, "{ratio}");
        let centre = |at: &[Vec3]| -> Vec3 {
            at.iter().zip(fabric.particle_areas()).map(|(at, &area)| *at * area).sum()
        };
        assert!(centre(&end).distance(centre(&start)) < 1e-6);
    }
}
