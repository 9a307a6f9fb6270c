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
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct TickWind {
    pub(super) everywhere: Vec<MovingAir>,
    pub(super) local: Vec<LocalAir>,
}

/// A wind that blows inside a ball.
#[derive(Clone, Debug, PartialEq, Reflect)]
pub(super) struct LocalAir {
    /// Centre in the world and radius of the ball, m.
    pub ball: (Vec3, f32),
    pub source: Source,
}

/// What moves the air of a [`LocalAir`].
#[derive(Clone, Debug, PartialEq, Reflect)]
pub(super) enum Source {
    /// A field bounded to a region, and the region's pose.
    Region(MovingAir, WindRegion, Isometry3d),
    /// A jet, and its pose.
    Fan(WindFan, Isometry3d),
    /// A blast, and the length of the tick, s.
    Blast(WindBlast, f32),
    /// A wake, and the drag area of its body, m².
    Wake(WakeTrail, f32),
}

impl LocalAir {
    /// Velocity (m/s) at a position in the world (m).
    fn at(&self, position: Vec3) -> Vec3 {
        let (centre, radius) = self.ball;
        let from_centre = position - centre;
        // False where a number is NaN.
        let is_near = from_centre.length_squared() <= radius * radius;
        if !is_near {
            return Vec3::ZERO;
        }
        match &self.source {
            Source::Region(air, region, pose) => {
                let weight = region.weight_at(pose.rotation.inverse() * from_centre);
                if weight == 0.0 { Vec3::ZERO } else { weight * air.at(position) }
            }
            Source::Fan(fan, pose) => {
                let from_fan = position - Vec3::from(pose.translation);
                pose.rotation * fan.velocity_at(pose.rotation.inverse() * from_fan)
            }
            Source::Blast(blast, tick) => blast.velocity_at(from_centre, *tick),
            Source::Wake(trail, drag_area) => trail.velocity_at(position, *drag_area),
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
        for air in &self.local {
            let velocity = air.at(position);
            if velocity.is_finite() {
                sum += velocity;
            }
        }
        if sum.abs().max_element() < 0.5 * FASTEST { sum } else { limited(sum) }
    }

    /// Whether the air changed everywhere since an earlier tick.
    pub(crate) fn changed_everywhere(&self, before: &Self) -> bool {
        self.everywhere != before.everywhere
    }

    /// Centres and radii (m) of balls outside which the local air has not changed since an earlier tick.
    pub(crate) fn changed_balls(&self, before: &Self) -> impl Iterator<Item = (Vec3, f32)> {
        let changed = |one: &Self, other: &Self| {
            let is_new = |air: &&LocalAir| !other.local.contains(air);
            one.local.iter().filter(is_new).map(|air| air.ball).collect::<Vec<_>>()
        };
        changed(self, before).into_iter().chain(changed(before, self))
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
