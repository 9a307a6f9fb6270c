//! The state of a batch with a given width and layout.

use std::sync::Arc;

use glam::Vec3;

use crate::batch::lane_fabric::{FabricNumbers, LaneFabric};
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::batch::masses::Masses;
use crate::batch::mixed::Mixed;
use crate::batch::probe_motion::ProbeMotion;
use crate::batch::side_by_side::SideBySide;
use crate::constraints::rest_bends::RestBendPacks;
use crate::constraints::strip_block::StripBlock;
use crate::constraints::tridiagonal::TridiagonalRow;
use crate::contact::collider_packs::ColliderPacks;
use crate::fabric::{CHAINS_PER_PAIR, Fabric};
use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, lane3, set_lane3, splat3};
use crate::stability::pole::Pole;
use crate::step::clock::Clock;
use crate::step::guides::Guides;
use crate::step::local_wind::LocalWind;
use crate::step::parameters::Parameters;

/// Cloths of one fabric, or of one topology, in the lanes of packs of `P`, in the layout `Y`.
///
/// Arrays of packs have one pack for each particle, or for several particles of one cloth: see
/// [`Layout::locate`].
#[derive(Clone, Debug)]
pub(crate) struct LaneBatch<P: Pack, Y: Layout<P> = SideBySide<P>> {
    /// The fabric of the batch. Where cloths have different fabrics, this is one with their topology.
    pub fabric: Arc<Fabric>,
    /// The fabric of all cloths, or of each lane's cloth, present or last.
    pub fabrics: Vec<LaneFabric>,
    /// Numbers of these fabrics, in lanes.
    pub numbers: FabricNumbers<P>,
    /// For each lane that can hold a cloth, the cloth that it holds.
    pub lanes: Vec<Option<LaneState>>,
    pub layout: Y,

    /// Positions in the cloth's frame, m.
    pub positions: Y::Positions,
    /// Scratch array with successive uses, since fewer arrays leave more room in the cache. Before the
    /// prediction: for each particle the sum over its triangles of corner area times the change of their
    /// velocity by air, m³/s. Until the end of the substep: the positions at its start, m. From
    /// `compute_normals` to the next substep: unit normals.
    pub scratch: Vec<Pack3<P>>,
    /// Velocities relative to the world along the frame's axes, m/s.
    pub velocity: Vec<Pack3<P>>,
    /// Change of position in the last substep, or so far in this one, m.
    pub displacement: Vec<Pack3<P>>,
    /// Change of position in the substep before, m.
    pub older_displacement: Vec<Pack3<P>>,
    /// Velocities one substep earlier, m/s, plus all changes by air since.
    pub older_velocity: Vec<Pack3<P>>,
    /// Velocities two substeps earlier, m/s, plus all changes by air since.
    pub oldest_velocity: Vec<Pack3<P>>,
    /// Under-relaxation factor of each particle: the fraction of a change of velocity that is applied.
    pub relaxation: Vec<P>,

    /// Length that each link has under the tension found so far in the substep, l − α̃ λ, m, in the order in
    /// which the scheme solves links.
    pub link_target: Vec<P>,
    /// Scratch array of targets before bending that comes after stretch, m.
    pub targets_before_bending: Vec<P>,
    /// Scratch array of predicted positions, m, for lanes that bend stiffly.
    pub predicted_position: Vec<Pack3<P>>,
    /// Scratch array of displacements by stretch, m, for lanes that bend stiffly.
    pub stretch_shift: Vec<Pack3<P>>,
    /// Scratch array of the tridiagonal systems of a pair of chains.
    pub rows: Vec<TridiagonalRow<P>>,
    /// Scratch array of the closing links' parts in the unknowns of closed chains.
    pub by_closing: Vec<P>,
    /// Second differences at rest, if the fabric is a net.
    pub rest_bends: Option<Box<RestBendPacks<P, Y>>>,
    /// Scratch array of the block tridiagonal system of a strip.
    pub strip_blocks: Vec<StripBlock<P>>,
    /// Scratch array of the bending moments of a line, or the twisting moments of a ribbon.
    pub moments: Vec<Pack3<P>>,

    pub masses: Masses<P, Y::Constant>,
    /// Index of the partial sum to which each pack adds, in sums over all particles.
    pub partial_sums: Vec<u8>,
    pub parameters: Parameters<P>,
    pub clock: Clock,
    pub probe_motion: ProbeMotion<P>,
    /// Colliders near the cloths in this tick, as far as they are solved in lanes.
    pub collider_packs: Vec<ColliderPacks<P>>,
    /// The guides of the cloths, if any cloth has them.
    pub guides: Option<Box<Guides<P>>>,
    /// Wind at the particles, where it differs from particle to particle.
    pub local_wind: Option<Box<LocalWind<P>>>,
    /// Scratch array of the air inside cloths; empty if no cloth has a pressure.
    pub gradient: Vec<Pack3<P>>,
}

