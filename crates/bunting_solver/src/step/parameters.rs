//! Parameters of each lane: values that differ from cloth to cloth and are constant over a substep.

use core::ops::Range;

use glam::Vec3;

use crate::fabric::{Fabric, FabricMaterial};
use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, fill_lanes3, splat3};
use crate::stability::pole::PoleTurn;
use crate::step::bdf::Formula;
use crate::step::clock::Clock;
use crate::step::load_stretch::LoadStretch;
use crate::step::{Drive, Scheme};

/// Inputs of a cloth's compliances, air coefficients and damping, which are computed again when an input
/// changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ParameterInputs {
    pub material: FabricMaterial,
    /// Density of the air, kg/m³.
    pub air_density: f32,
    /// Length h of a substep, s.
    pub step: f32,
    pub formula: Formula,
    /// Scheme, on which the link stiffnesses of a grid depend.
    pub scheme: Scheme,
}

impl ParameterInputs {
    /// Effective length β h of the substep, s.
    pub fn effective_step(&self) -> f32 {
        self.formula.beta * self.step
    }
}

/// Values of each lane that kernels need besides the particles and the constraints' factors.
#[derive(Clone, Debug)]
pub(crate) struct Parameters<P: Pack> {
    /// Coefficients γ₁ and γ₂ of the [`Formula`].
    pub extrapolation: [P; 2],
    /// See [`Formula::inverse_extrapolation`].
    pub inverse_extrapolation: P,
    /// Effective length β h of the substep, s. All values below that refer to a substep refer to this length.
    pub step: P,
    /// One over the effective length, 1/s.
    pub inverse_step: P,
    /// 1 in lanes whose cloth bends stiffly, otherwise 0.
    pub bends_stiffly: P,
    /// Change of velocity by gravity in a substep, m/s.
    pub gravity_step: Pack3<P>,
    /// Velocity of the air, m/s.
    pub wind: Pack3<P>,
    /// Pressure coefficient ½ ρ C_n h/σ, s/m.
    pub pressure: P,
    /// Friction coefficient ½ ρ C_t h/σ, s/m.
    pub friction: P,
    /// Angle, rad, and rate, rad/s, by which the last substep's corrections have turned the cloth about its
    /// pole.
    pub pole_turn: [P; 2],
    /// 1 in lanes whose cloth hardly moves, otherwise 0.
    pub near_rest: P,
    /// Fraction of the velocity relative to the frame that damping leaves in a substep.
    pub damping_factor: P,
    /// Fraction of the non-rigid velocity that internal damping leaves in a substep, for cloth without pins.
    pub internal_damping_factor: P,
    /// Lengths of tethers to the farthest pins, and to the nearest pins, in units of their rest lengths.
    pub tether_stretch: [P; 2],
    /// Greatest length of a grid's diagonals, in units of their rest length.
    pub diagonal_stretch: P,
    /// Rotation of the frame in this substep minus the identity, see
    /// [`FrameStep`](crate::step::frame::FrameStep).
    pub frame_turn: [Pack3<P>; 3],
    /// Shift of coordinates by the frame in this substep, m.
    pub frame_shift: Pack3<P>,
    /// 1 in lanes whose frame moves in this substep, otherwise 0.
    pub frame_moves: P,
    /// Whether any frame moves, or moved in the substep before.
    pub any_frame_moved: bool,
}

impl<P: Pack> Parameters<P> {
    /// Parameters of lanes without cloths.
    pub fn new() -> Self {
        let [zero, one] = [0.0, 1.0].map(P::splat);
        let zero3 = splat3(Vec3::ZERO);
        Self {
            extrapolation: [zero; 2],
            inverse_extrapolation: zero,
            step: zero,
            inverse_step: zero,
            bends_stiffly: zero,
            gravity_step: zero3,
            wind: zero3,
            pressure: zero,
            friction: zero,
            pole_turn: [zero; 2],
            near_rest: zero,
            damping_factor: one,
            internal_damping_factor: one,
            tether_stretch: [one; 2],
            diagonal_stretch: one,
            frame_turn: [zero3; 3],
            frame_shift: zero3,
            frame_moves: zero,
            any_frame_moved: false,
        }
    }

    /// Stops lanes without a cloth: the effective substep is zero, and velocities become zero.
    pub fn set_empty(&mut self, lanes: Range<usize>) {
        let set = |pack: &mut P| pack.lanes_mut()[lanes.clone()].fill(0.0);
        set(&mut self.step);
        set(&mut self.inverse_step);
        set(&mut self.frame_moves);
        set(&mut self.near_rest);
        set(&mut self.bends_stiffly);
        set(&mut self.damping_factor);
        self.extrapolation.iter_mut().chain(&mut self.pole_turn).for_each(set);
        fill_lanes3(&mut self.gravity_step, &lanes, Vec3::ZERO);
        fill_lanes3(&mut self.wind, &lanes, Vec3::ZERO);
    }

