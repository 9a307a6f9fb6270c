//! What differs from lane to lane and is constant over a tick or a substep.

use core::ops::Range;

use glam::Vec3;

use crate::batch::lane_batch::{Applied, Clock};
use crate::constants::{GREATEST_COMPLIANCE, LEAST_LINK_COMPLIANCE};
use crate::constraints::{anticipated, resists_twist};
use crate::fabric::{BendProfile, Fabric, FabricMaterial, RibbonProfile};
use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, fill_lanes3, splat3};
use crate::step::bdf::Turned;
use crate::step::{Drive, Scheme};

/// Factors L and D of a bend profile's pentadiagonal system, for each inner particle.
#[derive(Clone, Debug)]
pub(crate) struct BendFactors<P: Pack, C = f32> {
    pub rows: Vec<BendFactor<P>>,
    /// What a moment moves each particle by: one over its area and the square of the spacing, 1/m⁴.
    pub weights: Vec<C>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct BendFactor<P: Pack> {
    /// Factor of L one below the diagonal.
    pub near: P,
    /// Factor of L two below the diagonal.
    pub far: P,
    /// One over the diagonal.
    pub inverse: P,
}

impl<P: Pack> BendFactors<P> {
    pub fn new(profile: &BendProfile) -> Self {
        let nothing = P::splat(0.0);
        let row = BendFactor { near: nothing, far: nothing, inverse: nothing };
        let per_spacing = profile.inverse_spacing;
        Self {
            rows: vec![row; profile.coefficients.len()],
            weights: profile.inverse_areas.iter().map(|&w| w * per_spacing * per_spacing).collect(),
        }
    }

    /// Factorises D W Dᵀ + α̃ for one lane, α̃ being `compliance` over a row's weight. In double
    /// precision, since it is done once.
    fn factorise(&mut self, lanes: &Range<usize>, profile: &BendProfile, compliance: f32) {
        let per_spacing = f64::from(profile.inverse_spacing);
        let areas: Vec<f64> = profile
            .inverse_areas
            .iter()
            .map(|&w| f64::from(w) * per_spacing * per_spacing)
            .collect();
        // Of the last two rows: 1/d, and what couples them.
        let (mut one, mut two) = ((0.0, 0.0), (0.0, 0.0));
        for (row, (factor, &weight)) in self.rows.iter_mut().zip(&profile.coefficients).enumerate()
        {
            let softness = f64::from(compliance) / f64::from(weight);
            let diagonal = areas[row] + 4.0 * areas[row + 1] + areas[row + 2] + softness;
            let beside = if row >= 1 { -2.0 * (areas[row] + areas[row + 1]) } else { 0.0 };
            let beyond = if row >= 2 { areas[row] } else { 0.0 };
            // L D Lᵀ: far = a₂/d₋₂, near = (a₁ − far d₋₂ near₋₁)/d₋₁.
            let far = beyond * two.0;
            let near = (beside - beyond * one.1) * one.0;
            let pivot = diagonal - beyond * far - near * (beside - beyond * one.1);
            for (pack, value) in [
                (&mut factor.near, near),
                (&mut factor.far, far),
                (&mut factor.inverse, 1.0 / pivot),
            ] {
                pack.lanes_mut()[lanes.clone()].fill(value as f32);
            }
            (two, one) = (one, (1.0 / pivot, near));
        }
    }
}

/// Factors L and D of a ribbon profile's tridiagonal system, for each cell.
#[derive(Clone, Debug)]
pub(crate) struct TwistFactors<P: Pack, C = f32> {
    pub cells: Vec<TwistFactor<P>>,
    /// One over the area of each particle, 1/m².
    pub weights: Vec<[C; 2]>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct TwistFactor<P: Pack> {
    /// Factor of L below the diagonal.
    pub near: P,
    /// One over the diagonal; zero in lanes that do not resist twist.
    pub inverse: P,
}

impl<P: Pack> TwistFactors<P> {
    pub fn new(profile: &RibbonProfile) -> Self {
        let weights = profile.inverse_areas.clone();
        Self { cells: Self::room(weights.len()), weights }
    }

    /// No factors yet, for a ribbon of so many pairs.
    pub fn room(pairs: usize) -> Vec<TwistFactor<P>> {
        let nothing = P::splat(0.0);
        vec![TwistFactor { near: nothing, inverse: nothing }; pairs - 1]
    }

