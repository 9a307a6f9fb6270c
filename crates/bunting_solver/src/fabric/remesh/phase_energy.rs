//! The energy of phases, Σ w |z′ − e^{iω} z|² over all edges, with ω by how far a phase turns along the edge.

use glam::DVec2;

/// Weight of the phases found before in those found next. Larger: lines that end in the first guess still do. Smaller: numbers far from a border that holds
/// phases become rounding errors.
const INERTIA: f64 = 1e-2;

/// Weight of a whole phase.
const WHOLE: f64 = 20.0;

/// Square of the residual that is left of the right side.
const ACCURATE: f64 = 1e-8;

/// Most steps of conjugate gradients.
const STEPS: usize = 400;

/// The phases of a vertex as complex numbers.
pub(super) type Phases = [DVec2; 2];

/// What an edge adds to the energy.
pub(super) struct EdgeTerm {
    pub ends: [u32; 2],
    /// The quarter turns after which the axes of the second end are those of the first.
    pub quarters: u8,
    /// e^{iω} along both axes of the first end.
    pub turn: Phases,
    pub weight: f64,
}

/// The energy of the phases of a mesh.
pub(super) struct PhaseEnergy {
    pub terms: Vec<EdgeTerm>,
    /// Which phases of each vertex are whole.
    pub is_whole: Vec<[bool; 2]>,
}

impl PhaseEnergy {
    /// The phases of least energy that are near those before, by conjugate gradients (Hestenes and Stiefel 1952).
    pub fn relaxed(&self, before: &[Phases]) -> Vec<Phases> {
        let right: Vec<Phases> = before
            .iter()
            .zip(&self.is_whole)
            .map(|(at, is_whole)| {
                [0, 1].map(|axis| INERTIA * at[axis] + whole(is_whole[axis]) * DVec2::X)
            })
            .collect();
        let mut found = before.to_vec();
        let mut residuals = right.clone();
        add(&mut residuals, -1.0, &self.product(&found));
        let mut direction = residuals.clone();
        let mut size = dot(&residuals, &residuals);
        let accurate = ACCURATE * dot(&right, &right);
        for _ in 0..STEPS {
            if size <= accurate {
                break;
            }
            let along = self.product(&direction);
            let length = size / dot(&direction, &along);
            add(&mut found, length, &direction);
            add(&mut residuals, -length, &along);
            let next = dot(&residuals, &residuals);
            for (step, residual) in direction.iter_mut().flatten().zip(residuals.iter().flatten()) {
                *step = *residual + *step * (next / size);
            }
            size = next;
        }
        found
    }

    /// Half of the gradient of the energy.
    fn product(&self, phases: &[Phases]) -> Vec<Phases> {
        let own = |(at, is_whole): (&Phases, &[bool; 2])| {
            [0, 1].map(|axis| (INERTIA + whole(is_whole[axis])) * at[axis])
        };
        let mut products: Vec<Phases> = phases.iter().zip(&self.is_whole).map(own).collect();
        for EdgeTerm { ends, quarters, turn, weight } in &self.terms {
            let [one, other] = ends.map(|at| at as usize);
            let there = turned(phases[other], *quarters);
            let off =
                [0, 1].map(|axis| *weight * (there[axis] - turn[axis].rotate(phases[one][axis])));
            let back = turned(off, 4 - quarters);
            for axis in 0..2 {
                products[one][axis] -= conjugate(turn[axis]).rotate(off[axis]);
                products[other][axis] += back[axis];
            }
        }
        products
    }
}

fn whole(is_whole: bool) -> f64 {
    if is_whole { WHOLE } else { 0.0 }
}

fn conjugate(at: DVec2) -> DVec2 {
    DVec2::new(at.x, -at.y)
}

/// Phases along axes that make quarter turns to become those given.
fn turned([one, other]: Phases, quarters: u8) -> Phases {
    match quarters % 4 {
        0 => [one, other],
        1 => [other, conjugate(one)],
        2 => [conjugate(one), conjugate(other)],
        _ => [conjugate(other), one],
    }
}

fn dot(one: &[Phases], other: &[Phases]) -> f64 {
    one.iter().flatten().zip(other.iter().flatten()).map(|(a, b)| a.dot(*b)).sum()
}

fn add(to: &mut [Phases], factor: f64, by: &[Phases]) {
    for (to, by) in to.iter_mut().flatten().zip(by.iter().flatten()) {
        *to += factor * *by;
    }
}
