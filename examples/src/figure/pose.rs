//! The figure's poses.

use std::f32::consts::PI;

use bevy::prelude::*;

use crate::figure::skeleton::{ANKLE, Joint, LEG, Side};
use crate::figure::walker::Walker;

/// Height of the hips in a run, and the amplitude by which they bob, m.
const RUN_HEIGHT: f32 = 0.91;
const BOB: f32 = 0.03;

/// Angle of the thighs of a figure that sits, rad.
const SEATED: f32 = 1.48;

/// Angles of the joints at a phase and a speed, rad.
struct Pose {
    phase: f32,
    /// How much of a walk this is, from 0 to 1.
    walk: f32,
    /// How much of a run, from 0 to 1.
    run: f32,
    /// How far it sits, from 0 to 1.
    sit: f32,
    /// Angle by which the arms are held farther from the body.
    spread: f32,
    /// Angle by which the thighs are lifted higher in a run.
    lift: f32,
}

impl Pose {
    fn of(walker: &Walker) -> Self {
        let Walker { phase, sit, spread, lift, .. } = *walker;
        Self { phase, walk: walker.walk(), run: walker.run(), sit, spread, lift }
    }

    fn phase_of(&self, side: Side) -> f32 {
        if side == Side::Left { self.phase } else { self.phase + PI }
    }

    /// How much higher a thigh is lifted at this phase.
    fn lifted(&self, side: Side) -> f32 {
        0.5 * self.lift * self.run * (1.0 + self.phase_of(side).sin())
    }

    /// Angle of a thigh to the front.
    fn thigh(&self, side: Side) -> f32 {
        let swing = 0.40 * self.walk + 0.35 * self.run;
        let further = SEATED * self.sit + self.lifted(side);
        swing * self.phase_of(side).sin() + 0.06 * self.walk + 0.22 * self.run + further
    }

    /// Angle of a shin to the thigh, backwards.
    fn knee(&self, side: Side) -> f32 {
        let swing = 0.75 * self.walk + 0.75 * self.run;
        let forwards = self.phase_of(side).cos().max(0.0);
        self.still_knee() + 0.2 * self.run + swing * forwards + 3.0 * self.lifted(side)
    }

    /// That of a figure that stays in its place: shins are upright when it sits.
    fn still_knee(&self) -> f32 {
        0.08 + (SEATED - 0.08) * self.sit
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

    /// How far the hips are behind the place above the feet at which the figure stands, m: feet stay where they are.
    fn back(&self) -> f32 {
        let behind = |sit: f32, knee: f32| (SEATED * sit).sin() + (SEATED * sit - knee).sin();
        LEG * (behind(self.sit, self.still_knee()) - behind(0.0, 0.08))
    }

    fn rotation(&self, joint: Joint) -> Quat {
        let bend = Quat::from_rotation_x;
        let twist = 0.10 * self.walk + 0.10 * self.run;
        match joint {
            Joint::Hips => Quat::from_rotation_y(0.5 * twist * self.phase.sin()),
            Joint::Chest => {
                let bow = 0.6 * (PI * self.sit).sin();
                let lean = 0.02 * self.walk + 0.20 * self.run + bow;
                Quat::from_rotation_y(-1.5 * twist * self.phase.sin()) * bend(-lean)
            }
            Joint::Head => bend(0.12 * self.run),
            Joint::Arm(side) => {
                let swing = 0.35 * self.walk + 0.40 * self.run;
                let away = 0.08 + self.spread;
                let away = if side == Side::Left { -away } else { away };
                let angle = -swing * self.phase_of(side).sin() - 0.1 * self.run + 0.3 * self.sit;
                Quat::from_rotation_z(away) * bend(angle)
            }
            Joint::Forearm(_) => bend(0.15 + 0.15 * self.walk + 1.15 * self.run + 0.6 * self.sit),
            Joint::Thigh(side) => bend(self.thigh(side)),
            Joint::Shin(side) => bend(-self.knee(side)),
        }
    }
}

/// Moves the joints of a figure that no animation moves.
pub fn bend(figure: Single<&Walker>, mut joints: Query<(&Joint, &mut Transform)>) {
    let pose = Pose::of(&figure);
    for (joint, mut transform) in &mut joints {
        transform.rotation = pose.rotation(*joint);
        if *joint == Joint::Hips {
            transform.translation = Vec3::new(0.0, pose.hips(), pose.back());
        }
    }
}
