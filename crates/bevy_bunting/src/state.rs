//! Read access to what a cloth does.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_solver::Fabric;

use crate::activity::ClothActivity;

/// The simulated surface of a cloth, as of the last tick; read only.
///
/// Everything is in the cloth's frame, whose pose in the world is the entity's `GlobalTransform`:
/// the pose of the attachment's target times its offset or, without an
/// [`Attachment`](crate::Attachment), the entity's own. After [`ClothSystems::Publish`] and after
/// each frame the `GlobalTransform` is that of the target as it stands.
///
/// There is one particle for each vertex of a grid; of triangles, vertices that lie on one another
/// are one particle, see [`Fabric::particle_of_vertex`].
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
    pub(crate) fabric: Option<Arc<Fabric>>,
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
        self.fabric.as_ref()
    }

    /// Starts anew on a fabric, where nothing that was shown goes on.
    pub(crate) fn begin_anew(&mut self, level: usize, fabric: &Arc<Fabric>, positions: &[Vec3]) {
        self.begin(level, fabric, positions);
        self.left = None;
    }

    /// Starts on the fabric of another level.
    pub(crate) fn begin(&mut self, level: usize, fabric: &Arc<Fabric>, positions: &[Vec3]) {
        let left = Left {
            level: self.level,
            positions: core::mem::replace(&mut self.positions, positions.to_vec()),
            previous_positions: core::mem::take(&mut self.previous_positions),
            normals: core::mem::take(&mut self.normals),
        };
        // Of several changes before a tick ends the first is what was seen.
        self.left.get_or_insert(left);
        self.level = level;
        self.fabric = Some(Arc::clone(fabric));
        self.previous_positions.clone_from(&self.positions);
        self.normals = normals(fabric, positions);
        self.previous_normals.clone_from(&self.normals);
    }
}

/// Unit normals, weighted by area.
fn normals(fabric: &Fabric, positions: &[Vec3]) -> Vec<Vec3> {
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
