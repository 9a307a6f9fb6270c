//! Collects everything that moves the air in a tick.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::Time;

use crate::environment::wind::blast::WindBlast;
use crate::environment::wind::fan::WindFan;
use crate::environment::wind::field::{GustTravel, MovingAir, WindField};
use crate::environment::wind::influence::{WindInfluence, report_influences};
use crate::environment::wind::places::Frame;
use crate::environment::wind::region::{WindRegion, WindShape};
use crate::environment::wind::report::{report_regions, report_winds};
use crate::environment::wind::shift::shift_winds;
use crate::environment::wind::tick_wind::{LocalAir, TickWind};
use crate::environment::wind::wake::{WakeTrail, WindWake};
use crate::motion::observe::observe_ticks;
use crate::motion::pose::PoseHistory;
use crate::schedule::{ClothSystems, ClothTick};

/// Sums up the winds in each tick.
#[derive(Debug, Default)]
pub struct WindPlugin;

impl Plugin for WindPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<WindField>()
            .register_type::<GustTravel>()
            .register_type::<WindRegion>()
            .register_type::<WindShape>()
            .register_type::<WindFan>()
            .register_type::<WindBlast>()
            .register_type::<WindWake>()
            .register_type::<WakeTrail>()
            .register_type::<WindInfluence>()
            .register_type::<TickWind>()
            .init_resource::<TickWind>()
            .add_observer(shift_winds)
            .add_systems(
                ClothTick,
                (
                    (collect_fields, collect_fans, collect_blasts, collect_wakes).chain(),
                    (report_winds, report_regions).before(collect_fields),
                    report_influences,
                )
                    .in_set(ClothSystems::Prepare)
                    .after(observe_ticks),
            );
    }
}

type Region = (&'static WindRegion, &'static PoseHistory);

fn collect_fields(
    mut fields: Query<(&WindField, &mut GustTravel, Option<Region>)>,
    time: Res<Time>,
    mut wind: ResMut<TickWind>,
) {
    wind.clear();
    for (field, mut travel, region) in &mut fields {
        travel.0 += field.travel_rate() * time.delta_secs_f64();
        let air = MovingAir::new(field, travel.0);
        let Some((region, history)) = region else {
            wind.everywhere.push(air);
            continue;
        };
        let pose = history.end();
        let ball = (Vec3::from(pose.translation), region.shape.reach());
        wind.add_local(ball, LocalAir::Region(air, *region, Frame::of(pose)));
    }
}

fn collect_fans(fans: Query<(&WindFan, &PoseHistory)>, mut wind: ResMut<TickWind>) {
    for (fan, history) in &fans {
        let pose = history.end();
        let (centre, radius) = fan.ball();
        wind.add_local((pose * centre, radius), LocalAir::Fan(*fan, Frame::of(pose)));
    }
}

/// Collects blasts, and removes those that are over.
fn collect_blasts(
    mut blasts: Query<(Entity, &mut WindBlast, &PoseHistory)>,
    time: Res<Time>,
    mut wind: ResMut<TickWind>,
    mut commands: Commands,
) {
    let tick = time.delta_secs();
    for (entity, mut blast, history) in &mut blasts {
        blast.age += tick;
        if let Some(radius) = blast.reached() {
            let centre = Vec3::from(history.end().translation);
            wind.add_local((centre, radius), LocalAir::Blast(*blast, centre, tick));
        } else if blast.is_over() {
            commands.entity(entity).remove::<WindBlast>();
        }
    }
}

fn collect_wakes(
    mut wakes: Query<(&WindWake, &mut WakeTrail, &PoseHistory)>,
    time: Res<Time>,
    mut wind: ResMut<TickWind>,
) {
    for (wake, mut trail, history) in &mut wakes {
        let path = [history.start(), history.end()].map(|pose| Vec3::from(pose.translation));
        trail.advance(path.into(), time.delta_secs());
        if let Some(ball) = trail.ball(wake.drag_area) {
            wind.add_local(ball, LocalAir::Wake(trail.clone(), wake.drag_area));
        }
    }
}
