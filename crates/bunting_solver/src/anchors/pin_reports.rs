//! What a cloth does to its pins in a tick.

use std::sync::Arc;

use glam::{Quat, Vec3};

use crate::anchors::pin_groups::PinGroups;

/// Change of a pin's velocity in a tick above which the pin was put elsewhere, m/s, and has no inertia: no vehicle
/// changes its velocity by as much. Smaller: hard manoeuvres lose force. Larger: teleports are reported as blows.
const PUT_ELSEWHERE: f32 = 25.0;

/// What a cloth does to a group of pins in a tick: the tension, weight and drag of the cloth, and the inertia of the pins.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PinReaction {
    /// Impulse on that which holds the pins, N·s, along the axes of the cloth's frame at the end of the tick.
    pub impulse: Vec3,
    /// Angular impulse about the group's pivot, N·m·s, along the same axes.
    pub angular_impulse: Vec3,
}

impl PinReaction {
    /// Adds an impulse (N·s) at a distance from the pivot (m).
    pub(crate) fn add(&mut self, arm: Vec3, impulse: Vec3) {
        self.impulse += impulse;
        self.angular_impulse += arm.cross(impulse);
    }

    /// Adds another reaction, turned.
    pub(crate) fn add_turned(&mut self, other: Self, turn: Quat) {
        self.impulse += turn * other.impulse;
        self.angular_impulse += turn * other.angular_impulse;
    }
}

/// The reactions of a cloth's pins that are asked for.
#[derive(Clone, Debug)]
pub(crate) struct PinReports {
    pub groups: Arc<PinGroups>,
    /// For each group, the point about which torque is taken, at the start and at the end of the tick, each in the frame
    /// at that time, m.
    pub pivots: Vec<[Vec3; 2]>,
    /// Sum over the substeps so far, along the axes at the end of the tick.
    pub sums: Vec<PinReaction>,
    /// Velocities of the pins at the end of the last tick, m/s, along the axes at that time; empty before the first one.
    velocities: Vec<Vec3>,
}

impl PinReports {
    /// Reports of which no tick has begun, given the velocities of the pins at the end of the last tick, if they are known.
    pub fn new(groups: Arc<PinGroups>, pivots: Vec<[Vec3; 2]>, velocities: Vec<Vec3>) -> Self {
        Self { groups, pivots, sums: Vec::new(), velocities }
    }

    /// Velocities of the pins at the end of the last tick, m/s; empty before the first one.
    pub fn velocities(&self) -> &[Vec3] {
        &self.velocities
    }

    /// Forgets all sums: a tick begins.
    pub fn begin_tick(&mut self) {
        self.sums.clear();
        self.sums.resize(self.groups.count, PinReaction::default());
    }

    /// Pivot of a group after a part of the tick, m.
    pub fn pivot(&self, group: usize, part: f32) -> Vec3 {
        self.pivots.get(group).map_or(Vec3::ZERO, |[from, to]| from.lerp(*to, part))
    }

    /// Changes of the pins' velocities in this tick, m/s, in which the frame turned by `rotation`, given the velocities at
    /// its end.
    pub fn changes(&mut self, velocities: Vec<Vec3>, rotation: Quat) -> Vec<Vec3> {
        let former = core::mem::replace(&mut self.velocities, velocities);
        let turn = rotation.inverse();
        let change = |(index, now): (usize, &Vec3)| {
            let change = former.get(index).map_or(Vec3::ZERO, |former| *now - turn * *former);
            if change.length() < PUT_ELSEWHERE { change } else { Vec3::ZERO }
        };
        self.velocities.iter().enumerate().map(change).collect()
    }
}
