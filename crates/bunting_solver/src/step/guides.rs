//! Guides: where an animation would have each particle, and how far the particle may go from there.

use glam::Vec3;

use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, splat3};

/// The animated place of a particle during a tick, and the limits that hold a free particle near it. Between start and
/// end, place and limits move evenly along straight lines in the cloth's frame.
///
/// ```
/// use bunting_solver::{Backstop, Guide};
/// use glam::Vec3;
///
/// // A particle of a cape, at most 5 cm from where the skeleton would have it.
/// let [place, out] = [Vec3::new(0.0, 1.2, -0.2), Vec3::NEG_Z];
/// let backstop = Backstop { distance: 0.0, radius: 0.15 };
/// let guide = Guide { places: [place; 2], normals: [out; 2], max_distance: 0.05, backstop };
/// # assert_eq!(guide.places[0], guide.places[1]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guide {
    /// Place at the start and at the end of the tick, each in the frame at that time, m.
    pub places: [Vec3; 2],
    /// Unit normal at the start and at the end of the tick, each in the frame at that time.
    pub normals: [Vec3; 2],
    /// Greatest distance from the place, m; infinite where there is no limit.
    pub max_distance: f32,
    /// The sphere behind the place that the particle cannot enter.
    pub backstop: Backstop,
}

impl Guide {
    /// Whether the numbers can be simulated.
    pub(super) fn is_valid(&self) -> bool {
        let Self { places: [from, to], normals: [before, after], max_distance, backstop } = *self;
        let Backstop { distance, radius } = backstop;
        // Zero times a number that is not finite is not zero: one test for all instead of one for each of fourteen.
        let zeros = Vec3::ZERO * from + Vec3::ZERO * to + Vec3::ZERO * before + Vec3::ZERO * after;
        let zero = zeros.x + zeros.y + zeros.z + 0.0 * distance + 0.0 * radius;
        zero == 0.0 && max_distance >= 0.0 && radius >= 0.0
    }

    /// Centres of the backstop, m.
    pub(super) fn behind(&self) -> [Vec3; 2] {
        let depth = self.backstop.distance + self.backstop.radius;
        [0, 1].map(|end| self.places[end] - self.normals[end] * depth)
    }
}

/// A sphere behind the animated place of a particle, on the line of the animated normal, that the particle cannot enter: a
/// cheap stand-in for the body under the cloth.
///
/// ```
/// use bunting_solver::Backstop;
///
/// // The back of a figure, 1 cm behind the cloth.
/// let back = Backstop { distance: 0.01, radius: 0.15 };
/// # assert!(back.radius > back.distance);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect), type_path = "bunting_solver")]
pub struct Backstop {
    /// Distance of the sphere's surface behind the place, m; negative for a sphere that reaches in front of it.
    pub distance: f32,
    /// Radius, m; zero where there is none.
    pub radius: f32,
}

/// The guides of one cloth.
#[derive(Clone, Debug)]
pub(crate) struct ClothGuides {
    pub(super) guides: Vec<Guide>,
    pub(super) phase: Phase,
}

/// Where the guides of a cloth are in their tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// Their tick has not begun.
    Ahead,
    /// They move in this tick.
    Moving,
    /// They stay where they were at the end of their tick.
    Resting,
}

/// The guides of a batch, one for each pack of particles.
#[derive(Clone, Debug)]
pub(crate) struct Guides<P: Pack> {
    pub packs: Vec<GuidePack<P>>,
    /// Whether each cloth has guides.
    pub(super) guided: Vec<bool>,
}

/// The guides of a pack of particles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GuidePack<P: Pack> {
    /// Places at the start and at the end of the tick, m.
    pub places: [Pack3<P>; 2],
    /// Centres of the backstops at the start and at the end of the tick, m.
    pub behind: [Pack3<P>; 2],
    /// Unit normals at the end of the tick: the way out of the centre of a backstop.
    pub normal: Pack3<P>,
    /// Greatest distances from the places, m; infinite where there is no limit.
    pub max_distance: P,
    /// Radii of the backstops, m; zero where there is none.
    pub radius: P,
}

impl<P: Pack> GuidePack<P> {
    pub(super) fn unlimited() -> Self {
        Self {
            places: [splat3(Vec3::ZERO); 2],
            behind: [splat3(Vec3::ZERO); 2],
            normal: splat3(Vec3::ZERO),
            max_distance: P::splat(f32::INFINITY),
            radius: P::splat(0.0),
        }
    }

    /// Writes the limits of one lane.
    pub(super) fn set(&mut self, lane: usize, max_distance: f32, radius: f32) {
        self.max_distance.lanes_mut()[lane] = max_distance;
        self.radius.lanes_mut()[lane] = radius;
    }
}

impl ClothGuides {
    /// Has them written at the next tick into a batch that does not hold them yet.
    pub fn write_again(&mut self) {
        if self.phase == Phase::Resting {
            self.phase = Phase::Moving;
        }
    }

    /// Greatest way of the place of a particle that has a limit, in a tick that has not ended, m.
    pub fn greatest_way(&self) -> f32 {
        if self.phase == Phase::Resting {
            return 0.0;
        }
        let limited = self.guides.iter().filter(|guide| guide.max_distance < f32::INFINITY);
        limited.map(|guide| guide.places[0].distance(guide.places[1])).fold(0.0, f32::max)
    }
}
