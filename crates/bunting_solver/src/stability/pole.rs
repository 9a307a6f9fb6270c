//! The turn about a pole: a cloth whose pins lie on a line may turn about it, and nothing within the
//! cloth can make it.
//!
//! Each solve of a substep pulls particles along the directions in which it finds them, so each by
//! itself has no moment; but those that come later find particles moved by those that came before,
//! and of two pulls the cross product is left. It is small and always of one sign: a flag that hangs
//! from its pole in folds goes round it for ever. So the moment of all corrections about the pole is
//! taken out again, by a turn as of a rigid body: with the next prediction, when all particles are moved
//! anyway. What contacts do is no error, and has a moment of its own.

use glam::Vec3;

use crate::batch::places::Constant;
use crate::fabric::Fabric;
use crate::simd::lane::Lane;
use crate::simd::reduce::Sum;
use crate::simd::vec3::{V3, splat3};

/// How far pins may lie off the line through them, as a part of its length.
const STRAIGHT: f32 = 1e-3;

/// The line through all pins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pole {
    /// A point of it, m.
    at: Vec3,
    /// Its direction, of unit length.
    along: Vec3,
}

impl Pole {
    /// The line through a fabric's pins, if there are two or more and they lie on one.
    pub fn of(fabric: &Fabric) -> Option<Self> {
        let pins: Vec<Vec3> = fabric
            .pins()
            .iter()
            .map(|pin| fabric.rest_positions()[pin.particle as usize])
            .collect();
        let at = *pins.first()?;
        let far = pins.iter().max_by(|a, b| at.distance(**a).total_cmp(&at.distance(**b)))?;
        let along = (*far - at).try_normalize()?;
        let off = |pin: &Vec3| (*pin - at).reject_from_normalized(along).length();
        let straight = pins.iter().all(|pin| off(pin) <= STRAIGHT * at.distance(*far));
        straight.then_some(Self { at, along })
    }

    /// The two pins at its ends.
    pub fn ends(&self, fabric: &Fabric) -> [u32; 2] {
        let place = |particle: u32| self.along.dot(fabric.rest_positions()[particle as usize]);
        let order = |a: &u32, b: &u32| place(*a).total_cmp(&place(*b));
        let pins = || fabric.pins().iter().map(|pin| pin.particle);
        let ends = [pins().min_by(order), pins().max_by(order)];
        ends.map(|end| end.expect("a pole has pins"))
    }

    /// How far the cloth hangs along it: from 0 with the pole across gravity to 1 along it, in steps, as
    /// much hangs on it that is not computed for every small turn.
    pub fn uprightness(&self, gravity: Vec3) -> f32 {
        const STEPS: f32 = 32.0;
        libm::roundf(STEPS * gravity.normalize_or_zero().dot(self.along).abs()) / STEPS
    }

    /// Moment about it of what a particle was corrected by to where it is, m⁴ given its inertia in m².
    pub fn moment(&self, inertia: f32, at: Vec3, correction: Vec3) -> f32 {
        inertia * self.along.cross(at - self.at).dot(correction)
    }
}

/// A pole in registers.
#[derive(Clone, Copy)]
pub(crate) struct Axis<L> {
    at: V3<L>,
    along: V3<L>,
}

impl<L: Lane> Axis<L> {
    #[inline(always)]
    pub fn of(token: L::Token, pole: Option<Pole>) -> Option<Self> {
        let Pole { at, along } = pole?;
        Some(Self { at: V3::load(token, &splat3(at)), along: V3::load(token, &splat3(along)) })
    }

    /// What a point is moved by for each radian of a turn about the pole.
    #[inline(always)]
    pub fn round(&self, point: V3<L>) -> V3<L> {
        self.along.cross(point - self.at)
    }
}

/// Moment and inertia about the pole, in units of the density, m⁴.
pub(crate) struct Moment<L> {
    moment: Sum<L>,
    inertia: Sum<L>,
}

impl<L: Lane> Moment<L> {
    #[inline(always)]
    pub fn new(token: L::Token) -> Self {
        Self { moment: Sum::new(token), inertia: Sum::new(token) }
    }

    /// Adds that of a pack's particles, given their inertias, what they move by for each radian, and what
    /// they were corrected by.
    #[inline(always)]
    pub fn add(&mut self, part: u8, inertia: L, round: V3<L>, correction: V3<L>) {
        self.moment.add_product(part, inertia, round.dot(correction));
        self.inertia.add_product(part, inertia, round.dot(round));
    }

    /// The turn that it makes, rad, but for a moment that is no error.
    #[inline(always)]
    pub fn turn<C: Constant<L::Pack>>(self, token: L::Token, but: L) -> L {
        let inertia = self.inertia.total::<C>(token) + L::splat(token, f32::MIN_POSITIVE);
        (self.moment.total::<C>(token) - but) / inertia
    }
}
