//! A curtain whose rings slide on a rail, drawn aside and back by a hand.

#[cfg(feature = "render")]
mod draw;
mod hand;
mod rail;

use crate::limits::{Limit, LimitRecord, greatest};
use crate::strain::Strain;
use crate::{Example, Record};
use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;
use bunting_solver::LinkFamily;

/// Position of the viewer, m.
const EYE: Vec3 = Vec3::new(0.5, 1.6, 3.7);

/// The point at which the viewer looks, m.
const CENTRE: Vec3 = Vec3::new(-0.15, 1.1, 0.0);

/// Limit of the mean strain: larger strain would be visible.
const STRAIN_LIMIT: f32 = 0.01;

/// Limit of a ring's distance from the rail, m: a tenth of the ring.
const RING_LIMIT: f32 = 3e-3;

/// A curtain on a rail.
#[derive(Clone, Copy, Debug)]
pub struct Curtain;

impl Example for Curtain {
    const NAME: &'static str = "Curtain";
    const SECONDS: f64 = 12.0;

    fn build(&self, app: &mut App, schedule: impl ScheduleLabel) {
        app.add_systems(schedule, hand::work);
        let mut commands = app.world_mut().commands();
        let view = Transform::from_translation(EYE).looking_at(CENTRE, Vec3::Y);
        commands.spawn((LodViewer::default(), view));
        let curtain = rail::spawn(&mut commands);
        hand::spawn(&mut commands, curtain);
    }

    fn record(&self, _ticks_per_second: usize) -> impl Record {
        LimitRecord::new(measure)
    }

    #[cfg(feature = "render")]
    fn stage(&self) -> crate::render::stage::Stage {
        crate::render::stage::Stage::SMALL
    }

    #[cfg(feature = "render")]
    fn draw(&self, app: &mut App) {
        app.add_plugins(draw::plugin);
    }

    #[cfg(feature = "render")]
    fn control(&self, app: &mut App) {
        crate::render::control_orbit(app, EYE, CENTRE);
    }
}

/// Strain of the curtain, and distance of its rings from the rail.
fn measure(world: &mut World) -> Vec<Limit> {
    let [mut strain, mut off] = [0.0_f32; 2];
    for state in world.query::<&ClothState>().iter(world) {
        if state.fabric().is_none() {
            continue;
        }
        let mut cloth = Strain::default();
        cloth.add(state, LinkFamily::Warp);
        cloth.add(state, LinkFamily::Weft);
        strain = greatest([strain, cloth.mean() as f32]);
        for ring in rail::rings() {
            let at = state.positions()[ring as usize];
            off = greatest([off, at.yz().length()]);
        }
    }
    vec![
        Limit { name: "mean strain of the curtain", value: strain, limit: STRAIN_LIMIT },
        Limit { name: "distance of the rings from the rail, m", value: off, limit: RING_LIMIT },
    ]
}
