//! The levels of detail of a cloth: one fabric for each, the finest first.

#[cfg(feature = "render")]
use std::borrow::Cow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_solver::{Carried, Fabric, FabricBuilder, Grid, LevelTransfer, Resampled};

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
    /// The simulated vertices as indices in the [`ClothMesh`](crate::ClothMesh), ascending; of a level that carries the mesh all
    /// vertices that are not rigid.
    pub vertices: Vec<u32>,
    /// The particle of each of these vertices, or the nearest one.
    particles: Vec<u32>,
    /// Of each particle the vertex that is nearest to it, of those that it stands for the first one.
    nearest_vertices: Vec<u32>,
    /// How the mesh follows, if the particles are not its vertices.
    carried: Option<Carried>,
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
        let particles = fabric.particle_of_vertex().to_vec();
        let mut nearest_vertices = vec![u32::MAX; fabric.particle_count()];
        for (&vertex, &particle) in vertices.iter().zip(&particles) {
            let first = &mut nearest_vertices[particle as usize];
            *first = vertex.min(*first);
        }
        Self {
            blends: Blend::all(rigid, &vertices, &fabric),
            #[cfg(feature = "render")]
            topology: LevelTopology::new(&vertices, builder.indices(), rigid),
            fabric,
            vertices,
            particles,
            nearest_vertices,
            carried: None,
        }
    }

    /// A level with particles of its own, given the builder of the mesh's simulated part and its vertices in the
    /// [`ClothMesh`](crate::ClothMesh).
    #[cfg_attr(not(feature = "render"), expect(unused_variables, reason = "for meshes only"))]
    pub fn resampled(
        Resampled { fabric, carried, particles, nearest_vertices, .. }: Resampled,
        vertices: &[u32],
        builder: &FabricBuilder,
        rigid: &RigidPart,
    ) -> Self {
        let in_mesh = |&vertex: &u32| vertices[vertex as usize];
        let nearest_vertices: Vec<u32> = nearest_vertices.iter().map(in_mesh).collect();
        Self {
            blends: Blend::of_nearest(rigid, &nearest_vertices, &fabric),
            #[cfg(feature = "render")]
            topology: LevelTopology::new(vertices, builder.indices(), rigid),
            fabric,
            vertices: vertices.to_vec(),
            particles,
            nearest_vertices,
            carried: Some(carried),
        }
    }

    /// What is drawn when the particles are at these positions, m.
    #[cfg(feature = "render")]
    fn drawn<'a>(&'a self, positions: &'a [Vec3]) -> DrawnPoints<'a> {
        match &self.carried {
            Some(carried) => DrawnPoints {
                positions: carried.places(positions).into(),
                point_of_vertex: carried.place_of_vertex(),
            },
            None => DrawnPoints {
                positions: positions.into(),
                point_of_vertex: self.fabric.particle_of_vertex(),
            },
        }
    }
}

/// The points between which a level is drawn: its particles, or places of its mesh that follow these.
#[cfg(feature = "render")]
#[derive(Clone, Debug)]
pub(crate) struct DrawnPoints<'a> {
    /// m.
    pub positions: Cow<'a, [Vec3]>,
    /// The point of each vertex of the level.
    pub point_of_vertex: &'a [u32],
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
    /// The finest level, to which coarser ones are added.
    pub(super) fn of_finest(finest: Level, rigid: RigidPart, asked: usize) -> Self {
        Self {
            levels: vec![finest],
            transfers: Vec::new(),
            rigid,
            asked,
            shortage: None,
            is_shortage_told: false.into(),
        }
    }

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
        Some(level.particles[index] as usize)
    }

    /// For each particle of a level, the first of its vertices in the [`ClothMesh`](crate::ClothMesh), or the nearest one.
    pub fn vertices(&self, level: usize) -> &[u32] {
        &self.level(level).nearest_vertices
    }

    /// What is drawn of a level when its particles are at these positions, m.
    #[cfg(feature = "render")]
    pub fn drawn<'a>(&'a self, level: usize, positions: &'a [Vec3]) -> DrawnPoints<'a> {
        self.level(level).drawn(positions)
    }

    /// How the mesh follows a level; none if the level's particles are vertices of the mesh.
    #[cfg(feature = "render")]
    pub fn carried(&self, level: usize) -> Option<&Carried> {
        self.level(level).carried.as_ref()
    }

    /// Where a vertex of the [`ClothMesh`](crate::ClothMesh) is when the particles of a level are at these positions, m. None
    /// if the level leaves it out, or it is rigid.
    pub fn vertex_position(&self, level: usize, vertex: u32, positions: &[Vec3]) -> Option<Vec3> {
        let level = self.level(level);
        let index = level.vertices.binary_search(&vertex).ok()?;
        match &level.carried {
            Some(carried) => Some(carried.position(index, positions)),
            None => positions.get(level.particles[index] as usize).copied(),
        }
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
