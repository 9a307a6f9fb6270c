//! Relaxation: removal of strain from cloth that no viewer sees.
//!
//! Shared particles of a folded cloth are nearer to one another than along the cloth, by up to a tenth of the
//! distance. Sweeps over warp and weft move them apart. Shear and bending, which are soft, stay as they are.

use glam::Vec3;

use crate::fabric::{Fabric, Link, LinkFamily};

/// Number of sweeps, each forwards and backwards. Fewer: flags are thrown when they are simulated again (two leave
/// 2.8 % of strain at 5 × 5, and a fifth more kinetic energy). More: nothing is seen of it.
const SWEEPS: u32 = 8;

/// Moves the free particles so that warp and weft are nearly as long as at rest. Both ends of a link move alike.
pub(super) fn relax(fabric: &Fabric, positions: &mut [Vec3]) {
    let links = fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal);
    for _ in 0..SWEEPS {
        links.clone().for_each(|link| project(fabric, link, positions));
        links.clone().rev().for_each(|link| project(fabric, link, positions));
    }
}

/// Moves the free ends of a link to its length at rest.
fn project(fabric: &Fabric, link: &Link, positions: &mut [Vec3]) {
    let ends = link.particles.map(|particle| particle as usize);
    let [moves_first, moves_second] = ends.map(|end| !fabric.is_pinned(end));
    let between = positions[ends[1]] - positions[ends[0]];
    let length = between.length();
    if length == 0.0 || !(moves_first || moves_second) {
        return;
    }
    let share = if moves_first && moves_second { 0.5 } else { 1.0 };
    let change = between * (share * (length - link.rest_length) / length);
    if moves_first {
        positions[ends[0]] += change;
    }
    if moves_second {
        positions[ends[1]] -= change;
    }
}
