//! Releases what is kept for cloths that are gone: fabrics, batches and tables.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bunting_solver::Fabric;

use crate::batch::batches::ClothBatches;
use crate::fabric::library::FabricLibrary;
use crate::lod::select::LevelSelector;

/// Number of ticks between two releases. Fewer: looking through the fabrics of many different cloths takes time. More:
/// the fabrics of despawned cloths take memory for longer.
const RELEASED_EVERY: u32 = 64;

/// Whether this tick releases what is unused.
pub(crate) fn is_due(mut ticks: Local<u32>) -> bool {
    *ticks = (*ticks + 1) % RELEASED_EVERY;
    *ticks == 0
}

/// Drops the fabrics of cloths that are gone, all that is made of these, and batches that have not been needed for
/// long.
pub(super) fn release_unused(
    mut library: ResMut<FabricLibrary>,
    mut batches: ResMut<ClothBatches>,
    mut selector: ResMut<LevelSelector>,
) {
    batches.drop_old_spares();
    if !library.forget_unused() {
        return;
    }
    selector.forget_unused();
    let address = |fabric: &Arc<Fabric>| Arc::as_ptr(fabric).addr();
    let mut living: Vec<usize> = library
        .living()
        .flat_map(|levels| levels.fabrics().map(address).collect::<Vec<_>>())
        .collect();
    living.sort_unstable();
    batches.drop_unused(|fabric| living.binary_search(&address(fabric)).is_ok());
}
