//! Nodes along the middle of strips of about one cell, such as straps and ties, which could not bend across otherwise.

use glam::DVec3;

use super::boxes::Boxes;
use super::place::Place;
use super::places::Choice;
use super::triangle::{nearest, nearest_weights};
use super::walk::Walks;

/// Greatest width of a strip, cells. Larger: a line of the lattice runs between its borders in most places.
const WIDEST: f64 = 1.6;

/// Least width of a strip, cells. Smaller: links a tenth as long as others.
const NARROWEST: f64 = 0.3;

/// Greatest cosine of the angle between the ways that two borders face, into the cloth. Larger: corners are strips.
const OPPOSITE: f64 = -0.5;

/// Least cosine of the angle between the way that a border faces and the way to the other border.
const ACROSS: f64 = 0.8;

impl Choice<'_> {
    /// Places halfway between two that lie opposite one another on the borders of a strip, each with the width of the strip, cells.
    pub(super) fn along_strips(&self, border: &[Place]) -> Vec<(Place, f64)> {
        let mut walks = Walks::on(&self.source.faces);
        let inward: Vec<Option<DVec3>> = border.iter().map(|place| self.inward(place)).collect();
        let mut boxes = Boxes::new(WIDEST * self.size);
        (0..).zip(border).for_each(|(index, place)| boxes.add(place.at, index));
        let mut between = Vec::new();
        for (from, inward_from) in border.iter().zip(&inward) {
            let Some(inward_from) = inward_from else { continue };
            let opposite = boxes.near(from.at).iter().filter_map(|&at| {
                let to = &border[at as usize];
                let way = to.at - from.at;
                let width = way.length() / self.size;
                let is_opposite = (NARROWEST..WIDEST).contains(&width)
                    && inward[at as usize].is_some_and(|it| it.dot(*inward_from) < OPPOSITE)
                    && way.dot(*inward_from) > ACROSS * way.length();
                is_opposite.then_some((width, to))
            });
            let Some((width, to)) = opposite.min_by(|one, other| one.0.total_cmp(&other.0)) else {
                continue;
            };
            // Each pair is found from both of its places.
            if from.at.to_array() < to.at.to_array()
                && let Some(middle) = self.halfway(&mut walks, from, to)
            {
                between.push((middle, width));
            }
        }
        between
    }

    /// The way into the cloth from a place on its border, a unit vector.
    fn inward(&self, place: &Place) -> Option<DVec3> {
        let faces = &self.source.faces;
        let is_on = |side: &usize| {
            let opposite = (side + 2) % 3;
            faces.across(place.triangle, *side).is_none() && place.weights[opposite] == 0.0
        };
        let side = (0..3).find(is_on)?;
        let corners = faces.corners(place.triangle).map(|corner| corner.as_dvec3());
        let [a, b, c] = [0, 1, 2].map(|by| corners[(side + by) % 3]);
        (c - a).reject_from((b - a).try_normalize()?).try_normalize()
    }

    /// The place on the surface nearest to the middle between two; none if no way along the surface leads from one to the other.
    fn halfway(&self, walks: &mut Walks, from: &Place, to: &Place) -> Option<Place> {
        let middle = from.at.midpoint(to.at);
        let mut best: Option<(f64, u32)> = None;
        let mut is_reached = false;
        walks.any_within((from.triangle, from.at), WIDEST * self.size, |triangle| {
            is_reached |= triangle == to.triangle;
            let away = nearest(middle, self.points(triangle)).distance_squared(middle);
            if best.is_none_or(|best| away < best.0) {
                best = Some((away, triangle));
            }
            false
        });
        let (_, triangle) = best.filter(|_| is_reached)?;
        Some(self.place(triangle, nearest_weights(middle, self.points(triangle))))
    }

    fn points(&self, triangle: u32) -> [DVec3; 3] {
        self.source.faces.corners(triangle).map(|corner| corner.as_dvec3())
    }
}
