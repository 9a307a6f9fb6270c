//! The state of a batch at one width.

use std::sync::Arc;

use glam::Vec3;

use crate::batch::layout::{Packed, Seating};
use crate::batch::places::Constant;
use crate::batch::single_cloth::Weave;
use crate::batch::snapshot::ClothSnapshot;
use crate::constraints::Knot;
use crate::contact::collider::Collider;
use crate::fabric::{CHAINS_PER_PAIR, Fabric, FabricMaterial};
use crate::simd::lane::{Pack, Pack1};
use crate::simd::vec3::{Pack3, set_lane3, splat3};
use crate::stability::added_mass::{self, Hung, Weights};
use crate::stability::pin_strain::Overstretch;
use crate::stability::pole::Pole;
use crate::step::bdf::{Formula, Past};
use crate::step::parameters::Parameters;
use crate::step::{Drive, Scheme, StepSettings};

/// One cloth's place in a batch: what the lanes do not hold.
#[derive(Clone, Debug)]
pub(crate) struct Slot {
    pub material: FabricMaterial,
    pub drive: Drive,
    pub colliders: Vec<Collider>,
    /// What there is of the lane's history.
    pub past: Past,
    /// What the lane's parameters were last computed from.
    pub applied: Option<Applied>,
    /// What its pins strain it by.
    pub overstretch: Overstretch,
    /// What its weights were last computed from.
    pub hung: Option<Hung>,
    /// Moment about the pole of what its contacts did in this substep, in units of the density, m⁴.
    pub contact_moment: f32,
    /// For each collider, the particles that may touch it in this tick.
    pub contacts: Vec<Vec<u32>>,
}

/// One of the vectors of each particle, if the state has it.
type OfState = fn(&ClothSnapshot) -> Option<&[Vec3]>;

/// What a lane's compliances, air and damping depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Applied {
    pub material: FabricMaterial,
    pub air_density: f32,
    /// Length of a substep, s.
    pub step: f32,
    pub formula: Formula,
    /// The bias of a grid does not carry the same in each.
    pub scheme: Scheme,
}

/// Up to `P::WIDTH` cloths of one fabric, one in each lane. Or one whose particles lie side by side in the
/// lanes: then what belongs to the fabric is each lane's own, and `C` is `P`.
#[derive(Clone, Debug)]
pub(crate) struct LaneBatch<P: Pack, C = f32> {
    pub fabric: Arc<Fabric>,
    pub slots: Vec<Option<Slot>>,

    /// Positions in the cloth's frame, m.
    pub position: Vec<Pack3<P>>,
    /// What is needed for a while only, as fewer arrays leave more room in the cache. Within a substep the
    /// positions at its start, m. Before that, for each particle the sum over its triangles of area times
    /// what the air changes of their velocity, m³/s. Once computed, and up to the next substep, unit normals.
    pub scratch: Vec<Pack3<P>>,
    /// Velocities relative to the world along the frame's axes, m/s.
    pub velocity: Vec<Pack3<P>>,
    /// Change of position in the last substep, or so far in this one, m.
    pub displacement: Vec<Pack3<P>>,
    /// Change of position in the substep before, m.
    pub older_displacement: Vec<Pack3<P>>,
    /// Velocities a substep earlier, m/s, and what the air has changed them by since.
    pub older_velocity: Vec<Pack3<P>>,
    /// The same of two substeps earlier, m/s.
    pub oldest_velocity: Vec<Pack3<P>>,
    /// What part of what changes its velocity each particle follows: less than all of it where it trembles.
    pub share: Vec<P>,

    /// The length that each link has under the tension found so far in a substep, l − α̃ λ, m. In the
    /// order in which the scheme solves links.
    pub link_target: Vec<P>,
    /// Multipliers of hinges, kept from pass to pass of a substep.
    pub hinge_multiplier: Vec<P>,

