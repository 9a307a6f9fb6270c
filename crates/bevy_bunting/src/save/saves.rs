//! How cloths are saved and restored.

use std::sync::Arc;

use bevy_ecs::prelude::*;

use crate::save::apply::apply;
use crate::save::check::check;
use crate::save::cloth::ClothSnapshot;
use crate::save::error::SnapshotError;
use crate::save::lanes::{enter_lanes, mark};
use crate::save::take::take;
use crate::save::world::ClothWorldSnapshot;

/// Saves and restores cloth between two ticks: methods of [`World`], for exclusive systems and commands.
///
/// A snapshot holds what the plugin keeps to itself. Components of the user's and transforms are saved and restored by the
/// app, as a library of saved games or of rollback does; cloth is restored last, since what was changed before counts as
/// part of the restored state. With equal components, transforms and lengths of ticks, cloth then goes on with the same
/// bits. The clock need not be restored.
///
/// ```
/// use bevy_app::prelude::*;
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
///
/// /// The last eight ticks, the latest last.
/// #[derive(Resource, Default)]
/// struct Past(Vec<ClothWorldSnapshot>);
///
/// fn save(world: &mut World) -> Result {
///     let snapshot = world.save_cloths()?;
///     let past = &mut world.resource_mut::<Past>().0;
///     past.drain(..past.len().saturating_sub(7));
///     past.push(snapshot);
///     Ok(())
/// }
///
/// fn roll_back(world: &mut World) -> Result {
///     let first = world.resource::<Past>().0.first().cloned();
///     first.map_or(Ok(()), |snapshot| Ok(world.restore_cloths(&snapshot)?))
/// }
/// # let _ = (save, roll_back);
/// ```
pub trait ClothSaves {
    /// The state of a cloth.
    ///
    /// # Errors
    ///
    /// The entity is no cloth, has no state yet, or is made of something that has changed since its last tick.
    fn save_cloth(&self, cloth: Entity) -> Result<ClothSnapshot, SnapshotError>;

    /// Gives a cloth a state. Winds, colliders and other cloths are as they are.
    ///
    /// A cloth that has not been simulated yet gets its fabrics now, however long they take to build.
    ///
    /// # Errors
    ///
    /// The entity is no cloth, cannot be simulated, or is another cloth than that which was saved; or the snapshot holds
    /// numbers that cannot be simulated. Nothing has changed then.
    fn restore_cloth(
        &mut self,
        cloth: Entity,
        snapshot: &ClothSnapshot,
    ) -> Result<(), SnapshotError>;

    /// The state of all cloth. Cloths that have no state yet are left out, and begin anew when they are restored.
    ///
    /// # Errors
    ///
    /// A cloth is made of something that has changed since its last tick.
    ///
    /// # Panics
    ///
    /// The world has no [`ClothPlugins`](crate::ClothPlugins).
    fn save_cloths(&self) -> Result<ClothWorldSnapshot, SnapshotError>;

    /// Gives all saved cloths their states, and winds, colliders and hands what is known of their motion. Cloths that were
    /// not saved go on as they are.
    ///
    /// # Errors
    ///
    /// A cloth is not there, cannot be simulated, or is another than that which was saved; or the snapshot holds numbers
    /// that cannot be simulated. Nothing has changed then.
    ///
    /// # Panics
    ///
    /// The world has no [`ClothPlugins`](crate::ClothPlugins).
    fn restore_cloths(&mut self, snapshot: &ClothWorldSnapshot) -> Result<(), SnapshotError>;
}

impl ClothSaves for World {
    fn save_cloth(&self, cloth: Entity) -> Result<ClothSnapshot, SnapshotError> {
        Ok(ClothSnapshot(Arc::new(take(self, cloth)?)))
    }

    fn restore_cloth(
        &mut self,
        cloth: Entity,
        snapshot: &ClothSnapshot,
    ) -> Result<(), SnapshotError> {
        let fitting = check(self, cloth, &snapshot.0)?;
        apply(self, &fitting, &snapshot.0);
        enter_lanes(self, [(cloth, &*snapshot.0)]);
        mark(self, [cloth]);
        Ok(())
    }

    fn save_cloths(&self) -> Result<ClothWorldSnapshot, SnapshotError> {
        ClothWorldSnapshot::of(self)
    }

    fn restore_cloths(&mut self, snapshot: &ClothWorldSnapshot) -> Result<(), SnapshotError> {
        snapshot.restore(self)
    }
}
