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
/// press hard, such as balls of 2 m/s through a curtain. Larger: cloth that is caught stays stretched that far, and trembles.
const GREATEST_STRAIN: f32 = 0.2;

/// Greatest strain of the cloth between a particle that a shape carries along and its nearest pin. Single links are stretched farther, since what
/// is hit by such a shape has moved before lines can pull its neighbours along. Smaller: fast shapes come through loose cloth. Larger: they
/// draw cloth out that far.
const GREATEST_CARRIED_STRAIN: f32 = 0.5;

/// Length of a push, in lengths of the shortest link, up to which links are not looked at: if both ends are pushed so far apart, the strain is
/// [`GREATEST_STRAIN`].
const SHORT: f32 = 0.5 * GREATEST_STRAIN;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Takes back those pushes of a collider that strain links too far.
    pub(super) fn take_back_straining(
        &mut self,
        cloth: usize,
        contact: &Contact,
        pushes: &mut Vec<Push>,
    ) {
        let link = self.fabric_of(cloth).fabric.shortest_link();
        let is_fast = contact.way() > CARRIED * link;
        let is_short = |push: &Push| push.before.distance(contact.end(push)) <= SHORT * link;
        if !is_fast && pushes.iter().all(is_short) {
            return;
        }
        // Between a particle whose push is taken back and its neighbours links may be too long then.
        loop {
            let strains = |&index: &usize| {
                let push = &pushes[index];
                self.is_carried_off(cloth, contact, push, is_fast)
                    || !is_fast && self.strains_links(cloth, push)
            };
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

    /// Whether a push draws a particle farther from its nearest pin than a fast shape may, or than any may if the pin is within the shape.
    fn is_carried_off(&self, cloth: usize, contact: &Contact, push: &Push, is_fast: bool) -> bool {
        let Some(tether) = self.fabric_of(cloth).fabric.tether_of(push.particle) else {
            return false;
        };
        let pin = self.position_of(cloth, tether.pin);
        let distance = self.position_of(cloth, push.particle).distance(pin);
        let strain = distance / tether.length - self.stretch_by_loads(cloth);
        is_fast && strain > GREATEST_CARRIED_STRAIN || strain > 0.0 && contact.contains(pin)
    }

    /// Whether a push lengthens a link that is too long.
    fn strains_links(&self, cloth: usize, push: &Push) -> bool {
        let greatest = self.stretch_by_loads(cloth) + GREATEST_STRAIN;
        let after = self.position_of(cloth, push.particle);
        self.fabric_of(cloth).fabric.links_at(push.particle).any(|link| {
            let [one, other] = link.particles;
            let end = self.position_of(cloth, if one == push.particle { other } else { one });
            let length = after.distance(end);
            length > greatest * link.rest_length && length > push.before.distance(end)
        })
    }

    /// Length of a cloth under weight and wind, and between its pins, in lengths at rest.
    fn stretch_by_loads(&self, cloth: usize) -> f32 {
        let [_, stretch] = &self.parameters.tether_stretch;
        stretch.lanes()[Y::lanes(cloth).start]
    }
}
