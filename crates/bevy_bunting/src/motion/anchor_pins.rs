//! The pins that anchors hold, and where they are.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_math::{Isometry3d, Vec3};
use bunting_solver::{Fabric, MovingPin};

use crate::fabric::known_level::KnownLevel;
use crate::fabric::levels::ClothLevels;
use crate::motion::anchor_poses::AnchorPoses;
use crate::motion::growth::Growth;
use crate::motion::held_group::HeldGroup;
use crate::motion::pose::PoseHistory;

/// Distance of a pin from its place at which it begins to move there over a while, m. Smaller: a change of level,
/// after which pins are interpolated, counts. Larger: pins visibly jump.
const IN_PLACE: f32 = 1e-3;

/// Part of a pin from which an anchor holds it alone. Larger: rounding moves it.
const NEARLY_ALL: f32 = 0.999;

/// The pins of a cloth that are held by its anchors, at its present level.
#[derive(Component, Debug, Default)]
pub(crate) struct AnchorPins {
    /// The levels and the level that the pins are those of.
    of: Option<KnownLevel>,
    pins: Vec<AnchoredPin>,
}

/// A pin that anchors hold, by itself or between vertices that they hold.
#[derive(Clone, Debug)]
struct AnchoredPin {
    particle: u32,
    /// The anchors with their parts in it; the frame has the rest.
    shares: Vec<(usize, f32)>,
    /// Position now, in the cloth's frame, m.
    at: Vec3,
    /// Place at the end of the tick, in the cloth's frame at that time, m.
    place: Vec3,
    /// Whether it is in its place, and neither the frame nor an anchor has moved since.
    is_settled: bool,
}

impl AnchorPins {
    /// Whether the pins are those of a level.
    pub fn fits(&self, levels: &Arc<ClothLevels>, level: usize) -> bool {
        self.of.as_ref().is_some_and(|of| of.is(levels, level))
    }

    /// Finds the pins of a level, given what each anchor holds and the positions of all particles, m.
    pub fn find(
        &mut self,
        levels: &Arc<ClothLevels>,
        level: usize,
        groups: &[HeldGroup],
        positions: &[Vec3],
    ) {
        self.of = Some(KnownLevel::new(levels, level));
        self.pins.clear();
        self.pins.extend(levels.held(level, groups).into_iter().map(|held| {
            let at = positions[held.particle];
            AnchoredPin {
                particle: held.particle as u32,
                shares: held.shares,
                at,
                place: at,
                is_settled: false,
            }
        }));
    }

    /// Finds the places of the pins in a tick, given the cloth's frame and its growth. Returns whether all are in their places at its start.
    pub fn find_places(
        &mut self,
        fabric: &Fabric,
        poses: &AnchorPoses,
        frame: &PoseHistory,
        growth: &Growth,
    ) -> bool {
        let (start, end) = (frame.start().inverse(), frame.end().inverse());
        let mut are_in_place = true;
        for pin in &mut self.pins {
            let rest = fabric.rest_positions()[pin.particle as usize];
            let place = |pin: &AnchoredPin, of: &dyn Fn((Isometry3d, Isometry3d)) -> Vec3| {
                let parts = pin
                    .shares
                    .iter()
                    .filter_map(|&(anchor, part)| Some((of(poses.span(anchor)?), part)));
                between(rest, parts)
            };
            let size = growth.end();
            pin.place = place(pin, &|(_, to)| end * (to * (size * rest)) / size);
            let rests = frame.rests() && pin.shares.iter().all(|&(anchor, _)| poses.rests(anchor));
            if rests && pin.is_settled {
                // Another place is the rounding of a world that was moved.
                pin.place = pin.at;
                continue;
            }
            pin.is_settled = rests && pin.place == pin.at;
            let size = growth.start();
            let from = place(pin, &|(from, _)| start * (from * (size * rest)) / size);
            are_in_place &= from.distance(pin.at) < IN_PLACE;
        }
        are_in_place
    }

    /// Place of a particle that an anchor holds, m.
    pub fn place(&self, particle: u32) -> Option<Vec3> {
        let index = self.pins.binary_search_by_key(&particle, |pin| pin.particle).ok()?;
        Some(self.pins[index].place)
    }

    /// The motions of the pins to their places in this tick.
    pub fn motions(&self) -> Vec<MovingPin> {
        let moving = self.pins.iter().filter(|pin| pin.at != pin.place);
        let moving =
            moving.map(|pin| MovingPin { particle: pin.particle, from: pin.at, to: pin.place });
        moving.collect()
    }

    /// Notes the motions of pins in this tick.
    pub fn note(&mut self, motions: &[MovingPin]) {
        for motion in motions {
            if let Ok(index) = self.pins.binary_search_by_key(&motion.particle, |pin| pin.particle)
            {
                self.pins[index].at = motion.to;
            }
        }
    }
}

/// The mean of places (m) with their parts, and of one with what is left to 1.
fn between(rest: Vec3, places: impl Iterator<Item = (Vec3, f32)>) -> Vec3 {
    let (mut sum, mut left) = (Vec3::ZERO, 1.0);
    for (place, part) in places {
        if part > NEARLY_ALL {
            return place;
        }
        sum += part * place;
        left -= part;
    }
    sum + left.max(0.0) * rest
}