    /// Factorises C W Cᵀ + α̃ for one lane. In double precision, since it is done once.
    fn factorise(&mut self, lanes: &Range<usize>, profile: &RibbonProfile, compliance: f32) {
        let pair: Vec<f64> =
            profile.inverse_areas.iter().map(|[a, b]| f64::from(*a) + f64::from(*b)).collect();
        let softness = f64::from(compliance / profile.coefficient);
        let mut last = 0.0;
        for (cell, factor) in self.cells.iter_mut().enumerate() {
            let near = -pair[cell] * last;
            let inverse = 1.0 / (pair[cell] + pair[cell + 1] + softness + near * pair[cell]);
            factor.near.lanes_mut()[lanes.clone()].fill(near as f32);
            factor.inverse.lanes_mut()[lanes.clone()].fill(inverse as f32);
            last = inverse;
        }
    }

    /// Finds no moment in these lanes.
    fn forget(&mut self, lanes: &Range<usize>) {
        for factor in &mut self.cells {
            factor.near.lanes_mut()[lanes.clone()].fill(0.0);
            factor.inverse.lanes_mut()[lanes.clone()].fill(0.0);
        }
    }
}

/// One value for each lane of everything that a kernel needs besides the particles.
#[derive(Clone, Debug)]
pub(crate) struct Parameters<P: Pack> {
    /// γ₁ and γ₂ of the [`Formula`](crate::step::bdf::Formula).
    pub extrapolation: [P; 2],
    /// The effective substep β h of the formula, s. Everything below that is "in a substep" is in
    /// this one.
    pub step: P,
    /// One over it, 1/s.
    pub inverse_step: P,
    /// σ/(k h²) of each link class, 1/m²: compliance in units of inverse areas.
    pub link_compliance: Vec<P>,
    /// σ/(k h²) of each hinge class, 1/m⁴.
    pub hinge_compliance: Vec<P>,
    /// Of each bend profile.
    pub bend_factors: Vec<BendFactors<P>>,
    /// Of each ribbon profile.
    pub twist_factors: Vec<TwistFactors<P>>,
    /// Part of its memory of stretch that bending anticipates.
    pub anticipated: P,
    /// Gravity times the substep, m/s.
    pub gravity_step: Pack3<P>,
    /// Air velocity, m/s.
    pub wind: Pack3<P>,
    /// See [`Formula::foresight`](crate::step::bdf::Formula::foresight).
    pub foresight: P,
    /// ½ ρ C_n h/σ, s/m.
    pub pressure: P,
    /// ½ ρ C_t h/σ, s/m.
    pub friction: P,
    /// What the cloth was turned by about its pole in the substep before, rad and rad/s: see
    /// [`Turned`].
    pub turned: [P; 2],
    /// 1 in lanes that hardly move, else 0.
    pub creeps: P,
    /// Part of the velocity relative to the frame that damping leaves in a substep.
    pub keep: P,
    /// Part of the non-rigid velocity that internal damping leaves in a substep, for cloth without
    /// pins.
    pub keep_internal: P,
    /// Length that tethers have, in units of that at rest: twice what the loads and the pins stretch, which
    /// they must not hide.
    pub tether_stretch: P,
    /// The same of tethers to the farthest pin, along the bias.
    pub far_tether_stretch: P,
    /// Length that the loads and the pins may stretch the bias to, in units of that at rest.
    pub bias_stretch: P,
    /// The frame's motion in this substep, see [`Carry`](crate::step::frame::Carry).
    pub turn: [Pack3<P>; 3],
    pub shift: Pack3<P>,
    /// 1 in lanes whose frame moves in this substep, else 0.
    pub moves: P,
    /// Whether any lane has to be carried.
    pub carries: bool,
}

impl<P: Pack> Parameters<P> {
    pub fn new(fabric: &Fabric) -> Self {
        let nothing = P::splat(0.0);
        Self {
            extrapolation: [nothing; 2],
            step: nothing,
            inverse_step: nothing,
            link_compliance: vec![nothing; fabric.link_classes().len()],
            hinge_compliance: vec![nothing; fabric.hinge_classes().len()],
            bend_factors: fabric.bend_profiles().iter().map(BendFactors::new).collect(),
            twist_factors: fabric.ribbon_profiles().iter().map(TwistFactors::new).collect(),
            anticipated: nothing,
            gravity_step: splat3(Vec3::ZERO),
            wind: splat3(Vec3::ZERO),
            foresight: nothing,
            pressure: nothing,
            friction: nothing,
            turned: [nothing; 2],
            creeps: nothing,
            keep: P::splat(1.0),
            keep_internal: P::splat(1.0),
            tether_stretch: P::splat(1.0),
            far_tether_stretch: P::splat(1.0),
            bias_stretch: P::splat(1.0),
            turn: [splat3(Vec3::ZERO); 3],
            shift: splat3(Vec3::ZERO),
            moves: nothing,
            carries: false,
        }
    }

