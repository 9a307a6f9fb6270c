//! The figure's way and gait.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use bevy::prelude::*;

use crate::scenes::cape::skeleton::{ANKLE, Joint, LEG, Side};
use crate::scenes::cape::walker::{RUN, WALK, Walker};

/// Height of the hips in a run, and the amplitude by which they bob, m.
const RUN_HEIGHT: f32 = 0.91;
const BOB: f32 = 0.03;

/// Changes of speed: the time at which each begins, s, its duration, s, and the speed that it adds, m/s.
const CHANGES: [[f32; 3]; 3] = [[1.5, 0.7, WALK], [6.5, 1.0, RUN - WALK], [11.0, 0.9, -RUN]];

/// Turns: the time at which each begins, s, its duration, s, and its angle to the left, rad.
const TURNS: [[f32; 3]; 3] = [[3.8, 1.2, FRAC_PI_2], [8.6, 0.9, -FRAC_PI_2], [12.4, 0.7, PI * 0.6]];

/// The sum of changes up to a time, each smooth.
fn sum(changes: &[[f32; 3]], time: f32) -> f32 {
    let part = |&[begin, duration, by]: &[f32; 3]| {
        let part = ((time - begin) / duration).clamp(0.0, 1.0);
        by * part * part * (3.0 - 2.0 * part)
    };
    changes.iter().map(part).sum()
}

/// Angles of the joints at a phase and a speed, rad.
struct Pose {
    phase: f32,
    /// How much of a walk this is, from 0 to 1.
    walk: f32,
    /// How much of a run, from 0 to 1.
    run: f32,
}

impl Pose {
    fn of(walker: &Walker) -> Self {
        Self { phase: walker.phase, walk: walker.walk(), run: walker.run() }
    }

    fn phase_of(&self, side: Side) -> f32 {
        if side == Side::Left { self.phase } else { self.phase + PI }
    }

    /// Angle of a thigh to the front.
    fn thigh(&self, side: Side) -> f32 {
        let swing = 0.40 * self.walk + 0.35 * self.run;
        swing * self.phase_of(side).sin() + 0.06 * self.walk + 0.22 * self.run
    }

    /// Angle of a shin to the thigh, backwards.
    fn knee(&self, side: Side) -> f32 {
        let swing = 0.75 * self.walk + 0.75 * self.run;
        let forwards = self.phase_of(side).cos().max(0.0);
        0.08 + 0.2 * self.run + swing * forwards
    }

    /// Height of the hips above the ground, m: one foot is on the ground in a walk, and a run leaps over its wide steps.
    fn hips(&self) -> f32 {
        let leg = |side| {
            let thigh = self.thigh(side);
            LEG * (thigh.cos() + (thigh - self.knee(side)).cos())
        };
        let longest = leg(Side::Left).max(leg(Side::Right));
        let above_thighs = Joint::Hips.place().y - Joint::Thigh(Side::Left).place().y;
        let on_ground = ANKLE + longest + above_thighs;
        let leaping = RUN_HEIGHT - BOB * (2.0 * self.phase).cos();
        on_ground + 0.85 * self.run * (leaping - on_ground)
    }

    fn rotation(&self, joint: Joint) -> Quat {
        let bend = Quat::from_rotation_x;
        let twist = 0.10 * self.walk + 0.10 * self.run;
        match joint {
            Joint::Hips => Quat::from_rotation_y(0.5 * twist * self.phase.sin()),
            Joint::Chest => {
                let lean = 0.02 * self.walk + 0.20 * self.run;
                Quat::from_rotation_y(-1.5 * twist * self.phase.sin()) * bend(-lean)
            }
            Joint::Head => bend(0.12 * self.run),
            Joint::Arm(side) => {
                let swing = 0.35 * self.walk + 0.40 * self.run;
                let away = if side == Side::Left { -0.08 } else { 0.08 };
                let angle = -swing * self.phase_of(side).sin() - 0.1 * self.run;
                Quat::from_rotation_z(away) * bend(angle)
            }
            Joint::Forearm(_) => bend(0.15 + 0.15 * self.walk + 1.15 * self.run),
            Joint::Thigh(side) => bend(self.thigh(side)),
            Joint::Shin(side) => bend(-self.knee(side)),
        }
    }
}

/// Moves the figure along its way.
pub fn go(mut figure: Single<(&mut Walker, &mut Transform)>, time: Res<Time>) {
    let (now, tick) = (time.elapsed_secs(), time.delta_secs());
    let speed = sum(&CHANGES, now);
    let heading = Quat::from_rotation_y(sum(&TURNS, now));
    let (walker, place) = &mut *figure;
    // Longer steps at higher speed.
    let stride = 0.9 + 0.45 * speed;
    walker.speed = speed;
    walker.phase = (walker.phase + TAU * speed / stride * tick) % TAU;
    place.translation += heading * Vec3::NEG_Z * (speed * tick);
    place.rotation = heading;
}

/// Moves the joints of a figure that no animation moves.
pub fn bend(figure: Single<&Walker>, mut joints: Query<(&Joint, &mut Transform)>) {
    let pose = Pose::of(&figure);
    for (joint, mut transform) in &mut joints {
        transform.rotation = pose.rotation(*joint);
        if *joint == Joint::Hips {
            transform.translation.y = pose.hips();
        }
    }
}