    /// Sets the turn about the pole that the coming substep undoes.
    pub fn set_pole_turn(&mut self, lanes: Range<usize>, turn: PoleTurn) {
        let [angle, rate] = &mut self.pole_turn;
        angle.lanes_mut()[lanes.clone()].fill(turn.angle);
        rate.lanes_mut()[lanes].fill(turn.rate);
    }

    /// Sets the integration formula, the air's coefficients and damping. `bends_stiffly` is that of
    /// [`Stiffness`](crate::constraints::stiffness::Stiffness::bends_stiffly).
    pub fn set_inputs(
        &mut self,
        lanes: Range<usize>,
        fabric: &Fabric,
        inputs: &ParameterInputs,
        bends_stiffly: bool,
    ) {
        let ParameterInputs { material, air_density, formula, .. } = inputs;
        let step = inputs.effective_step();
        let set = |pack: &mut P, value: f32| pack.lanes_mut()[lanes.clone()].fill(value);
        for (pack, part) in self.extrapolation.iter_mut().zip(formula.extrapolation) {
            set(pack, part);
        }
        set(&mut self.inverse_extrapolation, formula.inverse_extrapolation);
        set(&mut self.step, step);
        set(&mut self.inverse_step, 1.0 / step);
        set(&mut self.bends_stiffly, if bends_stiffly { 1.0 } else { 0.0 });
        let air = air_factor(*air_density, inputs.step, material);
        set(&mut self.pressure, air * material.pressure_coefficient);
        set(&mut self.friction, air * material.friction_coefficient);
        // The rigid motion of a pinned cloth is that of its frame.
        let (relative_to_frame, internal) = if fabric.has_pins() {
            (material.internal_damping, 0.0)
        } else {
            (0.0, material.internal_damping)
        };
        let damping = material.damping + relative_to_frame;
        set(&mut self.damping_factor, libm::expf(-damping * step));
        set(&mut self.internal_damping_factor, libm::expf(-internal * step));
    }

    /// Sets gravity, wind and the frame's motion in the substep that `clock` is about to begin.
    pub fn set_drive(&mut self, lanes: Range<usize>, drive: &Drive, clock: &Clock) {
        let (index, count) = (clock.begun, clock.settings.substeps);
        let turned = |direction| drive.motion.turn_back(direction, index, count);
        let set3 = |pack: &mut Pack3<P>, value: Vec3| fill_lanes3(pack, &lanes, value);
        set3(&mut self.gravity_step, turned(drive.gravity) * self.step.lanes()[lanes.start]);
        set3(&mut self.wind, turned(drive.wind));
        let frame = drive.motion.substep(index, count);
        for (pack, row) in self.frame_turn.iter_mut().zip(frame.turn.rows) {
            set3(pack, row);
        }
        set3(&mut self.frame_shift, frame.shift);
        self.frame_moves.lanes_mut()[lanes].fill(if frame.moves { 1.0 } else { 0.0 });
    }

    /// Sets the greatest stretch of tethers and diagonals.
    pub fn set_load_stretch(&mut self, lanes: Range<usize>, stretch: &LoadStretch) {
        for (pack, length) in self.tether_stretch.iter_mut().zip(stretch.tethers) {
            pack.lanes_mut()[lanes.clone()].fill(length);
        }
        self.diagonal_stretch.lanes_mut()[lanes].fill(stretch.diagonals);
    }

    /// Sets whether a cloth hardly moves.
    pub fn set_near_rest(&mut self, lanes: Range<usize>, near_rest: bool) {
        self.near_rest.lanes_mut()[lanes].fill(if near_rest { 1.0 } else { 0.0 });
    }

    /// Whether a cloth hardly moves.
    pub fn is_near_rest(&self, lanes: Range<usize>) -> bool {
        self.near_rest.lanes()[lanes.start] == 1.0
    }

    /// Whether any cloth hardly moves.
    pub fn any_near_rest(&self) -> bool {
        self.near_rest.lanes().contains(&1.0)
    }

    /// Whether any cloth bends stiffly.
    pub fn any_bends_stiffly(&self) -> bool {
        self.bends_stiffly.lanes().contains(&1.0)
    }

    /// Whether the frame of any lane moves in this substep.
    pub fn any_frame_moves(&self) -> bool {
        self.frame_moves.lanes().contains(&1.0)
    }

    /// Whether the air acts on any lane.
    pub fn any_feels_air(&self) -> bool {
        let acts = |pack: &P| pack.lanes().iter().any(|&coefficient| coefficient != 0.0);
        acts(&self.pressure) || acts(&self.friction)
    }
}

/// Change of a velocity in a substep by the air for each unit of an aerodynamic coefficient and of squared speed, ½ρ h/σ, s/m.
pub(crate) fn air_factor(air_density: f32, step: f32, material: &FabricMaterial) -> f32 {
    0.5 * air_density * step / material.area_density
}
