//! Bending along the lines of a grid, each line solved exactly: C = (x₋ − 2x + x₊)/l at every inner particle,
//! of stiffness B × width/l.
//!
//! The XPBD system (D W Dᵀ + α̃) λ = −C of a line is pentadiagonal, constant, and the same for x, y and z (see
//! `bend_factors.rs`). On a net C is less by the bend at rest (`rest_bends.rs`). Solved before stretch, three substeps suffice for the heavy cantilever, where Gauss–Seidel
//! needs hundreds.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Particles, Positions};
use crate::constraints::bend_factors::BendFactors;
use crate::fabric::BendLine;
use crate::simd::constant::Constant;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves every line once.
    pub fn solve_bending(&mut self) {
        for (order, lines) in self.layout.bend_lines(&self.fabric) {
            for lines in lines.chunk_by(|line, next| line.is_row == next.is_row) {
                let (masses, linked) = (&self.masses.inverse, self.layout.linked());
                let rest = self.rest_bends.as_mut();
                P::run(Bending {
                    lines,
                    factors: &self.layout.factors().bending,
                    moments: &mut self.moments,
                    at_rest: rest.map(|rest| rest.of_lines(lines[0].is_row, order, masses, linked)),
                    particles: self.positions.lines(order, masses, linked),
                });
            }
        }
    }
}

struct Bending<'a, P: Pack, S: Particles<P>, R: Particles<P>> {
    lines: &'a [BendLine],
    factors: &'a [BendFactors<P, S::Constant>],
    moments: &'a mut [Pack3<P>],
    /// Second differences at rest, m, of a net.
    at_rest: Option<R>,
    particles: S,
}

impl<P: Pack, S: Particles<P>, R: Particles<P>> Kernel<P> for Bending<'_, P, S, R> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        for line in self.lines {
            let factors = &self.factors[line.profile as usize];
            let (rows, _) = line.particles.as_chunks::<1>();
            self.particles.bring::<L, 1>(token, rows, 1);
            self.eliminate::<L>(token, &line.particles, factors);
            self.substitute::<L>(token, &line.particles, factors);
            self.particles.put_back::<L, 1>(token, rows, 1);
        }
    }
}

impl<P: Pack, S: Particles<P>, R: Particles<P>> Bending<'_, P, S, R> {
    /// Solves L y = −l C along a line. A factor of one over the spacing is contained in `mobilities`.
    #[inline(always)]
    fn eliminate<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        particles: &[u32],
        factors: &BendFactors<P, S::Constant>,
    ) {
        let zero = V3::<L>::splat(token, 0.0);
        let mut at: V3<L> = self.particles.position(token, particles[1]);
        let mut edge = at - self.particles.position(token, particles[0]);
        let (mut last, mut before_last) = (zero, zero);
        for (index, (row, &next)) in factors.rows.iter().zip(&particles[2..]).enumerate() {
            let next: V3<L> = self.particles.position(token, next);
            let next_edge = next - at;
            let mut right = edge - next_edge;
            if let Some(at_rest) = &self.at_rest {
                right = right + at_rest.position(token, particles[index + 1]);
            }
            let y = right
                .minus_scaled(last, L::load(token, &row.first_lower))
                .minus_scaled(before_last, L::load(token, &row.second_lower));
            y.store(&mut self.moments[index]);
            (before_last, last) = (last, y);
            (at, edge) = (next, next_edge);
        }
    }

    /// Solves D Lᵀ λ = y back along a line, and moves each particle by W Dᵀ λ: by the moments of its own
    /// stencil and of those of its neighbours.
    #[inline(always)]
    fn substitute<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        particles: &[u32],
        factors: &BendFactors<P, S::Constant>,
    ) {
        let zero = V3::<L>::splat(token, 0.0);
        let two = L::splat(token, 2.0);
        let mobilities = &factors.mobilities;
        // Moments of the next row and of the one after, and the elements of Lᵀ that couple them.
        let (mut next, mut after_next) = (zero, zero);
        let (mut first_upper, mut second_upper) = (L::splat(token, 0.0), L::splat(token, 0.0));
        let mut next_second_upper = L::splat(token, 0.0);
        for index in (0..factors.rows.len()).rev() {
            let row = &factors.rows[index];
            let y: V3<L> = V3::load(token, &self.moments[index]);
            let moment = (y * L::load(token, &row.inverse_diagonal))
                .minus_scaled(next, first_upper)
                .minus_scaled(after_next, second_upper);
            let difference = (moment + after_next).minus_scaled(next, two);
            self.shift::<L>(token, particles[index + 2], difference, mobilities[index + 2]);
            (after_next, next) = (next, moment);
            first_upper = L::load(token, &row.first_lower);
            second_upper = next_second_upper;
            next_second_upper = L::load(token, &row.second_lower);
        }
        let difference = after_next.minus_scaled(next, two);
        self.shift::<L>(token, particles[1], difference, mobilities[1]);
        self.shift::<L>(token, particles[0], next, mobilities[0]);
    }

    /// Moves a particle by the second difference of moments that acts on it.
    #[inline(always)]
    fn shift<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        particle: u32,
        difference: V3<L>,
        mobility: S::Constant,
    ) {
        let position = self.particles.position(token, particle);
        let moved = position.plus_scaled(difference, mobility.load(token));
        self.particles.set_position(token, particle, moved);
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
