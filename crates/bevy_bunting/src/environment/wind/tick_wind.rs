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

/// Part of the radius in which a wind has one velocity that is taken for that: less by more than rounding.
const CORE: f32 = 0.999;

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
    /// Squared radius of the ball around the same centre in which the wind is the same, m²; zero where there is none.
    squared_core: f32,
    /// Velocity in that ball, m/s.
    velocity: Vec3,
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
    /// Radius of a ball around the middle in which this air has one velocity (m/s), m.
    fn core(&self) -> Option<(f32, Vec3)> {
        let Self::Region(air, region, _) = self else { return None };
        let velocity = air.steady().filter(|velocity| velocity.is_finite())?;
        let radius = CORE * region.depth_of_core();
        (radius > 0.0 && radius.is_finite()).then_some((radius, velocity))
    }

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
            let squared = position.distance_squared(ball.centre);
            // Both are false where a number is NaN.
            if squared < ball.squared_core {
                sum += ball.velocity;
            } else if squared <= ball.squared_radius {
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
        let (core, velocity) = air.core().unwrap_or((0.0, Vec3::ZERO));
        let (squared_radius, squared_core) = (radius * radius, core * core);
        self.balls.push(Ball { centre, squared_radius, squared_core, velocity });
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
    use bevy_math::Quat;

    use super::*;

    #[test]
    fn steady_regions_are_the_same_in_their_cores_and_outside() {
        use crate::environment::wind::field::WindField;
        use crate::environment::wind::region::WindShape;

        let air = MovingAir::new(&WindField::steady(Vec3::new(3.0, -1.0, 0.7)), Default::default());
        let pose = Isometry3d::new(Vec3::new(1.0, 2.0, -3.0), Quat::from_rotation_x(0.7));
        let shapes = [
            WindShape::Box { half_extents: Vec3::new(3.0, 2.5, 4.0) },
            WindShape::Sphere { radius: 3.0 },
            WindShape::Cone { length: 3.0, radius: 2.0 },
            WindShape::Capsule { half_height: 1.0, radius: 2.0 },
        ];
        for (shape, falloff) in shapes.into_iter().flat_map(|shape| [(shape, 0.0), (shape, 1.0)]) {
            let region = WindRegion::new(shape, falloff);
            let local = LocalAir::Region(air, region, pose);
            let mut wind = TickWind::default();
            wind.add_local((Vec3::from(pose.translation), shape.reach()), local.clone());
            let mut in_core = 0;
            for index in 0..4096 {
                let number = |step: f32| 8.0 * ((index as f32 * step).fract() - 0.5);
                let offset = Vec3::new(number(0.618_034), number(0.754_878), number(0.569_84));
                let at = Vec3::from(pose.translation) + offset;
                assert_eq!(wind.at(at), local.at(at), "{region:?} at {offset}");
                in_core += usize::from(offset.length_squared() < wind.balls[0].squared_core);
            }
            let is_cone = matches!(shape, WindShape::Cone { .. });
            assert_eq!(in_core == 0, is_cone, "{region:?}");
        }
    }

    #[test]
    fn velocities_of_any_size_are_limited() {
        for size in [1.0, 300.0, 341.0, 1e6, f32::MAX] {
            let limited = limited(Vec3::new(0.6, 0.0, -0.8) * size);
            assert!((limited.length() / size.min(FASTEST) - 1.0).abs() < 1e-5, "{limited}");
        }
    }
}
