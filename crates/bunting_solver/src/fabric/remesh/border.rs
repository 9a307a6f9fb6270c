//! The places of nodes on the border of a mesh: at its corners, where lines of the lattice cross it, and between.

use std::collections::BTreeMap;

use super::place::Place;
use super::places::{Choice, LEAST_DISTANCE};
use super::source::Source;

/// Least sine of the turn of a border at a corner.
const CORNER: f64 = 0.5;

/// Greatest tangent of the angle between the border and an axis of the lattice that it runs along. Larger: the other lines cross it anywhere.
const ALONG: f64 = 0.35;

/// Part of a side of a triangle at its ends in which a place is that end.
const AT_END: f64 = 0.15;

/// Fewest nodes around a border.
const FEWEST: usize = 3;

/// A side of a triangle at the border.
#[derive(Clone, Copy)]
struct Side {
    triangle: u32,
    /// Joins this corner to the next one.
    corner: usize,
    /// Its distance from the beginning of the border, m, and its length, m.
    start: f64,
    length: f64,
}

/// A border, and where on it places are chosen.
struct Ring {
    sides: Vec<Side>,
    length: f64,
    /// Distances of places from the beginning, m.
    chosen: Vec<f64>,
}

impl Ring {
    /// Whether no place is chosen within a distance, m.
    fn is_open(&self, at: f64, distance: f64) -> bool {
        self.chosen.iter().all(|other| {
            let away = (at - other).abs();
            away.min(self.length - away) > distance
        })
    }

    /// The side at a distance from the beginning, and the part of it.
    fn side_at(&self, at: f64) -> (Side, f64) {
        let side = self.sides.partition_point(|side| side.start <= at).max(1) - 1;
        let side = self.sides[side];
        (side, ((at - side.start) / side.length).clamp(0.0, 1.0))
    }
}

impl Choice<'_> {
    /// The places of nodes on the border, beside those vertices that are nodes.
    pub(super) fn on_border(&self, is_given: &[bool]) -> Vec<Place> {
        let mut places = Vec::new();
        let least = LEAST_DISTANCE * self.size;
        for mut ring in self.rings() {
            let given = ring.sides.iter().filter(|side| is_given[self.start_of(side) as usize]);
            ring.chosen = given.map(|side| side.start).collect();
            let at_corners = self.corners(&ring).map(|side| (side, 0.0));
            let crossed = ring.sides.iter().flat_map(|side| self.crossings(*side));
            let wanted: Vec<(Side, f64)> = at_corners.chain(crossed).collect();
            for (side, part) in wanted {
                let at = side.start + part * side.length;
                if ring.is_open(at, least) {
                    places.push(self.on_side(side, part));
                    ring.chosen.push(at);
                }
            }
            if ring.chosen.is_empty() {
                places.push(self.on_side(ring.sides[0], 0.0));
                ring.chosen.push(0.0);
            }
            ring.chosen.sort_by(f64::total_cmp);
            let fewest = FEWEST.div_ceil(ring.chosen.len());
            let next = ring.chosen[1..].iter().copied().chain([ring.chosen[0] + ring.length]);
            for (&from, to) in ring.chosen.iter().zip(next) {
                let parts = (((to - from) / self.size).round() as usize).max(fewest);
                let between = (1..parts).map(|part| part as f64 / parts as f64);
                let at = between.map(|part| (from + (to - from) * part) % ring.length);
                places.extend(
                    at.map(|at| ring.side_at(at)).map(|(side, part)| self.on_side(side, part)),
                );
            }
        }
        places
    }

    /// The borders.
    fn rings(&self) -> Vec<Ring> {
        let Source { faces, positions, .. } = self.source;
        let mut from: BTreeMap<u32, Vec<(u32, usize)>> = BTreeMap::new();
        for triangle in 0..faces.count() as u32 {
            for corner in (0..3).filter(|&side| faces.across(triangle, side).is_none()) {
                let at = faces.particles(triangle)[corner];
                from.entry(at).or_default().push((triangle, corner));
            }
        }
        let mut rings = Vec::new();
        while let Some((&first, _)) = from.first_key_value() {
            let mut ring = Ring { sides: Vec::new(), length: 0.0, chosen: Vec::new() };
            let mut at = first;
            while let Some((triangle, corner)) = from.get_mut(&at).and_then(Vec::pop) {
                let to = faces.particles(triangle)[(corner + 1) % 3];
                let length = positions[at as usize].distance(positions[to as usize]);
                ring.sides.push(Side { triangle, corner, start: ring.length, length });
                ring.length += length;
                at = to;
                if at == first {
                    break;
                }
            }
            rings.push(ring);
            from.retain(|_, sides| !sides.is_empty());
        }
        rings
    }

    fn start_of(&self, side: &Side) -> u32 {
        self.source.faces.particles(side.triangle)[side.corner]
    }

    /// The sides before which a border turns.
    fn corners<'a>(&'a self, ring: &'a Ring) -> impl Iterator<Item = Side> + 'a {
        let count = ring.sides.len();
        let turns = move |at: &usize| {
            let around = [at + count - 1, *at, at + 1]
                .map(|at| self.source.positions[self.start_of(&ring.sides[at % count]) as usize]);
            let [to, on] = [around[1] - around[0], around[2] - around[1]];
            let [to, on] = [to, on].map(|along| along.normalize_or_zero());
            to.cross(on).length() > CORNER || to.dot(on) < 0.0
        };
        (0..count).filter(turns).map(|at| ring.sides[at])
    }

    /// A side with the parts of it at which lines of the lattice cross it; none if it runs along no axis.
    fn crossings(&self, side: Side) -> Vec<(Side, f64)> {
        let corners = self.source.faces.particles(side.triangle);
        let (from, to) = (corners[side.corner], corners[(side.corner + 1) % 3]);
        let first = self.lattice.turns(from);
        let Some((change, _)) = self.lattice.change(from, to) else { return Vec::new() };
        let axis = if change.x.abs() > change.y.abs() { 0 } else { 1 };
        if change[1 - axis].abs() > ALONG * change[axis].abs() {
            return Vec::new();
        }
        let (one, other) = (first[axis], first[axis] + change[axis]);
        let whole = one.min(other).ceil() as i64..=one.max(other).floor() as i64;
        whole.map(|turns| (side, (turns as f64 - one) / change[axis])).collect()
    }

    /// A place on a side.
    fn on_side(&self, side: Side, part: f64) -> Place {
        let part = match part {
            _ if part < AT_END => 0.0,
            _ if part > 1.0 - AT_END => 1.0,
            _ => part,
        };
        let mut weights = [0.0; 3];
        weights[side.corner] = 1.0 - part;
        weights[(side.corner + 1) % 3] = part;
        self.place(side.triangle, weights)
    }
}
