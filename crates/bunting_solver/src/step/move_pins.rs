//! Moves pins in the frame of their cloth, substep by substep.

use core::mem;

use glam::Vec3;

use crate::batch::BatchError;
use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::fabric::Fabric;
use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, lane3, set_lane3};
use crate::stability::pin_strain::{PinStrain, are_pins_near};
use crate::step::moving_pins::{MovingPin, MovingPins};

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Sets the motion of a cloth's pins in the next tick.
    pub fn set_pin_motion(&mut self, cloth: usize, pins: Vec<MovingPin>) -> Result<(), BatchError> {
        let fabric = &self.fabrics[Y::fabric_of(cloth)].fabric;
        let count = fabric.particle_count();
        let is_bad = |pin: &&MovingPin| {
            let particle = pin.particle as usize;
            let is_pinned = particle < count && fabric.is_pinned(particle);
            !(is_pinned && pin.from.is_finite() && pin.to.is_finite())
        };
        if let Some(&MovingPin { particle, .. }) = pins.iter().find(is_bad) {
            return Err(BatchError::Pin { particle });
        }
        if let Some(state) = &mut self.lanes[cloth] {
            state.moving_pins.next = pins;
        }
        Ok(())
    }

    /// Begins a tick: pins whose motion has ended come to rest, and those of this tick begin theirs.
    pub fn begin_pin_motion(&mut self) {
        for cloth in 0..self.lanes.len() {
            let Some(state) = &mut self.lanes[cloth] else { continue };
            if state.moving_pins.is_empty() {
                continue;
            }
            for pin in &state.moving_pins.now {
                let (pack, lane) = self.layout.locate(pin.particle as usize, cloth);
                set_lane3(&mut self.velocity[pack], lane, Vec3::ZERO);
            }
            let MovingPins { now, next, positions, stay_near } = &mut state.moving_pins;
            *now = mem::take(next);
            let fabric = &self.fabrics[Y::fabric_of(cloth)].fabric;
            read_pins(&self.layout, self.positions.packs_mut(), cloth, fabric, positions);
            // Two points that move evenly are farthest apart at one of the ends of their ways.
            *stay_near = [|pin: &MovingPin| pin.from, |pin: &MovingPin| pin.to].iter().all(|end| {
                now.iter().for_each(|pin| positions[pin.particle as usize] = end(pin));
                are_pins_near(fabric, positions)
            });
        }
    }

    /// Moves pins to their places at the end of the coming substep, and gives them the velocity of their motion besides
    /// that of the frame.
    pub fn move_pins(&mut self) {
        for cloth in 0..self.lanes.len() {
            let Some(state) = &mut self.lanes[cloth] else { continue };
            if state.moving_pins.now.is_empty() {
                continue;
            }
            let pins = mem::take(&mut state.moving_pins.now);
            self.move_pins_of(cloth, &pins);
            self.update_pins(cloth);
            if let Some(state) = &mut self.lanes[cloth] {
                state.moving_pins.now = pins;
            }
        }
    }

    fn move_pins_of(&mut self, cloth: usize, pins: &[MovingPin]) {
        let substeps = self.clock.settings.substeps as f32;
        let part = (self.clock.begun + 1) as f32 / substeps;
        let rate = 1.0 / (substeps * self.clock.step);
        let frame_moves = self.parameters.any_frame_moved;
        for pin in pins {
            let (pack, lane) = self.layout.locate(pin.particle as usize, cloth);
            set_lane3(&mut self.positions.packs_mut()[pack], lane, pin.from.lerp(pin.to, part));
            // The frame's velocity was set anew in this substep, if the frame moves.
            let velocity = &mut self.velocity[pack];
            let of_frame = if frame_moves { lane3(velocity, lane) } else { Vec3::ZERO };
            set_lane3(velocity, lane, of_frame + (pin.to - pin.from) * rate);
        }
    }

    /// Updates all that depends on the positions of a cloth's pins.
    fn update_pins(&mut self, cloth: usize) {
        let fabric = &self.fabrics[Y::fabric_of(cloth)].fabric;
        let Some(state) = &mut self.lanes[cloth] else { return };
        let positions = &mut state.moving_pins.positions;
        read_pins(&self.layout, self.positions.packs_mut(), cloth, fabric, positions);
        self.layout.set_pins(cloth, fabric, positions);
        state.are_pins_at_rest = fabric.are_pins_at_rest(positions);
        if state.moving_pins.stay_near && state.pin_strain == PinStrain::default() {
            return;
        }
        let pin_strain = PinStrain::of(fabric, &state.moving_pins.positions);
        if state.pin_strain != pin_strain {
            state.pin_strain = pin_strain;
            state.added_mass = None;
        }
    }
}

/// Overwrites the positions of a cloth's pins among those of all its particles, m.
fn read_pins<P: Pack, Y: Layout<P>>(
    layout: &Y,
    packs: &[Pack3<P>],
    cloth: usize,
    fabric: &Fabric,
    positions: &mut Vec<Vec3>,
) {
    positions.resize(fabric.particle_count(), Vec3::ZERO);
    for pin in fabric.pins() {
        let particle = pin.particle as usize;
        let (pack, lane) = layout.locate(particle, cloth);
        positions[particle] = lane3(&packs[pack], lane);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::batch::exchange::Entering;
    use crate::batch::snapshot::ClothSnapshot;
    use crate::fabric::{FabricBuilder, FabricMaterial, Grid};
    use crate::simd::registers::Pack1;
    use crate::stability::pin_strain::PinStrain;
    use crate::step::StepSettings;

    /// Strains by the pins of a sheet of 1 m, after each of two substeps in which its right edge moves by a distance, m, and
    /// after the first of the next tick, in which it stays.
    fn strains(by: f32) -> [f32; 3] {
        let sheet = FabricBuilder::grid(Grid::new(5, 5, 1.0, 1.0));
        let sheet = sheet.pin_where(|_, uv| uv.x == 0.0 || uv.x == 1.0).build();
        let fabric = &Arc::new(sheet.expect("a good fabric"));
        let snapshot = &ClothSnapshot::at_rest(fabric);
        let mut batch = LaneBatch::<Pack1>::side_by_side(Arc::clone(fabric));
        let material = FabricMaterial::NYLON;
        batch.exchange(&[], &[Entering { lane: 0, fabric, snapshot, material }]);
        let right = (0..25).filter(|particle| particle % 5 == 4);
        let pins = right.map(|particle| {
            let from = fabric.rest_positions()[particle];
            MovingPin { particle: particle as u32, from, to: from + Vec3::X * by }
        });
        batch.set_pin_motion(0, pins.collect()).expect("pins");
        let mut substep = |begins: bool| {
            if begins {
                batch.begin_tick(1.0 / 60.0, StepSettings::yarns(2));
            }
            batch.integrate();
            batch.solve_constraints();
            batch.update_velocities();
            let state = batch.lanes[0].as_ref().expect("a cloth");
            assert_eq!(state.pin_strain.greatest > 0.0, state.pin_strain != PinStrain::default());
            state.pin_strain.greatest
        };
        [substep(true), substep(false), substep(true)]
    }

    #[test]
    fn pins_that_move_apart_strain_the_cloth_in_each_substep() {
        for (strain, expected) in strains(0.2).into_iter().zip([0.1, 0.2, 0.2]) {
            assert!((strain - expected).abs() < 1e-5, "{strain}");
        }
        assert_eq!(strains(-0.2), [0.0; 3]);
    }
}
