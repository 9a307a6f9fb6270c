//! A line that ends at a seam, solved at once with the impulse there.
//!
//! The XPBD system of the line's links, (J M⁻¹ Jᵀ + α̃) Δλ = −C − J M⁻¹ μ e₀ with the impulse μ on its first particle, is tridiagonal
//! (`constraints/chain.rs`). It is eliminated from the far end to the seam, and says how the first particle responds to μ:
//! Δp₀ = f + w (I − (w/D) d dᵀ) μ, with D the last pivot, d the direction of the first link, and f what the line does without μ.
//! Along a line that is taut to a pin the response is that of the links' stretch alone, across it that of a free particle.

use glam::Vec3;

use crate::constants::LEAST_LENGTH;
use crate::seams::plan::{Seams, SewnLine};
use crate::seams::state::{Row, Sewing};

/// How a particle of a stitch responds to an impulse.
#[derive(Clone, Copy, Debug)]
pub(super) struct Response {
    /// How far its line moves it in any case, m.
    pub free: Vec3,
    /// Its inverse mass, 1/m².
    pub inverse_mass: f32,
    /// The direction in which its line holds it.
    pub along: Vec3,
    /// The part of its mobility in that direction that the line takes.
    pub held: f32,
}

impl Sewing {
    /// The response of a particle without a line.
    pub fn response_alone(&self, particle: usize) -> Response {
        let inverse_mass = self.inverse_mass[particle];
        Response { free: Vec3::ZERO, inverse_mass, along: Vec3::ZERO, held: 0.0 }
    }

    /// Eliminates the unknowns of a line from its far end to the seam.
    pub fn eliminate(&mut self, seams: &Seams, line: &SewnLine) -> Response {
        let points = &seams.points[line.points.clone()];
        let mut end = self.at[points[points.len() - 1] as usize];
        let mut end_mass = self.inverse_mass[points[points.len() - 1] as usize];
        let mut behind = Row::default();
        for (index, link) in line.links.clone().enumerate().rev() {
            let near = points[index] as usize;
            let (start, near_mass) = (self.at[near], self.inverse_mass[near]);
            let along = end - start;
            let length = along.length();
            let direction = if length > LEAST_LENGTH { along * (1.0 / length) } else { Vec3::ZERO };
            // The coupling of the link behind with this one.
            behind.coupling = end_mass * direction.dot(behind.direction);
            if index + 1 < points.len() - 1 {
                self.rows[link + 1].coupling = behind.coupling;
            }
            let multiplier = behind.coupling * behind.inverse;
            let diagonal =
                end_mass + near_mass + self.compliance[link] - behind.coupling * multiplier;
            let right = self.target[link] - length + multiplier * behind.right;
            let inverse = if diagonal > 0.0 { 1.0 / diagonal } else { 0.0 };
            behind = Row { direction, coupling: 0.0, inverse, right };
            self.rows[link] = behind;
            (end, end_mass) = (start, near_mass);
        }
        Response {
            free: behind.direction * (-end_mass * behind.right * behind.inverse),
            inverse_mass: end_mass,
            along: behind.direction,
            held: end_mass * behind.inverse,
        }
    }

    /// Moves the particles of a line by an impulse on its first one, and stores the targets of its links.
    pub fn substitute(&mut self, seams: &Seams, line: &SewnLine, impulse: Vec3) {
        let points = &seams.points[line.points.clone()];
        let mut pull = impulse;
        let mut nearer = 0.0;
        for (index, link) in line.links.clone().enumerate() {
            let Row { direction, coupling, inverse, right } = self.rows[link];
            let near = points[index] as usize;
            let coupled = if index == 0 {
                self.inverse_mass[near] * direction.dot(impulse)
            } else {
                coupling * nearer
            };
            let tension = (right + coupled) * inverse;
            self.target[link] -= self.compliance[link] * tension;
            self.at[near] += self.inverse_mass[near] * (pull - direction * tension);
            pull = direction * tension;
            nearer = tension;
        }
        let last = points[points.len() - 1] as usize;
        self.at[last] += self.inverse_mass[last] * pull;
    }
}
