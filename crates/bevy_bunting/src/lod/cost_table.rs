//! The table of costs by which levels are chosen before anything is measured.

use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::LaneCount;

use crate::batch::cost_kind::CostKind;

/// Costs of cloth; where the width of the batch matters, for one, eight and sixteen lanes. A partly filled
/// batch costs as much as a full one.
///
/// ```
/// use bevy_bunting::CostTable;
///
/// // A machine that publishes at twice the price.
/// let usual = CostTable::default();
/// let slow = CostTable { publish: 2.0 * usual.publish, ..usual.clone() };
/// # assert_ne!(slow, usual);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
pub struct CostTable {
    /// One particle in all lanes, in a substep of one pass, ns.
    pub substep: [f32; 3],
    /// One particle in all lanes, in each further pass, ns.
    pub pass: [f32; 3],
    /// A batch, in a substep, besides its particles, ns.
    pub batch: [f32; 3],
    /// Factor on the cost of a batch of cloths of different fabrics.
    pub mixed: f32,
    /// Driving a cloth and publishing its state in a tick, ns a particle.
    pub publish: f32,
    /// Driving a cloth and publishing its state in a tick, besides its particles, ns.
    pub cloth: f32,
    /// A tick without any cloth, µs.
    pub tick: f32,
    /// A change of level on a screen, ns a particle of the finer of the two levels.
    pub change: f32,
}

impl Default for CostTable {
    /// Costs of a 33 × 33 flag in the wind on one core of a server Xeon with AVX-512, in 2026.
    fn default() -> Self {
        Self {
            substep: [36.0, 140.0, 230.0],
            pass: [5.0, 18.0, 45.0],
            batch: [1200.0, 500.0, 500.0],
            mixed: 1.2,
            publish: 2.0,
            cloth: 700.0,
            tick: 20.0,
            change: 170.0,
        }
    }
}

impl CostTable {
    /// Cost of a batch in a tick, µs.
    pub(crate) fn batch(&self, kind: CostKind) -> f32 {
        let CostKind { particles, settings, lanes, mixed } = kind;
        let width = width(lanes);
        let passes = settings.passes.saturating_sub(1) as f32;
        let of_particle = self.substep[width] + passes * self.pass[width];
        let of_substep = self.batch[width] + particles as f32 * of_particle;
        let factor = if mixed { self.mixed } else { 1.0 };
        factor * settings.substeps as f32 * of_substep / NANOSECONDS
    }

    /// Cost of a change between two levels on a screen, µs; `particles` are those of the finer level.
    pub(crate) fn change(&self, particles: usize) -> f32 {
        1e-3 * self.change * particles as f32
    }

    /// Cost of a cloth in a tick besides its batch, µs.
    pub(super) fn per_cloth(&self, particles: usize) -> f32 {
        1e-3 * (self.cloth + self.publish * particles as f32)
    }
}

/// Nanoseconds in a microsecond.
const NANOSECONDS: f32 = 1e3;

/// Index of a width in the table's arrays.
fn width(lanes: LaneCount) -> usize {
    match lanes {
        LaneCount::One => 0,
        LaneCount::Eight => 1,
        LaneCount::Sixteen => 2,
    }
}
