//! What of a cloth hangs: panels that are sewn nowhere are pieces of their own, of which some may have no pin, and fall.

use bunting_solver::{ClothBatch, Fabric};
use glam::Vec3;

/// Whether each particle is joined to a pinned one by links.
pub fn held(fabric: &Fabric) -> Vec<bool> {
    let mut beside = vec![Vec::new(); fabric.particle_count()];
    for [a, b] in fabric.links().iter().map(|link| link.particles.map(|at| at as usize)) {
        beside[a].push(b);
        beside[b].push(a);
    }
    let mut is_held: Vec<bool> = (0..beside.len()).map(|at| fabric.is_pinned(at)).collect();
    let mut left: Vec<usize> = (0..beside.len()).filter(|at| is_held[*at]).collect();
    while let Some(from) = left.pop() {
        for &to in &beside[from] {
            if !std::mem::replace(&mut is_held[to], true) {
                left.push(to);
            }
        }
    }
    is_held
}

/// RMS speed of what hangs of a lone cloth, m/s; infinite if it is not a number.
pub fn speed(batch: &ClothBatch) -> f64 {
    let mut velocities = Vec::new();
    batch.copy_velocities(0, &mut velocities);
    let of_held = velocities.iter().zip(held(batch.fabric())).filter(|(_, is_held)| *is_held);
    let squares: Vec<f64> = of_held.map(|(v, _): (&Vec3, _)| v.length_squared().into()).collect();
    let speed = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    if speed.is_finite() { speed } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::meshes::net;
    use bunting_solver::FabricBuilder;

    #[test]
    fn a_sheet_beside_a_pinned_one_is_not_held() {
        let square = |x: f32| {
            [[0.0, 0.0], [0.0, -1.0], [1.0, 0.0], [1.0, -1.0]]
                .map(|[a, b]| Vec3::new(x + a, b, 0.0))
        };
        let positions = [square(0.0), square(2.0)].concat();
        let indices = vec![0, 1, 2, 2, 1, 3, 4, 5, 6, 6, 5, 7];
        let fabric = net(&FabricBuilder::new(positions, indices).pin([0]));
        let is_held = held(&fabric);
        for (at, is_held) in fabric.rest_positions().iter().zip(is_held) {
            assert_eq!(is_held, at.x < 1.5, "{at}");
        }
    }
}
