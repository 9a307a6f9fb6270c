//! States of cloths whose particles are others on the same surface, as after a change of what is held or of the resolution.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use bevy_math::Vec3;
use bunting_solver::{ClothSnapshot, Fabric, LevelTransfer};

use crate::cloth::mesh::ClothMesh;

/// Part of pins from which on a particle between them was held itself. Less: it may have been moved by the cloth.
const WAS_PINNED: f32 = 0.99;

/// What tells a surface from others.
pub(super) fn surface_key(mesh: &ClothMesh) -> u64 {
    let mut hasher = DefaultHasher::new();
    match mesh {
        ClothMesh::Grid { columns, rows, width, height } => {
            (columns, rows, width.to_bits(), height.to_bits()).hash(&mut hasher);
        }
        ClothMesh::Triangles { positions, indices, weights, merged, .. } => {
            (indices, merged).hash(&mut hasher);
            positions.iter().for_each(|at| at.to_array().map(f32::to_bits).hash(&mut hasher));
            weights.iter().for_each(|weight| weight.to_bits().hash(&mut hasher));
        }
    }
    hasher.finish()
}

/// A state on other particles, and whether all its pins were pins before.
pub(crate) struct MovedState {
    pub state: ClothSnapshot,
    pub had_pins: bool,
}

/// The state of a fabric on the particles of another one of the same surface, interpolated between them; none if the surfaces
/// have no triangles.
pub(crate) fn on_other_particles(
    state: &ClothSnapshot,
    from: &Arc<Fabric>,
    to: &Arc<Fabric>,
) -> Option<MovedState> {
    let transfer = LevelTransfer::of_surface(from, to).ok()?;
    let count = from.particle_count();
    let was_pinned: Vec<Vec3> =
        (0..count).map(|at| if from.is_pinned(at) { Vec3::X } else { Vec3::ZERO }).collect();
    let was_pinned = transfer.pick(&was_pinned);
    let mut pins = (0..to.particle_count()).filter(|&particle| to.is_pinned(particle));
    Some(MovedState {
        had_pins: pins.all(|pin| was_pinned[pin].x > WAS_PINNED),
        state: ClothSnapshot::new(
            transfer.pick(&state.positions),
            transfer.pick(&state.velocities),
        ),
    })
}

/// Whether all pins of a fabric are pins of the former one, with as many particles, and some are no longer.
pub(super) fn has_pins_of(fabric: &Fabric, former: &Fabric) -> bool {
    let pinned = |fabric: &Fabric, particle| fabric.is_pinned(particle);
    let count = fabric.particle_count();
    count == former.particle_count()
        && (0..count).all(|at| !pinned(fabric, at) || pinned(former, at))
        && (0..count).any(|at| pinned(fabric, at) != pinned(former, at))
}
