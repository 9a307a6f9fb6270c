//! Bending of any mesh: C = θ − θ₀, with θ the angle between the two triangles of a hinge (thesis, eq. 4.19
//! to 4.33).
//!
//! The correction is scaled by the gradients and masses (thesis, eq. 4.13 and 4.14: eq. 4.34 holds for equal
//! masses only).

use super::fold::{Fold, fold};
use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Order, Particles, Positions};
use crate::fabric::Fabric;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::V3;

impl<P: Pack> LaneBatch<P> {
    /// Projects every hinge once. With `accumulate`, multipliers are kept from pass to pass.
    pub fn solve_dihedral(&mut self, accumulate: bool) {
        P::run(Dihedral {
            fabric: &self.fabric,
            compliance: &self.layout.hinge_compliance,
            multiplier: &mut self.layout.hinge_multiplier,
            particles: self.positions.particles(Order::RowMajor, &self.masses.inverse, &[]),
            accumulate,
        });
    }
}

struct Dihedral<'a, P: Pack, S: Particles<P>> {
    fabric: &'a Fabric,
    compliance: &'a [P],
    multiplier: &'a mut [P],
    particles: S,
    accumulate: bool,
}

impl<P: Pack, S: Particles<P>> Kernel<P> for Dihedral<'_, P, S> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
        for (hinge, multiplier) in self.fabric.hinges().iter().zip(self.multiplier) {
            let mut at = [V3::<L>::splat(token, 0.0); 4];
            let mut masses = [L::splat(token, 0.0); 4];
            for (corner, &particle) in hinge.particles.iter().enumerate() {
                at[corner] = self.particles.position(token, particle);
                masses[corner] = self.particles.inverse_mass(token, particle);
            }
            let compliance = L::load(token, &self.compliance[hinge.class as usize]);
            let rest_angle = L::splat(token, hinge.rest_angle);
            let so_far = if self.accumulate { Some(L::load(token, multiplier)) } else { None };
            let HingeStep { step, gradient } =
                hinge_step(token, at, masses, rest_angle, compliance, so_far);
            if let Some(so_far) = so_far {
                (so_far + step).store(multiplier);
            }
            for ((particle, x), (w, g)) in
                hinge.particles.into_iter().zip(at).zip(masses.into_iter().zip(gradient))
            {
                self.particles.correct(token, particle, x, (g, w * step));
            }
        }
    }
}

/// The change of a hinge's multiplier.
pub(in crate::constraints) struct HingeStep<L> {
    /// Change of the multiplier.
    pub step: L,
    /// Gradient of the angle for each particle, rad/m.
    pub gradient: [V3<L>; 4],
}

/// Projects a hinge, given its corners (m), their inverse masses (1/m²), the angle at rest (rad), the compliance (1/m⁴)
/// and, if it counts, the multiplier so far.
#[inline(always)]
pub(in crate::constraints) fn hinge_step<L: Lane>(
    token: L::Token,
    corners: [V3<L>; 4],
    masses: [L; 4],
    rest_angle: L,
    compliance: L,
    multiplier: Option<L>,
) -> HingeStep<L> {
    let Fold { angle, gradient } = fold(token, corners);
    let mut excess = shortest_turn(token, angle - rest_angle);
    if let Some(multiplier) = multiplier {
        excess = excess + compliance * multiplier;
    }
    let mut denominator = compliance;
    for (w, g) in masses.into_iter().zip(gradient) {
        denominator = denominator + w * g.dot(g);
    }
    // A collapsed hinge has no gradient; without compliance its denominator would be zero.
    let step = -excess / denominator.max(L::splat(token, f32::MIN_POSITIVE));
    HingeStep { step, gradient }
}

/// The angle plus or minus full turns, between −π and π, so that a hinge folded past π opens the short way.
#[inline(always)]
fn shortest_turn<L: Lane>(token: L::Token, angle: L) -> L {
    let half = L::splat(token, core::f32::consts::PI);
    let full = L::splat(token, core::f32::consts::TAU);
    let angle = (angle - full).or_where_not(half.lt(angle), angle);
    (angle + full).or_where_not(angle.lt(-half), angle)
}
