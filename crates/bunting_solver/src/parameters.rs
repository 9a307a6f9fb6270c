//! What differs from lane to lane and is constant over a tick or a substep.

use glam::Vec3;

use crate::fabric::{Fabric, FabricMaterial};
use crate::lane_batch::Clock;
use crate::lanes::Pack;
use crate::step::Drive;
use crate::vector::{Pack3, set_lane3, splat3};

/// One value for each lane of everything that a kernel needs besides the particles.
#[derive(Clone, Debug)]
pub(crate) struct Parameters<P: Pack> {
    /// σ/(k h²) of each link class, 1/m²: compliance in units of inverse areas.
    pub link_compliance: Vec<P>,
    /// σ/(k h²) of each hinge class, 1/m⁴.
    pub hinge_compliance: Vec<P>,
    /// Gravity times the substep, m/s.
    pub gravity_step: Pack3<P>,
    /// Air velocity, m/s.
    pub wind: Pack3<P>,
    /// ½ ρ C_n h/σ, s/m.
    pub pressure: P,
    /// ½ ρ C_t h/σ, s/m.
    pub friction: P,
    /// Part of the velocity relative to the frame that damping leaves in a substep.
    pub keep: P,
    /// Part of the non-rigid velocity that internal damping leaves in a substep, for cloth without
    /// pins.
    pub keep_internal: P,
    /// The frame's motion in this substep, see [`Carry`](crate::frame::Carry).
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
            link_compliance: vec![nothing; fabric.link_classes().len()],
            hinge_compliance: vec![nothing; fabric.hinge_classes().len()],
            gravity_step: splat3(Vec3::ZERO),
            wind: splat3(Vec3::ZERO),
            pressure: nothing,
            friction: nothing,
            keep: P::splat(1.0),
            keep_internal: P::splat(1.0),
            turn: [splat3(Vec3::ZERO); 3],
            shift: splat3(Vec3::ZERO),
            moves: nothing,
            carries: false,
        }
    }

    /// Compliances, air and damping for a substep of `step` seconds.
    pub fn set_material(
        &mut self,
        lane: usize,
        fabric: &Fabric,
        material: &FabricMaterial,
        air_density: f32,
        step: f32,
    ) {
        let set = |pack: &mut P, value: f32| pack.lanes_mut()[lane] = value;
        // A stiffness of zero has an infinite compliance; the largest number is as soft, and zero
        // times it is still zero.
        let compliance =
            |stiffness: f32| (material.area_density / (stiffness * step * step)).min(f32::MAX);
        for (pack, class) in self.link_compliance.iter_mut().zip(fabric.link_classes()) {
            set(pack, compliance(class.stiffness(material)));
        }
        for (pack, class) in self.hinge_compliance.iter_mut().zip(fabric.hinge_classes()) {
            set(pack, compliance(class.stiffness(material)));
        }
        let air = 0.5 * air_density * step / material.area_density;
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

    /// Gravity, wind and the frame's motion in the coming substep.
    pub fn set_drive(&mut self, lane: usize, drive: &Drive, clock: &Clock) {
        let (index, count) = (clock.done, clock.settings.substeps);
        let turned = |direction| drive.motion.turn_back(direction, index, count);
        set_lane3(&mut self.gravity_step, lane, turned(drive.gravity) * clock.step);
        set_lane3(&mut self.wind, lane, turned(drive.wind));
        let carry = drive.motion.carry(index, count);
        for (pack, row) in self.turn.iter_mut().zip(carry.turn.rows) {
            set_lane3(pack, lane, row);
        }
        set_lane3(&mut self.shift, lane, carry.shift);
        self.moves.lanes_mut()[lane] = if carry.moves { 1.0 } else { 0.0 };
    }

    /// Whether the frame of any lane moves in this substep.
    pub fn moves_any(&self) -> bool {
        self.moves.lanes().contains(&1.0)
    }
}