    /// Positions after bending, before stretch, m.
    pub bent: Vec<Pack3<P>>,
    /// What stretch does to each particle, as a remembered acceleration, m/s².
    pub memory: Vec<Pack3<P>>,
    /// Room for what the cells of a row of a grid give to the particles below them.
    pub below: Vec<Pack3<P>>,
    /// Room for the bending moments of a line.
    pub moments: Vec<Pack3<P>>,
    /// Room for the links of yarns side by side.
    pub knots: Vec<Knot<P>>,

    /// One over each particle's inertia.
    pub weights: Weights,
    /// The same for each cloth as it hangs, 1/m²; zero where it is pinned.
    pub lane_weights: Vec<P>,
    /// One over that, m²; zero where it is pinned.
    pub lane_inertias: Vec<P>,
    /// Where the particles lie.
    pub seating: Seating,
    /// For each pack, into which part of a sum over all particles it goes.
    pub parts: Vec<u8>,
    /// What the particles of each pack have.
    pub packs: Packed<C>,
    /// The effective substep that the weights are for, s; zero with the fabric's own.
    weights_step: f32,

    /// The line about which the cloth is free to turn.
    pub pole: Option<Pole>,
    pub parameters: Parameters<P>,
    /// The cloth's own yarns in the lanes of a vector, where it has one to itself.
    pub weave: Option<Box<Weave<P>>>,
    pub clock: Clock,
}

/// Where in the tick the batch is.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Clock {
    pub settings: StepSettings,
    /// Length of a substep, s.
    pub step: f32,
    /// Substeps done in this tick.
    pub done: u32,
}

