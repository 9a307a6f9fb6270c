//! The levels of detail of a cloth: one fabric for each, the finest first.

#[cfg(feature = "render")]
use std::borrow::Cow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_solver::{Carried, Fabric, FabricBuilder, Grid, LevelTransfer, MeshPoint, Resampled};

#[cfg(feature = "render")]
use crate::fabric::level_topology::LevelTopology;
use crate::fabric::rigid::{Blend, RigidPart};
use crate::waves::mix;

/// The fabrics of a cloth, the finest first, and the transfers between neighbouring levels.
#[derive(Debug)]
pub(crate) struct ClothLevels {
    pub(super) levels: Vec<Level>,
    /// Transfer between each level and the next coarser one: one fewer than levels.
    pub(super) transfers: Vec<LevelTransfer>,
    pub(super) rigid: RigidPart,
    /// What tells the surface from others.
    pub(super) surface: u64,
    /// The points at which there are particles, in the order of the fabrics.
    pub(super) points: Vec<MeshPoint>,
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
    /// The vertices that the level has as indices in the [`ClothMesh`](crate::ClothMesh), ascending: of a grid those that are
    /// simulated, of another mesh all that are not rigid.
    pub vertices: Vec<u32>,
    /// The particles of a mesh that is no grid.
    own: Option<OwnParticles>,
    /// What tells the fabric from others, once it has been asked for.
    fingerprint: OnceLock<u32>,
    #[cfg(feature = "render")]
    topology: LevelTopology,
}

/// Particles that are no vertices.
#[derive(Debug)]
struct OwnParticles {
    /// How the mesh follows.
    carried: Carried,
    /// The vertices around each particle, as indices in the [`ClothMesh`](crate::ClothMesh), with their weights.
    corners: Vec<Vec<(u32, f32)>>,
    /// Particles with a weight below 1.
    blends: Vec<Blend>,
    /// Places of vertices with a weight below 1, the weights, and unit normals at rest.
    #[cfg(feature = "render")]
    blended_normals: Vec<(u32, f32, Vec3)>,
}

impl Level {
    /// A level of a grid, with its vertices in the [`ClothMesh`](crate::ClothMesh).
    pub fn of_grid(fabric: Arc<Fabric>, vertices: Vec<u32>) -> Self {
        Self {
            #[cfg(feature = "render")]
            topology: {
                let indices = fabric.triangles().as_flattened();
                LevelTopology::new(&vertices, indices, &RigidPart::default())
            },
            fabric,
            vertices,
            own: None,
            fingerprint: OnceLock::new(),
        }
    }

    /// A level of a mesh that is no grid, given the builder of its simulated part and its vertices in the
    /// [`ClothMesh`](crate::ClothMesh).
    #[cfg_attr(not(feature = "render"), expect(unused_variables, reason = "for meshes only"))]
    pub fn resampled(
        Resampled { fabric, carried, mut corners, .. }: Resampled,
        vertices: &[u32],
        builder: &FabricBuilder,
        rigid: &RigidPart,
    ) -> Self {
        for (vertex, _) in corners.iter_mut().flatten() {
            *vertex = vertices[*vertex as usize];
        }
        Self {
            #[cfg(feature = "render")]
            topology: LevelTopology::new(vertices, builder.indices(), rigid),
            vertices: vertices.to_vec(),
            own: Some(OwnParticles {
                blends: Blend::all(rigid, &corners, &fabric),
                #[cfg(feature = "render")]
                blended_normals: blended_normals(&carried, vertices, rigid),
                carried,
                corners,
            }),
            fabric,
            fingerprint: OnceLock::new(),
        }
    }

    /// A number by which positions at rest and pins are told from others, in every run and on every machine.
    fn fingerprint(&self) -> u32 {
        *self.fingerprint.get_or_init(|| {
            let at_rest = self.fabric.rest_positions().iter().enumerate();
            let of_particle = |(particle, at): (usize, &Vec3)| {
                let [x, y, z] = at.to_array().map(f32::to_bits);
                [x, y, z, u32::from(self.fabric.is_pinned(particle))]
            };
            at_rest.flat_map(of_particle).fold(1, |hash, bits| mix(hash ^ bits))
        })
    }

