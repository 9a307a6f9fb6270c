//! Boxes around cloths during a tick, by which a host finds the colliders that a cloth may touch.

use glam::Vec3;
use parry3d::bounding_volume::Aabb;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::lane_state::LaneState;
use crate::batch::layout::{Layout, Positions};
use crate::simd::lane::Pack;
use crate::simd::vec3::Pack3;
use crate::step::guides::ClothGuides;

/// Least and greatest coordinates in each lane, m, and the square of the greatest speed, m²/s².
struct Extent<P: Pack> {
    least: Pack3<P>,
    greatest: Pack3<P>,
    squared_speed: P,
}

impl<P: Pack> Extent<P> {
    fn of(positions: &[Pack3<P>], velocities: &[Pack3<P>]) -> Self {
        let mut extent = Self {
            least: [P::splat(f32::INFINITY); 3],
            greatest: [P::splat(f32::NEG_INFINITY); 3],
            squared_speed: P::splat(0.0),
        };
        for (position, [x, y, z]) in positions.iter().zip(velocities) {
            let extremes = extent.least.iter_mut().zip(&mut extent.greatest);
            for (at, (least, greatest)) in position.iter().zip(extremes) {
                let extremes = least.lanes_mut().iter_mut().zip(greatest.lanes_mut());
                for (&at, (least, greatest)) in at.lanes().iter().zip(extremes) {
                    *least = least.min(at);
                    *greatest = greatest.max(at);
                }
            }
            let velocity = x.lanes().iter().zip(y.lanes()).zip(z.lanes());
            for (most, ((x, y), z)) in extent.squared_speed.lanes_mut().iter_mut().zip(velocity) {
                *most = most.max(x * x + y * y + z * z);
            }
        }
        extent
    }
}

/// Greatest distance over which gravity and wind move a particle within a tick of `tick` seconds, m.
pub(super) fn moved_by_forces(state: &LaneState, tick: f32) -> f32 {
    let wind = state.drive.wind.length() + state.greatest_local_wind();
    state.drive.gravity.length() * tick * tick + wind * tick
}

/// Greatest distance over which moving pins, holds and guides drag a particle within a tick, m, given the positions of the
/// particles at its start. Cloth that hangs on them moves no farther than they do.
pub(super) fn dragged_by_anchors(state: &LaneState, position: impl Fn(u32) -> Vec3) -> f32 {
    let pins = state.moving_pins.now.iter().chain(&state.moving_pins.next);
    let by_pins = pins.map(|pin| pin.from.distance(pin.to));
    let holds = state.holds.iter().flat_map(|holds| &holds.list);
    let by_holds = holds.map(|hold| {
        let at = position(hold.particle);
        hold.by.place(1.0, at).distance(at)
    });
    let by_guides = state.guides.iter().map(ClothGuides::greatest_way);
    by_pins.chain(by_holds).chain(by_guides).fold(0.0, f32::max)
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// For each lane with a cloth, the box around all positions that its particles reach in a tick of `tick`
    /// seconds without contacts, relative to the frame at the start of the tick, with the cloth's thickness, m. Pins,
    /// holds and guides drag particles.
    pub fn swept_bounds(&self, tick: f32) -> Vec<Option<Aabb>> {
        let extent = Extent::of(self.positions.packs(), &self.velocity);
        let bounds_of = |(cloth, state): (usize, &Option<LaneState>)| {
            let state = state.as_ref()?;
            let of_lane =
                |pack: &Pack3<P>, lane: usize| Vec3::from(pack.map(|it| it.lanes()[lane]));
            // The cloth of a single lane is spread over all lanes.
            let mut all = Aabb::new_invalid();
            let mut squared_speed = 0.0_f32;
            for lane in Y::lanes(cloth) {
                all.mins = all.mins.min(of_lane(&extent.least, lane));
                all.maxs = all.maxs.max(of_lane(&extent.greatest, lane));
                squared_speed = squared_speed.max(extent.squared_speed.lanes()[lane]);
            }
            let by_speed = squared_speed.sqrt() * tick;
            let dragged = dragged_by_anchors(state, |particle| self.position_of(cloth, particle));
            let by_forces = moved_by_forces(state, tick);
            let reach = state.material.thickness + by_speed.max(dragged) + by_forces;
            Some(Aabb::new(all.mins - reach, all.maxs + reach))
        };
        self.lanes.iter().enumerate().map(bounds_of).collect()
    }
}
