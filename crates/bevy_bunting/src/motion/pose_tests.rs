//! Pose histories of entities that are moved in frames, in ticks, or not at all.

use bevy_math::{Isometry3d, Quat, Vec3};

use super::PoseHistory;
use crate::motion::observation_times::ObservationTimes;

/// Length of a tick, s: Bevy's default.
const TICK: f64 = 1.0 / 64.0;

/// Change of velocity above which a change of pose is a teleport, m/s.
const LIMIT: f32 = 25.0;

/// Rounding error of a position some tens of metres from the origin, m.
const ROUNDING: f32 = 1e-5;

fn at(x: f32) -> Isometry3d {
    Isometry3d::from_translation(Vec3::X * x)
}

/// An app's clocks, with the observations that the plugin makes of an entity.
struct Clocks {
    history: PoseHistory,
    last: ObservationTimes,
    now: f64,
    pose: Isometry3d,
    /// Motions that were given their velocities: numbers of the ticks and velocities, m/s.
    launches: Vec<(u32, Vec3)>,
}

impl Clocks {
    fn new() -> Self {
        Self {
            history: PoseHistory::default(),
            last: ObservationTimes::default(),
            now: 0.0,
            pose: at(0.0),
            launches: Vec::new(),
        }
    }

    /// Runs one frame and returns the motion of each tick in it.
    fn frame(
        &mut self,
        seconds: f64,
        update: impl Fn(f64) -> Option<Isometry3d>,
        fixed_update: impl Fn(f64) -> Option<Isometry3d>,
    ) -> Vec<f32> {
        self.now += seconds;
        self.last.note_frame(seconds);
        self.history.observe_frame(&self.last, self.now, self.pose, LIMIT, true);
        let mut motions = Vec::new();
        while self.last.tick + TICK <= self.now {
            let tick = self.last.tick + TICK;
            self.pose = fixed_update(tick).unwrap_or(self.pose);
            let now = ObservationTimes { tick, ticks: self.last.ticks + 1, ..self.last };
            self.history.observe_tick(&self.last, &now, TICK, self.pose, LIMIT);
            self.last = now;
            self.launches.extend(self.history.launch().map(|by| (now.ticks, by)));
            let (start, end) = (self.history.start(), self.history.end());
            motions.push((end.translation - start.translation).length());
        }
        self.history.observe_end_of_ticks(&self.last, self.pose);
        self.pose = update(self.now).unwrap_or(self.pose);
        self.history.observe_frame(&self.last, self.now, self.pose, LIMIT, false);
        self.last.end_frame(self.now);
        motions
    }
}

const SPEED: f32 = 20.0;

fn drives(time: f64) -> Option<Isometry3d> {
    Some(at(SPEED * time as f32))
}

fn rests(_: f64) -> Option<Isometry3d> {
    None
}

#[test]
fn a_steady_motion_in_update_is_steady_at_any_frame_rate() {
    for rate in [24.0, 45.0, 60.0, 64.0, 75.0, 144.0, 1000.0] {
        let mut clocks = Clocks::new();
        let mut motions = Vec::new();
        for _ in 0..(2.0 * rate) as u32 {
            motions.extend(clocks.frame(1.0 / rate, drives, rests));
        }
        // Extrapolation needs two frames: the first motions are left out.
        let settled = &motions[motions.len() / 4..];
        for motion in settled {
            assert!(
                (motion - SPEED * TICK as f32).abs() < ROUNDING,
                "{motion} m in a tick at {rate} Hz"
            );
        }
    }
}

#[test]
fn a_motion_in_fixed_update_is_taken_as_it_is() {
    let mut clocks = Clocks::new();
    for frame in 0..120 {
        for motion in clocks.frame(1.0 / 50.0, rests, drives) {
            if frame > 2 {
                assert!((motion - SPEED * TICK as f32).abs() < ROUNDING, "{motion}");
            }
        }
        if clocks.last.ticks > 0 {
            assert_eq!(clocks.history.end(), clocks.pose);
        }
    }
}

#[test]
fn an_entity_that_is_new_and_moves_gives_its_velocity_and_no_jerk() {
    for (rate, in_update) in [(64.0, false), (24.0, true), (60.0, true), (144.0, true)] {
        let mut clocks = Clocks::new();
        let mut motions = Vec::new();
        for _ in 0..128 {
            motions.extend(if in_update {
                clocks.frame(1.0 / rate, drives, rests)
            } else {
                clocks.frame(1.0 / rate, rests, drives)
            });
        }
        let begin = 1 + motions.iter().position(|&motion| motion != 0.0).expect("followed");
        let [(tick, launch)] = clocks.launches[..] else { panic!("{:?}", clocks.launches) };
        assert_eq!(tick as usize, begin, "at {rate} Hz");
        assert!((launch.x - SPEED).abs() < 0.1, "{launch} at {rate} Hz");
    }
}