    /// The index among the level's vertices of a vertex of the [`ClothMesh`](crate::ClothMesh).
    fn index(&self, vertex: u32) -> Option<usize> {
        self.vertices.binary_search(&vertex).ok()
    }

    /// Particle of a vertex, or the nearest one.
    pub fn particle(&self, vertex: u32) -> Option<usize> {
        Some(self.fabric.particle_of_vertex()[self.index(vertex)?] as usize)
    }

    /// A number that a vertex shares with those at the same position.
    pub fn place(&self, vertex: u32) -> Option<u32> {
        let index = self.index(vertex)?;
        let of_own = self.own.as_ref().map(|own| own.carried.place_of_vertex()[index]);
        Some(of_own.unwrap_or(index as u32))
    }

    /// The vertices around a particle, as indices in the [`ClothMesh`](crate::ClothMesh), with their weights, whose sum is 1.
    pub fn corners(&self, particle: usize) -> impl Iterator<Item = (u32, f32)> {
        let (alone, several) = match &self.own {
            Some(own) => (None, &own.corners[particle][..]),
            None => (Some((self.vertices[particle], 1.0)), &[][..]),
        };
        alone.into_iter().chain(several.iter().copied())
    }

    /// What is drawn when the particles are at these positions, m.
    #[cfg(feature = "render")]
    fn drawn<'a>(&'a self, positions: &'a [Vec3]) -> DrawnPoints<'a> {
        match &self.own {
            Some(own) => DrawnPoints {
                positions: own.carried.places(positions).into(),
                point_of_vertex: own.carried.place_of_vertex(),
            },
            None => DrawnPoints {
                positions: positions.into(),
                point_of_vertex: self.fabric.particle_of_vertex(),
            },
        }
    }
}

