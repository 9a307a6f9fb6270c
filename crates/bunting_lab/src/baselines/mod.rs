//! The methods that the thesis discusses, as plain scalar single-precision code.
//!
//! The product is compared with these methods. They are straightforward but not wasteful code: flat arrays,
//! no vector instructions, nothing computed twice.

pub mod dihedral;
pub mod hpbd;
pub mod implicit_euler;
pub mod jakobsen;
pub mod mass_spring;
pub mod pbd;
pub mod projection;
pub mod sheet;
mod stepper;
pub mod xpbd;

use std::fmt;

use glam::Vec3;
use hpbd::Hpbd;
use implicit_euler::ImplicitEuler;
use jakobsen::Jakobsen;
use mass_spring::{MassSpring, Order};
use pbd::{Bending, Pbd};
use sheet::Sheet;
use stepper::Stepper;
use xpbd::Xpbd;

use crate::{
    scenes::{Scene, TICK_RATE},
    simulation::Simulation,
};

/// A method of the thesis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Mass-spring, explicit Euler.
    ExplicitEuler,
    /// Mass-spring, symplectic Euler.
    SymplecticEuler,
    /// Mass-spring, implicit Euler by sparse Cholesky factorisation.
    ImplicitEuler,
    /// Jakobsen's Verlet integration and relaxation.
    Jakobsen,
    /// Position-based dynamics with dihedral bending.
    PbdDihedral,
    /// Position-based dynamics with bending by distances over one vertex.
    PbdOverOne,
    /// Position-based dynamics with bending over one vertex, solved on coarser cloths first.
    Hpbd,
    /// Extended position-based dynamics.
    Xpbd,
}

/// A method with its settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Baseline {
    /// The method.
    pub method: Method,
    /// Substeps a tick.
    pub substeps: usize,
    /// Passes over the constraints a substep; one if the method has no passes.
    pub passes: usize,
}

impl Baseline {
    /// The settings that the tables show, the cheapest first within each method.
    #[must_use]
    pub fn catalogue() -> Vec<Self> {
        let settings: [(Method, &[(usize, usize)]); 8] = [
            (Method::ExplicitEuler, &[(400, 1)]),
            (Method::SymplecticEuler, &[(100, 1), (200, 1), (400, 1), (800, 1)]),
            (Method::ImplicitEuler, &[(1, 1), (4, 1)]),
            (Method::Jakobsen, &[(1, 5), (1, 20)]),
            (Method::PbdDihedral, &[(1, 10), (1, 40)]),
            (Method::PbdOverOne, &[(1, 10), (1, 40)]),
            (Method::Hpbd, &[(1, 2), (1, 10), (10, 2)]),
            (Method::Xpbd, &[(1, 10), (10, 1), (20, 1), (80, 1)]),
        ];
        settings
            .iter()
            .flat_map(|(method, pairs)| {
                pairs.iter().map(|(substeps, passes)| Self {
                    method: *method,
                    substeps: *substeps,
                    passes: *passes,
                })
            })
            .collect()
    }

    /// The scene at its start under this method.
    #[must_use]
    pub fn start(&self, scene: &Scene) -> Box<dyn Simulation> {
        let sheet = Sheet::new(scene);
        let stepper: Box<dyn Stepper> = match self.method {
            Method::ExplicitEuler => Box::new(MassSpring::new(&sheet, Order::Explicit)),
            Method::SymplecticEuler => Box::new(MassSpring::new(&sheet, Order::Symplectic)),
            Method::ImplicitEuler => Box::new(ImplicitEuler::new(&sheet)),
            Method::Jakobsen => Box::new(Jakobsen::new(&sheet, self.passes)),
            Method::PbdDihedral => Box::new(Pbd::new(&sheet, Bending::Dihedral, self.passes)),
            Method::PbdOverOne => Box::new(Pbd::new(&sheet, Bending::OverOne, self.passes)),
            Method::Hpbd => Box::new(Hpbd::new(&sheet, scene, self.passes)),
            Method::Xpbd => Box::new(Xpbd::new(&sheet, self.passes)),
        };
        Box::new(Stepped { sheet, stepper, substeps: self.substeps })
    }
}

/// A sheet advanced by a method.
struct Stepped {
    sheet: Sheet,
    stepper: Box<dyn Stepper>,
    substeps: usize,
}

impl Simulation for Stepped {
    fn tick(&mut self) {
        let h = 1.0 / (TICK_RATE as f32 * self.substeps as f32);
        for _ in 0..self.substeps {
            self.stepper.substep(&mut self.sheet, h);
        }
    }

    fn positions(&self) -> &[Vec3] {
        &self.sheet.positions
    }

    fn velocities(&self) -> &[Vec3] {
        &self.sheet.velocities
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::ExplicitEuler => "explicit Euler",
            Self::SymplecticEuler => "symplectic Euler",
            Self::ImplicitEuler => "implicit Euler",
            Self::Jakobsen => "Jakobsen",
            Self::PbdDihedral => "PBD, dihedral",
            Self::PbdOverOne => "PBD, over one",
            Self::Hpbd => "HPBD",
            Self::Xpbd => "XPBD",
        })
    }
}
