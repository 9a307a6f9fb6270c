//! A thousand flags in one steady wind, and in a gusty one with ten regions: a program that compares the times of the sets
//! `Prepare` and `Drive`, which the winds are part of.
//!
//! ```sh
//! cargo run --release -p bunting_lab --example wind_ticks -- TICKS
//! ```

use anyhow::{Context, Result, bail};
use bevy_app::App;
use bevy_bunting::{
    Attachment, ClothEdge, ClothMesh, ClothSystems, ClothTimings, LodSet, WindField, WindRegion,
};
use bevy_transform::components::Transform;
use bunting_lab::{game, settings::steps_of_levels};
use glam::Vec3;

/// Updates before anything is measured.
const WARM_UP: usize = 30;

/// Flags along each edge of the field, and their distance, m.
const FLAGS: u32 = 32;
const SPACING: f32 = 3.0;

/// Regions.
const REGIONS: u32 = 10;

/// The air of an app.
#[derive(Clone, Copy, Debug)]
enum Winds {
    /// None: one steady wind.
    Uniform,
    /// Gusts, and regions of 15 m about the field.
    Spread,
    /// Gusts, and regions in whose falloff all flags are.
    Falloff,
    /// Gusts, and gusty regions in whose falloff all flags are.
    Gusty,
}

fn app(winds: Winds) -> App {
    let mut app = game::app_in_still_air(steps_of_levels());
    let world = app.world_mut();
    for flag in 0..1000 {
        let (column, row) = (flag % FLAGS, flag / FLAGS);
        let at = SPACING * Vec3::new(column as f32, 0.0, row as f32);
        world.spawn((
            ClothMesh::grid(5, 4, 1.0, 0.7),
            Attachment::in_place(ClothEdge::Left),
            LodSet { pinned: Some(0), ..LodSet::default() },
            Transform::from_translation(at),
        ));
    }
    let breeze = WindField::steady(5.0 * Vec3::X);
    if matches!(winds, Winds::Uniform) {
        world.spawn(breeze);
        return app;
    }
    world.spawn(breeze.with_gusts(2.0, 0.5, 1));
    let middle = 0.5 * SPACING * FLAGS as f32;
    for region in 0..REGIONS {
        let (bounds, at) = match winds {
            Winds::Uniform | Winds::Spread => {
                let part = region as f32 / REGIONS as f32;
                (WindRegion::ball(15.0, 3.0), Vec3::new(2.0 * middle * part, 0.0, middle))
            }
            Winds::Falloff | Winds::Gusty => {
                (WindRegion::ball(300.0, 300.0), middle * Vec3::new(1.0, 0.0, 1.0))
            }
        };
        let air = WindField::steady(0.5 * Vec3::Z);
        let gusty = matches!(winds, Winds::Gusty);
        let air = if gusty { air.with_gusts(0.5, 0.5, 2 + region as i32) } else { air };
        world.spawn((air, bounds, Transform::from_translation(at)));
    }
    app
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [ticks] = &arguments[..] else { bail!("TICKS") };
    let ticks: usize = ticks.parse().context("TICKS")?;
    let all = [Winds::Uniform, Winds::Spread, Winds::Falloff, Winds::Gusty];
    let mut apps = all.map(app);
    for app in &mut apps {
        (0..WARM_UP).for_each(|_| app.update());
    }
    let times = game::time_in_turn(&mut apps, ticks, |app| {
        let timings = app.world().resource::<ClothTimings>();
        let sets = [ClothSystems::Prepare, ClothSystems::Drive];
        sets.map(|set| timings.of(set).as_secs_f64() * 1e3).iter().sum()
    });
    for (winds, times) in all.iter().zip(&times) {
        println!("{winds:?}: least {:.4} ms, median {:.4} ms", times.min(), times.median());
    }
    Ok(())
}
