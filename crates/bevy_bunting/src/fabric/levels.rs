//! The levels of detail of a cloth: one fabric for each, the finest first.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_solver::{Fabric, FabricBuilder, Grid, LevelTransfer};

use crate::cloth::error::ClothError;
#[cfg(feature = "render")]
use crate::fabric::level_topology::LevelTopology;
use crate::fabric::rigid::{Blend, RigidPart};

/// The fabrics of a cloth, the finest first, and the transfers between neighbouring levels.
#[derive(Debug)]
pub(crate) struct ClothLevels {
    pub(super) levels: Vec<Level>,
    /// Transfer between each level and the next coarser one: one fewer than levels.
    pub(super) transfers: Vec<LevelTransfer>,
    pub(super) rigid: RigidPart,
    /// Number of levels that the [`LodSet`](crate::LodSet) asks for.
    pub(super) asked: usize,
    /// Reason why there are fewer levels than asked for; none if there are not.
    pub(super) shortage: Option<Shortage>,
}

/// One level of detail.
#[derive(Debug)]
pub(super) struct Level {
    pub fabric: Arc<Fabric>,
    /// The simulated vertices as indices in the [`ClothMesh`](crate::ClothMesh), ascending.
    pub vertices: Vec<u32>,
    /// Particles with a weight below 1.
    blends: Vec<Blend>,
    #[cfg(feature = "render")]
    topology: LevelTopology,
}

impl Level {
    /// A level of a fabric and its builder, with its vertices in the [`ClothMesh`](crate::ClothMesh).
    #[cfg_attr(not(feature = "render"), expect(unused_variables, reason = "for meshes only"))]
    pub fn new(
        fabric: Arc<Fabric>,
        vertices: Vec<u32>,
        builder: &FabricBuilder,
        rigid: &RigidPart,
    ) -> Self {
        Self {
            blends: Blend::all(rigid, &vertices, &fabric),
            #[cfg(feature = "render")]
            topology: LevelTopology::new(&vertices, builder.indices(), rigid),
            fabric,
            vertices,
        }
    }
}

/// Reason why a level cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shortage {
    /// The grid cannot be halved, or no vertex of the mesh can be left out.
    Particles,
    /// No pinned vertex would be left.
    Pins,
}

impl ClothLevels {
    /// Fabric of a level. A level that could not be built has the fabric of the coarsest level.
    pub fn fabric(&self, level: usize) -> &Arc<Fabric> {
        &self.level(level).fabric
    }

    /// The fabrics of all levels.
    pub fn fabrics(&self) -> impl Iterator<Item = &Arc<Fabric>> {
        self.levels.iter().map(|level| &level.fabric)
    }

    /// Number of levels that the [`LodSet`](crate::LodSet) asks for.
    pub fn count(&self) -> usize {
        self.asked
    }

    /// The topology of the mesh that shows a level.
    #[cfg(feature = "render")]
    pub fn topology(&self, level: usize) -> &LevelTopology {
        &self.level(level).topology
    }

    /// The rigid part of the mesh.
    #[cfg(feature = "render")]
    pub fn rigid(&self) -> &RigidPart {
        &self.rigid
    }

    /// Particle at a level of a vertex of the [`ClothMesh`](crate::ClothMesh), if there is one.
    pub fn particle(&self, level: usize, vertex: u32) -> Option<usize> {
        let level = self.level(level);
        let index = level.vertices.binary_search(&vertex).ok()?;
        Some(level.fabric.particle_of_vertex()[index] as usize)
    }

    /// For each particle of a level, the first of its vertices in the [`ClothMesh`](crate::ClothMesh).
    pub fn vertices(&self, level: usize) -> Vec<u32> {
        let Level { fabric, vertices, .. } = self.level(level);
        let mut first = vec![u32::MAX; fabric.particle_count()];
        for (&vertex, &particle) in vertices.iter().zip(fabric.particle_of_vertex()) {
            first[particle as usize] = first[particle as usize].min(vertex);
        }
        first
    }

    /// Blends simulated positions (m) and normals of a level's particles with those at rest.
    pub fn blend(&self, level: usize, positions: &mut [Vec3], normals: &mut [Vec3]) {
        let blends = &self.level(level).blends;
        blends.iter().for_each(|blend| blend.apply(positions, normals));
    }

    /// A level, or the coarsest one if there are fewer.
    pub(super) fn level(&self, level: usize) -> &Level {
        &self.levels[level.min(self.levels.len() - 1)]
    }

    /// Error of a cloth with fewer levels than asked for; `grid` is its mesh if that is a grid.
    pub fn shortage(&self, entity: Entity, grid: Option<Grid>) -> Option<ClothError> {
        let (built, asked) = (self.levels.len(), self.asked);
        Some(match (self.shortage?, grid) {
            (Shortage::Pins, _) => ClothError::NoVertices { entity, level: built },
            (Shortage::Particles, Some(grid)) => ClothError::NotNested {
                entity,
                columns: grid.columns,
                rows: grid.rows,
                halvings: asked - 1,
            },
            (Shortage::Particles, None) => ClothError::TooFewLevels { entity, built, asked },
        })
    }
}
