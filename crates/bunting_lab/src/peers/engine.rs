//! Engines with their settings.

use bunting_solver::{LaneCount, StepSettings};

use super::{
    peer::Peer,
    rapier::{Elasticity, Rapier},
};
use crate::{
    contender::Contender,
    product::{DEFAULT, Product},
    scenes::Scene,
    simulation::Simulation,
};

/// Starts an engine on a scene.
pub type Start = dyn Fn(&Scene) -> Box<dyn Peer>;

/// An engine with its settings.
pub struct Engine {
    /// Name.
    pub name: &'static str,
    /// Substeps a tick.
    pub substeps: u32,
    /// Cloths advanced at once.
    pub lanes: usize,
    /// Description of the engine's constraints.
    pub constraints: &'static str,
    /// Starts the engine on a scene.
    pub start: Box<Start>,
}

/// Numbers of rapier's substeps in the comparison with the methods of the thesis.
const RAPIER_CONTENDS: [usize; 4] = [4, 10, 20, 40];

/// Other engines in the comparison with the methods of the thesis, on scenes without air.
#[must_use]
pub fn contenders() -> Vec<Contender> {
    let rapier = |substeps| Contender {
        method: "rapier 0.36".into(),
        substeps,
        passes: 1,
        lanes: 1,
        start: Box::new(move |scene: &Scene| {
            let start = || Box::new(Rapier::new(scene, Elasticity::Constraints, substeps));
            scene.air.is_vacuum().then(|| start() as Box<dyn Simulation>)
        }),
    };
    RAPIER_CONTENDS.map(rapier).into()
}

/// Rapier's default number of substeps.
const RAPIER_SUBSTEPS: usize = 4;
/// Number of substeps at which rapier's stretch hardly improves further.
const RAPIER_MANY_SUBSTEPS: usize = 20;

impl Engine {
    /// All compared engines.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let rapier = |name, elasticity: Elasticity, substeps: usize| Self {
            name,
            substeps: substeps as u32,
            lanes: 1,
            constraints: elasticity.description(),
            start: Box::new(move |scene| Box::new(Rapier::new(scene, elasticity, substeps))),
        };
        vec![
            Self::product("bunting yarns", DEFAULT, LaneCount::One),
            Self::product("bunting yarns", DEFAULT, LaneCount::Eight),
            Self::product("bunting Gauss–Seidel", StepSettings::gauss_seidel(10), LaneCount::One),
            Self::product("bunting Gauss–Seidel", StepSettings::gauss_seidel(10), LaneCount::Eight),
            rapier("rapier 0.36", Elasticity::Constraints, RAPIER_SUBSTEPS),
            rapier("rapier 0.36", Elasticity::Constraints, RAPIER_MANY_SUBSTEPS),
            rapier("rapier 0.36 FEM", Elasticity::Fem, RAPIER_SUBSTEPS),
        ]
    }

    fn product(name: &'static str, settings: StepSettings, lanes: LaneCount) -> Self {
        let product = Product { settings, lanes };
        Self {
            name,
            substeps: settings.substeps,
            lanes: lanes.get(),
            constraints: "links of the material's stiffness, bending 2e-5 N·m",
            start: Box::new(move |scene| Box::new(product.start(scene))),
        }
    }
}
