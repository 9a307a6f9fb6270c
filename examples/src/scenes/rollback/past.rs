//! The last ticks, to which the game can go back.

use std::collections::VecDeque;

use bevy::platform::time::Instant;
use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::durations::Durations;
use crate::scenes::rollback::bodies::SavedBodies;

/// The number of the present tick; between two ticks that of the next one.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Tick(pub u32);

/// What the next tick reads of those before it.
#[derive(Clone)]
struct Saved {
    next: u32,
    bodies: SavedBodies,
    cloth: ClothWorldSnapshot,
}

/// The state after each of the last ticks.
#[derive(Resource)]
pub struct Past {
    kept: usize,
    saved: VecDeque<Saved>,
}

impl Past {
    /// A memory from which the last ticks, so many, can be simulated again: the states before each of them and after the last.
    pub fn of(ticks: u32) -> Self {
        Self { kept: if ticks == 0 { 0 } else { ticks as usize + 1 }, saved: VecDeque::new() }
    }
}

/// What saving and restoring takes each time.
#[derive(Resource, Clone, Debug, Default)]
pub struct Costs {
    pub save_cloth: Durations,
    pub save_bodies: Durations,
    pub restore_cloth: Durations,
    pub restore_bodies: Durations,
}

/// Ends a tick, and saves the state after it.
pub fn save(world: &mut World) -> Result {
    let mut tick = world.resource_mut::<Tick>();
    tick.0 += 1;
    let next = tick.0;
    if world.resource::<Past>().kept == 0 {
        return Ok(());
    }
    let start = Instant::now();
    let bodies = SavedBodies::of(world);
    let between = Instant::now();
    let cloth = world.save_cloths()?;
    let end = Instant::now();
    let mut costs = world.resource_mut::<Costs>();
    costs.save_bodies.push(between - start);
    costs.save_cloth.push(end - between);
    let Past { kept, saved } = &mut *world.resource_mut::<Past>();
    // Where this tick is simulated again, those from it on are another past.
    saved.retain(|it| it.next < next);
    saved.push_back(Saved { next, bodies, cloth });
    if saved.len() > *kept {
        saved.pop_front();
    }
    Ok(())
}

/// Goes back to the state before a tick: bodies first, and then cloth, to which what was changed before it counts as restored.
pub fn restore(world: &mut World, tick: u32) -> Result {
    let saved = world.resource::<Past>().saved.iter().find(|it| it.next == tick).cloned();
    let Saved { next, bodies, cloth } = saved.ok_or("the tick is too long past")?;
    world.resource_mut::<Tick>().0 = next;
    let start = Instant::now();
    bodies.restore(world);
    let between = Instant::now();
    world.restore_cloths(&cloth)?;
    let end = Instant::now();
    let mut costs = world.resource_mut::<Costs>();
    costs.restore_bodies.push(between - start);
    costs.restore_cloth.push(end - between);
    Ok(())
}
