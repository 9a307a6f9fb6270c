//! Builds the fabrics of a cloth's levels from its mesh.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use bunting_solver::{
    CoarserMesh, Fabric, FabricBuilder, FabricError, Grid, LevelTransfer, MaterialRegion,
    Resampled, Resolution,
};

use crate::cloth::mesh::ClothMesh;
use crate::cloth::resolution::ClothResolution;
use crate::fabric::attached::Attached;
use crate::fabric::levels::{ClothLevels, Level, Shortage};
use crate::fabric::simulated::SimulatedPart;

/// Part of a finer level's particles that a coarser one has at most. More: it hardly takes less time.
const MOST_OF_FINER: f32 = 0.6;

/// Builds the levels that are asked for, or as many as the mesh allows, with what is attached pinned, and with regions in which the
/// material differs. A grid that is held beside its vertices is resampled to about as many particles as it has.
///
/// # Errors
///
/// The finest fabric cannot be built.
pub(super) fn cut_levels(
    mesh: &ClothMesh,
    attached: &Attached,
    asked: usize,
    resolution: ClothResolution,
    regions: &[MaterialRegion],
) -> Result<ClothLevels, FabricError> {
    let part = SimulatedPart::of(mesh, attached)?.with_regions(regions);
    let points = part.points.clone();
    let mut cut = match mesh.as_grid() {
        Some(_) if points.is_empty() => of_grid(part, asked)?,
        Some(Grid { columns, rows, .. }) => {
            resampled(part, Resolution::Particles(columns * rows), asked)?
        }
        None => resampled(part, resolution.of_solver(), asked)?,
    };
    cut.points = points;
    cut.surface = surface_key(mesh);
    Ok(cut)
}

/// What tells a surface from others.
fn surface_key(mesh: &ClothMesh) -> u64 {
    let mut hasher = DefaultHasher::new();
    match mesh {
        ClothMesh::Grid { columns, rows, width, height } => {
            (columns, rows, width.to_bits(), height.to_bits()).hash(&mut hasher);
        }
        ClothMesh::Sheet { columns, rows, width, depth } => {
            ("sheet", columns, rows, width.to_bits(), depth.to_bits()).hash(&mut hasher);
        }
        ClothMesh::Triangles { positions, indices, weights, merged, .. } => {
            (indices, merged).hash(&mut hasher);
            positions.iter().for_each(|at| at.to_array().map(f32::to_bits).hash(&mut hasher));
            weights.iter().for_each(|weight| weight.to_bits().hash(&mut hasher));
        }
    }
    hasher.finish()
}

/// Levels of a grid, of half as many cells along each side each.
fn of_grid(part: SimulatedPart, asked: usize) -> Result<ClothLevels, FabricError> {
    let fabric = part.builder.clone().build().map_err(|error| part.renumber(error))?;
    let SimulatedPart { mut builder, vertices, rigid, .. } = part;
    let has_pins = fabric.has_pins();
    let finest = Level::of_grid(Arc::new(fabric), vertices);
    let mut cut = ClothLevels::of_finest(finest, rigid, asked);
    while cut.levels.len() < asked {
        let finer = cut.level(usize::MAX);
        let Some((coarser, fabric, transfer)) = coarsen(&builder, &finer.fabric) else {
            cut.shortage = Some(Shortage::Particles);
            break;
        };
        if has_pins && !fabric.has_pins() {
            cut.shortage = Some(Shortage::Pins);
            break;
        }
        let in_mesh = |&vertex: &u32| finer.vertices[vertex as usize];
        let vertices = coarser.vertices.iter().map(in_mesh).collect();
        builder = coarser.builder;
        cut.levels.push(Level::of_grid(fabric, vertices));
        cut.transfers.push(transfer);
    }
    Ok(cut)
}

/// Builds the next coarser level of a grid: builder, fabric, and the transfer between the two levels. None if there is
/// no coarser level.
fn coarsen(
    builder: &FabricBuilder,
    fabric: &Arc<Fabric>,
) -> Option<(CoarserMesh, Arc<Fabric>, LevelTransfer)> {
    let coarser = builder.coarser()?;
    let coarse_fabric = Arc::new(coarser.builder.clone().build().ok()?);
    let transfer = LevelTransfer::between(fabric, &coarse_fabric).ok()?;
    Some((coarser, coarse_fabric, transfer))
}

/// Levels of a mesh that is no grid, in cells twice as large each.
fn resampled(
    part: SimulatedPart,
    resolution: Resolution,
    asked: usize,
) -> Result<ClothLevels, FabricError> {
    let finest = part.builder.resampled(resolution).map_err(|error| part.renumber(error))?;
    let SimulatedPart { builder, vertices, rigid, .. } = part;
    let mut size = finest.cell_size;
    let finest = Level::resampled(finest, &vertices, &builder, &rigid);
    let mut cut = ClothLevels::of_finest(finest, rigid, asked);
    while cut.levels.len() < asked {
        size *= 2.0;
        let finer = cut.level(usize::MAX);
        let Some((level, transfer)) = coarser(&builder, size, &finer.fabric) else {
            cut.shortage = Some(Shortage::Particles);
            break;
        };
        if finer.fabric.has_pins() && !level.fabric.has_pins() {
            cut.shortage = Some(Shortage::Pins);
            break;
        }
        cut.levels.push(Level::resampled(level, &vertices, &builder, &cut.rigid));
        cut.transfers.push(transfer);
    }
    Ok(cut)
}

/// The level with cells of a size, m, and the transfer to it from a finer one. None if it has hardly fewer particles.
fn coarser(
    builder: &FabricBuilder,
    size: f32,
    finer: &Arc<Fabric>,
) -> Option<(Resampled, LevelTransfer)> {
    let level = builder.resampled(Resolution::CellSize(size)).ok()?;
    let most = MOST_OF_FINER * finer.particle_count() as f32;
    if level.fabric.particle_count() as f32 > most {
        return None;
    }
    let transfer = LevelTransfer::of_surface(finer, &level.fabric).ok()?;
    Some((level, transfer))
}
