//! Bending along the lines of a grid, each line exactly: C = (x₋ − 2x + x₊)/l at every inner
//! particle, of stiffness B × width/l.
//!
//! The XPBD system (D W Dᵀ + α̃) λ = −C of a line is pentadiagonal, constant, and the same for x, y
//! and z: it is factorised once as L D Lᵀ. Solved before stretch it passes the heavy cantilever with
//! three substeps, where Gauss–Seidel needs hundreds.

use crate::fabric::{BendProfile, Fabric};
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::parameters::BendFactors;
use crate::vector::{Pack3, V3};

impl<P: Pack> LaneBatch<P> {
    /// Solves every line once.
    pub fn solve_bending(&mut self) {
        P::run(Bending {
            fabric: &self.fabric,
            factors: &self.parameters.bend_factors,
            moments: &mut self.moments,
            position: &mut self.position,
        });
    }
}

struct Bending<'a, P: Pack> {
    fabric: &'a Fabric,
    factors: &'a [BendFactors<P>],
    moments: &'a mut [Pack3<P>],
    position: &'a mut [Pack3<P>],
}

impl<P: Pack> Kernel<P> for Bending<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        for line in self.fabric.bend_lines() {
            let profile = &self.fabric.bend_profiles()[line.profile as usize];
            let factors = &self.factors[line.profile as usize];
            solve_line::<L>(token, &line.particles, profile, factors, self.moments, self.position);
        }
    }
}

#[inline(always)]
fn solve_line<L: Lane>(
    token: L::Token,
    particles: &[u32],
    profile: &BendProfile,
    factors: &BendFactors<L::Pack>,
    moments: &mut [Pack3<L::Pack>],
    position: &mut [Pack3<L::Pack>],
) {
    let zero = V3::<L>::splat(token, 0.0);
    let inverse_spacing = L::splat(token, profile.inverse_spacing);
    let inner = factors.rows.len();

    // Down the line: L y = −C.
    let mut at: V3<L> = V3::load(token, &position[particles[1] as usize]);
    let mut edge = at - V3::load(token, &position[particles[0] as usize]);
    let (mut last, mut before_last) = (zero, zero);
    for (row, (factor, &next)) in factors.rows.iter().zip(&particles[2..]).enumerate() {
        let next: V3<L> = V3::load(token, &position[next as usize]);
        let next_edge = next - at;
        let y = (edge - next_edge) * inverse_spacing
            - last * L::load(token, &factor.near)
            - before_last * L::load(token, &factor.far);
        y.store(&mut moments[row]);
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
        let y: V3<L> = V3::load(token, &moments[row]);
        let moment = y * L::load(token, &factor.inverse) - above * near - above_that * far;
        let moved = moment - above - above + above_that;
        shift::<L>(token, &mut position[particles[row + 2] as usize], moved, profile, row + 2);
        (above_that, above) = (above, moment);
        near = L::load(token, &factor.near);
        far = next_far;
        next_far = L::load(token, &factor.far);
    }
    let moved = above_that - above - above;
    shift::<L>(token, &mut position[particles[1] as usize], moved, profile, 1);
    shift::<L>(token, &mut position[particles[0] as usize], above, profile, 0);
}

/// Moves a particle of a line by the difference of moments that acts on it.
#[inline(always)]
fn shift<L: Lane>(
    token: L::Token,
    position: &mut Pack3<L::Pack>,
    moments: V3<L>,
    profile: &BendProfile,
    at: usize,
) {
    let weight = L::splat(token, profile.inverse_areas[at] * profile.inverse_spacing);
    (V3::load(token, position) + moments * weight).store(position);
}
