//! The turn about a pole: a cloth whose pins lie on a line may turn about it, and nothing within the
//! cloth can make it.
//!
//! Each solve of a substep pulls particles along the directions in which it finds them, so each by
//! itself has no moment; but those that come later find particles moved by those that came before,
//! and of two pulls the cross product is left. It is small and always of one sign: a flag that hangs
//! from its pole in folds goes round it for ever. So the moment of all corrections about the pole is
//! taken out again, by a turn as of a rigid body.

use glam::Vec3;

use crate::fabric::Fabric;
use crate::lane_batch::LaneBatch;
use crate::lanes::{Kernel, Lane, Pack};
use crate::places::Constant;
use crate::sums::Sum;
use crate::vector::{Pack3, V3, splat3};

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
}

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// Takes the moment about the pole out of what this substep has corrected.
    pub fn still_turn(&mut self) {
        let Some(pole) = self.pole else { return };
        P::run(StillTurn {
            pole,
            inverse_areas: &self.packs.inverse_areas,
            inertias: &self.lane_inertias,
            parts: &self.parts,
            predicted: &self.predicted,
            position: &mut self.position,
        });
    }
}

struct StillTurn<'a, P: Pack, C> {
    pole: Pole,
    inverse_areas: &'a [C],
    /// Each particle's inertia, in units of the density, m²; zero where it is pinned.
    inertias: &'a [P],
    /// Into which part of the sums each pack goes.
    parts: &'a [u8],
    predicted: &'a [Pack3<P>],
    position: &'a mut [Pack3<P>],
}

impl<P: Pack, C: Constant<P>> Kernel<P> for StillTurn<'_, P, C> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let at: V3<L> = V3::load(token, &splat3(self.pole.at));
        let along: V3<L> = V3::load(token, &splat3(self.pole.along));
        let mut moment = Sum::new(token);
        let mut inertia = Sum::new(token);
        let places = self.position.iter().zip(self.predicted).zip(self.inertias).zip(self.parts);
        for (((position, predicted), mass), &part) in places {
            let x: V3<L> = V3::load(token, position);
            let mass = L::load(token, mass);
            // How fast the particle would go round at a radian per second.
            let round = along.cross(x - at);
            let way = round.dot(x - V3::load(token, predicted));
            moment.add_product(part, mass, way);
            inertia.add_product(part, mass, round.dot(round));
        }
        let inertia = inertia.total::<C>(token) + L::splat(token, f32::MIN_POSITIVE);
        let turn = moment.total::<C>(token) / inertia;
        for (position, inverse_area) in self.position.iter_mut().zip(self.inverse_areas) {
            if inverse_area.is_zero() {
                continue;
            }
            let x: V3<L> = V3::load(token, position);
            let turned = x.minus_scaled(along.cross(x - at), turn);
            inverse_area.choose3(token, turned, x).store(position);
        }
    }
}
