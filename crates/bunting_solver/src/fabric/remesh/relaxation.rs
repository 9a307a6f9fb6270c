//! Phases of least energy Σ w |z′ − e^{iω} z|² over all edges, with ω by how far a phase turns along the edge.

use core::f64::consts::TAU;

use glam::DVec2;

use super::steps::{Step, Steps};

/// Weight of a whole phase.
const WHOLE: f64 = 20.0;

/// How often all phases are relaxed. Fewer: what does not fit across the mesh stays where it was guessed, and lines end there.
const SWEEPS: usize = 40;

/// By how much phases are relaxed too far. Smaller: what does not fit spreads over fewer cells. From 2 on they do not converge.
const OVER_RELAXATION: f64 = 1.8;

/// The phases of a vertex as complex numbers.
pub(super) type Phases = [DVec2; 2];

/// The term of an edge in the mean of one of its ends.
struct EdgeTerm {
    /// The other end.
    from: u32,
    /// The quarter turns after which the axes of the other end are those of this one.
    quarters: u8,
    /// w e^{−iω} of both phases.
    back: Phases,
}

/// Relaxes the phases of each vertex in turn towards the weighted mean of those that follow from its neighbours' (successive over-relaxation,
/// Young 1954).
pub(super) fn relax(phases: &mut [Phases], steps: &Steps, is_whole: &[[bool; 2]]) {
    let term = |step: &Step| EdgeTerm {
        from: step.to,
        quarters: step.quarters,
        back: step.vector.to_array().map(|turns| step.weight * unit(-TAU * turns)),
    };
    let terms: Vec<EdgeTerm> = steps.all().iter().map(term).collect();
    for _ in 0..SWEEPS {
        for (vertex, is_whole) in is_whole.iter().enumerate() {
            let mut sums = is_whole.map(|is_whole| if is_whole { WHOLE } else { 0.0 } * DVec2::X);
            for EdgeTerm { from, quarters, back } in &terms[steps.numbers_from(vertex as u32)] {
                let there = turned(phases[*from as usize], *quarters);
                sums = [0, 1].map(|axis| sums[axis] + back[axis].rotate(there[axis]));
            }
            phases[vertex] = [0, 1].map(|axis| {
                let (before, wanted) = (phases[vertex][axis], sums[axis].normalize_or(DVec2::X));
                before.lerp(wanted, OVER_RELAXATION).normalize_or(wanted)
            });
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

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use glam::DVec2;

    use super::{Phases, Step, Steps, relax, unit};

    /// Turns: 0.8⁴⁰ of the greatest error is left, and more of what spreads.
    const NEAR: f64 = 1e-3;

    fn step(to: u32, quarters: u8, vector: DVec2) -> Step {
        Step { to, quarters, vector, weight: 1.0 }
    }

    #[test]
    fn what_does_not_fit_around_a_ring_spreads_evenly() {
        const COUNT: u32 = 20;
        const TOO_LONG: f64 = 0.3;
        let along = DVec2::new((10.0 + TOO_LONG) / f64::from(COUNT), 0.0);
        let steps = (0..COUNT).flat_map(|from| {
            let [on, back] = [1, COUNT - 1].map(|by| (from + by) % COUNT);
            [(from, step(on, 0, along)), (from, step(back, 0, -along))]
        });
        let steps = Steps::sorted(steps.collect(), COUNT as usize);
        // All that does not fit is between the last vertex and the first.
        let guess = |vertex: u32| [unit(TAU * along.x * f64::from(vertex)), DVec2::X];
        let mut phases: Vec<Phases> = (0..COUNT).map(guess).collect();
        relax(&mut phases, &steps, &[[false; 2]; COUNT as usize]);
        for (one, two) in phases.iter().zip(phases.iter().cycle().skip(1)) {
            let off = unit(TAU * along.x).rotate(one[0]).angle_to(two[0]) / TAU;
            assert!((off + TOO_LONG / f64::from(COUNT)).abs() < NEAR, "{off} turns");
        }
    }

    #[test]
    fn quarter_turns_swap_the_phases() {
        // A quarter turn takes the axes of the second vertex to those of the first.
        let (there, back) = (DVec2::new(0.3, 0.4), DVec2::new(0.4, -0.3));
        let steps = Steps::sorted(vec![(0, step(1, 1, there)), (1, step(0, 3, back))], 2);
        let mut phases = [[DVec2::X; 2]; 2];
        relax(&mut phases, &steps, &[[true; 2], [false; 2]]);
        let turns = phases[1].map(|phase| DVec2::X.angle_to(phase) / TAU);
        assert!((turns[0] + 0.4).abs() < NEAR && (turns[1] - 0.3).abs() < NEAR, "{turns:?} turns");
    }
}