/// Places of vertices with a weight below 1 among a level's vertices, the weights, and unit normals at rest.
#[cfg(feature = "render")]
fn blended_normals(
    carried: &Carried,
    vertices: &[u32],
    rigid: &RigidPart,
) -> Vec<(u32, f32, Vec3)> {
    let blended = rigid.blended.iter().filter_map(|(rest, weight)| {
        let index = vertices.binary_search(&rest.vertex).ok()?;
        Some((carried.place_of_vertex()[index], *weight, rest.normal))
    });
    blended.collect()
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
    /// Particles on borders and at attached vertices stay at every level, which limits how far their number can fall.
    #[error(
        "cloth {entity}, and all others of its mesh, have {built} levels, not {asked}: cells twice as large would leave hardly fewer particles; give their LodSets fewer levels or a finer ClothResolution"
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
    /// The grid cannot be halved, or larger cells have hardly fewer particles.
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
            surface: 0,
            points: Vec::new(),
            asked,
            shortage: None,
            is_shortage_told: false.into(),
        }
    }

    /// Fabric of a level. A level that could not be built has the fabric of the coarsest level.
    pub fn fabric(&self, level: usize) -> &Arc<Fabric> {
        &self.level(level).fabric
    }

    /// A number by which the fabric of a level is told from others, in every run and on every machine.
    pub fn fingerprint(&self, level: usize) -> u32 {
        self.level(level).fingerprint()
    }

    /// The fabrics of all levels.
    pub fn fabrics(&self) -> impl Iterator<Item = &Arc<Fabric>> {
        self.levels.iter().map(|level| &level.fabric)
    }

    /// Whether other levels are those of the same surface, and either has particles of its own: those of a grid do not depend on
    /// what is held.
    pub fn has_surface_of(&self, other: &Self) -> bool {
        (self.has_own_particles() || other.has_own_particles()) && self.surface == other.surface
    }

    /// Whether particles are no vertices.
    fn has_own_particles(&self) -> bool {
        self.levels[0].own.is_some()
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

    /// Particle at a level of a vertex of the [`ClothMesh`](crate::ClothMesh), or the nearest one; none if the level leaves the
    /// vertex out, or it is rigid.
    pub fn particle(&self, level: usize, vertex: u32) -> Option<usize> {
        self.level(level).particle(vertex)
    }

    /// The vertices around a particle of a level, as indices in the [`ClothMesh`](crate::ClothMesh), with their weights, whose sum
    /// is 1.
    pub fn corners(&self, level: usize, particle: usize) -> impl Iterator<Item = (u32, f32)> {
        self.level(level).corners(particle)
    }

    /// What is drawn of a level when its particles are at these positions, m.
    #[cfg(feature = "render")]
    pub fn drawn<'a>(&'a self, level: usize, positions: &'a [Vec3]) -> DrawnPoints<'a> {
        self.level(level).drawn(positions)
    }

    /// How often the edges of the drawn mesh of a level must be halved to be as short as the cells of its simulation.
    #[cfg(feature = "render")]
    pub fn halvings_to_cells(&self, level: usize) -> u32 {
        let level = self.level(level);
        if level.own.is_none() {
            return 0;
        }
        let drawn = (level.topology.indices.len() / 3).max(1);
        let ratio = level.fabric.triangles().len() as f32 / drawn as f32;
        (0.5 * ratio.log2()).round().max(0.0) as u32
    }

    /// The points that a subdivision of a level is evaluated from, m: those that are drawn, and behind them the particles if these
    /// [lie closer](Self::halvings_to_cells).
    #[cfg(feature = "render")]
    pub fn points<'a>(&'a self, level: usize, positions: &'a [Vec3]) -> DrawnPoints<'a> {
        let mut points = self.drawn(level, positions);
        if self.halvings_to_cells(level) > 0 {
            points.positions.to_mut().extend(positions);
        }
        points
    }

    /// How the mesh follows a level; none of a grid, whose particles are its vertices.
    #[cfg(feature = "render")]
    pub fn carried(&self, level: usize) -> Option<&Carried> {
        self.level(level).own.as_ref().map(|own| &own.carried)
    }

    /// Unit normals at the points of a level that are drawn, given their positions, m, and the normals of the particles. Those of
    /// a cloth that is blended with its place at rest go over into the normals of its rigid part.
    #[cfg(feature = "render")]
    pub fn drawn_normals<'a>(
        &self,
        level: usize,
        drawn: &[Vec3],
        normals: &'a [Vec3],
        is_blended: bool,
    ) -> Cow<'a, [Vec3]> {
        let Some(own) = &self.level(level).own else { return normals.into() };
        let mut normals = own.carried.normals(drawn);
        for &(place, weight, at_rest) in own.blended_normals.iter().filter(|_| is_blended) {
            let normal = &mut normals[place as usize];
            *normal = at_rest.lerp(*normal, weight).normalize_or_zero();
        }
        normals.into()
    }

    /// Where a vertex of the [`ClothMesh`](crate::ClothMesh) is when the particles of a level are at these positions, m. None
    /// if the level leaves it out, or it is rigid.
    pub fn vertex_position(&self, level: usize, vertex: u32, positions: &[Vec3]) -> Option<Vec3> {
        let level = self.level(level);
        let index = level.index(vertex)?;
        match &level.own {
            Some(own) => Some(own.carried.position(index, positions)),
            None => positions.get(index).copied(),
        }
    }

    /// Blends simulated positions (m) and normals of a level's particles with those at rest.
    pub fn blend(&self, level: usize, positions: &mut [Vec3], normals: &mut [Vec3]) {
        let own = self.level(level).own.iter();
        own.flat_map(|own| &own.blends).for_each(|blend| blend.apply(positions, normals));
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
        let grid = grid.filter(|_| !self.has_own_particles());
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
