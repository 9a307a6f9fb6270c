//! Materials and drives of cloths that lie in one batch, which differ from seed to seed.

use bunting_solver::{Drive, FabricMaterial, FrameMotion};
use glam::{Quat, Vec3};

/// Materials that differ in every property that may differ within a batch.
pub fn material(seed: usize) -> FabricMaterial {
    match seed % 3 {
        0 => FabricMaterial { friction_coefficient: 0.0, ..FabricMaterial::SILK },
        // This cloth is so stiff that bending is solved at positions with the displacement by stretch.
        1 => FabricMaterial { bend_stiffness: 10.0, ..FabricMaterial::DENIM },
        _ => FabricMaterial { internal_damping: 1.0, ..FabricMaterial::COTTON },
    }
}

/// Drive of a cloth in a tick; frames of odd seeds move for twenty ticks.
pub fn drive(seed: usize, tick: usize) -> Drive {
    let moves = seed % 2 == 1 && tick < 20;
    let seed = seed as f32;
    let motion = FrameMotion {
        rotation: Quat::from_rotation_y(0.01 * seed),
        translation: Vec3::new(0.02 * seed, 0.0, -0.01),
    };
    let motion = if moves { motion } else { FrameMotion::NONE };
    Drive { motion, wind: Vec3::new(5.0, 0.2 * seed, 1.0), ..Drive::default() }
}
