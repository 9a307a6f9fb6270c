//! The spurious turn of a cloth about its pole, and its removal.
//!
//! A cloth whose pins lie on a line, the pole, is free to turn about it, and no internal force can turn it. Neither can it
//! turn a cloth that hangs from one point: its pole is the upright line through this point.
//!
//! Each solve of a constraint moves particles along the directions between them, and so has no moment. But
//! later solves find particles that earlier ones have moved, and the cross product of two corrections
//! remains. It is small and always of one sign: a flag that hangs from its pole in folds would turn about it
//! for ever. Therefore the moment of all corrections about the pole is computed, and a rigid turn of the
//! opposite moment is applied with the next prediction, when all particles are moved anyway. Contacts and
//! users' constraints do turn a cloth: their moment is left out.

use core::ops::Range;

use glam::Vec3;

use crate::fabric::Fabric;
use crate::simd::constant::Constant;
use crate::simd::lane::{Lane, Pack};
use crate::simd::sum::Sum;
use crate::simd::vec3::{Pack3, V3, fill_lanes3, lane3, splat3};

/// Greatest distance of pins from the line through them, as a fraction of its length. Smaller: rounding bends
/// poles. Larger: cloth that its pins hold counts as free to turn.
const STRAIGHT: f32 = 1e-3;

/// The line about which a cloth is free to turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pole {
    /// A point of the line, m.
    at: Vec3,
    /// Direction of the line, of unit length.
    along: Vec3,
    /// Whether all pins are at one point, so that the line follows gravity.
    is_point: bool,
}

impl Pole {
    /// The line through a fabric's pins, if they lie on one or at a point.
    pub fn of(fabric: &Fabric) -> Option<Self> {
        let pins: Vec<Vec3> = fabric
            .pins()
            .iter()
            .map(|pin| fabric.rest_positions()[pin.particle as usize])
            .collect();
        let at = *pins.first()?;
        let far = pins.iter().max_by(|a, b| at.distance(**a).total_cmp(&at.distance(**b)))?;
        let Some(along) = (*far - at).try_normalize() else {
            return Some(Self { at, along: Vec3::Y, is_point: true });
        };
        let off = |pin: &Vec3| (*pin - at).reject_from_normalized(along).length();
        let straight = pins.iter().all(|pin| off(pin) <= STRAIGHT * at.distance(*far));
        straight.then_some(Self { at, along, is_point: false })
    }

    /// The upright line through the point at which a cloth is held; none if its pins lie on a line, or nothing pulls the
    /// cloth down.
    pub fn upright(self, gravity: Vec3) -> Option<Self> {
        let along = gravity.try_normalize().filter(|_| self.is_point)?;
        Some(Self { along, ..self })
    }

    /// The two pins at the ends of the pole; twice the same one at a point.
    pub fn ends(&self, fabric: &Fabric) -> [u32; 2] {
        let place = |particle: u32| self.along.dot(fabric.rest_positions()[particle as usize]);
        let order = |a: &u32, b: &u32| place(*a).total_cmp(&place(*b));
        let pins = || fabric.pins().iter().map(|pin| pin.particle);
        let ends = [pins().min_by(order), pins().max_by(order)];
        ends.map(|end| end.expect("a pole has pins"))
    }

    /// |cos| of the angle between the pole and gravity: 0 for a level pole, 1 for an upright one. Rounded to
    /// 32 steps, so that inverse masses are not computed again for every small turn.
    pub fn uprightness(&self, gravity: Vec3) -> f32 {
        const STEPS: f32 = 32.0;
        if self.is_point {
            return 1.0;
        }
        libm::roundf(STEPS * gravity.normalize_or_zero().dot(self.along).abs()) / STEPS
    }

    /// Displacement of a point, m, by a turn about the pole, rad.
    pub fn turned(&self, point: Vec3, angle: f32) -> Vec3 {
        self.along.cross(point - self.at) * angle
    }

    /// Moment about the pole of a particle's correction, m⁴, given its inertia, m², its corrected position, m,
    /// and the correction, m.
    pub fn moment(&self, inertia: f32, at: Vec3, correction: Vec3) -> f32 {
        inertia * self.along.cross(at - self.at).dot(correction)
    }

    /// Change of this moment, m⁴, where something from outside has moved a particle, m, in a substep for which its position
    /// was predicted, m.
    pub fn gained(&self, inertia: f32, predicted: Vec3, [before, after]: [Vec3; 2]) -> f32 {
        let moment = |at: Vec3| self.moment(inertia, at, at - predicted);
        moment(after) - moment(before)
    }
}

/// A turn about the pole by the corrections of a substep.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct PoleTurn {
    /// Angle, rad.
    pub angle: f32,
    /// Rate, rad/s.
    pub rate: f32,
}

/// The pole of each lane's cloth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PolePacks<P> {
    at: Pack3<P>,
    along: Pack3<P>,
}

impl<P: Pack> PolePacks<P> {
    /// The same pole in all lanes.
    pub fn splat(pole: Pole) -> Self {
        Self { at: splat3(pole.at), along: splat3(pole.along) }
    }

    /// Overwrites the pole of some lanes.
    pub fn set_lanes(&mut self, lanes: &Range<usize>, pole: Pole) {
        fill_lanes3(&mut self.at, lanes, pole.at);
        fill_lanes3(&mut self.along, lanes, pole.along);
    }

    /// The pole of a lane, given that at rest.
    pub fn of_lane(&self, lane: usize, at_rest: Pole) -> Pole {
        Pole { along: lane3(&self.along, lane), ..at_rest }
    }
}

/// A pole in registers.
#[derive(Clone, Copy)]
pub(crate) struct Axis<L> {
    at: V3<L>,
    along: V3<L>,
}

impl<L: Lane> Axis<L> {
    /// The pole in registers.
    #[inline(always)]
    pub fn load(token: L::Token, pole: Option<&PolePacks<L::Pack>>) -> Option<Self> {
        let PolePacks { at, along } = pole?;
        Some(Self { at: V3::load(token, at), along: V3::load(token, along) })
    }

    /// Displacement of a point, m, by a turn of one radian about the pole.
    #[inline(always)]
    pub fn turn_of(&self, point: V3<L>) -> V3<L> {
        self.along.cross(point - self.at)
    }
}

/// Sums over the particles of the moment of corrections about the pole, and of inertia, in units of the
/// density, m⁴.
pub(crate) struct Moment<L> {
    moment: Sum<L>,
    inertia: Sum<L>,
}

impl<L: Lane> Moment<L> {
    /// Zero.
    #[inline(always)]
    pub fn new(token: L::Token) -> Self {
        Self { moment: Sum::new(token), inertia: Sum::new(token) }
    }

    /// Adds the terms of a pack, given the particles' inertias, m², their displacement by a turn of one
    /// radian, m, and their corrections, m.
    #[inline(always)]
    pub fn add(&mut self, partial: u8, inertia: L, turn: V3<L>, correction: V3<L>) {
        self.moment.add_product(partial, inertia, turn.dot(correction));
        self.inertia.add_product(partial, inertia, turn.dot(turn));
    }

    /// The rigid turn, rad, with the moment of the corrections minus that of corrections from outside the
    /// cloth, m⁴.
    #[inline(always)]
    pub fn turn<C: Constant<L::Pack>>(self, token: L::Token, external: L) -> L {
        let inertia = self.inertia.total::<C>(token) + L::splat(token, f32::MIN_POSITIVE);
        (self.moment.total::<C>(token) - external) / inertia
    }
}
