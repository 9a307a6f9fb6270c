//! The way of a figure.

use std::f32::consts::TAU;

use bevy::prelude::*;

use crate::figure::walker::Walker;

/// What a figure does at which times. Each change has the time at which it begins, s, its duration, s, and what it adds.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Way {
    /// Changes of speed, m/s.
    pub speed: &'static [[f32; 3]],
    /// Turns to the left, rad.
    pub turns: &'static [[f32; 3]],
    /// Changes between standing, 0, and sitting, 1.
    pub sits: &'static [[f32; 3]],
}

impl Way {
    /// The way that lies behind a figure that has come to rest after all of the changes of speed, m.
    pub fn length(&self) -> f32 {
        // A smooth change adds half of its speed while it lasts, and all of it later. The time at which all is over cancels.
        -self.speed.iter().map(|[begin, duration, by]| by * (begin + 0.5 * duration)).sum::<f32>()
    }
}

/// The sum of changes up to a time, each smooth.
fn sum(changes: &[[f32; 3]], time: f32) -> f32 {
    let part = |&[begin, duration, by]: &[f32; 3]| {
        let part = ((time - begin) / duration).clamp(0.0, 1.0);
        by * part * part * (3.0 - 2.0 * part)
    };
    changes.iter().map(part).sum()
}

/// Moves the figure along its way.
pub fn go(mut figure: Single<(&mut Walker, &mut Transform)>, way: Res<Way>, time: Res<Time>) {
    let (now, tick) = (time.elapsed_secs(), time.delta_secs());
    let speed = sum(way.speed, now);
    let heading = Quat::from_rotation_y(sum(way.turns, now));
    let (walker, place) = &mut *figure;
    // Longer steps at higher speed.
    let stride = 0.9 + 0.45 * speed;
    walker.speed = speed;
    walker.sit = sum(way.sits, now);
    walker.phase = (walker.phase + TAU * speed / stride * tick) % TAU;
    place.translation += heading * Vec3::NEG_Z * (speed * tick);
    place.rotation = heading;
}
