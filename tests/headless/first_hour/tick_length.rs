//! Item 11: long ticks are solved as finely as short ones.

use bevy_bunting::prelude::*;
use bevy_math::Vec3;
use bevy_time::{Fixed, Time};
use bunting_tests::{app_at, run};

use super::strain;

/// Mean strain of a flag in wind, with ticks of the given length (s).
fn mean_strain(tick: f64) -> f32 {
    let mut app = app_at(std::time::Duration::from_secs_f64(tick));
    app.insert_resource(Time::<Fixed>::from_seconds(tick));
    app.world_mut().spawn(WindField::steady(Vec3::new(6.0, 0.0, 2.0)).with_gusts(2.0, 0.5, 1));
    let held = Attachment::in_place(ClothEdge::Left);
    let flag = app.world_mut().spawn((ClothMesh::grid(33, 23, 1.5, 1.0), held)).id();
    run(&mut app, (4.0 / tick) as usize);
    let ticks = (4.0 / tick) as usize;
    let strains = (0..ticks).map(|_| {
        app.update();
        strain(&app, flag).mean
    });
    strains.sum::<f32>() / ticks as f32
}

#[test]
fn long_ticks_do_not_stretch_the_cloth() {
    let short = mean_strain(1.0 / 64.0);
    for tick in [1.0 / 30.0, 1.0 / 20.0, 1.0 / 10.0] {
        let long = mean_strain(tick);
        assert!(long < 2.0 * short + 1e-3, "ticks of {tick} s: {long}, of 1/64 s: {short}");
    }
}
