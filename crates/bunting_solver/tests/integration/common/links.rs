use bunting_solver::Fabric;
use glam::Vec3;

/// Greatest length of a link, in lengths at rest, given the positions of all particles, m.
pub fn longest_link(fabric: &Fabric, positions: &[Vec3]) -> f32 {
    let length = |[from, to]: [u32; 2]| positions[from as usize].distance(positions[to as usize]);
    let lengths = fabric.links().iter().map(|link| length(link.particles) / link.rest_length);
    lengths.fold(0.0, f32::max)
}