impl Clock {
    /// Whether no time passes in this tick, or none that can be reckoned with.
    pub fn stands_still(&self) -> bool {
        !(self.step > 0.0 && self.step.is_finite())
    }
}

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    pub fn new(fabric: Arc<Fabric>) -> Self {
        let seating = Seating::of::<P, C>(&fabric);
        let parts = seating.parts();
        let zero = vec![splat3(Vec3::ZERO); parts.len()];
        let nothing = P::splat(0.0);
        let longest_line =
            fabric.bend_lines().iter().map(|line| line.particles.len()).max().unwrap_or(0);
        let longest_yarn = fabric.chains().longest();
        let cloths = P::WIDTH / C::SIDE;
        // Lanes without a cloth lie at rest.
        let mut position = zero.clone();
        for (particle, &rest) in fabric.rest_positions().iter().enumerate() {
            for cloth in 0..cloths {
                let (pack, lane) = seating.seat(particle, cloth);
                set_lane3(&mut position[pack], lane, without_minus_zero(rest));
            }
        }
        let mut batch = Self {
            slots: vec![None; cloths],
            scratch: zero.clone(),
            displacement: zero.clone(),
            bent: zero.clone(),
            memory: zero.clone(),
            older_displacement: zero.clone(),
            older_velocity: zero.clone(),
            oldest_velocity: zero.clone(),
            position,
            velocity: zero,
            link_target: vec![nothing; fabric.chains().target_count()],
            hinge_multiplier: vec![nothing; fabric.hinges().len()],
            below: vec![splat3(Vec3::ZERO); fabric.patch_grid_columns().unwrap_or(0)],
            moments: vec![splat3(Vec3::ZERO); longest_line],
            knots: vec![Knot::new(); CHAINS_PER_PAIR * longest_yarn],
            weights: Weights::bare(&fabric),
            share: vec![P::splat(1.0); parts.len()],
            lane_weights: vec![nothing; parts.len()],
            lane_inertias: vec![nothing; parts.len()],
            packs: Packed::new(seating, &fabric),
            parts,
            seating,
            weights_step: 0.0,
            pole: Pole::of(&fabric),
            parameters: Parameters::new(&fabric),
            weave: None,
            clock: Clock::default(),
            fabric,
        };
        batch.square_cells_as_at_rest(0..P::WIDTH);
        batch
    }

    /// Empties lanes, and fills others.
    pub fn exchange(&mut self, leave: &[usize], come: &[(usize, &ClothSnapshot, FabricMaterial)]) {
        // Who leaves is forgotten by the next substep, for which they have no time. But what is no number
        // would stay.
        let rest = ClothSnapshot::at_rest(&self.fabric);
        let mut states = Vec::new();
        for &lane in leave {
            self.slots[lane] = None;
            if !self.is_finite(lane) {
                states.push((lane, &rest));
            }
        }
        for &(lane, snapshot, material) in come {
            self.slots[lane] = Some(Slot {
                material,
                drive: Drive::default(),
                colliders: Vec::new(),
                past: Past::default(),
                applied: None,
                overstretch: Overstretch::default(),
                hung: None,
                contact_moment: 0.0,
                contacts: Vec::new(),
            });
            states.push((lane, snapshot));
        }
        self.restore(&states);
    }

    /// Overwrites the states of lanes, all in one pass over the memory; those without a history go on with a
    /// substep of first order.
    pub fn restore(&mut self, states: &[(usize, &ClothSnapshot)]) {
        let unsigned = |state: &ClothSnapshot| -> Vec<Vec3> {
            state.positions.iter().copied().map(without_minus_zero).collect()
        };
        let positions: Vec<Vec<Vec3>> = states.iter().map(|(_, state)| unsigned(state)).collect();
        let shape: Vec<_> =
            states.iter().zip(&positions).map(|(&(lane, _), at)| (lane, Some(&at[..]))).collect();
        // Without a history, what else is there counts for nothing, as long as these are numbers.
        let counts = |&(lane, state): &(usize, &ClothSnapshot)| {
            state.history.is_some() || C::SIDE > 1 || !self.is_finite(lane)
        };
        let with_past: Vec<_> = states.iter().copied().filter(counts).collect();
        let seating = self.seating;
        seating.write::<P, C>(&mut self.position, &shape);
        let arrays: [(_, &[_], OfState); 6] = [
            (&mut self.velocity, states, |state| Some(&state.velocities)),
            (&mut self.memory, states, |state| Some(&state.history.as_ref()?.memory)),
            (&mut self.displacement, &with_past, |state| {
                Some(&state.history.as_ref()?.displacements[0])
            }),
            (&mut self.older_displacement, &with_past, |state| {
                Some(&state.history.as_ref()?.displacements[1])
            }),
            (&mut self.older_velocity, &with_past, |state| {
                Some(&state.history.as_ref()?.older_velocities[0])
            }),
            (&mut self.oldest_velocity, &with_past, |state| {
                Some(&state.history.as_ref()?.older_velocities[1])
            }),
        ];
        for (packs, states, of) in arrays {
            let values: Vec<_> = states.iter().map(|&(lane, state)| (lane, of(state))).collect();
            seating.write::<P, C>(packs, &values);
        }
        for (&(lane, state), positions) in states.iter().zip(&positions) {
            self.set_shares(lane, state.history.as_ref().map_or(&[], |past| &past.shares));
            // At the start of a tick they are found anew.
            if (1..self.clock.settings.substeps).contains(&self.clock.done) {
                self.square_cells_as_at_rest(C::lanes(lane));
            }
            for pin in self.fabric.pins() {
                let (pack, lane) = self.seating.seat(pin.particle as usize, lane);
                set_lane3(&mut self.velocity[pack], lane, Vec3::ZERO);
            }
            if let Some(weave) = &mut self.weave {
                weave.begin(positions);
            }
            if let Some(slot) = &mut self.slots[lane] {
                slot.past = state.history.as_ref().map_or_else(Past::default, |past| past.past);
                let overstretch = Overstretch::of(&self.fabric, positions);
                if slot.overstretch != overstretch {
                    slot.overstretch = overstretch;
                    slot.hung = None;
                }
            }
        }
    }

    /// Sets everything that is constant over the tick, and gathers contacts.
    pub fn begin_tick(&mut self, tick: f32, settings: StepSettings) {
        let step = tick / settings.substeps as f32;
        self.clock = Clock { settings, step, done: 0 };
        if self.clock.stands_still() {
            return;
        }
        let weights_step = match settings.scheme {
            Scheme::GaussSeidel => 0.0,
            Scheme::Yarns => Formula::BDF2_OPT.weight * step,
        };
        if self.weights_step != weights_step {
            self.weights_step = weights_step;
            self.weights = Weights::new(&self.fabric, weights_step);
            self.slots.iter_mut().flatten().for_each(|slot| slot.hung = None);
        }
        self.gather_contacts(tick);
    }

    /// Sets everything that is constant over the substep.
    pub fn begin_substep(&mut self) {
        let moved = self.parameters.moves_any();
        let Clock { settings, step, .. } = self.clock;
        for (cloth, slot) in self.slots.iter_mut().enumerate() {
            let lanes = C::lanes(cloth);
            let Some(slot) = slot else {
                self.parameters.set_empty(lanes);
                continue;
            };
            let formula = slot.past.begin(step, settings.scheme);
            self.parameters.set_turned(lanes.clone(), slot.past.turned);
            let applied = Applied {
                material: slot.material,
                air_density: slot.drive.air_density,
                step,
                formula,
                scheme: settings.scheme,
            };
            if slot.applied.replace(applied) != Some(applied) {
                self.parameters.apply(lanes.clone(), &self.fabric, &applied);
                if let Some(weave) = &mut self.weave {
                    weave.set_parameters(&self.parameters);
                }
            }
            let upright = self.pole.map_or(0.0, |pole| pole.uprightness(slot.drive.gravity));
            let hung = Hung::new(
                upright,
                &slot.overstretch,
                &self.fabric,
                &slot.material,
                self.weights_step,
            );
            if slot.hung.replace(hung) != Some(hung) {
                let weights = self.weights.of_lane(hung, &slot.overstretch);
                let inertias = added_mass::inertias(&weights);
                self.seating.put(cloth, &weights, &mut self.lane_weights);
                self.seating.put(cloth, &inertias, &mut self.lane_inertias);
                if let Some(weave) = &mut self.weave {
                    weave.sheets.set_weights(&weights);
                }
            }
            let reach = match self.fabric.grid() {
                // What is free is held by its own inertia.
                Some(grid) if !self.fabric.has_pins() => grid.width.max(grid.height),
                _ => self.fabric.reach(),
            };
            let apart = slot.overstretch.greatest;
            self.parameters.set_drive(
                lanes,
                &slot.material,
                &slot.drive,
                reach,
                apart,
                &self.clock,
            );
        }
        // One substep more than the motion lasts, so that pinned particles come to rest.
        self.parameters.carries = moved || self.parameters.moves_any();
    }
}

