//! Air that the wind traps in a canopy.
//!
//! A triangle that knows the free stream alone is pushed by ½ρC cos²θ: over a hemisphere of radius R that is open towards the wind, ½ρC πR² ½
//! in sum, half of what its outline says. The air inside does not pass along the cloth, but stands still, at the dynamic
//! pressure ½ρu² of the stream into the mouth, and behind the canopy is the pressure of its wake. Their difference Cₚ ½ρu² is the
//! same at all triangles; by the divergence theorem their sum is Cₚ ½ρu² times the area of the mouth, whatever the shape.

use glam::Vec3;

use super::state::LanePressure;
use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::Layout;
use crate::pressure::air::Pressure;
use crate::simd::lane::Pack;
use crate::simd::vec3::lane3;
use crate::step::parameters::air_factor;

/// Depth of a canopy, its volume over the area of its mouth, at which it traps all air, in radii of a round mouth of that area;
/// less where it is flatter. A hemisphere's is ⅔. Smaller: a canopy that turns inside out jerks. Larger: flat parachutes fall too fast.
const DEEP: f32 = 0.25;

/// Least area of a mouth, m², and least squared wind, m²/s².
const LEAST: f32 = 1e-12;

impl LanePressure {
    /// The unit vector from the mouth inwards, the area of the mouth, m², and the part of the air that it traps, from 0 to 1,
    /// negative where the triangles' normals point inwards.
    fn bag(&self) -> (Vec3, f32, f32) {
        let mouth = self.mouth();
        let area = mouth.length();
        if area * area < LEAST {
            return (Vec3::ZERO, 0.0, 0.0);
        }
        let radius = (area / core::f32::consts::PI).sqrt();
        let depth = self.volume() / area;
        let part = (depth / (DEEP * radius)).clamp(-1.0, 1.0);
        (mouth / area * part.signum(), area, part)
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// The pressure along the normals, Pa; `slowing` is by how much a unit of pressure slows the stream into the mouth in a substep, times the
    /// mouth's area, m³/(s Pa).
    ///
    /// It follows what the stream says as fast as the substep resolves: 1/(1 + a) of the difference in a substep, with a the part of the
    /// stream that the pressure would take away, so that a light canopy is not thrown back, and a held one has all of it after some
    /// substeps.
    pub(super) fn trapped(
        &self,
        cloth: usize,
        state: &LaneState,
        inner: &LanePressure,
        coefficient: f32,
        slowing: f32,
    ) -> f32 {
        let before = state.history.pressure.unwrap_or_default();
        let (inwards, area, part) = inner.bag();
        if area == 0.0 {
            return 0.0;
        }
        let wind = lane3(&self.parameters.wind, Y::lanes(cloth).start);
        let swept = self.swept(cloth, inner) / area * part.signum();
        let speed = (wind.dot(inwards) - swept).max(0.0);
        let of_speed = 0.5 * state.drive.air_density * coefficient * part * speed;
        let taken = 2.0 * of_speed.abs() * slowing / area;
        before + (of_speed * speed - before) / (1.0 + taken)
    }

    /// The rate at which the volume grows along the normals, with the border's own motion, m³/s.
    fn swept(&self, cloth: usize, inner: &LanePressure) -> f32 {
        let of = |(particle, gradient): (usize, &Vec3)| {
            self.vector(&self.velocity, particle, cloth).dot(*gradient)
        };
        inner.gradient.iter().enumerate().map(of).sum()
    }

    /// Reduces the wind's own pressure on the triangles of canopies by the part of the stream that their mouths face, as far as
    /// they trap it: what stands still inside shelters them.
    pub(crate) fn shelter_canopies(&mut self) {
        for cloth in 0..self.lanes.len() {
            self.with_air(cloth, |batch, state, inner| {
                let Pressure::Canopy { coefficient } = inner.air else { return };
                let wind = lane3(&batch.parameters.wind, Y::lanes(cloth).start);
                let squared = (wind - batch.mean_velocity(cloth)).length_squared();
                let dynamic = 0.5 * state.drive.air_density * coefficient * squared;
                let trapped = state.history.pressure.unwrap_or_default().abs();
                let open = 1.0 - (trapped / dynamic.max(LEAST)).min(1.0);
                let material = &state.material;
                let air = air_factor(state.drive.air_density, batch.clock.step, material);
                let pressure = air * material.pressure_coefficient * open;
                batch.parameters.pressure.lanes_mut()[Y::lanes(cloth)].fill(pressure);
            });
        }
    }

    /// The mean velocity of a cloth's particles, by their masses, m/s.
    fn mean_velocity(&self, cloth: usize) -> Vec3 {
        let fabric = &self.fabric_of(cloth).fabric;
        let areas = fabric.particle_areas().iter().enumerate();
        let sum: Vec3 = areas
            .map(|(particle, &area)| self.vector(&self.velocity, particle, cloth) * area)
            .sum();
        sum / fabric.mass_area()
    }
}
