//! Figures of a part of a run.

use bevy_app::App;
use bevy_bunting::{ClothBatches, ClothState};
use bunting_solver::LinkFamily;
use serde::Serialize;

use super::memory::resident;
use crate::{heap, scenes::ticks, stats::worse, timing::Timing};

/// Length of a part, s; half of the run where that is shorter.
const LENGTH: f64 = 60.0;
/// Time before the first part, s: until then cloth falls into the wind.
const SETTLING: f64 = 5.0;
/// Ticks between two looks at the particles, which take as long as a tick.
const BETWEEN_LOOKS: u32 = 4;

/// What was greatest in a part of a run.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Part {
    /// Number of cloths.
    pub cloths: usize,
    /// Bytes on the heap.
    pub heap: usize,
    /// Bytes of the process in memory, at the end.
    pub resident: Option<usize>,
    /// Batches, with those that are kept for others.
    pub batches: usize,
    /// Median time of an update, µs.
    pub tick_us: f64,
    /// Strain of a link along warp and weft.
    pub strain: f64,
    /// Mean kinetic energy of all particles relative to their frames, J/kg.
    pub energy: f64,
    /// Speed of a particle relative to its frame, m/s.
    pub speed: f64,
}

/// Runs an app for some seconds, with `drive` before each update, and returns its parts. There are two at least.
pub fn run(app: &mut App, seconds: f64, mut drive: impl FnMut(&mut App, u32)) -> Vec<Part> {
    let length = LENGTH.min(0.5 * seconds);
    let mut tick = 0;
    let mut update = |app: &mut App| {
        drive(app, tick);
        app.update();
        tick += 1;
    };
    (0..ticks(SETTLING)).for_each(|_| update(app));
    let parts = (seconds / length).round() as usize;
    (0..parts).map(|_| Part::of(app, ticks(length) as u32, &mut update)).collect()
}

impl Part {
    fn of(app: &mut App, ticks: u32, mut update: impl FnMut(&mut App)) -> Self {
        let mut part = Self::default();
        let mut time = Timing::default();
        for tick in 0..ticks {
            time.time(|| update(app));
            part.heap = part.heap.max(heap::in_use());
            let batches = app.world().resource::<ClothBatches>();
            part.batches = part.batches.max(batches.batch_count() + batches.spare_count());
            if tick % BETWEEN_LOOKS == 0 {
                part.look(app);
            }
        }
        part.tick_us = time.median();
        part.resident = resident();
        part
    }

    /// Looks at all particles.
    fn look(&mut self, app: &mut App) {
        let world = app.world_mut();
        let (mut cloths, mut particles, mut energy) = (0, 0, 0.0);
        for state in world.query::<&ClothState>().iter(world) {
            cloths += 1;
            for velocity in state.velocities() {
                particles += 1;
                energy += 0.5 * f64::from(velocity.length_squared());
                self.speed = worse(self.speed, velocity.length().into());
            }
            // Diagonals are as long as shear makes them.
            let links = state.fabric().map_or(&[][..], |fabric| fabric.links());
            let yarns = links.iter().zip(state.strains());
            let yarns = yarns.filter(|(link, _)| link.family != LinkFamily::Diagonal);
            self.strain = yarns.map(|(_, strain)| strain.into()).fold(self.strain, worse);
        }
        self.cloths = self.cloths.max(cloths);
        self.energy = worse(self.energy, energy / f64::from(particles.max(1)));
    }

    /// What was greatest in several parts; the memory of the process and the time of an update are those of the last.
    #[must_use]
    pub fn greatest(parts: &[Self]) -> Self {
        parts.iter().fold(Self::default(), |before, part| Self {
            cloths: before.cloths.max(part.cloths),
            heap: before.heap.max(part.heap),
            batches: before.batches.max(part.batches),
            strain: worse(before.strain, part.strain),
            energy: worse(before.energy, part.energy),
            speed: worse(before.speed, part.speed),
            ..*part
        })
    }
}
