//! Read access to what a cloth does.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_solver::Fabric;

use crate::cloth::activity::ClothActivity;
use crate::fabric::levels::ClothLevels;

/// The simulated surface of a cloth, as of the last tick; read only.
///
/// Everything is in the cloth's frame, whose pose in the world is the entity's `GlobalTransform`:
/// the pose of the attachment's target times its offset or, without an
/// [`Attachment`](crate::Attachment), the entity's own. After [`ClothSystems::Publish`] and after
/// each frame the `GlobalTransform` is that of the target as it stands.
///
/// There is one particle for each vertex of a grid; of triangles, vertices that lie on one another
/// are one particle, and rigid ones none, see [`particle_of_vertex`](Self::particle_of_vertex).
/// Particles of a weight below 1 are where they are shown, between their places and where they are
/// simulated, see [`ClothMesh::with_weights`](crate::ClothMesh::with_weights).
///
/// [`ClothSystems::Publish`]: crate::ClothSystems::Publish
#[derive(Component, Clone, Debug, Default)]
pub struct ClothState {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) previous_positions: Vec<Vec3>,
    pub(crate) normals: Vec<Vec3>,
    pub(crate) previous_normals: Vec<Vec3>,
    pub(crate) level: usize,
    pub(crate) activity: ClothActivity,
    /// Whether it has moved in the last tick.
    pub(crate) moved: bool,
    pub(crate) levels: Option<Arc<ClothLevels>>,
    /// What was shown before a change of level, until it is eased.
    pub(crate) left: Option<Left>,
}

/// The surface that a change of level left behind.
#[derive(Clone, Debug, Default)]
pub(crate) struct Left {
    pub level: usize,
    pub positions: Vec<Vec3>,
    pub previous_positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
}

impl ClothState {
    /// Positions of the particles after the last tick, m. Empty until the first tick, and while
    /// the cloth cannot be simulated.
    #[must_use]
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Positions of the same particles before the last tick, in the frame as it stood then, m.
    #[must_use]
    pub fn previous_positions(&self) -> &[Vec3] {
        &self.previous_positions
    }

    /// Unit normals of the particles after the last tick, to the front.
    #[must_use]
    pub fn normals(&self) -> &[Vec3] {
        &self.normals
    }

    /// Unit normals of the particles before the last tick.
    #[must_use]
    pub fn previous_normals(&self) -> &[Vec3] {
        &self.previous_normals
    }

    /// The level of detail; 0 is the finest.
    #[must_use]
    pub fn level(&self) -> usize {
        self.level
    }

    /// Whether the cloth is simulated or asleep.
    #[must_use]
    pub fn activity(&self) -> ClothActivity {
        self.activity
    }

    /// The fabric that the cloth is cut from at its level: triangles, texture coordinates, pins.
    /// None until the first tick, and while the cloth cannot be simulated.
    #[must_use]
    pub fn fabric(&self) -> Option<&Arc<Fabric>> {
        self.levels.as_ref().map(|levels| levels.fabric(self.level))
    }

    /// The particle that a vertex of the [`ClothMesh`](crate::ClothMesh) is at the cloth's level.
    /// None where the level does not have it, and where it is rigid: it then stays where the mesh
    /// has it.
    #[must_use]
    pub fn particle_of_vertex(&self, vertex: u32) -> Option<usize> {
        self.levels.as_ref()?.particle(self.level, vertex)
    }

    /// Starts anew at a level, where nothing that was shown goes on.
    pub(crate) fn begin_anew(
        &mut self,
        level: usize,
        levels: &Arc<ClothLevels>,
        positions: &[Vec3],
    ) {
        self.begin(level, levels, positions);
        self.left = None;
    }

    /// Starts on the fabric of another level, from where its particles are simulated.
    pub(crate) fn begin(&mut self, level: usize, levels: &Arc<ClothLevels>, positions: &[Vec3]) {
        let normals = normals(levels.fabric(level), positions);
        self.go_over(level, levels, positions, normals);
    }

    /// The same for a cloth that ticks: until the tick ends, its normals are those that were shown.
    pub(crate) fn go_on(&mut self, level: usize, levels: &Arc<ClothLevels>, positions: &[Vec3]) {
        let normals = levels.carry(&self.normals, self.level, level);
        self.go_over(level, levels, positions, normals);
    }

    fn go_over(
        &mut self,
        level: usize,
        levels: &Arc<ClothLevels>,
        positions: &[Vec3],
        normals: Vec<Vec3>,
    ) {
        let left = Left {
            level: self.level,
            positions: core::mem::replace(&mut self.positions, positions.to_vec()),
            previous_positions: core::mem::take(&mut self.previous_positions),
            normals: core::mem::replace(&mut self.normals, normals),
        };
        // Of several changes before a tick ends the first is what was seen.
        self.left.get_or_insert(left);
        self.level = level;
        self.levels = Some(Arc::clone(levels));
        self.blend();
        self.previous_positions.clone_from(&self.positions);
        self.previous_normals.clone_from(&self.normals);
    }

    /// Takes the surface from where it is simulated to where it is shown.
    pub(crate) fn blend(&mut self) {
        if let Some(levels) = &self.levels {
            levels.blend(self.level, &mut self.positions, &mut self.normals);
        }
    }
}

/// Unit normals, weighted by area.
pub(crate) fn normals(fabric: &Fabric, positions: &[Vec3]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for corners in fabric.triangles() {
        let [a, b, c] = corners.map(|corner| positions[corner as usize]);
        let normal = (b - a).cross(c - a);
        for &corner in corners {
            normals[corner as usize] += normal;
        }
    }
    normals.into_iter().map(Vec3::normalize_or_zero).collect()
}