#[test]
fn a_motion_faster_than_a_teleport_is_followed_after_its_first_change() {
    const FAST: f32 = 40.0;
    // It rests for a second, and is fast from one frame to the next.
    let flies = |time: f64| Some(at(FAST * (time - 1.0).max(0.0) as f32));
    for in_update in [false, true] {
        let mut clocks = Clocks::new();
        let mut motions = Vec::new();
        for _ in 0..128 {
            motions.extend(if in_update {
                clocks.frame(TICK, flies, rests)
            } else {
                clocks.frame(TICK, rests, flies)
            });
        }
        let way = FAST * TICK as f32;
        let moving = motions.iter().filter(|&&motion| motion != 0.0);
        assert!(moving.clone().count() > 60, "followed: {in_update}");
        assert!(moving.clone().all(|motion| (motion - way).abs() < 1e-4), "{motions:?}");
        let [(_, launch)] = clocks.launches[..] else { panic!("{:?}", clocks.launches) };
        assert!(launch.distance(FAST * Vec3::X) < 1e-2, "{launch}");
    }
}

#[test]
fn two_teleports_by_different_ways_are_no_motion() {
    let jumps = |time: f64| Some(at([0.0, 1.0, -3.0, -1.0][((time * 4.0) as usize).min(3)]));
    let mut clocks = Clocks::new();
    for _ in 0..64 {
        for motion in clocks.frame(TICK, rests, jumps) {
            assert_eq!(motion, 0.0);
        }
    }
    assert_eq!(clocks.launches, []);
}

#[test]
fn uneven_frames_make_an_almost_steady_motion() {
    let mut clocks = Clocks::new();
    let mut motions = Vec::new();
    for frame in 0..240 {
        let seconds = if frame % 3 == 0 { 0.021 } else { 0.014 };
        motions.extend(clocks.frame(seconds, drives, rests));
    }
    for motion in &motions[60..] {
        let error = (motion / (SPEED * TICK as f32) - 1.0).abs();
        assert!(error < 0.11, "{motion}");
    }
}

#[test]
fn an_entity_at_rest_has_exactly_no_motion() {
    let mut clocks = Clocks::new();
    clocks.pose = Isometry3d::new(Vec3::new(1.1, 2.2, 3.3), Quat::from_rotation_y(0.7));
    for _ in 0..100 {
        clocks.frame(1.0 / 60.0, rests, rests);
        assert_eq!(clocks.history.start(), clocks.history.end());
    }
}

#[test]
fn a_teleport_gives_no_motion() {
    for in_update in [true, false] {
        let mut clocks = Clocks::new();
        for frame in 0..60 {
            let jump = move |_| Some(at(if frame >= 30 { 50.0 } else { 0.0 }));
            let motions = if in_update {
                clocks.frame(1.0 / 60.0, jump, rests)
            } else {
                clocks.frame(1.0 / 60.0, rests, jump)
            };
            assert!(motions.iter().all(|&motion| motion == 0.0), "{motions:?} in frame {frame}");
        }
        assert_eq!(clocks.history.end(), at(50.0));
    }
}

#[test]
fn a_teleport_keeps_the_motion() {
    for in_update in [true, false] {
        let mut clocks = Clocks::new();
        let mut motions = Vec::new();
        let course = |time: f64| {
            let along = SPEED * time as f32;
            Some(if time < 1.0 {
                at(along)
            } else {
                // A turn, followed by motion along the turned x axis.
                Isometry3d::new(
                    Vec3::new(0.0, 0.0, -along),
                    Quat::from_rotation_y(core::f32::consts::FRAC_PI_2),
                )
            })
        };
        for _ in 0..120 {
            motions.extend(if in_update {
                clocks.frame(1.0 / 60.0, course, rests)
            } else {
                clocks.frame(1.0 / 60.0, rests, course)
            });
        }
        for motion in &motions[20..] {
            assert!((motion - SPEED * TICK as f32).abs() < 10.0 * ROUNDING, "{motion} {in_update}");
        }
    }
}

#[test]
fn a_requested_teleport_may_be_small() {
    let mut clocks = Clocks::new();
    for _ in 0..30 {
        clocks.frame(1.0 / 60.0, rests, rests);
    }
    clocks.history.teleport_next(&clocks.last);
    for _ in 0..30 {
        let motions = clocks.frame(1.0 / 60.0, |_| Some(at(1.0)), rests);
        assert!(motions.iter().all(|&motion| motion == 0.0), "{motions:?}");
    }
    assert_eq!(clocks.history.end(), at(1.0));
}
