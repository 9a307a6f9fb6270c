//! Jakobsen 2001, "Advanced character physics": Verlet integration without velocities, and relaxation
//! of equal-mass sticks with the square root replaced by its first-order expansion at the rest length.

use glam::Vec3;

use super::{sheet::Sheet, stepper::Stepper};

/// A cloth of sticks; it has no bending.
#[derive(Clone, Debug)]
pub struct Jakobsen {
    passes: usize,
    previous: Vec<Vec3>,
}

impl Jakobsen {
    /// The method, initialised for a sheet.
    #[must_use]
    pub fn new(sheet: &Sheet, passes: usize) -> Self {
        Self { previous: sheet.positions.clone(), passes }
    }
}

impl Stepper for Jakobsen {
    fn substep(&mut self, sheet: &mut Sheet, h: f32) {
        sheet.predict(&mut self.previous, h);
        for _ in 0..self.passes {
            relax(sheet);
        }
        sheet.take_velocities_from(&self.previous, h);
    }
}

fn relax(sheet: &mut Sheet) {
    for link in &sheet.links {
        let (wa, wb) = (sheet.inverse_masses[link.a], sheet.inverse_masses[link.b]);
        let (share_a, share_b) = match (wa > 0.0, wb > 0.0) {
            (true, true) => (0.5, 0.5),
            (true, false) => (1.0, 0.0),
            (false, true) => (0.0, 1.0),
            (false, false) => continue,
        };
        let d = sheet.positions[link.b] - sheet.positions[link.a];
        let squared = link.rest * link.rest;
        let pull = d * (1.0 - 2.0 * squared / (d.length_squared() + squared));
        sheet.positions[link.a] += pull * share_a;
        sheet.positions[link.b] -= pull * share_b;
    }
}
