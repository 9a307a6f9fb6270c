//! Contacts that would tear cloth: a shape passes through cloth that it would draw out too far.
//!
//! A banner that is driven against a post, or a pin within a shape, leaves particles no place on this side of the
//! surface. Cloth that cannot tear would be drawn out without limit, and be thrown to and fro by its links and the shape.

use glam::Vec3;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::contact::substep::{Contact, Push};
use crate::fabric::Tether;
use crate::simd::lane::Pack;
use crate::simd::vec3::set_lane3;

/// Greatest distance from its nearest pin, in lengths of the tether between them, to which a shape moves a particle.
/// Smaller: fast shapes that draw cloth out pass through it. Larger: caught cloth is stretched that far.
const DRAWN_OUT: f32 = 3.0;

/// Greatest length of a link, in lengths at rest, to which a shape that stands still pulls it. Smaller: corners of shapes
/// that press taut cloth pass through it. Larger: caught cloth is stretched that far, and trembles.
const TORN: f32 = 4.0;

/// Part of the motion of the surface in a substep, relative to the nearest pin, by which a link may be longer. Smaller:
/// fast shapes that draw cloth out pass through it. Larger: cloth is stretched farther before it comes free of a shape
/// that drives on.
const DRAWN_ALONG: f32 = 4.0;

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Takes back those pushes of a collider that draw a pinned cloth out too far.
    pub(super) fn take_back_tearing(
        &mut self,
        cloth: usize,
        contact: &Contact,
        pushes: &mut Vec<Push>,
    ) {
        let fabric = &self.fabric_of(cloth).fabric;
        if !fabric.has_pins() {
            return;
        }
        let shortest = fabric.shortest_link();
        let is_drawn_out = |push: &Push| self.is_drawn_out(cloth, contact, push);
        let drawn_out = (0..pushes.len()).filter(|&push| is_drawn_out(&pushes[push])).collect();
        self.take_back(cloth, drawn_out, pushes);
        // Short pushes hardly lengthen any link.
        if pushes.iter().any(|push| push.before.distance(contact.end(push)) > shortest) {
            // The links between a particle whose push is taken back and its neighbours may be too long then.
            loop {
                let tearing = self.pushes_at_torn_links(cloth, contact, pushes);
                if tearing.is_empty() {
                    break;
                }
                self.take_back(cloth, tearing, pushes);
            }
        }
    }

    /// Takes back pushes, given by their indices in ascending order.
    fn take_back(&mut self, cloth: usize, indices: Vec<usize>, pushes: &mut Vec<Push>) {
        for index in indices.into_iter().rev() {
            let push = pushes.remove(index);
            let (pack, lane) = self.layout.locate(push.particle as usize, cloth);
            set_lane3(&mut self.positions.packs_mut()[pack], lane, push.before);
        }
    }

    /// Whether a push draws a particle out too far from its pin, or farther from a pin within the shape than its tether
    /// reaches.
    fn is_drawn_out(&self, cloth: usize, contact: &Contact, push: &Push) -> bool {
        let Some(tether) = self.tether_of(cloth, push.particle) else { return false };
        let pin = self.position_of(cloth, tether.pin);
        let [_, of_nearest] = &self.parameters.tether_stretch;
        let reach = of_nearest.lanes()[Y::lanes(cloth).start] * tether.length;
        let distance = contact.end(push).distance(pin);
        distance > DRAWN_OUT * reach || distance > reach && contact.contains(pin)
    }

    /// The tether of a particle to its nearest pin.
    fn tether_of(&self, cloth: usize, particle: u32) -> Option<&Tether> {
        let tethers = self.fabric_of(cloth).fabric.tethers();
        let index = tethers.binary_search_by_key(&particle, |tether| tether.particle).ok()?;
        Some(&tethers[index])
    }

    /// Motion of a particle's nearest pin in the substep, m, in the present frame.
    fn way_of_pin(&self, cloth: usize, particle: u32) -> Vec3 {
        let Some(tether) = self.tether_of(cloth, particle) else { return Vec3::ZERO };
        self.position_of(cloth, tether.pin) - self.start_of(cloth, tether.pin)
    }

    /// Indices, in ascending order, of the pushes that make a link too long.
    fn pushes_at_torn_links(&self, cloth: usize, contact: &Contact, pushes: &[Push]) -> Vec<usize> {
        let mut tearing = Vec::new();
        for link in self.fabric_of(cloth).fabric.links() {
            let ends = link.particles.map(|end| self.position_of(cloth, end));
            let length = ends[0].distance(ends[1]);
            let most = TORN * link.rest_length;
            if length <= most {
                continue;
            }
            for (end, other) in [(0, ends[1]), (1, ends[0])] {
                let is_of_end = |push: &Push| push.particle == link.particles[end];
                let Some(index) = pushes.iter().position(is_of_end) else { continue };
                let push = &pushes[index];
                let way = contact.surface_motion(push.to) - self.way_of_pin(cloth, push.particle);
                let drawn_along = DRAWN_ALONG * way.length();
                if length > most + drawn_along && length > push.before.distance(other) {
                    tearing.push(index);
                }
            }
        }
        tearing.sort_unstable();
        tearing.dedup();
        tearing
    }
}