impl<P: Pack> LaneBatch<P, P> {
    /// A batch of one cloth that fills the lanes with its own yarns, if the fabric lets it.
    pub fn woven_of(fabric: &Arc<Fabric>) -> Option<Self> {
        let mut weave = Weave::of(fabric)?;
        let mut batch = Self::new(Arc::clone(fabric));
        weave.begin(fabric.rest_positions());
        batch.weave = Some(Box::new(weave));
        batch.square_cells_as_at_rest(0..P::WIDTH);
        Some(batch)
    }

    /// The same cloth by itself in a lane, for a scheme without yarns.
    pub fn unwoven(&self) -> LaneBatch<Pack1> {
        let mut batch = LaneBatch::new(Arc::clone(&self.fabric));
        if let Some(slot) = &self.slots[0] {
            batch.exchange(&[], &[(0, &self.snapshot(0), slot.material)]);
            batch.slots[0] = Some(Slot { applied: None, hung: None, ..slot.clone() });
        }
        for (pack, normal) in batch.scratch.iter_mut().zip(self.of_cloth(&self.scratch, 0)) {
            set_lane3(pack, 0, normal);
        }
        batch
    }
}

/// A position rid of −0, which would or would not become 0 where something of no weight is added.
fn without_minus_zero(position: Vec3) -> Vec3 {
    position + Vec3::ZERO
}
