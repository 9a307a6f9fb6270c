//! Lays yarns over a mesh, evenly spaced.
//!
//! Streamlines of the directions of warp, weft and both diagonals are placed as by Jobard and Lefer 1997: a line is
//! followed until it leaves the mesh or comes too near another one, and new lines start beside those that are there.

use glam::Vec3;

use super::directions::Directions;
use super::faces::{Crossing, Faces, Heading};
use super::near::{Near, Passing};
use crate::fabric::links::LinkFamily;

/// Least distance from a yarn at which another one begins, in distances of yarns. Smaller: yarns lie closer than asked
/// for, by rounding. Larger: wider gaps stay open.
const BEGINS: f32 = 0.95;

/// Distance from a yarn at which another one ends, in distances of yarns. Smaller: yarns that converge get many short
/// links. Larger: where directions turn, many yarns end.
const ENDS: f32 = 0.6;

/// Length of a yarn behind its end that it may be near to, in distances of yarns.
const OWN_TAIL: f32 = 2.0;

/// Most points of a piece by which lines beside it are found.
const MOST_MARKS: f32 = 4.0;

/// Least distance of such points on a line, in distances of lines.
const LEAST_MARK: f32 = 0.05;

/// Most triangles that a line to a neighbouring yarn's start crosses.
const MOST_STEPS_ASIDE: usize = 64;

/// Most pieces of all lines in one direction, per triangle; most meshes need one or two, long tubes seven. Smaller: of
/// narrow tubes, about which lines wind, parts get no yarns. Larger: spikes and slivers take more time and memory.
pub(super) const MOST_PIECES: usize = 64;

/// A piece of a yarn within one triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub triangle: u32,
    pub family: LinkFamily,
    /// m.
    pub length: f32,
}

/// A line across triangles: its crossings, and the pieces between them.
#[derive(Clone, Debug, Default)]
pub(super) struct Line {
    pub crossings: Vec<Crossing>,
    pub pieces: Vec<Piece>,
    /// Whether the line came back to its beginning.
    pub is_ring: bool,
}

/// Lays lines in the direction of a family and, across seams, of the family that continues it.
pub(super) struct Layer<'a> {
    faces: &'a Faces<'a>,
    directions: &'a Directions,
    near: Near,
    /// Pieces that may yet be laid in the direction at hand.
    left: usize,
}

impl<'a> Layer<'a> {
    /// No lines as yet; they will be about as far apart as given, m.
    pub fn new(faces: &'a Faces<'a>, directions: &'a Directions, distance: f32) -> Self {
        Self { faces, directions, near: Near::new(distance), left: 0 }
    }

    /// All lines in one direction, with their distances in each triangle, m.
    pub fn lay(&mut self, towards: Towards, distances: &[f32]) -> Vec<Line> {
        let way = Way { towards, distances };
        let mut lines = Vec::new();
        self.left = MOST_PIECES * self.faces.count();
        for triangle in 0..self.faces.count() as u32 {
            let at = self.faces.centre(triangle);
            let mut starts = vec![(triangle, at)];
            let mut next = 0;
            while let Some(&(triangle, at)) = starts.get(next) {
                next += 1;
                let direction = self.directions.of_triangle(triangle, towards);
                let start = Heading { triangle, side: None, at, direction };
                if self.is_near(&start, BEGINS * way.distance(triangle), f32::INFINITY) {
                    continue;
                }
                let (line, headings) = self.follow_both_ways(start, way);
                if line.pieces.is_empty() {
                    // Nothing is laid here, which would keep those beside it from starting here again.
                    continue;
                }
                starts.extend(
                    headings.iter().flat_map(|heading| self.beside(heading, way)).flatten(),
                );
                if line.crossings.len() > 1 {
                    lines.push(line);
                }
            }
        }
        lines
    }

    /// Whether a line passes within a distance, m; `before` is the length along the own line up to which it counts, m.
    fn is_near(&self, heading: &Heading, within: f32, before: f32) -> bool {
        let normal = self.faces.normals[heading.triangle as usize];
        self.near.is_near(heading.at, heading.direction, normal, within, before)
    }