    /// A lane without a cloth stands still, and forgets how it moved.
    pub fn set_empty(&mut self, lanes: Range<usize>) {
        let set = |pack: &mut P, value: f32| pack.lanes_mut()[lanes.clone()].fill(value);
        let set3 = |pack: &mut Pack3<P>, value: Vec3| fill_lanes3(pack, &lanes, value);
        set(&mut self.step, 0.0);
        set(&mut self.inverse_step, 0.0);
        set(&mut self.moves, 0.0);
        set(&mut self.creeps, 0.0);
        set(&mut self.keep, 0.0);
        self.extrapolation.iter_mut().chain(&mut self.turned).for_each(|part| set(part, 0.0));
        set3(&mut self.gravity_step, Vec3::ZERO);
        set3(&mut self.wind, Vec3::ZERO);
    }

    /// What is to be taken out again of the substep before.
    pub fn set_turned(&mut self, lanes: Range<usize>, turned: Turned) {
        let [angle, rate] = &mut self.turned;
        angle.lanes_mut()[lanes.clone()].fill(turned.angle);
        rate.lanes_mut()[lanes].fill(turned.rate);
    }

    /// Integration formula, compliances, air and damping.
    pub fn apply(&mut self, lanes: Range<usize>, fabric: &Fabric, applied: &Applied) {
        let Applied { material, air_density, step, formula, scheme } = applied;
        let step = formula.weight * step;
        let set = |pack: &mut P, value: f32| pack.lanes_mut()[lanes.clone()].fill(value);
        for (pack, part) in self.extrapolation.iter_mut().zip(formula.extrapolation) {
            set(pack, part);
        }
        set(&mut self.foresight, formula.foresight());
        set(&mut self.step, step);
        set(&mut self.inverse_step, 1.0 / step);
        let compliance = |stiffness: f32| {
            (material.area_density / (stiffness * step * step)).min(GREATEST_COMPLIANCE)
        };
        let least = LEAST_LINK_COMPLIANCE / fabric.particle_areas()[0];
        for (pack, class) in self.link_compliance.iter_mut().zip(fabric.link_classes()) {
            let stiffness = match scheme {
                Scheme::Yarns if fabric.has_shear_cells() => class.uncoupled_stiffness(material),
                _ => class.stiffness(material),
            };
            set(pack, compliance(stiffness).max(least));
        }
        for (pack, class) in self.hinge_compliance.iter_mut().zip(fabric.hinge_classes()) {
            set(pack, compliance(class.stiffness(material)));
        }
        for (factors, profile) in self.bend_factors.iter_mut().zip(fabric.bend_profiles()) {
            factors.factorise(&lanes, profile, compliance(material.bend_stiffness));
        }
        let twists = resists_twist(fabric, material);
        for (factors, profile) in self.twist_factors.iter_mut().zip(fabric.ribbon_profiles()) {
            if twists {
                factors.factorise(&lanes, profile, compliance(material.bend_stiffness));
            } else {
                factors.forget(&lanes);
            }
        }
        let spacing = fabric.bend_profiles().iter().map(|profile| profile.inverse_spacing);
        let finest = spacing.fold(0.0, f32::max);
        let stiffness_number =
            16.0 * step * step * material.bend_stiffness / material.area_density * finest.powi(4);
        set(&mut self.anticipated, anticipated(fabric, stiffness_number));
        let air = 0.5 * air_density * applied.step / material.area_density;
        set(&mut self.pressure, air * material.pressure_coefficient);
        set(&mut self.friction, air * material.friction_coefficient);
        // The rigid motion of a pinned cloth is its frame's.
        let (pinned, free) = if fabric.has_pins() {
            (material.internal_damping, 0.0)
        } else {
            (0.0, material.internal_damping)
        };
        set(&mut self.keep, libm::expf(-(material.damping + pinned) * step));
        set(&mut self.keep_internal, libm::expf(-free * step));
    }

