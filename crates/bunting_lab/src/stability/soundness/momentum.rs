//! Free meshes that fly, spin and vibrate without loads and damping: momentum and angular momentum stay as they are,
//! and kinetic energy, of which they have most at the start, never exceeds that.

use std::sync::Arc;

use bunting_solver::{ClothBatch, ClothSnapshot, Drive, Fabric, LaneCount, StepSettings};
use glam::{DVec3, Vec3};

use super::free::{free_meshes, scaled};
use crate::product::{DEFAULT, TICK};
use crate::stability::case::HardCase;

/// Greatest change of momentum and of angular momentum, in units of what the particles' speeds could give.
const KEPT: f64 = 1e-4;

/// Velocity of the whole mesh, m/s.
const DRIFT: Vec3 = Vec3::new(0.1, 0.0, 0.0);

/// Angular velocities, rad/s.
const SPINS: [f32; 2] = [1.0, 5.0];

/// Speed of the vibration, m/s.
const VIBRATION: f32 = 0.05;

/// Factors of the stretch stiffnesses.
const STIFFNESSES: [f32; 4] = [0.01, 0.1, 1.0, 50.0];

/// What a mesh's motion amounts to, in units of the density.
struct Motion {
    /// Σ m v, m³/s.
    momentum: DVec3,
    /// Σ m r × v about the centre of mass, m⁴/s.
    spin: DVec3,
    /// The greatest momentum and angular momentum that these speeds could have: Σ m |v| and Σ m |r| |v|.
    greatest: [f64; 2],
    /// ½ Σ m |v|², m⁴/s².
    energy: f64,
}

impl Motion {
    fn of(batch: &ClothBatch, lane: usize, areas: &[f32]) -> Self {
        let (mut positions, mut velocities) = (Vec::new(), Vec::new());
        batch.copy_positions(lane, &mut positions);
        batch.copy_velocities(lane, &mut velocities);
        let particles = || {
            let vectors = positions.iter().zip(&velocities);
            let areas = areas.iter().map(|&area| f64::from(area));
            vectors.zip(areas).map(|((x, v), area)| (x.as_dvec3(), v.as_dvec3(), area))
        };
        let area: f64 = particles().map(|(_, _, area)| area).sum();
        let centre = particles().map(|(x, _, area)| area * x).sum::<DVec3>() / area;
        Self {
            momentum: particles().map(|(_, v, area)| area * v).sum(),
            spin: particles().map(|(x, v, area)| area * (x - centre).cross(v)).sum(),
            greatest: [
                particles().map(|(_, v, area)| area * v.length()).sum(),
                particles().map(|(x, v, area)| area * (x - centre).length() * v.length()).sum(),
            ],
            energy: particles().map(|(_, v, area)| 0.5 * area * v.length_squared()).sum(),
        }
    }
}

/// The worst change of momentum, of angular momentum, and of energy, over all free meshes, at two and eight substeps.
pub(super) fn cases(quick: bool) -> Vec<HardCase> {
    let seconds = if quick { 5.0 } else { 30.0 };
    let mut worst = [0.0_f64; 3];
    for (_, fabric) in free_meshes(quick) {
        for substeps in [2, 8] {
            for (worst, of_mesh) in worst.iter_mut().zip(departures(&fabric, seconds, substeps)) {
                *worst = worst.max(of_mesh);
            }
        }
    }
    let [momentum, spin, energy] = worst;
    let case = |kept, figure, worst, limit| {
        let name = format!("free meshes that spin and vibrate: {kept}");
        HardCase::new(name, 0, figure, worst, limit)
    };
    vec![
        case("momentum", "change, of what it could be", momentum, KEPT),
        case("angular momentum", "change, of what it could be", spin, KEPT),
        case("energy", "kinetic energy, of the start's", energy, 1.0),
    ]
}

/// Greatest changes of momentum and angular momentum, in units of what they could be, and greatest kinetic energy, in
/// units of that of the start, of eight lanes that differ in stiffness and spin.
fn departures(fabric: &Arc<Fabric>, seconds: f32, substeps: u32) -> [f64; 3] {
    let areas = fabric.particle_areas();
    let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::Eight);
    for (stiffness, spin) in STIFFNESSES.iter().flat_map(|factor| SPINS.map(|spin| (factor, spin)))
    {
        let material = scaled(*stiffness, 1.0);
        let lane = batch.insert(&spinning(fabric, spin), material).expect("a good cloth");
        batch.drive(lane, Drive::NONE).expect("a good drive");
    }
    let lanes: Vec<usize> = batch.occupied().collect();
    let motions = |batch: &ClothBatch| -> Vec<Motion> {
        lanes.iter().map(|&lane| Motion::of(batch, lane, areas)).collect()
    };
    let start = motions(&batch);
    let mut worst = [0.0_f64; 3];
    for _ in 0..(seconds / TICK).round() as usize {
        batch.step(TICK, StepSettings { substeps, ..DEFAULT });
        for (now, start) in motions(&batch).iter().zip(&start) {
            let [momentum, spin] = start.greatest;
            let departures = [
                (now.momentum - start.momentum).length() / momentum,
                (now.spin - start.spin).length() / spin,
                now.energy / start.energy,
            ];
            for (worst, departure) in worst.iter_mut().zip(departures) {
                // What is not a number fails.
                *worst = if departure <= *worst { *worst } else { departure };
            }
        }
    }
    worst
}

/// A mesh at rest but for its velocities.
fn spinning(fabric: &Fabric, spin: f32) -> ClothSnapshot {
    let turning = spin * Vec3::new(0.0, 1.0, 0.3);
    let mut snapshot = ClothSnapshot::at_rest(fabric);
    for (particle, &at) in fabric.rest_positions().iter().enumerate() {
        let [x, y, z] = (at * Vec3::new(11.0, 9.0, 13.0)).to_array();
        let vibration = VIBRATION * Vec3::new(y.sin(), z.sin(), x.cos());
        snapshot.add_velocity(particle, DRIFT + turning.cross(at) + vibration);
    }
    snapshot
}
