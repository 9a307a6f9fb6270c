//! What can be wrong with a cloth.

use bevy_ecs::prelude::*;
use bunting_solver::FabricError;

use crate::fabric::part::WeightsError;

/// Why a cloth is not simulated as asked. Other cloths go on undisturbed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ClothError {
    /// The mesh is no cloth. Simulated again when its `ClothMesh` is replaced.
    #[error("the mesh of cloth {entity} cannot be simulated: {source}")]
    Mesh {
        /// The cloth.
        entity: Entity,
        /// What is wrong with it, and where.
        source: FabricError,
    },
    /// The weights of the mesh cannot be used. Simulated again when its `ClothMesh` is replaced.
    #[error("the weights of cloth {entity} cannot be used: {source}")]
    Weights {
        /// The cloth.
        entity: Entity,
        /// What is wrong with them.
        source: WeightsError,
    },
    /// The material cannot be simulated. The cloth keeps the last good one, if it had any.
    #[error("the material of cloth {entity} cannot be simulated: {source}")]
    Material {
        /// The cloth.
        entity: Entity,
        /// What is wrong with it.
        source: FabricError,
    },
    /// Switch distances must be positive and grow from level to level, or there must be a level.
    #[error(
        "the LodSet of cloth {entity} must have finite distances that grow or at least one level, a hysteresis from 0 to 1, and a positive bias"
    )]
    Levels {
        /// The cloth.
        entity: Entity,
    },
    /// So many levels cannot be made of the mesh: all of its border and what is attached stays. The
    /// cloth goes on with those that it has.
    #[error(
        "cloth {entity} has {built} levels, not {asked}: hardly a triangle more can go; give its LodSet fewer"
    )]
    TooFewLevels {
        /// The cloth.
        entity: Entity,
        /// Levels that it has.
        built: usize,
        /// Levels that its `LodSet` asks for.
        asked: usize,
    },
    /// The grid cannot be halved as often as there are levels. The cloth goes on with those that it
    /// has.
    #[error(
        "a grid of {columns} × {rows} particles cannot be halved {halvings} times as the LodSet of cloth {entity} asks: make columns − 1 and rows − 1 multiples of 2^{halvings}, or give fewer levels"
    )]
    NotNested {
        /// The cloth.
        entity: Entity,
        /// Particles in a row.
        columns: u32,
        /// Particles in a column.
        rows: u32,
        /// Levels besides the finest.
        halvings: usize,
    },
    /// The level that the `LodSet` pins does not exist.
    #[error(
        "cloth {entity} is pinned to level {level}, but has {levels}: pin a lower level, or give more levels"
    )]
    PinnedLevel {
        /// The cloth.
        entity: Entity,
        /// The level that it is pinned to.
        level: usize,
        /// Number of levels.
        levels: usize,
    },
    /// The attachment holds nothing. At a coarser level than the finest, the cloth goes on with the
    /// levels that are held.
    #[error(
        "the attachment of cloth {entity} holds no vertex at level {level}: choose vertices that the level has; an edge or a corner of a mesh without uv has none"
    )]
    NoVertices {
        /// The cloth.
        entity: Entity,
        /// The level.
        level: usize,
    },
    /// The target of the attachment is no entity with a transform.
    #[error(
        "cloth {entity} is attached to {target}, which does not exist or has no Transform: spawn it first"
    )]
    MissingTarget {
        /// The cloth.
        entity: Entity,
        /// Its target.
        target: Entity,
    },
    /// The pose that the cloth should take is not finite. It keeps the last that was.
    #[error("the transform that cloth {entity} follows is not finite: check what moves it")]
    Pose {
        /// The cloth.
        entity: Entity,
    },
    /// The mesh to show the cloth with is the renderer's alone. The cloth is simulated, but not
    /// drawn until its `Mesh3d` is replaced.
    #[cfg(feature = "render")]
    #[error(
        "the mesh of cloth {entity} is not kept in the main world and cannot be written: make it with RenderAssetUsages::default(), or leave out the Mesh3d"
    )]
    MeshUnwritable {
        /// The cloth.
        entity: Entity,
    },
    /// The mesh to show the cloth with is not that of its `ClothMesh`. The cloth is simulated, but
    /// not drawn until its `Mesh3d` is replaced.
    #[cfg(feature = "render")]
    #[error(
        "the mesh of cloth {entity} has {given} vertices, its ClothMesh {expected}: give both the same vertices, or leave out the Mesh3d"
    )]
    MeshVertices {
        /// The cloth.
        entity: Entity,
        /// Vertices of the mesh.
        given: usize,
        /// Vertices of the `ClothMesh`.
        expected: usize,
    },
    /// The state became infinite or not a number. The cloth was put back to rest.
    #[error(
        "cloth {entity} became infinite and was put back to rest: give it more substeps, or a softer material"
    )]
    Diverged {
        /// The cloth.
        entity: Entity,
    },
}

/// A cloth is not simulated as asked. Logged once, too.
#[derive(EntityEvent, Clone, Copy, Debug)]
pub struct ClothFailed {
    /// The cloth.
    pub entity: Entity,
    /// Why, and what to do.
    pub error: ClothError,
}

impl ClothFailed {
    /// Logs the error and triggers the event.
    pub(crate) fn report(commands: &mut Commands, entity: Entity, error: ClothError) {
        log::error!("{error}");
        commands.trigger(Self { entity, error });
    }
}
