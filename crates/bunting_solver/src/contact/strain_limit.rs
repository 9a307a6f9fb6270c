//! Contacts that would strain cloth too far: the push is taken back, so that the shape comes through.
//!
//! A limb that pierces a cloth at its start, a banner that is driven against a post, a pin within a shape, or an edge over which cloth is
//! drawn leave particles no place on this side of the surface. Cloth that cannot tear would be drawn out without limit, and be thrown to
//! and fro by its links and the shape.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::contact::gather::CARRIED;
use crate::contact::substep::{Contact, Push};
use crate::simd::lane::Pack;
use crate::simd::vec3::set_lane3;

/// Greatest strain to which a push stretches a link, beyond the strain by weight, wind and pins. Smaller: shapes come through cloth that they
/// press hard, such as balls of 2 m/s through a curtain, or the load under a tarpaulin in a jolt. Larger: cloth that is caught stays stretched
/// that far, and trembles.
const GREATEST_STRAIN: f32 = 0.3;

/// Part of the way of the surface in a substep, relative to the nearest pin, by which a link may be longer, since what is pushed has moved before
/// lines can pull its neighbours along. Smaller: cloth that is dragged against a post passes through it, and a ball of 5 m/s passes through a
/// curtain in pieces. Larger: faster ones draw curtains out farther.
const DRAWN_ALONG: f32 = 2.0;

/// Greatest strain of the cloth between a particle that a shape carries along and its nearest pin, whose links may be stretched farther. Smaller:
/// fast shapes come through loose cloth. Larger: they draw cloth out that far.
const GREATEST_CARRIED_STRAIN: f32 = 2.0;

/// Length of a push, in lengths of the shortest link, up to which links are not looked at: if both ends are pushed so far apart, the strain is
/// [`GREATEST_STRAIN`].
const SHORT: f32 = 0.5 * GREATEST_STRAIN;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Whether pushes of a collider, of which the longest is given, m, strain no link of a cloth too far.
    pub(super) fn cannot_strain(&self, cloth: usize, contact: &Contact, longest: f32) -> bool {
        let link = self.fabric_of(cloth).fabric.shortest_link();
        contact.way() <= CARRIED * link && longest <= SHORT * link
    }

    /// Takes back those pushes of a collider that strain links too far.
    pub(super) fn take_back_straining(
        &mut self,
        cloth: usize,
        contact: &Contact,
        pushes: &mut Vec<Push>,
    ) {
        let lengths = pushes.iter().map(|push| push.before.distance(contact.end(push)));
        if self.cannot_strain(cloth, contact, lengths.fold(0.0, f32::max)) {
            return;
        }
        // Between a particle whose push is taken back and its neighbours links may be too long then.
        loop {
            let strains = |&index: &usize| self.strains(cloth, contact, &pushes[index]);
            let straining: Vec<usize> = (0..pushes.len()).filter(strains).collect();
            if straining.is_empty() {
                break;
            }
            for index in straining.into_iter().rev() {
                let push = pushes.remove(index);
                let (pack, lane) = self.layout.locate(push.particle as usize, cloth);
                set_lane3(&mut self.positions.packs_mut()[pack], lane, push.before);
            }
        }
    }

    /// Whether a push draws a particle too far from its nearest pin, or lengthens a link that is too long.
    fn strains(&self, cloth: usize, contact: &Contact, push: &Push) -> bool {
        let fabric = &self.fabric_of(cloth).fabric;
        let by_loads = self.stretch_by_loads(cloth);
        let after = self.position_of(cloth, push.particle);
        let mut way = contact.surface_motion(push.to);
        let mut strain_to_pin = 0.0;
        if let Some(tether) = fabric.tether_of(push.particle) {
            let pin = self.position_of(cloth, tether.pin);
            way -= pin - self.start_of(cloth, tether.pin);
            strain_to_pin = after.distance(pin) / tether.length - by_loads;
            // Beside a pin within the shape there is no place outside.
            if strain_to_pin > 0.0 && contact.contains(pin) {
                return true;
            }
        }
        let way = way.length();
        if way > CARRIED * fabric.shortest_link() {
            return strain_to_pin > GREATEST_CARRIED_STRAIN;
        }
        fabric.links_at(push.particle).any(|link| {
            let [one, other] = link.particles;
            let end = self.position_of(cloth, if one == push.particle { other } else { one });
            let length = after.distance(end);
            length > (by_loads + GREATEST_STRAIN) * link.rest_length + DRAWN_ALONG * way
                && length > push.before.distance(end)
        })
    }

    /// Length of a cloth under weight and wind, and between its pins, in lengths at rest.
    fn stretch_by_loads(&self, cloth: usize) -> f32 {
        let [_, stretch] = &self.parameters.tether_stretch;
        stretch.lanes()[Y::lanes(cloth).start]
    }
}
