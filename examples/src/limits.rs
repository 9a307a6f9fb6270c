//! A record of durations, and of values that must stay within limits.

use bevy::prelude::*;
use bevy_bunting::ClothTimings;
use bevy_bunting::prelude::*;

use crate::Record;
use crate::durations::Durations;
use crate::table::table;

/// A measured value and the limit that it must not exceed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Name of the value, with its unit.
    pub name: &'static str,
    /// The value.
    pub value: f32,
    /// The greatest permitted value.
    pub limit: f32,
}

/// The greatest of non-negative values; NaN if one of them is NaN, unlike with `f32::max`.
pub fn greatest(values: impl IntoIterator<Item = f32>) -> f32 {
    let greater = |a: f32, b: f32| if b > a || b.is_nan() { b } else { a };
    values.into_iter().fold(0.0, greater)
}

/// The worst values of a headless run, and the durations of its ticks.
#[derive(Debug)]
pub struct LimitRecord {
    measure: fn(&mut World) -> Vec<Limit>,
    worst: Vec<Limit>,
    ticks: Durations,
    size: Size,
}

/// Numbers of cloths, particles and vertices.
#[derive(Clone, Copy, Debug, Default)]
struct Size {
    cloths: usize,
    particles: usize,
    vertices: usize,
}

impl LimitRecord {
    /// An empty record of the values that `measure` returns after each tick.
    #[must_use]
    pub fn new(measure: fn(&mut World) -> Vec<Limit>) -> Self {
        Self { measure, worst: Vec::new(), ticks: Durations::default(), size: Size::default() }
    }
}

impl Record for LimitRecord {
    fn add_tick(&mut self, world: &mut World) -> Option<String> {
        self.ticks.push(world.resource::<ClothTimings>().total());
        self.size = Size::of(world);
        let values = (self.measure)(world);
        if self.worst.is_empty() {
            self.worst = values;
        } else {
            for (worst, value) in self.worst.iter_mut().zip(values) {
                worst.value = greatest([worst.value, value.value]);
            }
        }
        None
    }

    fn print(&self) -> bool {
        let row =
            |row: &Limit| [row.name.to_owned(), format!("{:.5}", row.value), row.limit.to_string()];
        println!("{}\n", table(["", "worst", "limit"], self.worst.iter().map(row)));
        let Size { cloths, particles, vertices } = self.size;
        let ticks = self.ticks.summary();
        println!("{cloths} cloths, {particles} particles for {vertices} vertices; a tick: {ticks}");
        self.worst.iter().all(|worst| worst.value <= worst.limit)
    }
}

impl Size {
    fn of(world: &mut World) -> Self {
        let mut size = Self::default();
        for (state, mesh) in world.query::<(&ClothState, &ClothMesh)>().iter(world) {
            size.cloths += 1;
            size.particles += state.positions().len();
            size.vertices += mesh.vertex_count();
        }
        size
    }
}
