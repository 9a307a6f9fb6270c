//! Pose histories of entities that any schedule moves, at any rate of frames and of ticks, or while no time passes.

use bevy_math::{Isometry3d, Vec3};

use super::PoseHistory;
use crate::motion::observation_times::ObservationTimes;
use crate::motion::track::LEAST_INTERVAL;

/// Change of velocity above which a change of pose is a teleport, m/s.
const LIMIT: f32 = 25.0;

/// Error of a motion as a part of it: rounding some tens of metres from the origin.
const ROUNDING: f32 = 1e-3;

/// The schedule that moves the entity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Schedule {
    /// `First`, `PreUpdate`, or before the fixed loop.
    Early,
    /// `FixedFirst` to `FixedUpdate`.
    InTick,
    /// `FixedPostUpdate` after the cloth's tick, or `FixedLast`.
    AfterTick,
    /// `Update`, or `PostUpdate` before transforms are propagated.
    Late,
    /// After the propagation of transforms.
    Last,
}

impl Schedule {
    fn is_in_ticks(self) -> bool {
        matches!(self, Self::InTick | Self::AfterTick)
    }
}

const SCHEDULES: [Schedule; 5] =
    [Schedule::Early, Schedule::InTick, Schedule::AfterTick, Schedule::Late, Schedule::Last];

/// Rates of frames and of ticks, Hz.
const RATES: [[f64; 2]; 9] = [
    [30.0, 64.0],
    [60.0, 64.0],
    [64.0, 64.0],
    [144.0, 64.0],
    [240.0, 64.0],
    [30.0, 60.0],
    [60.0, 60.0],
    [144.0, 60.0],
    [240.0, 60.0],
];

/// Speeds on both sides of the limit, m/s.
const SPEEDS: [f32; 4] = [20.0, 26.0, 40.0, 60.0];

/// A tick, as the cloth sees it.
#[derive(Clone, Copy, Debug)]
struct Tick {
    /// End, s.
    time: f64,
    /// Motion along x, m.
    motion: f32,
    /// Velocity along x, m/s, that the cloth is given.
    launch: f32,
}

/// An app's clocks, with an entity that a schedule moves along x.
struct Ride {
    schedule: Schedule,
    tick: f64,
    history: PoseHistory,
    last: ObservationTimes,
    now: f64,
    pose: Isometry3d,
    seen: Vec<Tick>,
}

impl Ride {
    fn new(schedule: Schedule, tick: f64) -> Self {
        Self {
            schedule,
            tick,
            history: PoseHistory::default(),
            last: ObservationTimes::default(),
            now: 0.0,
            pose: Isometry3d::IDENTITY,
            seen: Vec::new(),
        }
    }

    /// Places the entity if it is the turn of its schedule.
    fn place(&mut self, schedule: Schedule, x: f32) {
        if schedule == self.schedule {
            self.pose = Isometry3d::from_translation(Vec3::X * x);
        }
    }

    /// Runs a frame in which the entity moves along a course (x in m, at a time).
    fn frame(&mut self, seconds: f64, course: impl Fn(f64) -> f32) {
        self.now += seconds;
        self.last.note_frame(seconds);
        self.place(Schedule::Early, course(self.now));
        self.history.observe_frame(&self.last, self.now, self.pose, LIMIT, true);
        while f64::from(self.last.ticks + 1) * self.tick <= self.now {
            let time = f64::from(self.last.ticks + 1) * self.tick;
            self.place(Schedule::InTick, course(time));
            let next = self.last.in_tick(time);
            self.history.observe_tick(&self.last, &next, self.tick, self.pose, LIMIT);
            self.last = next;
            let motion = self.history.motion().translation.x;
            let launch = self.history.launch().map_or(0.0, |by| by.x);
            self.seen.push(Tick { time, motion, launch });
            self.place(Schedule::AfterTick, course(time));
        }
        self.history.observe_end_of_ticks(&self.last, self.pose);
        self.place(Schedule::Late, course(self.now));
        self.history.observe_frame(&self.last, self.now, self.pose, LIMIT, false);
        self.last.end_frame(self.now);
        self.place(Schedule::Last, course(self.now));
    }

    /// Runs some seconds at a rate of frames (Hz), and returns the way that the cloth has gone so far, m.
    fn run(&mut self, seconds: f64, rate: f64, course: impl Fn(f64) -> f32) -> f32 {
        (0..(seconds * rate) as u32).for_each(|_| self.frame(1.0 / rate, &course));
        self.seen.iter().map(|tick| tick.motion).sum()
    }

    /// Velocities that the cloth was given, m/s.
    fn launches(&self) -> Vec<f32> {
        self.seen.iter().map(|tick| tick.launch).filter(|launch| *launch != 0.0).collect()
    }
}

