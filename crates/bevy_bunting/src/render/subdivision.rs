//! The component that says how finely a cloth is drawn.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// Greatest number of halvings: each makes four times as many triangles.
const MOST_HALVINGS: u32 = 4;

/// The same of meshes whose triangles are larger than the cells of their simulation, which the first halvings only reach.
const MOST_OF_COARSE: u32 = 6;

/// Factor by which drawn edges may be longer or shorter than wanted before they are halved or doubled, so that a
/// cloth near a switch does not change to and fro.
const HYSTERESIS: f32 = 1.2;

/// The drawn surface of a cloth: smooth, through all particles, with a mesh of its own whose edges are halved as long as
/// they are long on the screen. Where an edge is shorter than wanted, the surface deviates from a flat
/// triangle by a fraction of a pixel, so that changes are not seen.
///
/// Grids are subdivided by the four-point scheme, other meshes by the modified butterfly scheme; pins and the border
/// keep their place, see [`Subdivision`](bunting_solver::Subdivision). Normals are those of the smooth surface.
/// Where the triangles of a mesh are larger than the cells of its simulation, its edges are halved as often more, and the added
/// vertices lie on the simulated surface, whose folds they show.
///
/// Cloth with rigid parts is drawn as it is simulated. Every cloth with a mesh has this component; the cost falls on
/// visible cloths only.
///
/// ```
/// use bevy_bunting::ClothSubdivision;
/// use bevy_bunting::prelude::*;
///
/// // A curtain in the foreground: edges of at most three pixels.
/// let curtain = (ClothMesh::grid(33, 33, 2.0, 2.0), ClothSubdivision { edge: 3.0, halvings: 3 });
/// // A banner that is drawn as it is simulated.
/// let banner = (ClothMesh::grid(33, 33, 2.0, 2.0), ClothSubdivision::NONE);
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothSubdivision {
    /// Length of an edge on the screen above which it is halved, px. Shorter: rounder folds, more vertices.
    pub edge: f32,
    /// Greatest number of times that edges are halved; at most 4 count.
    pub halvings: u32,
}

impl Default for ClothSubdivision {
    /// Edges of at most four pixels, halved at most twice.
    fn default() -> Self {
        Self { edge: 4.0, halvings: 2 }
    }
}

impl ClothSubdivision {
    /// The mesh of the particles.
    pub const NONE: Self = Self { edge: f32::INFINITY, halvings: 0 };

    /// Number of halvings for edges of the drawn mesh with a length on the screen (px), where they are halved `present` times
    /// now. Edges that must be halved some times to be as short as the cells of the simulation may be halved as often more; none
    /// is halved where no halvings are wanted.
    pub(super) fn halvings_for(&self, length: f32, present: u32, to_cells: u32) -> u32 {
        let more = if self.halvings > 0 { to_cells } else { 0 };
        let most = (self.halvings.min(MOST_HALVINGS) + more).min(MOST_OF_COARSE);
        let halved = |times: u32| length / (1 << times) as f32;
        let is_kept = present <= most
            && (present == most || halved(present) <= self.edge * HYSTERESIS)
            && (present == 0 || halved(present - 1) > self.edge / HYSTERESIS);
        if is_kept {
            return present;
        }
        (0..most).find(|&times| halved(times) <= self.edge).unwrap_or(most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_halved_until_they_are_short() {
        let wanted = ClothSubdivision { edge: 6.0, halvings: 3 };
        let halvings = |length: f32, present: u32| wanted.halvings_for(length, present, 0);
        assert_eq!([3.0, 10.0, 20.0, 40.0, 1e9].map(|length| halvings(length, 0)), [0, 1, 2, 3, 3]);
        // Near a switch the number stays.
        assert_eq!([0, 1].map(|present| halvings(6.5, present)), [0, 1]);
        assert_eq!([0, 1].map(|present| halvings(5.5, present)), [0, 1]);
        assert_eq!([0, 1].map(|present| halvings(4.0, present)), [0, 0]);
        assert_eq!([0, 1].map(|present| halvings(9.0, present)), [1, 1]);
        let none = ClothSubdivision::NONE;
        assert_eq!([0, 3].map(|present| none.halvings_for(1e9, present, 3)), [0, 0]);
        let not_a_number = ClothSubdivision { edge: f32::NAN, halvings: 9 };
        assert!(not_a_number.halvings_for(10.0, 0, 0) <= MOST_HALVINGS);
        // A mesh whose triangles are eight times as wide as cells.
        assert_eq!([0, 3].map(|to_cells| wanted.halvings_for(1e9, 0, to_cells)), [3, 6]);
    }
}