    /// Gravity, wind, what they stretch the cloth by, and the frame's motion in the coming substep. `apart` is
    /// the part by which pins are too far apart.
    pub fn set_drive(
        &mut self,
        lanes: Range<usize>,
        material: &FabricMaterial,
        drive: &Drive,
        reach: f32,
        apart: f32,
        clock: &Clock,
    ) {
        let (index, count) = (clock.done, clock.settings.substeps);
        let turned = |direction| drive.motion.turn_back(direction, index, count);
        let set = |pack: &mut P, value: f32| pack.lanes_mut()[lanes.clone()].fill(value);
        let set3 = |pack: &mut Pack3<P>, value: Vec3| fill_lanes3(pack, &lanes, value);
        set3(&mut self.gravity_step, turned(drive.gravity) * self.step.lanes()[lanes.start]);
        set3(&mut self.wind, turned(drive.wind));
        let tensions = greatest_tensions(material, drive, reach);
        let softness = 1.0 / material.warp_stiffness.min(material.weft_stiffness);
        let [hung, blown] = tensions.map(|tension| tension * softness);
        set(&mut self.tether_stretch, 1.0 + 2.0 * (apart + hung + blown));
        let [hung_askew, blown_askew] = tensions.map(|tension| tension * bias_softness(material));
        set(&mut self.far_tether_stretch, 1.0 + 2.0 * (apart + hung_askew + blown_askew));
        set(&mut self.bias_stretch, 1.0 + apart + hung + blown.min(MOST_BLOWN));
        let carry = drive.motion.carry(index, count);
        for (pack, row) in self.turn.iter_mut().zip(carry.turn.rows) {
            set3(pack, row);
        }
        set3(&mut self.shift, carry.shift);
        set(&mut self.moves, if carry.moves { 1.0 } else { 0.0 });
    }

    /// Whether the air acts on any lane.
    pub fn feels_air(&self) -> bool {
        let acts = |pack: &P| pack.lanes().iter().any(|&coefficient| coefficient != 0.0);
        acts(&self.pressure) || acts(&self.friction)
    }

    /// Whether any lane resists twist.
    pub fn twists(&self) -> bool {
        let first = self.twist_factors.first().and_then(|factors| factors.cells.first());
        first.is_some_and(|cell| cell.inverse.lanes().iter().any(|&inverse| inverse != 0.0))
    }

    /// Says whether the lanes of a cloth hardly move.
    pub fn set_creeps(&mut self, lanes: Range<usize>, creeps: bool) {
        self.creeps.lanes_mut()[lanes].fill(if creeps { 1.0 } else { 0.0 });
    }

    /// Whether they do.
    pub fn creeps(&self, lanes: Range<usize>) -> bool {
        self.creeps.lanes()[lanes.start] == 1.0
    }

    /// Whether any lane hardly moves.
    pub fn creeps_any(&self) -> bool {
        self.creeps.lanes().contains(&1.0)
    }

    /// Whether the frame of any lane moves in this substep.
    pub fn moves_any(&self) -> bool {
        self.moves.lanes().contains(&1.0)
    }
}

/// Strain by the wind beyond which it counts as not yet solved, rather than as the material's. Larger: what
/// a storm overstretches is not held by the bias. Smaller: what wind holds taut stretches too little.
const MOST_BLOWN: f32 = 0.01;

/// Strain of the bias for each N/m, m/N: that of warp and weft and of their shear.
fn bias_softness(material: &FabricMaterial) -> f32 {
    let FabricMaterial { warp_stiffness, weft_stiffness, shear_stiffness, .. } = *material;
    0.25 * (1.0 / warp_stiffness + 1.0 / weft_stiffness + 1.0 / shear_stiffness)
}

/// How much gravity and wind may pull at the top of a cloth that hangs by a length of `reach` metres, N/m.
fn greatest_tensions(material: &FabricMaterial, drive: &Drive, reach: f32) -> [f32; 2] {
    let weight = material.area_density * drive.gravity.length();
    let coefficients = material.pressure_coefficient + material.friction_coefficient;
    let pressure = 0.5 * drive.air_density * coefficients * drive.wind.length_squared();
    [weight * reach, pressure * reach]
}