/// All schedules and rates.
fn all() -> impl Iterator<Item = (Schedule, [f64; 2])> {
    RATES.into_iter().flat_map(|rates| SCHEDULES.map(|schedule| (schedule, rates)))
}

#[test]
fn every_schedule_gives_a_steady_motion_at_any_speed() {
    for (schedule, [frames, ticks]) in all() {
        for speed in SPEEDS {
            let case = format!("{schedule:?} at {frames} / {ticks} Hz, {speed} m/s");
            let mut ride = Ride::new(schedule, 1.0 / ticks);
            let way = ride.run(4.0, frames, |time| speed * (time - 1.0).clamp(0.0, 2.0) as f32);
            let even = speed / ticks as f32;
            for tick in &ride.seen {
                assert!(tick.motion < even * (1.0 + ROUNDING), "{tick:?}: {case}");
                let is_under_way = tick.time > 1.25 && tick.time < 3.0;
                assert!(!is_under_way || tick.motion > even * (1.0 - ROUNDING), "{tick:?}: {case}");
                assert!(tick.time < 3.25 || tick.motion == 0.0, "{tick:?}: {case}");
            }
            // The first change of a fast motion is taken for a teleport.
            let first = 1.0 / if schedule.is_in_ticks() { ticks } else { frames } as f32;
            assert!(way > speed * (2.0 - first - ROUNDING), "{way} m: {case}");
            let launches = ride.launches();
            let is_launched = launches.len() == 1 && (launches[0] / speed - 1.0).abs() < ROUNDING;
            assert!(launches.is_empty() || is_launched, "{launches:?}: {case}");
            let is_far = speed * first > LIMIT * first.max(LEAST_INTERVAL as f32);
            assert_eq!(is_launched, is_far, "{case}");
        }
    }
}

#[test]
fn a_single_jump_is_a_teleport_in_every_schedule() {
    for (schedule, [frames, ticks]) in all() {
        for (speed, jump) in [0.0, 20.0, 40.0, 60.0]
            .into_iter()
            .flat_map(|it| [1.2, 5.0, -5.0, 1e3].map(|by| (it, by)))
        {
            let case = format!("{schedule:?} at {frames} / {ticks} Hz, {speed} m/s, {jump} m");
            let mut ride = Ride::new(schedule, 1.0 / ticks);
            let course = |time: f64| speed * (time - 1.0).max(0.0) as f32;
            let before = ride.run(2.0, frames, course);
            let launches = ride.launches();
            let after = ride.run(1.0, frames, |time| jump + course(time));
            // A second has a tick more or less; a place at 1 km has a rounding error of a tenth of a millimetre.
            let error = after - before - speed;
            assert!(error.abs() < speed / ticks as f32 + 0.02, "{error} m: {case}");
            assert_eq!(ride.launches(), launches, "{case}");
        }
    }
}

#[test]
fn what_moves_while_no_time_passes_is_a_teleport_of_any_length() {
    for (schedule, [frames, ticks]) in all() {
        for (speed, way) in
            [0.0, 5.0, 40.0].into_iter().flat_map(|it| [0.01, 0.3, 5.0].map(|way| (it, way)))
        {
            let case = format!("{schedule:?} at {frames} / {ticks} Hz, {speed} m/s, {way} m");
            // The ticks of fixed schedules do not run in the pause: something else moves the entity.
            for mover in [Schedule::Early, Schedule::Late, Schedule::Last] {
                let mut ride = Ride::new(schedule, 1.0 / ticks);
                let course = |time: f64| speed * (time - 1.0).max(0.0) as f32;
                let before = ride.run(2.0, frames, course);
                let launches = ride.launches();
                for frame in 0_u8..30 {
                    let moved = ride.pose.translation.x + way;
                    ride.schedule = if frame == 20 { mover } else { schedule };
                    let x = if frame == 20 { moved } else { ride.pose.translation.x };
                    ride.frame(0.0, |_| x);
                }
                ride.schedule = schedule;
                let after = ride.run(1.0, frames, |time| way + course(time));
                let error = after - before - speed;
                assert!(error.abs() < speed / ticks as f32 + 1e-3, "{error} m: {case}");
                assert_eq!(ride.launches(), launches, "{case}");
            }
        }
    }
}

#[test]
fn what_moved_just_before_time_goes_on_is_a_teleport() {
    for (schedule, [frames, ticks]) in all() {
        let case = format!("{schedule:?} at {frames} / {ticks} Hz");
        let mut ride = Ride::new(schedule, 1.0 / ticks);
        ride.run(1.0, frames, |_| 0.0);
        (0..5).for_each(|_| ride.frame(0.0, |_| 0.0));
        // Between two frames, after the last one of the pause.
        ride.pose = Isometry3d::from_translation(0.3 * Vec3::X);
        let way = ride.run(1.0, frames, |_| 0.3);
        assert_eq!(way, 0.0, "{case}");
    }
}
