//! The imperfection of a cloth: a small departure from its shape at rest, since a perfect plane that is
//! loaded along itself never buckles.

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::{ClothSnapshot, Fabric};

use crate::waves::{Random, mix, sine};

/// Greatest distance of a particle from its position at rest when a cloth is spawned, m. Folds grow from it
/// by a factor of about e in a tenth of a second. Smaller: folds are late, with a hundredth of it by a third
/// of a second.
const AMPLITUDE: f32 = 1e-4;

/// Distance between the first positions of two cloths below which both get the same seed, m.
const SAME_PLACE: f32 = 1e-3;

/// Wave numbers of the waves whose sum is the imperfection, in periods along the extent of the cloth.
const WAVES: [f32; 4] = [1.3, 2.1, 3.4, 5.5];

/// Seed of a cloth's imperfection: a departure of up to a tenth of a millimetre from the shape at rest, from
/// which folds grow. Optional: by default the seed follows from the position in the world at which the cloth
/// is first simulated.
///
/// Read when the cloth is first simulated; later changes have no effect.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // Two flags with the same folds, wherever they hang.
/// let flag = || (ClothMesh::grid(17, 17, 1.0, 1.0), ClothSeed(1));
/// let flags = [flag(), flag()];
/// # assert_eq!(flags[0], flags[1]);
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct ClothSeed(pub u32);

impl ClothSeed {
    /// Seed of a cloth that is first simulated in this pose: the same in every run and any order of spawning.
    pub(crate) fn of_frame(pose: &Isometry3d) -> Self {
        let place = (Vec3::from(pose.translation) / SAME_PLACE).round().as_ivec3();
        Self(place.to_array().into_iter().fold(1, |hash, part| mix(hash ^ part as u32)))
    }
}

/// State of a fabric at rest with an imperfection: free particles leave their plane by at most [`AMPLITUDE`].
pub(crate) fn almost_at_rest(fabric: &Fabric, seed: ClothSeed) -> ClothSnapshot {
    let mut snapshot = ClothSnapshot::at_rest(fabric);
    let rest = fabric.rest_positions();
    let normals = fabric.normals(rest);
    let extent = fabric.area().sqrt();
    let mut random = Random::with_seed(seed.0);
    let waves = WAVES.map(|count| {
        let direction =
            Vec3::from([(); 3].map(|()| 2.0 * random.unit() - 1.0)).normalize_or(Vec3::ONE);
        (direction * (count / extent), random.unit())
    });
    for (particle, position) in snapshot.positions.iter_mut().enumerate() {
        if fabric.is_pinned(particle) {
            continue;
        }
        let at = rest[particle];
        let sum: f32 = waves.iter().map(|(wave, phase)| sine(wave.dot(at) + phase)).sum();
        *position += normals[particle] * (AMPLITUDE / WAVES.len() as f32 * sum);
    }
    snapshot
}

#[cfg(test)]
mod tests {
    use super::*;
    use bunting_solver::{FabricBuilder, Grid};

    #[test]
    fn an_imperfection_is_small_seeded_and_alike_at_all_levels() {
        let of = |n: u32, seed: u32| {
            let grid = FabricBuilder::grid(Grid::new(n, n, 1.0, 1.0)).pin([0]);
            let fabric = grid.build().expect("a good fabric");
            almost_at_rest(&fabric, ClothSeed(seed)).positions
        };
        let fine = of(33, 7);
        assert!(fine.iter().all(|at| at.z.abs() <= AMPLITUDE));
        assert!(fine.iter().any(|at| at.z.abs() > 0.2 * AMPLITUDE));
        assert_eq!(fine[0], Vec3::ZERO, "what is held is in its place");
        assert_ne!(fine, of(33, 8));
        let coarse = of(17, 7);
        for (index, at) in coarse.iter().enumerate() {
            let (row, column) = (index / 17, index % 17);
            assert!(at.distance(fine[2 * row * 33 + 2 * column]) < 1e-7);
        }
    }

    #[test]
    fn neighbouring_places_have_seeds_of_their_own() {
        let seed = |x: f32| ClothSeed::of_frame(&Isometry3d::from_translation(Vec3::X * x));
        assert_ne!(seed(0.0), seed(0.01));
        assert_eq!(seed(0.0), seed(1e-5));
    }
}
