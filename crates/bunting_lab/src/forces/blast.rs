//! Blasts: when the front arrives, and how far the air moves whatever the tick is.

use std::time::{Duration, Instant};

use bevy_app::App;
use bevy_bunting::{TickWind, WindBlast};
use bevy_time::{Fixed, Time, TimeUpdateStrategy};
use glam::Vec3;

use crate::{contacts::Row, game, product::DEFAULT};

const BLAST: WindBlast = WindBlast { front_speed: 100.0, ..WindBlast::new(30.0, 4.0) };

/// An app with a blast at the origin that begins with the next tick, of a length in s.
fn blast(tick: f32) -> App {
    let mut app = game::app_in_still_air([DEFAULT]);
    let length = Duration::from_secs_f32(tick);
    app.world_mut().resource_mut::<Time<Fixed>>().set_timestep(length);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(length));
    app.update();
    app.world_mut().spawn(BLAST);
    app
}

/// The air at a distance along x, m/s, in each tick of a number of ticks.
fn air(tick: f32, ticks: usize, distances: &[f32]) -> Vec<Vec<f32>> {
    let mut app = blast(tick);
    let sample = |_| {
        app.update();
        let wind = app.world().resource::<TickWind>();
        distances.iter().map(|&distance| wind.at(Vec3::X * distance).x).collect()
    };
    (0..ticks).map(sample).collect()
}

pub(super) fn rows(_quick: bool) -> Vec<Row> {
    vec![arrival(), flow()]
}

/// Row of the number of ticks by which the front is early or late.
fn arrival() -> Row {
    const TICK: f32 = 1.0 / 60.0;
    let distances = [3.0, 11.0, 29.0, 57.0, 120.5];
    let start = Instant::now();
    let air = air(TICK, 120, &distances);
    let us = 1e6 * start.elapsed().as_secs_f64() / 120.0;
    let error = |(index, distance): (usize, &f32)| {
        let arrived = air.iter().position(|of_tick| of_tick[index] != 0.0);
        let due = f64::from((distance / BLAST.front_speed / TICK).floor());
        arrived.map_or(f64::INFINITY, |tick| (tick as f64 - due).abs())
    };
    let worst = distances.iter().enumerate().map(error).fold(0.0, f64::max);
    Row::new("blast, arrival of the front", "ticks early or late", worst, 0.0, us)
}

/// Row of the way of the air up to a time, in short and long ticks, compared with the closed form.
fn flow() -> Row {
    const DISTANCE: f32 = 10.0;
    const SECONDS: f32 = 0.25;
    let start = Instant::now();
    let time = (SECONDS - BLAST.arrival(DISTANCE)) / BLAST.duration;
    let peak = BLAST.speed * BLAST.radius / DISTANCE;
    let expected = f64::from(peak * BLAST.duration * time) * f64::from(-time).exp();
    let mut ticks = 0;
    let error = |rate: f32| {
        let count = (SECONDS * rate) as usize;
        ticks += count;
        let air = air(1.0 / rate, count, &[DISTANCE]);
        let way: f64 = air.iter().map(|of_tick| f64::from(of_tick[0] / rate)).sum();
        (way / expected - 1.0).abs()
    };
    let worst = [20.0, 60.0, 240.0].map(error).into_iter().fold(0.0, f64::max);
    let us = 1e6 * start.elapsed().as_secs_f64() / ticks as f64;
    Row::new("blast, way of the air", "error at 20, 60 and 240 Hz, of one", worst, 1e-3, us)
}
