//! Constraints, one file each, with the same verb: `solve_x` projects every constraint of its kind once.
//!
//! A constraint C(x) = 0 of stiffness k moves its particles by Δx = w ∇C Δλ with
//! Δλ = −(C + α̃ λ)/(Σ w |∇C|² + α̃), α̃ = 1/(k h²) (XPBD, Macklin 2016, eq. 18; with α̃ = 0 the thesis's eq. 4.13
//! and 4.14). The inverse mass of a particle is w/σ, with w one over its area and σ the area density, so the
//! equation is multiplied through by σ: inverse masses are w, 1/m², and compliances σ/(k h²).

#[cfg(test)]
mod bench;
pub(crate) mod bend_factors;
mod bending;
mod both_ways;
mod chain;
mod closed_chain;
mod direction;
pub(crate) mod factors;
mod gauss_seidel;
mod guide;
pub(crate) mod order;
mod overlong;
pub(crate) mod rest_bends;
pub(crate) mod shear;
mod single_link;
mod solve;
mod stiff_bending;
pub(crate) mod stiffness;
mod strip;
pub(crate) mod strip_block;
mod strip_system;
mod sweep;
mod tether;
pub(crate) mod tridiagonal;
mod twist;
pub(crate) mod twist_factors;

pub(crate) use stiffness::resists_twist;
