//! The simulated surface of a cloth, for reading.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_solver::{Fabric, FabricMaterial, FrameMotion, LinkFamily, MeshPoint};

use crate::cloth::activity::ClothActivity;
use crate::fabric::levels::ClothLevels;

/// The simulated surface of a cloth after the last tick; read only.
///
/// Positions and normals are in the cloth's frame, whose pose in the world is the entity's `GlobalTransform`, with the
/// [`scale`](Self::scale) of cloth that has grown: the pose of the attachment's target times its offset or, without an [`Attachment`](crate::Attachment), the
/// entity's own. After [`ClothSystems::Publish`] and after each frame, the `GlobalTransform` follows the
/// target's current pose.
///
/// A grid has one particle for each vertex. The particles of a mesh of triangles, and of a grid that is held beside its vertices, are
/// others, see [`ClothResolution`](crate::ClothResolution): its vertices lie between them, see [`vertex_position`](Self::vertex_position).
/// Rigid vertices have none. Particles with a weight below 1 are blended with their position at rest, see
/// [`ClothMesh::with_weights`](crate::ClothMesh::with_weights): this component holds the blended surface.
///
/// [`ClothSystems::Publish`]: crate::ClothSystems::Publish
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// /// Prints how low each cloth hangs in its frame.
/// fn lowest(cloths: Query<(Entity, &ClothState)>) {
///     for (cloth, state) in &cloths {
///         println!("{cloth}: {:?}", state.positions().iter().map(|at| at.y).reduce(f32::min));
///     }
/// }
/// # bevy_ecs::system::assert_is_system(lowest);
/// ```
#[derive(Component, Clone, Debug)]
pub struct ClothState {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) previous_positions: Vec<Vec3>,
    pub(crate) normals: Vec<Vec3>,
    pub(crate) previous_normals: Vec<Vec3>,
    pub(crate) level: usize,
    pub(crate) activity: ClothActivity,
    /// Whether the cloth was simulated in the last tick.
    pub(crate) moved: bool,
    pub(crate) levels: Option<Arc<ClothLevels>>,
    /// The surface before a change of level, until the change is eased.
    pub(crate) replaced: Option<ReplacedSurface>,
    /// Whether the cloth follows a skeleton.
    pub(crate) is_skinned: bool,
    /// Motion of the frame in the last tick in which the cloth was simulated, and the length of that tick, s.
    pub(crate) motion: FrameMotion,
    pub(crate) tick: f32,
    /// Metres in a unit of positions.
    pub(crate) scale: f32,
}

impl Default for ClothState {
    /// The state of a cloth before its first tick.
    fn default() -> Self {
        Self {
            positions: Vec::new(),
            previous_positions: Vec::new(),
            normals: Vec::new(),
            previous_normals: Vec::new(),
            level: 0,
            activity: ClothActivity::default(),
            moved: false,
            levels: None,
            replaced: None,
            is_skinned: false,
            motion: FrameMotion::NONE,
            tick: 0.0,
            scale: 1.0,
        }
    }
}

/// The surface of a cloth before a change of level, in the cloth's frame.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ReplacedSurface {
    pub level: usize,
    /// Positions after the last tick, m.
    #[cfg_attr(feature = "serialize", serde(with = "bunting_solver::packed"))]
    pub positions: Vec<Vec3>,
    /// Positions before that tick, m.
    #[cfg_attr(feature = "serialize", serde(with = "bunting_solver::packed"))]
    pub previous_positions: Vec<Vec3>,
    #[cfg_attr(feature = "serialize", serde(with = "bunting_solver::packed"))]
    pub normals: Vec<Vec3>,
}

impl ClothState {
    /// Positions of the particles after the last tick, m. Empty until the first tick, and while
    /// the cloth cannot be simulated.
    #[must_use]
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Positions of the same particles before the last tick, in the cloth's frame at that time, m.
    #[must_use]
    pub fn previous_positions(&self) -> &[Vec3] {
        &self.previous_positions
    }

