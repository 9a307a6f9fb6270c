//! Cutting fabrics: one for each level of a cloth, shared by all cloths cut alike.

use std::collections::HashMap;
use std::sync::{Arc, Weak};

use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bunting_solver::{ClothSnapshot, Fabric, FabricBuilder, FabricMaterial, LevelTransfer};

use crate::attachment::Attachment;
use crate::error::ClothError;
use crate::lod::LodSet;
use crate::mesh::ClothMesh;

/// The fabrics of one cloth, the finest first, and how state moves between neighbours.
#[derive(Debug)]
pub(crate) struct ClothLevels {
    fabrics: Vec<Arc<Fabric>>,
    transfers: Vec<LevelTransfer>,
}

impl ClothLevels {
    /// The fabric of a level.
    pub fn fabric(&self, level: usize) -> &Arc<Fabric> {
        &self.fabrics[level]
    }

    /// Number of levels.
    pub fn count(&self) -> usize {
        self.fabrics.len()
    }

    /// The state at one level, moved to another, for a cloth of a material under a gravity along
    /// the axes of its frame, m/s².
    pub fn transfer(
        &self,
        mut snapshot: ClothSnapshot,
        (from, to): (usize, usize),
        material: &FabricMaterial,
        gravity: Vec3,
    ) -> ClothSnapshot {
        for level in from..to {
            snapshot = self.transfers[level].restrict(&snapshot, material, gravity);
        }
        for level in (to..from).rev() {
            snapshot = self.transfers[level].prolong(&snapshot, material, gravity);
        }
        snapshot
    }

    /// Values at the particles of a level, spread over its triangles to those of a finer level.
    pub fn spread(&self, mut values: Vec<Vec3>, from: usize, to: usize) -> Vec<Vec3> {
        for level in (to..from).rev() {
            values = self.transfers[level].spread(&values).collect();
        }
        values
    }

    fn cut(
        entity: Entity,
        mesh: &ClothMesh,
        pinned: Option<&[u32]>,
        lods: &LodSet,
    ) -> Result<Self, ClothError> {
        let build = |builder: FabricBuilder, pins: &[u32]| {
            let fabric = builder.pin(pins.iter().copied()).build();
            fabric.map(Arc::new).map_err(|source| ClothError::Mesh { entity, source })
        };
        let mut fabrics = vec![build(mesh.builder(), pinned.unwrap_or_default())?];
        let mut transfers = Vec::new();
        for level in 1..lods.levels() {
            let mut grid = mesh.as_grid().ok_or(ClothError::NotAGrid { entity })?;
            let halvings = lods.levels() - 1;
            let (columns, rows) = (grid.columns, grid.rows);
            for _ in 0..level {
                grid = grid.halved().ok_or(ClothError::NotNested {
                    entity,
                    columns,
                    rows,
                    halvings,
                })?;
            }
            let stride = 1 << level;
            let pins: Vec<u32> = (0..grid.rows)
                .flat_map(|row| (0..grid.columns).map(move |column| (column, row)))
                .filter(|&(column, row)| {
                    fabrics[0].is_pinned((row * stride * columns + column * stride) as usize)
                })
                .map(|(column, row)| grid.index(column, row))
                .collect();
            if pinned.is_some() && pins.is_empty() {
                return Err(ClothError::NoVertices { entity, level });
            }
            let fabric = build(FabricBuilder::grid(grid), &pins)?;
            let transfer = LevelTransfer::between(&fabrics[level - 1], &fabric)
                .map_err(|_| ClothError::NotNested { entity, columns, rows, halvings })?;
            transfers.push(transfer);
            fabrics.push(fabric);
        }
        Ok(Self { fabrics, transfers })
    }
}

/// Puts pinned particles where they belong, to the last bit.
pub(crate) fn hold_pins(snapshot: &mut ClothSnapshot, fabric: &Fabric) {
    for (particle, position) in snapshot.positions.iter_mut().enumerate() {
        if fabric.is_pinned(particle) {
            *position = fabric.rest_positions()[particle];
        }
    }
}

