//! Builds the fabrics of a cloth's levels from its mesh.

use std::sync::Arc;

use bunting_solver::{CoarserMesh, Fabric, FabricBuilder, FabricError, LevelTransfer};

use crate::cloth::mesh::ClothMesh;
use crate::fabric::levels::{ClothLevels, Level, Shortage};
use crate::fabric::simulated::SimulatedPart;

/// Builds the levels that are asked for, or as many as the mesh allows, with attached vertices pinned.
///
/// # Errors
///
/// The finest fabric cannot be built.
pub(super) fn cut_levels(
    mesh: &ClothMesh,
    attached: &[u32],
    asked: usize,
) -> Result<ClothLevels, FabricError> {
    let part = SimulatedPart::of(mesh, attached)?;
    let fabric = part.builder.clone().build().map_err(|error| part.renumber(error))?;
    let SimulatedPart { mut builder, vertices, rigid, .. } = part;
    let has_pins = fabric.has_pins();
    let finest = Level::new(Arc::new(fabric), vertices, &builder, &rigid);
    let (levels, transfers) = (vec![finest], Vec::new());
    let (shortage, is_shortage_told) = (None, false.into());
    let mut cut = ClothLevels { levels, transfers, rigid, asked, shortage, is_shortage_told };
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
        cut.levels.push(Level::new(fabric, vertices, &builder, &cut.rigid));
        cut.transfers.push(transfer);
    }
    Ok(cut)
}

/// Builds the next coarser level: builder, fabric, and the transfer between the two levels. None if there is
/// no coarser level.
fn coarsen(
    builder: &FabricBuilder,
    fabric: &Arc<Fabric>,
) -> Option<(CoarserMesh, Arc<Fabric>, LevelTransfer)> {
    let coarser = builder.coarser()?;
    let coarse_fabric = Arc::new(coarser.builder.clone().build().ok()?);
    let transfer = LevelTransfer::nested(fabric, &coarse_fabric, &coarser.vertices).ok()?;
    Some((coarser, coarse_fabric, transfer))
}
