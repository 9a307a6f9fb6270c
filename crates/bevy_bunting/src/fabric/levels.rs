//! The levels of detail of a cloth: one fabric for each, the finest first.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_solver::{Fabric, FabricBuilder, Grid, LevelTransfer};

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
    /// Whether this reason was told.
    pub(super) is_shortage_told: AtomicBool,
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

/// Why a mesh has fewer levels than asked for, and what to do. The cloth is simulated with the levels that it has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum FewerLevels {
    /// The border and the attached vertices stay at every level, which limits how far the number of triangles can fall.
    #[error(
        "cloth {entity}, and all others of its mesh, have {built} levels, not {asked}: the mesh has hardly any triangle left to remove; give their LodSets fewer levels"
    )]
    Triangles { entity: Entity, built: usize, asked: usize },
    /// For each further level, columns − 1 and rows − 1 must be multiples of 2 once more.
    #[error(
        "a grid of {columns} × {rows} particles cannot be halved {halvings} times as the LodSet of cloth {entity}, and all others of its mesh, asks: make columns − 1 and rows − 1 multiples of 2^{halvings}, or give fewer levels"
    )]
    Grid { entity: Entity, columns: u32, rows: u32, halvings: usize },
    /// A coarser level would hold none of the attached vertices.
    #[error(
        "cloth {entity}, and all others of its mesh, have {built} levels, not {asked}: the next one would have none of the vertices that the attachment holds; choose vertices that it has, or give fewer levels"
    )]
    Pins { entity: Entity, built: usize, asked: usize },
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

    /// Whether there are fewer levels than asked for.
    pub fn has_fewer(&self) -> bool {
        self.shortage.is_some()
    }

    /// Why there are fewer levels than asked for, the first time; `grid` is the mesh of the cloth if that is a grid. None if
    /// there are as many, or if it was told before, of another cloth with these levels.
    pub fn tell_fewer(&self, entity: Entity, grid: Option<Grid>) -> Option<FewerLevels> {
        let shortage = self.shortage?;
        let (built, asked) = (self.levels.len(), self.asked);
        let is_told = self.is_shortage_told.swap(true, Ordering::Relaxed);
        (!is_told).then_some(match (shortage, grid) {
            (Shortage::Pins, _) => FewerLevels::Pins { entity, built, asked },
            (Shortage::Particles, Some(Grid { columns, rows, .. })) => {
                FewerLevels::Grid { entity, columns, rows, halvings: asked - 1 }
            }
            (Shortage::Particles, None) => FewerLevels::Triangles { entity, built, asked },
        })
    }
}
