//! Impossible winds: they are left out or limited, and change no bit of other cloths.

use std::time::Instant;

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;
use glam::Vec3;

use crate::{contacts::Row, game, product::DEFAULT};

/// Place of the cloth that a wind with a place hits, m.
const HIT: Vec3 = Vec3::new(60.0, 0.0, 0.0);

/// Ticks that are simulated.
const TICKS: usize = 120;

/// Number of failures of cloths that were reported. That the wind fails is right.
#[derive(Resource, Default)]
struct Failures(usize);

fn count_failure(
    failed: On<ClothFailed>,
    cloths: Query<(), With<ClothMesh>>,
    mut failures: ResMut<Failures>,
) {
    failures.0 += usize::from(cloths.contains(failed.entity));
}

/// Two flags, one of them in the way of a wind.
struct Flags {
    app: App,
    other: Entity,
    hit: Entity,
    us: f64,
}

impl Flags {
    fn in_wind(wind: impl FnOnce(&mut World)) -> Self {
        let mut app = game::app_in_still_air([DEFAULT]);
        app.init_resource::<Failures>().add_observer(count_failure);
        let [other, hit] =
            [Vec3::ZERO, HIT].map(|at| game::spawn_flag(&mut app, 17, at, LodSet::default()));
        wind(app.world_mut());
        let start = Instant::now();
        (0..TICKS).for_each(|_| app.update());
        let us = 1e6 * start.elapsed().as_secs_f64() / TICKS as f64;
        Self { app, other, hit, us }
    }

    fn positions(&self, flag: Entity) -> Vec<Vec3> {
        self.app.world().get::<ClothState>(flag).expect("a cloth").positions().to_vec()
    }

    /// Number of cloths that failed or are not finite, and of particles of the other flag that are not where they would
    /// be without the wind.
    fn harm(&self, calm: &Self) -> f64 {
        let failures = self.app.world().resource::<Failures>().0;
        let broken = self.positions(self.hit).iter().filter(|at| !at.is_finite()).count();
        let (with, without) = (self.positions(self.other), calm.positions(calm.other));
        let moved = with.iter().zip(&without).filter(|(a, b)| a != b).count();
        (failures + broken + moved) as f64
    }
}

pub(super) fn rows(_quick: bool) -> Vec<Row> {
    let calm = Flags::in_wind(|_| {});
    let row = |name: &str, wind: &dyn Fn(&mut World)| {
        let flags = Flags::in_wind(wind);
        let quantity = "failures, and particles of another flag that moved";
        Row::new(format!("impossible wind, {name}"), quantity, flags.harm(&calm), 0.0, flags.us)
    };
    let here = Transform::from_translation(HIT);
    vec![
        row("not a number everywhere", &|world| {
            world.spawn(WindField::steady(Vec3::splat(f32::NAN)).with_gusts(1.0, 0.5, 1));
        }),
        row("10⁶ m/s in a region", &|world| {
            world.spawn((WindField::steady(Vec3::Z * 1e6), WindRegion::ball(9.0, 1.0), here));
        }),
        row("10⁶ m/s of a fan", &|world| {
            world.spawn((WindFan::new(1e6, 0.3), here));
        }),
        row("not a number of a blast", &|world| {
            world.spawn((WindBlast::new(f32::NAN, 1.0), here));
        }),
    ]
}
