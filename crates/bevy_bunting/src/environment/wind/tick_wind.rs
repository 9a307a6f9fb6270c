//! The air in one tick: the sum of everything that moves it.

use bevy_ecs::prelude::*;
use bevy_math::{BVec4A, Vec3, Vec4};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::environment::wind::blast::WindBlast;
use crate::environment::wind::fan::WindFan;
use crate::environment::wind::field::MovingAir;
use crate::environment::wind::places::{Frame, PLACES, Places};
use crate::environment::wind::region::WindRegion;
use crate::environment::wind::wake::WakeTrail;

/// Greatest velocity of the air, m/s: the speed of sound, above which the solver's drag is not that of air.
pub(crate) const FASTEST: f32 = 340.0;

/// Part of the radius in which a wind has one velocity that is taken for that: less by more than rounding.
const CORE: f32 = 0.999;

/// Air in this tick: the sum of all winds, of which those with a place are felt only there.
#[derive(Resource, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct TickWind {
    pub(super) everywhere: Vec<MovingAir>,
    /// Balls in which local winds blow, beside one another in memory since each cloth is compared with all of them.
    balls: Vec<Ball>,
    local: Vec<LocalAir>,
}

impl Clone for TickWind {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    /// Copies into the present lists: a derived `clone_from` would allocate them in each tick.
    fn clone_from(&mut self, source: &Self) {
        let Self { everywhere, balls, local } = source;
        self.everywhere.clone_from(everywhere);
        self.balls.clone_from(balls);
        self.local.clone_from(local);
    }
}

/// A ball in the world.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
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
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(super) enum LocalAir {
    /// A field bounded to a region, and the region's frame.
    Region(MovingAir, WindRegion, Frame),
    /// A jet, and its frame.
    Fan(WindFan, Frame),
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

    /// Moves this air along with the world, m.
    fn shift(&mut self, by: Vec3) {
        match self {
            Self::Region(air, _, frame) => {
                air.shift(by);
                frame.shift(by);
            }
            Self::Fan(_, frame) => frame.shift(by),
            Self::Blast(_, centre, _) => *centre += by,
            Self::Wake(trail, _) => trail.shift(by),
        }
    }

    /// Velocities (m/s) at some of four positions in the world (m).
    fn at(&self, positions: &Places, within: BVec4A) -> Places {
        match self {
            Self::Region(air, region, frame) => {
                let weights = region.weights_at(&positions.seen_from(frame));
                if weights == Vec4::ZERO {
                    return Places::ZERO;
                }
                air.at(positions).scaled(weights)
            }
            Self::Fan(fan, frame) => {
                let seen = positions.seen_from(frame);
                seen.map_where(within, |at| frame.to_world(fan.velocity_at(at)))
            }
            Self::Blast(blast, centre, tick) => {
                positions.map_where(within, |at| blast.velocity_at(at - *centre, *tick))
            }
            Self::Wake(trail, drag_area) => {
                positions.map_where(within, |at| trail.velocity_at(at, *drag_area))
            }
        }
    }
}

impl TickWind {
    /// Velocity of the air (m/s) at a position in the world (m): the sum of all winds, but at most 340 m/s. A wind that
    /// is not finite is left out.
    #[must_use]
    pub fn at(&self, position: Vec3) -> Vec3 {
        self.at_places(&Places::of(&[position])).get(0)
    }

    /// The velocity of the air (m/s) if it is the same at all positions.
    pub(crate) fn same_everywhere(&self) -> Option<Vec3> {
        let is_same =
            self.local.is_empty() && self.everywhere.iter().all(|air| air.steady().is_some());
        is_same.then(|| self.at(Vec3::ZERO))
    }

