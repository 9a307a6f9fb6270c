//! The times at which poses are observed.

use bevy_ecs::prelude::*;
use bevy_time::{Time, Virtual};

/// Time constants with which the mean and the longest length of frames are averaged, s. Smaller: uneven
/// frames change the delay, and so shake the cloth.
const MEAN_TIME: f64 = 0.5;
const LONGEST_TIME: f64 = 2.0;

/// Ratio of a frame's length to the mean above which the frame is a hitch, which does not change the delay.
const HITCH: f64 = 1.5;

/// Times of the last observation of any entity that was not at rest. An entity at rest would have been
/// observed at the same times.
#[derive(Resource, Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ObservationTimes {
    /// Time of the last frame, s.
    pub frame: f64,
    /// Mean length of frames, s.
    pub mean_frame: f64,
    /// Length of the longest frames other than hitches, s.
    pub longest_frame: f64,
    /// End of the last tick, s.
    pub tick: f64,
    /// Number of ticks so far.
    pub ticks: u32,
    /// Number of ticks up to the last frame.
    pub ticks_to_frame: u32,
    /// Whether no time passes in this frame.
    pub stands: bool,
    /// Whether no time passes in this frame, and did in the last one.
    pub begins_to_stand: bool,
    /// Whether time passes in this frame, and did not in the last one.
    pub resumes: bool,
}

impl ObservationTimes {
    /// The times of a tick that ends at a time (s).
    pub fn in_tick(&self, end: f64) -> Self {
        Self { tick: end, ticks: self.ticks.wrapping_add(1), ..*self }
    }

    /// These times on another clock, given the last observation on that: the last tick on it is the last one here.
    pub fn on_clock_of(self, other: &Self) -> Self {
        let in_frame = self.ticks.wrapping_sub(self.ticks_to_frame);
        Self {
            frame: self.frame + (other.tick - self.tick),
            tick: other.tick,
            ticks: other.ticks,
            ticks_to_frame: other.ticks.wrapping_sub(in_frame),
            ..self
        }
    }

    /// Whether a tick has run in this frame.
    pub fn has_ticked(&self) -> bool {
        self.ticks != self.ticks_to_frame
    }

    /// Notes the end of a frame at a time (s).
    pub fn end_frame(&mut self, time: f64) {
        self.frame = time;
        self.ticks_to_frame = self.ticks;
    }

    /// Notes the length of a frame, s.
    pub fn note_frame(&mut self, length: f64) {
        let stood = self.stands;
        self.stands = length <= 0.0;
        self.begins_to_stand = self.stands && !stood;
        self.resumes = stood && !self.stands;
        if self.stands {
            return;
        }
        if self.mean_frame == 0.0 {
            (self.mean_frame, self.longest_frame) = (length, length);
        }
        self.mean_frame += (length - self.mean_frame) * (length / MEAN_TIME).min(1.0);
        let excess = self.longest_frame - self.mean_frame;
        let decayed = self.longest_frame - excess * (length / LONGEST_TIME).min(1.0);
        self.longest_frame = decayed.max(length.min(HITCH * self.mean_frame));
    }
}

/// Notes the beginning of a frame.
pub(crate) fn begin_frame(time: Res<Time<Virtual>>, mut times: ResMut<ObservationTimes>) {
    times.note_frame(time.delta_secs_f64());
}