/// All fabrics in use, by content: what is cut alike is cut once.
#[derive(Resource, Debug, Default)]
pub(crate) struct FabricLibrary {
    cut: HashMap<Vec<u32>, Weak<ClothLevels>>,
}

impl FabricLibrary {
    /// The fabrics of a cloth, cut now or before.
    ///
    /// # Errors
    ///
    /// The mesh, the attachment's vertices or the levels are bad.
    pub fn levels(
        &mut self,
        entity: Entity,
        mesh: &ClothMesh,
        attachment: Option<&Attachment>,
        lods: &LodSet,
    ) -> Result<Arc<ClothLevels>, ClothError> {
        lods.validate(entity)?;
        let pinned = attachment.map(|attachment| attachment.vertices.choose(&mesh.uvs()));
        if pinned.as_ref().is_some_and(Vec::is_empty) {
            return Err(ClothError::NoVertices { entity, level: 0 });
        }
        let key = key(mesh, pinned.as_deref(), lods);
        if let Some(levels) = self.cut.get(&key).and_then(Weak::upgrade) {
            return Ok(levels);
        }
        let levels = Arc::new(ClothLevels::cut(entity, mesh, pinned.as_deref(), lods)?);
        self.cut.retain(|_, levels| levels.strong_count() > 0);
        self.cut.insert(key, Arc::downgrade(&levels));
        Ok(levels)
    }
}

/// Everything that a fabric depends on, bit for bit; each list after its length.
fn key(mesh: &ClothMesh, pinned: Option<&[u32]>, lods: &LodSet) -> Vec<u32> {
    let mut key = vec![lods.levels() as u32];
    match mesh {
        ClothMesh::Grid { columns, rows, width, height } => {
            key.extend([0, *columns, *rows, width.to_bits(), height.to_bits()]);
        }
        ClothMesh::Triangles { positions, indices, uv } => {
            key.extend([1, positions.len() as u32, indices.len() as u32, uv.len() as u32]);
            key.extend(positions.iter().flat_map(|position| position.to_array()).map(f32::to_bits));
            key.extend(indices);
            key.extend(uv.iter().flat_map(|uv| uv.to_array()).map(f32::to_bits));
        }
    }
    key.extend(pinned.unwrap_or_default());
    key
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::ClothEdge;

    const FLAG: ClothMesh = ClothMesh::grid(9, 5, 1.5, 1.0);

    fn levels(
        library: &mut FabricLibrary,
        edge: ClothEdge,
        lods: LodSet,
    ) -> Result<Arc<ClothLevels>, ClothError> {
        let attachment = Attachment::in_place(edge);
        library.levels(Entity::PLACEHOLDER, &FLAG, Some(&attachment), &lods)
    }

    #[test]
    fn alike_is_cut_once() {
        let mut library = FabricLibrary::default();
        let one = levels(&mut library, ClothEdge::Left, LodSet::default()).expect("a flag");
        let same = levels(&mut library, ClothEdge::Left, LodSet::default()).expect("a flag");
        let other = levels(&mut library, ClothEdge::Right, LodSet::default()).expect("a flag");
        assert!(Arc::ptr_eq(&one, &same));
        assert!(!Arc::ptr_eq(&one, &other));
    }

    #[test]
    fn every_level_keeps_its_pins() {
        let mut library = FabricLibrary::default();
        let levels =
            levels(&mut library, ClothEdge::Right, LodSet::new([5.0, 10.0])).expect("a flag");
        let pins = |level: usize| {
            let fabric = levels.fabric(level);
            (0..fabric.particle_count())
                .filter(|&particle| fabric.is_pinned(particle))
                .collect::<Vec<_>>()
        };
        assert_eq!(pins(0), [8, 17, 26, 35, 44]);
        assert_eq!(pins(1), [4, 9, 14]);
        assert_eq!(pins(2), [2, 5]);
    }

    #[test]
    fn too_many_levels_are_an_error() {
        let result =
            levels(&mut FabricLibrary::default(), ClothEdge::Left, LodSet::new([1.0, 2.0, 3.0]));
        assert!(matches!(
            result,
            Err(ClothError::NotNested { columns: 9, rows: 5, halvings: 3, .. })
        ));
    }
}