    /// Unit normals of the particles after the last tick, on the front side.
    #[must_use]
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// Unit normals of the particles before the last tick.
    #[must_use]
    pub fn previous_normals(&self) -> &[Vec3] {
        &self.previous_normals
    }

    /// How many times as large the cloth is as when it was made: metres in a unit of [`positions`](Self::positions), and the scale
    /// of the cloth's `GlobalTransform`. It is 1 unless the scale of what the cloth follows has changed since.
    #[must_use]
    pub fn scale(&self) -> f32 {
        self.scale
    }

    /// The level of detail; 0 is the finest.
    #[must_use]
    pub fn level(&self) -> usize {
        self.level
    }

    /// Whether the cloth is simulated or asleep, or what it waits for.
    #[must_use]
    pub fn activity(&self) -> ClothActivity {
        self.activity
    }

    /// The fabric of the cloth at its level: triangles, texture coordinates, pins. None until the
    /// first tick, and while the cloth cannot be simulated.
    #[must_use]
    pub fn fabric(&self) -> Option<&Arc<Fabric>> {
        self.levels.as_ref().map(|levels| levels.fabric(self.level))
    }

    /// The particle of a vertex of the [`ClothMesh`](crate::ClothMesh) at the cloth's level: an index into
    /// [`positions`](Self::positions). Of a mesh that is no grid, that which is nearest to the vertex at rest. None if the level
    /// leaves the vertex out, or if the vertex is rigid and so stays where the mesh has it.
    #[must_use]
    pub fn particle_of_vertex(&self, vertex: u32) -> Option<usize> {
        self.levels.as_ref()?.particle(self.level, vertex)
    }

    /// The particle at a point that the cloth's attachment holds, see [`AttachedVertices::Points`](crate::AttachedVertices::Points):
    /// an index into [`positions`](Self::positions). None of other points, and of points at vertices.
    #[must_use]
    pub fn particle_of_point(&self, point: &MeshPoint) -> Option<usize> {
        self.levels.as_ref()?.particle_of_point(self.level, point)
    }

    /// Position of a vertex of the [`ClothMesh`](crate::ClothMesh) after the last tick, m, in the cloth's frame: that of its
    /// particle or, of a mesh that is no grid, on the surface between particles. None if the level leaves the vertex out, or if
    /// the vertex is rigid.
    #[must_use]
    pub fn vertex_position(&self, vertex: u32) -> Option<Vec3> {
        self.levels.as_ref()?.vertex_position(self.level, vertex, &self.positions)
    }

    /// Velocity of a particle relative to the world, along the axes of the cloth's frame, m/s: the mean over the last tick, without
    /// that by growth. Zero
    /// while the cloth is not simulated, and of a particle that does not exist. Reading it wakes nothing.
    #[must_use]
    pub fn velocity(&self, particle: usize) -> Vec3 {
        let pair = self.positions.get(particle).zip(self.previous_positions.get(particle));
        let Some((now, before)) = pair.filter(|_| self.moved && self.tick > 0.0) else {
            return Vec3::ZERO;
        };
        let FrameMotion { rotation, translation } = self.motion;
        let [now, before] = [now, before].map(|at| self.scale * at);
        (now - rotation.inverse() * (before - translation)) / self.tick
    }

    /// Velocities of all particles, as [`velocity`](Self::velocity).
    pub fn velocities(&self) -> impl Iterator<Item = Vec3> {
        (0..self.positions.len()).map(|particle| self.velocity(particle))
    }

    /// The strain of each of the [`links`](Fabric::links) of the fabric, in their order: its length after the last tick over
    /// that at rest, less 1. Negative where the cloth is slack or folded between particles.
    pub fn strains(&self) -> impl Iterator<Item = f32> {
        let links = self.fabric().map_or(&[][..], |fabric| fabric.links());
        // A link of another level has no particles here.
        let end = |particle: u32| self.positions.get(particle as usize);
        links.iter().map(move |link| match link.particles.map(end) {
            [Some(from), Some(to)] => from.distance(*to) / link.rest_length - 1.0,
            _ => 0.0,
        })
    }