    /// Velocities of the air (m/s) at positions in the world (m), as [`at`](Self::at) gives them.
    pub(crate) fn at_places(&self, positions: &Places) -> Places {
        let mut sum = Places::ZERO;
        for air in &self.everywhere {
            sum = sum.plus_where(BVec4A::TRUE, &air.at(positions));
        }
        for (ball, air) in self.balls.iter().zip(&self.local) {
            let squared = positions.distances_squared(ball.centre);
            // Both are false where a number is NaN.
            let within = squared.cmple(Vec4::splat(ball.squared_radius));
            if squared.cmplt(Vec4::splat(ball.squared_core)).all() {
                sum = sum.plus(&Places::splat(ball.velocity));
            } else if within.any() {
                sum = sum.plus_where(within, &air.at(positions, within));
            }
        }
        if !sum.greatest().cmplt(Vec4::splat(0.5 * FASTEST)).all() {
            for place in 0..PLACES {
                let velocity = sum.get(place);
                if velocity != Vec3::ZERO {
                    sum.set(place, limited(velocity));
                }
            }
        }
        sum
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

    /// Moves all winds along with the world, m.
    pub(crate) fn shift(&mut self, by: Vec3) {
        self.everywhere.iter_mut().for_each(|air| air.shift(by));
        self.balls.iter_mut().for_each(|ball| ball.centre += by);
        self.local.iter_mut().for_each(|air| air.shift(by));
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
    use bevy_math::{DVec3, Isometry3d, Quat};

    use super::*;
    use crate::environment::wind::field::WindField;
    use crate::environment::wind::region::WindShape;

    #[test]
    fn steady_regions_are_the_same_in_their_cores_and_outside() {
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
            let local = LocalAir::Region(air, region, Frame::of(pose));
            let mut wind = TickWind::default();
            wind.add_local((Vec3::from(pose.translation), shape.reach()), local.clone());
            let mut in_core = 0;
            for index in 0..4096 {
                let number = |step: f32| 8.0 * ((index as f32 * step).fract() - 0.5);
                let offset = Vec3::new(number(0.618_034), number(0.754_878), number(0.569_84));
                let at = Vec3::from(pose.translation) + offset;
                assert_eq!(
                    wind.at(at),
                    local.at(&Places::of(&[at]), BVec4A::TRUE).get(0),
                    "{region:?} at {offset}"
                );
                in_core += usize::from(offset.length_squared() < wind.balls[0].squared_core);
            }
            let is_cone = matches!(shape, WindShape::Cone { .. });
            assert_eq!(in_core == 0, is_cone, "{region:?}");
        }
    }

    #[test]
    fn four_places_have_the_winds_that_each_has_alone() {
        let gusty = WindField::steady(Vec3::X).with_gusts(2.0, 0.5, 3);
        let mut wind = TickWind::default();
        wind.everywhere.push(MovingAir::new(&gusty, Default::default()));
        let pose = |x: f32| Isometry3d::new(Vec3::X * x, Quat::from_rotation_y(x));
        let region = WindRegion::ball(4.0, 2.0);
        let of_region =
            LocalAir::Region(MovingAir::new(&gusty, DVec3::ONE), region, Frame::of(pose(1.0)));
        wind.add_local((Vec3::X, 4.0), of_region);
        wind.add_local(
            (Vec3::X * 3.0, 5.0),
            LocalAir::Fan(WindFan::new(8.0, 0.3), Frame::of(pose(3.0))),
        );
        let blast = WindBlast { age: 0.02, ..WindBlast::new(60.0, 2.0) };
        wind.add_local((Vec3::ZERO, 6.0), LocalAir::Blast(blast, Vec3::ZERO, 0.01));
        let at = |place: usize| Vec3::new(1.1, 0.3, -0.4) * place as f32;
        let positions: Vec<Vec3> = (0..PLACES).map(at).collect();
        let together = wind.at_places(&Places::of(&positions));
        for (place, position) in positions.iter().enumerate() {
            assert_eq!(together.get(place), wind.at(*position), "{position}");
        }
        assert_eq!(wind.same_everywhere(), None);
    }

    #[test]
    fn a_storm_at_one_place_leaves_the_others_calm() {
        let storm = MovingAir::new(&WindField::steady(Vec3::X * 1e6), DVec3::ZERO);
        let region =
            LocalAir::Region(storm, WindRegion::ball(2.0, 1.0), Frame::of(Isometry3d::IDENTITY));
        let mut wind = TickWind::default();
        wind.add_local((Vec3::ZERO, 2.0), region);
        let winds = wind.at_places(&Places::of(&[Vec3::ZERO, 9.0 * Vec3::X]));
        assert_eq!([0, 1].map(|place| winds.get(place)), [FASTEST * Vec3::X, Vec3::ZERO]);
    }

    #[test]
    fn velocities_of_any_size_are_limited() {
        for size in [1.0, 300.0, 341.0, 1e6, f32::MAX] {
            let limited = limited(Vec3::new(0.6, 0.0, -0.8) * size);
            assert!((limited.length() / size.min(FASTEST) - 1.0).abs() < 1e-5, "{limited}");
        }
    }
}
