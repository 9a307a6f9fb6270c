//! Springs and masses, stepped explicitly (Provot 1995; thesis, chapter 4.1 and equations of chapter 3).

use glam::Vec3;

use super::{sheet::Sheet, stepper::Stepper};

/// Velocities by which positions move: those before or after the forces have acted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Explicit Euler: the old velocities.
    Explicit,
    /// Symplectic Euler: the new velocities.
    Symplectic,
}

/// A mass-spring cloth.
#[derive(Clone, Debug)]
pub struct MassSpring {
    order: Order,
    forces: Vec<Vec3>,
}

impl MassSpring {
    /// The method, initialised for a sheet.
    #[must_use]
    pub fn new(sheet: &Sheet, order: Order) -> Self {
        Self { order, forces: vec![Vec3::ZERO; sheet.positions.len()] }
    }
}

impl Stepper for MassSpring {
    fn substep(&mut self, sheet: &mut Sheet, h: f32) {
        self.forces.fill(Vec3::ZERO);
        sheet.add_elastic_forces(&mut self.forces);
        if self.order == Order::Explicit {
            drift(sheet, h);
        }
        sheet.apply_outer_forces(h);
        for ((v, f), w) in sheet.velocities.iter_mut().zip(&self.forces).zip(&sheet.inverse_masses)
        {
            *v += *f * (w * h);
        }
        if self.order == Order::Symplectic {
            drift(sheet, h);
        }
    }
}

fn drift(sheet: &mut Sheet, h: f32) {
    for (x, v) in sheet.positions.iter_mut().zip(&sheet.velocities) {
        *x += *v * h;
    }
}