    /// The tension of each of the [`links`](Fabric::links) of the fabric, in their order, N for each metre across it: of warp
    /// and weft the stiffness of a material, that of the cloth's [`ClothMaterial`](crate::ClothMaterial), times the strain and the factor
    /// of the cloth's [`ClothRegions`](crate::ClothRegions) there. Zero
    /// where the cloth is slack, of diagonals, and where the material cannot be stretched. As exact as the strain is: it holds
    /// for cloth that hangs or is blown, and is too great where the effort is too low for what acts on the cloth.
    pub fn tensions(&self, material: &FabricMaterial) -> impl Iterator<Item = f32> {
        let links = self.fabric().map_or(&[][..], |fabric| fabric.links());
        let stiffness = |family| match family {
            LinkFamily::Warp => material.warp_stiffness,
            LinkFamily::Weft => material.weft_stiffness,
            LinkFamily::Diagonal => 0.0,
        };
        let stiffnesses: [f32; 3] =
            [LinkFamily::Warp, LinkFamily::Weft, LinkFamily::Diagonal].map(stiffness);
        let factor = |link| self.fabric().map_or(1.0, |fabric| fabric.stretch_factor(link));
        links.iter().zip(self.strains()).map(move |(link, strain)| {
            let stiffness = stiffnesses[link.family as usize] * factor(link);
            if stiffness.is_finite() { stiffness * strain.max(0.0) } else { 0.0 }
        })
    }

    /// Sets the surface from simulated positions (m) of a level's particles, without easing from the surface
    /// shown before.
    pub(crate) fn restart(&mut self, level: usize, levels: &Arc<ClothLevels>, positions: &[Vec3]) {
        self.change_level(level, levels, positions);
        self.replaced = None;
    }

    /// Changes the level of a cloth that is not simulated in this tick: normals are computed from the
    /// simulated positions (m) of the new level's particles.
    pub(crate) fn change_level(
        &mut self,
        level: usize,
        levels: &Arc<ClothLevels>,
        positions: &[Vec3],
    ) {
        let normals = levels.fabric(level).normals(positions);
        self.replace_surface(level, levels, positions, normals);
    }

    /// Changes the level of a cloth that is simulated in this tick: until the tick ends, its normals are the
    /// shown ones, interpolated to the new level's particles.
    pub(crate) fn change_level_in_motion(
        &mut self,
        level: usize,
        levels: &Arc<ClothLevels>,
        positions: &[Vec3],
    ) {
        let normals = levels.transfer_directions(&self.normals, self.level, level);
        self.replace_surface(level, levels, positions, normals);
    }

    fn replace_surface(
        &mut self,
        level: usize,
        levels: &Arc<ClothLevels>,
        positions: &[Vec3],
        normals: Vec<Vec3>,
    ) {
        let replaced = ReplacedSurface {
            level: self.level,
            positions: core::mem::replace(&mut self.positions, positions.to_vec()),
            previous_positions: core::mem::take(&mut self.previous_positions),
            normals: core::mem::replace(&mut self.normals, normals),
        };
        // Several changes may precede the end of a tick; only the surface before the first of them was shown.
        self.replaced.get_or_insert(replaced);
        self.level = level;
        self.levels = Some(Arc::clone(levels));
        self.blend();
        self.previous_positions.clone_from(&self.positions);
        self.previous_normals.clone_from(&self.normals);
    }

    /// Blends simulated positions and normals with those at rest, for particles with a weight below 1.
    pub(crate) fn blend(&mut self) {
        // The surface of a skinned cloth is blended with the animated places.
        if let Some(levels) = self.levels.as_ref().filter(|_| !self.is_skinned) {
            levels.blend(self.level, &mut self.positions, &mut self.normals);
        }
    }
}
