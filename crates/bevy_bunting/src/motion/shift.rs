//! A floating origin: the whole world is moved, and nothing notices.

use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use crate::lod::rest_timer::RestTimer;
use crate::motion::anchor_poses::AnchorPoses;
use crate::motion::pose::PoseHistory;

/// Moves everything that cloth knows of the world by a displacement, as games do that keep the player near the origin, where
/// numbers are exact. Trigger it where all transforms without a parent are moved by the same displacement, before or after them in
/// the same system: cloths, targets, colliders, winds and viewers. Nothing has moved then as cloth sees it: no cloth is jolted
/// or wakes, and gusts, wakes and the fronts of blasts go on where they are. It may be any length and come in each frame.
///
/// It moves no transform, and does not belong into [`ClothTick`](crate::ClothTick). A displacement that is not finite is logged and
/// left out. Positions in `f32` are only as exact as their size allows: 10 km away a target moves in steps of a
/// millimetre, which is why the origin floats.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
/// use bevy_math::Vec3;
/// use bevy_transform::prelude::*;
///
/// #[derive(Component)]
/// struct Player;
///
/// /// Keeps the player within a kilometre of the origin.
/// fn float(
///     player: Single<Entity, With<Player>>,
///     mut roots: Query<&mut Transform, Without<ChildOf>>,
///     mut commands: Commands,
/// ) -> Result {
///     let by = -roots.get(*player)?.translation;
///     if by.length() > 1000.0 {
///         roots.iter_mut().for_each(|mut it| it.translation += by);
///         commands.trigger(ShiftOrigin { by });
///     }
///     Ok(())
/// }
/// # let _ = float;
/// ```
#[derive(Event, Clone, Copy, Debug, PartialEq)]
pub struct ShiftOrigin {
    /// What is added to the translation of each transform without a parent, m.
    pub by: Vec3,
}

impl ShiftOrigin {
    /// The displacement, m; zero if it is not finite.
    pub(crate) fn acting(self) -> Vec3 {
        if self.by.is_finite() { self.by } else { Vec3::ZERO }
    }
}

/// Moves the poses of all that cloth follows or touches.
pub(super) fn shift_poses(
    shift: On<ShiftOrigin>,
    mut histories: Query<&mut PoseHistory>,
    mut anchors: Query<&mut AnchorPoses>,
    mut timers: Query<&mut RestTimer>,
) {
    let by = shift.acting();
    if !shift.by.is_finite() {
        log::error!("a ShiftOrigin by {} is left out: give a finite displacement", shift.by);
    }
    if by == Vec3::ZERO {
        return;
    }
    histories.iter_mut().for_each(|mut history| history.shift(by));
    anchors.iter_mut().for_each(|mut poses| poses.shift(by));
    timers.iter_mut().for_each(|mut timer| timer.shift(by));
}
