//! Impulses: free cloth gains the momentum that it is given, and keeps it.

use std::time::{Duration, Instant};

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::{entity::Entity, system::RunSystemOnce};
use bevy_time::{Fixed, Time, TimeUpdateStrategy};
use bevy_transform::components::Transform;
use glam::{DVec3, Quat, Vec3};

use crate::{contacts::Row, game, product::DEFAULT};

/// Cotton that loses no momentum.
const UNDAMPED: FabricMaterial =
    FabricMaterial { damping: 0.0, internal_damping: 0.0, ..FabricMaterial::COTTON };

/// The momentum that is given, kg m/s.
const GIVEN: Vec3 = Vec3::new(0.3, -0.2, 0.5);

/// Greatest error of the momentum, of one.
const LIMIT: f64 = 1e-5;

/// Ticks after the impulse in which the momentum is compared. In a second, rounding changes that of a sheet full of waves
/// by as much as the limit, with and without an impulse.
const TICKS: usize = 10;

/// Free sheets of the given sizes, in empty space, one beside the other in turned frames.
fn free_sheets(sizes: &[u32]) -> (App, Vec<Entity>) {
    let mut app = game::app_in_still_air([DEFAULT]);
    let mut settings = app.world_mut().resource_mut::<ClothSettings>();
    settings.gravity = Vec3::ZERO;
    settings.air_density = 0.0;
    let sheets = (0_u8..).zip(sizes).map(|(index, &n)| {
        let turned = Quat::from_rotation_y(0.7 * f32::from(index));
        let pose = Transform::from_xyz(0.4 * f32::from(index), 1.0, 0.0).with_rotation(turned);
        let mesh = ClothMesh::grid(n, n, 1.0, 1.0);
        app.world_mut().spawn((mesh, ClothMaterial(UNDAMPED), pose)).id()
    });
    let sheets = sheets.collect();
    (app, sheets)
}

/// Sums over the particles of some cloths along the world's axes.
#[derive(Clone, Copy, Default)]
struct Sums {
    /// Mass, kg.
    mass: f64,
    /// Mass times position, kg m.
    moment: DVec3,
    /// Momentum, kg m/s.
    momentum: DVec3,
}

fn sums(app: &mut App, cloths: &[Entity]) -> Sums {
    let cloths = cloths.to_vec();
    let sum = move |mut control: ClothControl| {
        let mut sums = Sums::default();
        for &cloth in &cloths {
            let added = control.edit(cloth, |cloth| {
                let areas = cloth.fabric().particle_areas().to_vec();
                for (particle, area) in areas.into_iter().enumerate() {
                    let mass = f64::from(area) * f64::from(UNDAMPED.area_density);
                    let frame = cloth.frame();
                    let [at, velocity] = [cloth.position(particle)?, cloth.velocity(particle)?]
                        .map(|vector| frame.rotation.as_dquat() * vector.as_dvec3());
                    sums.mass += mass;
                    sums.moment += (at + Vec3::from(frame.translation).as_dvec3()) * mass;
                    sums.momentum += velocity * mass;
                }
                Ok(())
            });
            added.expect("the cloth is simulated");
        }
        sums
    };
    app.world_mut().run_system_once(sum).expect("the system runs")
}

/// Rows of sheets of the given sizes that share a momentum while they move, in ticks of one length or of several.
fn both(name: &str, sizes: &[u32], lengths: [f32; 2]) -> [Row; 2] {
    let (mut app, sheets) = free_sheets(sizes);
    let start = Instant::now();
    let mut ticks = 0_usize;
    let mut run = |app: &mut App, count: usize| {
        let mut seconds = 0.0;
        for _ in 0..count {
            let length = Duration::from_secs_f32(lengths[ticks % 2]);
            app.world_mut().resource_mut::<Time<Fixed>>().set_timestep(length);
            app.insert_resource(TimeUpdateStrategy::ManualDuration(length));
            app.update();
            ticks += 1;
            seconds += length.as_secs_f64();
        }
        seconds
    };
    run(&mut app, 3);
    // Waves within the sheet.
    app.world_mut().trigger(ClothImpulse::velocity(Vec3::Y, 0.5, Vec3::new(1.0, 0.5, -2.0)));
    run(&mut app, 20);
    let before = sums(&mut app, &sheets);
    app.world_mut().trigger(ClothImpulse::momentum(Vec3::new(0.2, 0.8, 0.0), 0.6, GIVEN));
    let given = GIVEN.as_dvec3();
    let (mut of_momentum, mut of_way, mut seconds) = (0.0_f64, 0.0_f64, 0.0);
    for _ in 0..TICKS {
        seconds += run(&mut app, 1);
        let now = sums(&mut app, &sheets);
        let gained = now.momentum - before.momentum;
        of_momentum = of_momentum.max(gained.distance(given) / given.length());
        let gone = (now.moment - before.moment) / seconds - before.momentum;
        of_way = of_way.max(gone.distance(given) / given.length());
    }
    let us = 1e6 * start.elapsed().as_secs_f64() / ticks as f64;
    let name = format!("impulse, {name}");
    let way = format!("{name}, way");
    [
        Row::new(name, "error of the momentum, of one", of_momentum, LIMIT, us),
        Row::new(way, "error of the way of the centre, of one", of_way, LIMIT, us),
    ]
}

pub(super) fn rows(_quick: bool) -> Vec<Row> {
    const TICK: [f32; 2] = [1.0 / 60.0; 2];
    let all = [
        both("one sheet", &[17], TICK),
        both("three sheets", &[9, 9, 17], TICK),
        both("uneven ticks", &[17], [1.0 / 60.0, 1.0 / 80.0]),
    ];
    all.into_iter().flatten().collect()
}