impl<P: Pack> LaneBatch<P> {
    /// An empty batch of cloths side by side.
    pub fn side_by_side(fabric: Arc<Fabric>) -> Self {
        let layout = SideBySide::new(&fabric);
        Self::new(fabric, layout)
    }
}

impl<P: Pack> LaneBatch<P, Mixed<P>> {
    /// An empty batch of cloths of different fabrics with the topology of this one; none where it has no
    /// [`topology`](Fabric::topology).
    pub fn mixed(fabric: &Arc<Fabric>) -> Option<Self> {
        let layout = Mixed::of(fabric)?;
        Some(Self::new(Arc::clone(fabric), layout))
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// An empty batch. Its lanes hold the fabric at rest.
    pub fn new(fabric: Arc<Fabric>, layout: Y) -> Self {
        let zero = vec![splat3(Vec3::ZERO); layout.pack_count()];
        let mut position = zero.clone();
        for (particle, &rest) in fabric.rest_positions().iter().enumerate() {
            for cloth in 0..Y::CLOTHS {
                let (pack, lane) = layout.locate(particle, cloth);
                set_lane3(&mut position[pack], lane, without_minus_zero(rest));
            }
        }
        let chains = layout.chains(&fabric);
        let longest_line = fabric.longest_line();
        let of_lanes = LaneFabric::new(Arc::clone(&fabric), 0.0);
        let mut batch = Self {
            numbers: FabricNumbers::new(&of_lanes),
            fabrics: vec![of_lanes; Y::FABRICS],
            lanes: vec![None; Y::CLOTHS],
            positions: layout.positions(position),
            scratch: zero.clone(),
            displacement: zero.clone(),
            older_displacement: zero.clone(),
            older_velocity: zero.clone(),
            oldest_velocity: zero.clone(),
            predicted_position: Vec::new(),
            stretch_shift: Vec::new(),
            velocity: zero,
            relaxation: vec![P::splat(1.0); layout.pack_count()],
            link_target: vec![P::splat(0.0); chains.target_count()],
            targets_before_bending: Vec::new(),
            rows: vec![TridiagonalRow::new(); CHAINS_PER_PAIR * chains.longest()],
            by_closing: vec![P::splat(0.0); CHAINS_PER_PAIR * chains.longest_closed()],
            rest_bends: RestBendPacks::of(&fabric, &layout).map(Box::new),
            strip_blocks: Vec::new(),
            moments: vec![splat3(Vec3::ZERO); longest_line],
            masses: Masses::new(
                layout.constants(fabric.particle_areas()),
                layout.constants(fabric.inverse_areas()),
                layout.pack_count(),
            ),
            partial_sums: layout.partial_sums(),
            parameters: Parameters::new(),
            clock: Clock::default(),
            probe_motion: ProbeMotion::default(),
            collider_packs: Vec::new(),
            guides: None,
            local_wind: None,
            gradient: Vec::new(),
            fabric,
            layout,
        };
        batch.set_diagonals_at_rest(0..P::WIDTH);
        batch.positions.set_inverse_masses(batch.fabric.inverse_areas());
        for cloth in 0..Y::CLOTHS {
            batch.layout.set_pins(cloth, &batch.fabric, batch.fabric.rest_positions());
        }
        batch
    }

    /// The fabric of a lane's cloth.
    pub fn fabric_of(&self, cloth: usize) -> &LaneFabric {
        &self.fabrics[Y::fabric_of(cloth)]
    }

    /// The vector of a particle among those of all.
    pub fn vector(&self, packs: &[Pack3<P>], particle: usize, cloth: usize) -> Vec3 {
        let (pack, lane) = self.layout.locate(particle, cloth);
        lane3(&packs[pack], lane)
    }

    /// The line about which a cloth is free to turn in this substep.
    pub fn pole_of(&self, cloth: usize) -> Option<Pole> {
        let packs = self.numbers.pole.as_ref()?;
        let at_rest = self.fabric_of(cloth).pole?;
        Some(packs.of_lane(Y::lanes(cloth).start, at_rest))
    }

    /// Gives a lane another fabric of the batch's topology, before a cloth of that fabric is put into it.
    pub fn set_fabric(&mut self, cloth: usize, fabric: &Arc<Fabric>) {
        let of_lane = &mut self.fabrics[Y::fabric_of(cloth)];
        if Arc::ptr_eq(&of_lane.fabric, fabric) {
            return;
        }
        *of_lane = LaneFabric::new(Arc::clone(fabric), self.masses.substep);
        self.numbers.set(Y::lanes(cloth), of_lane);
        self.layout.set_fabric(cloth, fabric, &mut self.masses);
    }
}

/// Returns the position with each −0 replaced by 0. Adding zero to −0 gives 0, and whether zero is added to a
/// pin's coordinate depends on the layout.
pub(super) fn without_minus_zero(position: Vec3) -> Vec3 {
    position + Vec3::ZERO
}
