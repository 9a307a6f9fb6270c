//! A cloth among colliders in an app, with the plugin's default settings.

use bevy_app::App;
use bevy_bunting::{ClothActivity, ClothSettings, ClothState};
use bevy_ecs::{bundle::Bundle, entity::Entity, world::World};
use bevy_transform::components::Transform;
use glam::Vec3;

use crate::{
    game,
    product::yarn_strains,
    stats::{Strain, worse},
    timing::Timing,
};

/// An app without wind, in which a tick takes place in each update.
pub(super) struct InApp {
    app: App,
    /// Time of the updates, µs.
    time: Timing,
}

impl InApp {
    pub fn new() -> Self {
        let mut app = game::app_in_still_air([]);
        app.insert_resource(ClothSettings::default());
        Self { app, time: Timing::default() }
    }

    pub fn spawn(&mut self, bundle: impl Bundle) -> Entity {
        self.app.world_mut().spawn(bundle).id()
    }

    /// The world, for what is not done in every update.
    pub fn world(&mut self) -> &mut World {
        self.app.world_mut()
    }

    pub fn move_to(&mut self, entity: Entity, transform: Transform) {
        *self.app.world_mut().get_mut::<Transform>(entity).expect("it has a transform") = transform;
    }

    pub fn update(&mut self) {
        let Self { app, time } = self;
        time.time(|| app.update());
    }

    pub fn updates(&mut self, count: usize) {
        (0..count).for_each(|_| self.update());
    }

    /// Median time of an update, µs.
    pub fn us(&self) -> f64 {
        self.time.median()
    }

    fn state(&self, cloth: Entity) -> &ClothState {
        self.app.world().get(cloth).expect("a cloth has a state")
    }

    pub fn is_asleep(&self, cloth: Entity) -> bool {
        self.state(cloth).activity() == ClothActivity::AtRest
    }

    /// Positions of a cloth's particles in the frame of its entity, m.
    pub fn positions(&self, cloth: Entity) -> &[Vec3] {
        self.state(cloth).positions()
    }

    /// Strain of warp and weft.
    pub fn strain(&self, cloth: Entity) -> Strain {
        let state = self.state(cloth);
        let fabric = state.fabric().expect("the cloth is built");
        Strain::of(yarn_strains(fabric, state.positions()))
    }

    /// Greatest stretch of a link along warp and weft.
    pub fn greatest_stretch(&self, cloth: Entity) -> f64 {
        let state = self.state(cloth);
        let fabric = state.fabric().expect("the cloth is built");
        yarn_strains(fabric, state.positions()).fold(0.0, worse)
    }

    /// Greatest angle by which a normal turned in the last tick, °.
    pub fn greatest_turn(&self, cloth: Entity) -> f64 {
        let state = self.state(cloth);
        let pairs = state.previous_normals().iter().zip(state.normals());
        let turns = pairs.map(|(before, now)| f64::from(before.angle_between(*now).to_degrees()));
        turns.fold(0.0, worse)
    }
}
