//! Gusts: a sum of plane waves.

use bevy_math::{DVec3, Vec3};
use bevy_reflect::Reflect;

use crate::environment::wind::places::Places;
use crate::waves::{Random, sines};

/// Number of waves. Fewer: gusts repeat. More: the wind at each cloth costs more.
const WAVES: usize = 8;

/// Wave numbers, in waves to the length of a gust and spaced by equal ratios, and relative amplitudes, after
/// Kolmogorov's spectrum: with this spacing the energy of a wave falls with the power −2/3 of the wave
/// number.
const SPECTRUM: [(f32, f32); WAVES] = [
    (0.50, 1.26),
    (0.61, 1.18),
    (0.74, 1.11),
    (0.91, 1.03),
    (1.10, 0.97),
    (1.35, 0.90),
    (1.64, 0.85),
    (2.00, 0.79),
];

/// Deviation of the air's velocity from its mean: plane waves in random directions, each perpendicular to its
/// own amplitude, so that the divergence of the sum is zero (kinematic simulation of turbulence, Fung et al.
/// 1992).
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Gusts {
    /// Wave vectors, 1/m: x, y and z of each wave.
    wave_vectors: [[f32; WAVES]; 3],
    /// Phases at the origin of the world, periods.
    phases: [f32; WAVES],
    /// Amplitudes, m/s: x, y and z of each wave.
    amplitudes: [[f32; WAVES]; 3],
}

impl Gusts {
    /// Gusts with a strength (the greatest velocity along each axis, m/s) and a length (m), carried by
    /// `travel` lengths of a gust.
    pub fn new(seed: i32, strength: f32, length: f32, travel: DVec3) -> Self {
        let mut random = Random::with_seed(seed.cast_unsigned());
        let mut gusts = Self {
            wave_vectors: Default::default(),
            phases: [0.0; WAVES],
            amplitudes: Default::default(),
        };
        for (wave, (wave_number, relative)) in SPECTRUM.into_iter().enumerate() {
            let direction = unit_vector(&mut random);
            let across = direction.cross(unit_vector(&mut random));
            let amplitude = across.normalize_or(direction.any_orthonormal_vector()) * relative;
            let wave_vector = wave_number * direction;
            let phase = f64::from(random.unit()) - wave_vector.as_dvec3().dot(travel);
            gusts.phases[wave] = (phase - phase.floor()) as f32;
            for axis in 0..3 {
                gusts.wave_vectors[axis][wave] = wave_vector[axis] / length;
                gusts.amplitudes[axis][wave] = amplitude[axis];
            }
        }
        gusts.scale_to(strength);
        gusts
    }

    /// Velocities at positions (m) in the world, m/s.
    pub fn at(&self, positions: &Places) -> Places {
        let mut velocities = Places::ZERO;
        let Places { x: at_x, y: at_y, z: at_z } = *positions;
        for (wave, &phase) in self.phases.iter().enumerate() {
            let [x, y, z] = self.wave_vectors.map(|axis| axis[wave]);
            let values = sines(at_x * x + at_y * y + at_z * z + phase);
            let [x, y, z] = self.amplitudes.map(|axis| axis[wave]);
            velocities.x += values * x;
            velocities.y += values * y;
            velocities.z += values * z;
        }
        velocities
    }

    /// Moves the gusts along with the world, m.
    pub fn shift(&mut self, by: Vec3) {
        for (wave, phase) in self.phases.iter_mut().enumerate() {
            let [x, y, z] = self.wave_vectors.map(|axis| f64::from(axis[wave]));
            let moved = f64::from(*phase) - by.as_dvec3().dot(DVec3::new(x, y, z));
            *phase = (moved - moved.floor()) as f32;
        }
    }

    /// Scales the amplitudes so that the sum of all waves' crests reaches `strength` (m/s) along the axis
    /// where this sum is greatest.
    fn scale_to(&mut self, strength: f32) {
        let crests = self.amplitudes.map(|axis| axis.iter().map(|it| it.abs()).sum::<f32>());
        let scale = strength / crests.into_iter().fold(0.0, f32::max);
        self.amplitudes.as_flattened_mut().iter_mut().for_each(|amplitude| *amplitude *= scale);
    }
}

/// A random unit vector.
fn unit_vector(random: &mut Random) -> Vec3 {
    loop {
        let vector = Vec3::from([(); 3].map(|()| 2.0 * random.unit() - 1.0));
        if (0.01..=1.0).contains(&vector.length_squared()) {
            return vector.normalize();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STRENGTH: f32 = 2.0;

    fn at(gusts: &Gusts, position: Vec3) -> Vec3 {
        gusts.at(&Places::of(&[position])).get(0)
    }

    fn velocities(seed: i32) -> Vec<Vec3> {
        let gusts = Gusts::new(seed, STRENGTH, 12.0, DVec3::ZERO);
        (0..20_000).map(|step| at(&gusts, Vec3::new(0.3, 0.5, 0.7) * step as f32)).collect()
    }

    #[test]
    fn gusts_are_bounded_and_a_quarter_as_strong_by_root_mean_square() {
        for seed in 0..20 {
            let all = velocities(seed);
            let greatest = all.iter().map(|it| it.abs().max_element()).fold(0.0, f32::max);
            let mean_square =
                all.iter().map(|it| it.length_squared()).sum::<f32>() / all.len() as f32;
            let along_an_axis = (mean_square / 3.0).sqrt() / STRENGTH;
            assert!(greatest <= STRENGTH, "{greatest} m/s");
            assert!((0.18..0.32).contains(&along_an_axis), "{along_an_axis} of the strength");
        }
    }

    #[test]
    fn gusts_have_no_divergence() {
        let gusts = Gusts::new(5, STRENGTH, 12.0, DVec3::ZERO);
        let step = 0.1;
        for place in (0..100).map(|place| Vec3::new(1.7, -2.3, 0.9) * place as f32) {
            let slope = |axis: Vec3| {
                (at(&gusts, place + step * axis) - at(&gusts, place - step * axis)) / (2.0 * step)
            };
            let slopes = [Vec3::X, Vec3::Y, Vec3::Z].map(slope);
            let divergence = slopes[0].x + slopes[1].y + slopes[2].z;
            let size = slopes.iter().map(|slope| slope.length()).sum::<f32>();
            assert!(divergence.abs() < 0.02 * size, "{divergence} of {size} 1/s");
        }
    }
}