    fn follow_both_ways(&mut self, start: Heading, way: Way) -> (Line, Vec<Heading>) {
        self.near.begin_line();
        let mut headings = vec![start];
        let forwards = self.follow(start, way, &mut headings);
        let back = Heading { direction: -start.direction, ..start };
        let backwards =
            if forwards.is_ring { Line::default() } else { self.follow(back, way, &mut headings) };
        // The piece within the first triangle is the first of both ways.
        let mut line = Line { is_ring: forwards.is_ring, ..Line::default() };
        line.crossings.extend(backwards.crossings.iter().rev());
        line.crossings.extend(&forwards.crossings);
        line.pieces.extend(backwards.pieces.iter().skip(1).rev());
        if let (Some(one), Some(other)) = (backwards.pieces.first(), forwards.pieces.first()) {
            line.pieces.push(Piece { length: one.length + other.length, ..*other });
        }
        line.pieces.extend(forwards.pieces.iter().skip(1));
        (line, headings)
    }

    /// Follows the directions from a start, up to a border or another line, or until no more pieces may be laid.
    fn follow(&mut self, start: Heading, way: Way, headings: &mut Vec<Heading>) -> Line {
        let towards = way.towards;
        let mut line = Line::default();
        let mut heading = start;
        let (mut length, mut unmarked) = (0.0, 0.0);
        while self.left > 0 {
            let exit @ (crossing, _) = self.faces.exit(&heading);
            let passed = crossing.at - heading.at;
            let distance = way.distance(heading.triangle);
            let at_end = Heading { at: crossing.at, ..heading };
            if self.is_near(
                &at_end,
                ENDS * distance,
                length + passed.length() - OWN_TAIL * distance,
            ) {
                line.is_ring = self.near.is_own(crossing.at, ENDS * distance);
                return line;
            }
            let family = self.directions.family(heading.triangle, heading.direction, towards);
            self.left -= 1;
            line.pieces.push(Piece { triangle: heading.triangle, family, length: passed.length() });
            // Long pieces are marked all along, and of short ones some.
            unmarked += passed.length();
            if length == 0.0 || unmarked > LEAST_MARK * distance {
                let marks = (2.0 * passed.length() / distance).ceil().clamp(1.0, MOST_MARKS);
                for mark in 0..marks as u32 {
                    let at = heading.at + passed * ((mark as f32 + 0.5) / marks);
                    headings.push(Heading { at, side: None, ..heading });
                    self.near.add(Passing {
                        at,
                        direction: heading.direction,
                        normal: self.faces.normals[heading.triangle as usize],
                        before: length,
                        reach: (unmarked - passed.length()).max(0.5 * passed.length() / marks),
                    });
                }
                unmarked = 0.0;
            }
            length += passed.length();
            line.crossings.push(crossing);
            let directions = |triangle| self.directions.all(triangle, towards);
            match self.faces.cross(&heading, exit, directions) {
                Some(next) => heading = next,
                None => return line,
            }
        }
        line
    }

    /// Points to both sides of a line, at the distance of lines.
    fn beside(&self, heading: &Heading, way: Way) -> [Option<(u32, Vec3)>; 2] {
        let normal = self.faces.normals[heading.triangle as usize];
        [1.0, -1.0].map(|sign| {
            let direction = normal.cross(heading.direction) * sign;
            let mut aside = Heading { direction, ..*heading };
            let mut left = way.distance(heading.triangle);
            for _ in 0..MOST_STEPS_ASIDE {
                let exit @ (crossing, _) = self.faces.exit(&aside);
                let passed = (crossing.at - aside.at).length();
                if passed > left {
                    return Some((aside.triangle, aside.at + aside.direction * left));
                }
                left -= passed;
                aside = self.faces.cross(&aside, exit, |triangle| {
                    self.directions.all(triangle, way.towards.across())
                })?;
            }
            None
        })
    }
}

/// How lines are laid.
#[derive(Clone, Copy)]
struct Way<'a> {
    towards: Towards,
    /// Distance of lines in each triangle, m.
    distances: &'a [f32],
}

impl Way<'_> {
    fn distance(&self, triangle: u32) -> f32 {
        self.distances[triangle as usize]
    }
}

/// The direction in which lines are laid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::fabric) enum Towards {
    Warp,
    Weft,
    /// Between warp and weft.
    Rising,
    /// Between warp and minus weft.
    Falling,
}

impl Towards {
    pub const ALL: [Self; 4] = [Self::Warp, Self::Weft, Self::Rising, Self::Falling];

    /// The direction at right angles to this one.
    pub fn across(self) -> Self {
        match self {
            Self::Warp => Self::Weft,
            Self::Weft => Self::Warp,
            Self::Rising => Self::Falling,
            Self::Falling => Self::Rising,
        }
    }
}
