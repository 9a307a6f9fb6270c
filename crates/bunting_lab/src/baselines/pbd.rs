//! Position-based dynamics as the thesis does it: Gauss–Seidel with rigid distances (Müller et al.
//! 2007; thesis, chapter 4.4), and bending by dihedral angles or by distances over one vertex
//! (thesis, chapter 6.2).

use glam::Vec3;

use super::{
    dihedral::{Hinge, hinges},
    projection::project,
    sheet::{Link, Sheet},
    stepper::Stepper,
};

/// Fraction of a bending error that one projection removes. The method has no physical bending stiffness:
/// this value looks like soft cloth, and grows stiffer with passes and substeps.
const BENDING: f32 = 0.01;

/// Type of bending constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bending {
    /// The angle between neighbouring triangles is constrained.
    Dihedral,
    /// The distance between every second vertex of a row or column is constrained.
    OverOne,
}

/// A cloth under position-based dynamics.
#[derive(Clone, Debug)]
pub struct Pbd {
    passes: usize,
    hinges: Vec<Hinge>,
    over_one: Vec<Link>,
    previous: Vec<Vec3>,
}

impl Pbd {
    /// The method, initialised for a sheet.
    #[must_use]
    pub fn new(sheet: &Sheet, bending: Bending, passes: usize) -> Self {
        let (hinges, over_one) = match bending {
            Bending::Dihedral => (hinges(&sheet.triangles), Vec::new()),
            Bending::OverOne => (Vec::new(), over_one(sheet)),
        };
        Self { previous: sheet.positions.clone(), passes, hinges, over_one }
    }
}

impl Pbd {
    /// Sweeps over bending and links, once for each pass.
    pub(super) fn relax(&self, sheet: &mut Sheet) {
        for _ in 0..self.passes {
            for hinge in &self.hinges {
                hinge.project(BENDING, &mut sheet.positions, &sheet.inverse_masses);
            }
            for link in &self.over_one {
                project(link, BENDING, &mut sheet.positions, &sheet.inverse_masses);
            }
            for link in &sheet.links {
                project(link, 1.0, &mut sheet.positions, &sheet.inverse_masses);
            }
        }
    }
}

impl Stepper for Pbd {
    fn substep(&mut self, sheet: &mut Sheet, h: f32) {
        sheet.predict(&mut self.previous, h);
        self.relax(sheet);
        sheet.take_velocities_from(&self.previous, h);
    }
}

/// Links between the outer vertices of every bend.
fn over_one(sheet: &Sheet) -> Vec<Link> {
    let [dx, dy] = sheet.spacing;
    let link = |[a, b, c]: [usize; 3]| Link {
        a,
        b: c,
        rest: 2.0 * if b == a + 1 { dx } else { dy },
        stiffness: 0.0,
    };
    sheet.bends.iter().map(|bend| link(bend.vertices)).collect()
}
