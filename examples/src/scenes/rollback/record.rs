//! What is printed: whether going back changes a bit, and what it costs.

use bevy::prelude::*;

use crate::Record;
use crate::durations::Durations;
use crate::scenes::rollback::past::{Costs, Tick};
use crate::scenes::rollback::rewind::{Confirmed, hash};
use crate::table::table;

/// The last confirmed tick, and the costs of all.
#[derive(Debug)]
pub struct RollbackRecord {
    /// Begins the same game with inputs that arrive in time.
    straight: fn(&mut App),
    confirmed: Confirmed,
    costs: Costs,
}

impl RollbackRecord {
    /// A record of a game that goes back, given what begins the same game with inputs that arrive in time.
    pub fn new(straight: fn(&mut App)) -> Self {
        Self { straight, confirmed: Confirmed::default(), costs: Costs::default() }
    }

    /// The hash after a tick where every input arrives in time.
    fn straight(&self, tick: u32) -> u64 {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, TransformPlugin));
        (self.straight)(&mut app);
        while app.world().resource::<Tick>().0 <= tick {
            app.update();
        }
        hash(app.world_mut())
    }
}

impl Record for RollbackRecord {
    fn add_tick(&mut self, world: &mut World) -> Option<String> {
        self.confirmed = *world.resource();
        self.costs = world.resource::<Costs>().clone();
        None
    }

    fn print(&self) -> bool {
        let row = |name: &str, durations: &Durations| {
            let cost = [0.5, 0.95].map(|part| format!("{:.1}", 1e3 * durations.quantile(part)));
            [name.to_owned()].into_iter().chain(cost)
        };
        let Costs { save_cloth, save_bodies, restore_cloth, restore_bodies } = &self.costs;
        let rows = [
            row("save cloth", save_cloth),
            row("save bodies", save_bodies),
            row("restore cloth", restore_cloth),
            row("restore bodies", restore_bodies),
        ];
        println!("{}\n", table(["µs", "median", "95 %"], rows));
        let Confirmed { tick, hash } = self.confirmed;
        let straight = self.straight(tick);
        println!("after tick {tick}: {hash:016x}, without going back {straight:016x}");
        hash == straight
    }
}
