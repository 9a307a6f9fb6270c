//! The beginning of a tick and of a substep: all values that are constant over it are computed.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_fabric::LaneFabric;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::constraints::stiffness::Stiffness;
use crate::simd::lane::Pack;
use crate::simd::vec3::lane3;
use crate::stability::added_mass::{AddedMass, InverseMasses, inertias};
use crate::step::bdf::Formula;
use crate::step::clock::Clock;
use crate::step::load_stretch::LoadStretch;
use crate::step::parameters::ParameterInputs;
use crate::step::{Drive, Scheme, StepSettings};

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Begins a tick of `tick` seconds: computes all values that are constant over it, and gathers contact
    /// candidates.
    pub fn begin_tick(&mut self, tick: f32, settings: StepSettings) {
        let step = tick / settings.substeps as f32;
        self.clock = Clock { settings, step, begun: 0, predicted: false };
        self.note_probes(tick);
        if self.clock.stands_still() {
            return;
        }
        let substep = match settings.scheme {
            Scheme::GaussSeidel => 0.0,
            Scheme::Yarns => Formula::BDF2_OPT.beta * step,
        };
        if self.masses.substep != substep {
            self.masses.substep = substep;
            for fabric in &mut self.fabrics {
                fabric.inverse_masses = InverseMasses::new(&fabric.fabric, substep);
            }
            self.lanes.iter_mut().flatten().for_each(|cloth| cloth.added_mass = None);
        }
        self.begin_pin_motion();
        self.begin_guides();
        self.begin_local_wind();
        self.begin_pin_reports();
        self.begin_layers();
        self.gather_contacts(tick);
    }

    /// Computes all values that are constant over the coming substep.
    pub fn begin_substep(&mut self) {
        let moved = self.parameters.any_frame_moves();
        for cloth in 0..self.lanes.len() {
            // The lane's state is taken out, so that the rest of the batch can be written.
            match self.lanes[cloth].take() {
                Some(mut state) => {
                    self.begin_substep_of(cloth, &mut state);
                    self.lanes[cloth] = Some(state);
                }
                None => self.parameters.set_empty(Y::lanes(cloth)),
            }
        }
        // The flag stays set for one substep after the motion, so that the velocities of pins become zero
        // again.
        self.parameters.any_frame_moved = moved || self.parameters.any_frame_moves();
    }

    fn begin_substep_of(&mut self, cloth: usize, state: &mut LaneState) {
        let clock = self.clock;
        let Clock { settings, step, .. } = clock;
        state.external_moment = 0.0;
        if state.history.join_last_substeps(step, settings.scheme) {
            self.join_last_substeps(cloth);
        }
        let formula = state.history.begin_substep(step, settings.scheme);
        self.parameters.set_pole_turn(Y::lanes(cloth), state.history.pole_turn);
        let inputs = ParameterInputs {
            material: state.material,
            air_density: state.drive.air_density,
            step,
            formula,
            scheme: settings.scheme,
        };
        state.history.disturbance.begin_substep(state.is_disturbed(&inputs));
        if state.inputs.replace(inputs) != Some(inputs) {
            self.set_inputs(cloth, &inputs);
        }
        self.set_added_mass(cloth, state);
        self.set_drive(cloth, &state.drive, &clock);
        let fabric = &self.fabric_of(cloth).fabric;
        let reach = match fabric.grid() {
            // A cloth without pins is held by its own inertia.
            Some(grid) if !fabric.has_pins() => grid.width.max(grid.height),
            _ => fabric.reach(),
        };
        let stretch = LoadStretch::new(
            &fabric.extremes().weakest(&fabric.material_along_rows(&state.material)),
            &state.drive,
            reach,
            state.pin_strain.greatest,
            state.pressure_inside().unwrap_or_default().abs(),
        );
        self.parameters.set_load_stretch(Y::lanes(cloth), &stretch);
    }

    /// Sets what acts on a cloth in the substep that `clock` is about to begin. The pole of a cloth that is held at a point
    /// turns to where gravity points.
    pub fn set_drive(&mut self, cloth: usize, drive: &Drive, clock: &Clock) {
        let lanes = Y::lanes(cloth);
        self.parameters.set_drive(lanes.clone(), drive, clock);
        if let Some(local) = &mut self.local_wind {
            let turn = drive.motion.turn_to_end(clock.begun, clock.settings.substeps).inverse();
            local.turns[lanes.clone()].fill(turn);
        }
        let gravity = lane3(&self.parameters.gravity_step, lanes.start);
        let pole = self.pole_of(cloth).and_then(|pole| pole.upright(gravity));
        if let (Some(pole), Some(packs)) = (pole, &mut self.numbers.pole) {
            packs.set_lanes(&lanes, pole);
        }
    }

    /// Makes one substep of a cloth's last two: the displacements of both, and the velocities before both.
    pub fn join_last_substeps(&mut self, cloth: usize) {
        let lanes = Y::lanes(cloth);
        let displacements = self.displacement.iter_mut().zip(&self.older_displacement);
        for (last, before) in displacements.flat_map(|(last, before)| last.iter_mut().zip(before)) {
            let before = &before.lanes()[lanes.clone()];
            let last = &mut last.lanes_mut()[lanes.clone()];
            last.iter_mut().zip(before).for_each(|(last, before)| *last += before);
        }
        let velocities = self.older_velocity.iter_mut().zip(&self.oldest_velocity);
        for (older, oldest) in velocities.flat_map(|(older, oldest)| older.iter_mut().zip(oldest)) {
            let oldest = &oldest.lanes()[lanes.clone()];
            older.lanes_mut()[lanes.clone()].copy_from_slice(oldest);
        }
    }

    /// Computes all values that depend on a cloth's material and on the formula.
    pub fn set_inputs(&mut self, cloth: usize, inputs: &ParameterInputs) {
        let stiffness = Stiffness {
            material: &inputs.material,
            step: inputs.effective_step(),
            scheme: inputs.scheme,
        };
        let fabric = &self.fabrics[Y::fabric_of(cloth)].fabric;
        self.layout.set_stiffness(cloth, fabric, &stiffness);
        let bends_stiffly = stiffness.bends_stiffly(fabric);
        self.parameters.set_inputs(Y::lanes(cloth), fabric, inputs, bends_stiffly);
    }

    /// Computes a cloth's inverse masses if their inputs have changed.
    fn set_added_mass(&mut self, cloth: usize, state: &mut LaneState) {
        let LaneFabric { fabric, pole, inverse_masses, .. } = self.fabric_of(cloth);
        let uprightness = pole.map_or(0.0, |pole| pole.uprightness(state.drive.gravity));
        let added_mass = AddedMass::new(
            uprightness,
            &state.pin_strain,
            fabric,
            &state.material,
            self.masses.substep,
        );
        if state.added_mass.replace(added_mass) == Some(added_mass) {
            return;
        }
        let inverse_masses = inverse_masses.of_cloth(added_mass, &state.pin_strain);
        self.layout.write_numbers(&inverse_masses, cloth, &mut self.masses.inverse);
        self.layout.write_numbers(&inertias(&inverse_masses), cloth, &mut self.masses.inertia);
        self.positions.set_inverse_masses(&inverse_masses);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec3;

    use super::*;
    use crate::batch::exchange::Entering;
    use crate::batch::snapshot::ClothSnapshot;
    use crate::fabric::{FabricBuilder, FabricMaterial, Grid};
    use crate::simd::registers::Pack1;
    use crate::step::Drive;

    #[test]
    fn substeps_are_joined_before_a_long_one() {
        let grid = FabricBuilder::grid(Grid::new(12, 12, 1.0, 1.0));
        let mesh = grid.pin_where(|at, _| at.x == 0.0).build().expect("a good fabric");
        let fabric = &Arc::new(mesh);
        let snapshot = &ClothSnapshot::at_rest(fabric);
        let mut batch = LaneBatch::<Pack1>::side_by_side(Arc::clone(fabric));
        let material = FabricMaterial::NYLON;
        batch.exchange(&[], &[Entering { lane: 0, fabric, snapshot, material }]);
        if let Some(cloth) = &mut batch.lanes[0] {
            cloth.drive = Drive { gravity: Vec3::NEG_Z * 9.81, ..Drive::NONE };
        }
        batch.begin_tick(1.0 / 60.0, StepSettings::yarns(4));
        for _ in 0..4 {
            batch.integrate();
            batch.solve_constraints();
            batch.update_velocities();
        }
        let history = |batch: &LaneBatch<Pack1>| batch.snapshot(0).history.expect("a history");
        let before = history(&batch);
        batch.begin_tick(1.0 / 60.0, StepSettings::yarns(2));
        batch.begin_substep();
        let after = history(&batch);
        let [last, older] = &before.displacements;
        assert!(older.iter().any(|displacement| displacement.length() > 1e-6));
        for (at, joined) in after.displacements[0].iter().enumerate() {
            assert_eq!(*joined, last[at] + older[at]);
            assert_eq!(after.older_velocities[0][at], before.older_velocities[1][at]);
        }
    }
}
