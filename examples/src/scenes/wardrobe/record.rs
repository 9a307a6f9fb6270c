//! The record of a headless run: what each outfit costs, and the worst values.

use bevy::prelude::*;
use bevy_bunting::ClothTimings;

use crate::Record;
use crate::durations::Durations;
use crate::limits::LimitRecord;
use crate::scenes::wardrobe::garment::Garment;
use crate::scenes::wardrobe::measure::measure;
use crate::table::table;

/// What has been worn, with the durations of its ticks, and the worst values.
#[derive(Debug)]
pub struct WardrobeRecord {
    outfits: Vec<(String, Durations)>,
    values: LimitRecord,
}

impl WardrobeRecord {
    /// An empty record.
    pub fn new() -> Self {
        Self { outfits: Vec::new(), values: LimitRecord::new(measure) }
    }
}

impl Record for WardrobeRecord {
    fn add_tick(&mut self, world: &mut World) -> Option<String> {
        let mut clothes = world.query::<&Garment>();
        let is_there = |garment: &&Garment| clothes.iter(world).any(|it| it == *garment);
        let worn: Vec<&Garment> = Garment::ALL.iter().filter(is_there).collect();
        if worn.is_empty() {
            return None;
        }
        let outfit = format!("{worn:?}");
        if self.outfits.last().is_none_or(|(last, _)| *last != outfit) {
            self.outfits.push((outfit, Durations::default()));
        }
        if let Some((_, durations)) = self.outfits.last_mut() {
            durations.push(world.resource::<ClothTimings>().total());
        }
        self.values.add_tick(world)
    }

    fn print(&self) -> bool {
        let row = |(outfit, durations): &(String, Durations)| {
            let quantile = |fraction| format!("{:.3}", durations.quantile(fraction));
            [outfit.clone(), quantile(0.5), quantile(1.0)]
        };
        let header = ["ms a tick", "median", "worst"];
        println!("{}\n", table(header, self.outfits.iter().map(row)));
        self.values.print()
    }
}
