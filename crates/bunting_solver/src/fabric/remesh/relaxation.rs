//! Phases of least energy Σ w |z′ − e^{iω} z|² over all edges, with ω by how far a phase turns along the edge.

use core::f64::consts::TAU;

use glam::DVec2;

use super::steps::Steps;

/// Weight of a whole phase.
const WHOLE: f64 = 20.0;

/// How often all phases are relaxed. Fewer: what does not fit across the mesh stays where it was guessed, and lines end there.
const SWEEPS: usize = 40;

/// By how much phases are relaxed too far. Smaller: what does not fit spreads over fewer cells. From 2 on they do not converge.
const OVER_RELAXATION: f64 = 1.8;

/// The phases of a vertex as complex numbers.
pub(super) type Phases = [DVec2; 2];

/// What a neighbour asks of the phases of a vertex.
struct Pull {
    from: u32,
    /// The quarter turns after which the axes of the neighbour are those of the vertex.
    quarters: u8,
    /// w e^{−iω} of both phases.
    back: Phases,
}

/// Relaxes the phases of each vertex in turn towards the mean of what its neighbours ask for (successive over-relaxation, Young 1954).
pub(super) fn relax(phases: &mut [Phases], steps: &Steps, is_whole: &[[bool; 2]]) {
    let mut pulls: Vec<Pull> = Vec::new();
    let mut ends = Vec::new();
    for vertex in 0..phases.len() as u32 {
        pulls.extend(steps.from(vertex).iter().map(|step| Pull {
            from: step.to,
            quarters: step.quarters,
            back: step.vector.to_array().map(|turns| step.weight * unit(-TAU * turns)),
        }));
        ends.push(pulls.len());
    }
    for _ in 0..SWEEPS {
        let mut first = 0;
        for (vertex, (&end, is_whole)) in ends.iter().zip(is_whole).enumerate() {
            let mut sums = is_whole.map(|is_whole| if is_whole { WHOLE } else { 0.0 } * DVec2::X);
            for Pull { from, quarters, back } in &pulls[first..end] {
                let there = turned(phases[*from as usize], *quarters);
                sums = [0, 1].map(|axis| sums[axis] + back[axis].rotate(there[axis]));
            }
            phases[vertex] = [0, 1].map(|axis| {
                let (before, wanted) = (phases[vertex][axis], sums[axis].normalize_or(DVec2::X));
                before.lerp(wanted, OVER_RELAXATION).normalize_or(wanted)
            });
            first = end;
        }
    }
}

/// A complex number with an angle, rad.
pub(super) fn unit(angle: f64) -> DVec2 {
    DVec2::new(libm::cos(angle), libm::sin(angle))
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
