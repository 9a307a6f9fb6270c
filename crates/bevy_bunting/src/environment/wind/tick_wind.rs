//! The air in one tick: the sum of everything that moves it.

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::environment::wind::blast::WindBlast;
use crate::environment::wind::fan::WindFan;
use crate::environment::wind::field::MovingAir;
use crate::environment::wind::region::WindRegion;
use crate::environment::wind::wake::WakeTrail;

/// Greatest velocity of the air, m/s: the speed of sound, above which the solver's drag is not that of air.
pub(crate) const FASTEST: f32 = 340.0;

/// Air in this tick: the sum of all winds, of which those with a place are felt only there.
#[derive(Resource, Clone, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct TickWind {
    pub(super) everywhere: Vec<MovingAir>,
    /// Balls in which local winds blow, beside one another in memory since each cloth is compared with all of them.
    balls: Vec<Ball>,
    local: Vec<LocalAir>,
}

/// A ball in the world.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
struct Ball {
    /// Its centre, m.
    centre: Vec3,
    /// Its squared radius, m².
    squared_radius: f32,
}

/// A wind that blows inside a ball.
#[expect(
    clippy::large_enum_variant,
    reason = "regions are the common case, and boxes cannot be reflected"
)]
#[derive(Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
pub(super) enum LocalAir {
    /// A field bounded to a region, and the region's pose.
    Region(MovingAir, WindRegion, Isometry3d),
    /// A jet, and its pose.
    Fan(WindFan, Isometry3d),
    /// A blast, its centre (m), and the length of the tick (s).
    Blast(WindBlast, Vec3, f32),
    /// A wake, and the drag area of its body, m².
    Wake(WakeTrail, f32),
}

impl LocalAir {
    /// Velocity (m/s) at a position in the world (m).
    #[inline(never)]
    fn at(&self, position: Vec3) -> Vec3 {
        let in_frame =
            |pose: &Isometry3d| pose.rotation.inverse() * (position - Vec3::from(pose.translation));
        match self {
            Self::Region(air, region, pose) => match region.weight_at(in_frame(pose)) {
                0.0 => Vec3::ZERO,
                weight => weight * air.at(position),
            },
            Self::Fan(fan, pose) => pose.rotation * fan.velocity_at(in_frame(pose)),
            Self::Blast(blast, centre, tick) => blast.velocity_at(position - centre, *tick),
            Self::Wake(trail, drag_area) => trail.velocity_at(position, *drag_area),
        }
    }
}

impl TickWind {
    /// Velocity of the air (m/s) at a position in the world (m): the sum of all winds, but at most 340 m/s. A wind that
    /// is not finite is left out.
    #[must_use]
    pub fn at(&self, position: Vec3) -> Vec3 {
        let velocities = self.everywhere.iter().map(|air| air.at(position));
        let mut sum: Vec3 = velocities.filter(|velocity| velocity.is_finite()).sum();
        for (ball, air) in self.balls.iter().zip(&self.local) {
            // False where a number is NaN.
            if position.distance_squared(ball.centre) <= ball.squared_radius {
                let velocity = air.at(position);
                sum += if velocity.is_finite() { velocity } else { Vec3::ZERO };
            }
        }
        if sum.abs().max_element() < 0.5 * FASTEST { sum } else { limited(sum) }
    }

    /// Whether the air changed everywhere since an earlier tick.
    pub(crate) fn changed_everywhere(&self, before: &Self) -> bool {
        self.everywhere != before.everywhere
    }

    /// Centres and radii (m) of balls outside which the local air has not changed since an earlier tick.
    pub(crate) fn changed_balls<'a>(
        &'a self,
        before: &'a Self,
    ) -> impl Iterator<Item = (Vec3, f32)> + 'a {
        let changed = |one: &'a Self, other: &'a Self| {
            let both = one.balls.iter().zip(&one.local);
            let new = both.filter(|(_, air)| !other.local.contains(air));
            new.map(|(ball, _)| (ball.centre, ball.squared_radius.sqrt()))
        };
        changed(self, before).chain(changed(before, self))
    }

    /// Removes all winds.
    pub(super) fn clear(&mut self) {
        self.everywhere.clear();
        self.balls.clear();
        self.local.clear();
    }

    /// Adds a wind that blows inside a ball, given by its centre and radius in the world, m.
    pub(super) fn add_local(&mut self, (centre, radius): (Vec3, f32), air: LocalAir) {
        self.balls.push(Ball { centre, squared_radius: radius * radius });
        self.local.push(air);
    }
}

/// A velocity (m/s) of any finite length, limited to [`FASTEST`].
fn limited(velocity: Vec3) -> Vec3 {
    let greatest = velocity.abs().max_element();
    let length = greatest * (velocity / greatest).length();
    if length <= FASTEST { velocity } else { velocity * (FASTEST / length) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn velocities_of_any_size_are_limited() {
        for size in [1.0, 300.0, 341.0, 1e6, f32::MAX] {
            let limited = limited(Vec3::new(0.6, 0.0, -0.8) * size);
            assert!((limited.length() / size.min(FASTEST) - 1.0).abs() < 1e-5, "{limited}");
        }
    }
}
