//! Planes that keep triangles apart over a substep: each triangle of a cell is compared with all of another at once.

use fearless_simd::Simd;

use crate::contact::itself::boxes::{Boxes, Corners, Splat, set_around};
use crate::contact::itself::patches::Cell;
use crate::contact::itself::swept::{End, Path, Swept, gather};
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::level::dispatch;
use crate::simd::registers::Pack8;
use crate::simd::vec3::V3;

/// Paths of the triangles of a cell in a substep.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct TrianglePaths {
    /// Corners at the start and at the end, m.
    corners: [Corners; 2],
    /// Boxes around the paths, widened by half of the thickness.
    around: Boxes,
    /// Number of triangles.
    count: usize,
}

impl TrianglePaths {
    /// Paths of no triangles.
    pub fn empty() -> Self {
        let corners = [[[Pack8::splat(0.0); 3]; 3]; 2];
        Self { corners, around: Boxes::empty(), count: 0 }
    }

    /// Sets the paths of a cell's triangles, given those of all particles.
    pub fn set(&mut self, cell: &Cell, paths: &[Path], thickness: f32) {
        self.count = cell.triangles.len();
        dispatch!(token => set(token, self, cell, paths, 0.5 * thickness));
    }
}

/// Sets the paths of a cell's triangles, given the distance by which boxes are widened, m.
#[inline(always)]
fn set<S: Simd>(token: S, triangles: &mut TrianglePaths, cell: &Cell, paths: &[Path], by: f32) {
    for end in [End::First, End::Last] {
        let corners = gather(token, cell, paths, end);
        set_around(token, &corners, end, by, &mut triangles.around);
        for (corner, into) in corners.iter().zip(&mut triangles.corners[end as usize]) {
            corner.store(into);
        }
    }
}

/// Two triangles that may touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::contact) struct Meeting {
    /// The lane of each.
    pub lanes: [usize; 2],
    /// Whether they do not touch if they have a corner in common: whether a plane through a point of both is between them.
    pub is_hinged: bool,
}

/// Finds the triangles of two cells that may touch: all but those that a plane keeps farther than the thickness from each
/// other, at the start and at the end of the substep.
pub(in crate::contact) fn find_meetings(
    cells: [&TrianglePaths; 2],
    around: &Swept,
    thickness: f32,
    meetings: &mut Vec<Meeting>,
) {
    meetings.clear();
    Pack8::run(FindMeetings { cells, around, thickness, meetings });
}

struct FindMeetings<'a> {
    cells: [&'a TrianglePaths; 2],
    /// Boxes around the second cell.
    around: &'a Swept,
    thickness: f32,
    meetings: &'a mut Vec<Meeting>,
}

/// States of a comparison, in lanes: triangles are apart, or hinged, or may touch.
const APART: f32 = 0.0;
const HINGED: f32 = 1.0;
const NEAR: f32 = 2.0;

impl Kernel<Pack8> for FindMeetings<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let [one, other] = self.cells;
        let squared_thickness = L::splat(token, self.thickness * self.thickness);
        let [apart, hinged, near] =
            [L::splat(token, APART), L::splat(token, HINGED), L::splat(token, NEAR)];
        let others = [load(token, &other.corners[0]), load(token, &other.corners[1])];
        let mut meeting = Pack8::splat(APART);
        let meets_cell = Splat::<L>::of(token, self.around).meets(token, &one.around);
        near.or_where_not(meets_cell, apart).store(&mut meeting);
        for first in 0..one.count {
            if meeting.lanes()[first] == APART {
                continue;
            }
            let meets = one.around.lane::<L>(token, first).meets(token, &other.around);
            let state = near.or_where_not(meets, apart);
            if !apart.lt(state).any() {
                continue;
            }
            let ones = [
                splat_lane::<L>(token, &one.corners[0], first),
                splat_lane::<L>(token, &one.corners[1], first),
            ];
            let gaps = [Gap::between(&ones[0], &others[0]), Gap::between(&ones[1], &others[1])];
            let are_hinged = gaps[0].is_none(token) & gaps[1].is_none(token);
            let are_far = gaps[0].is_wider(token, squared_thickness)
                & gaps[1].is_wider(token, squared_thickness);
            let state = hinged.min(state).or_where_not(are_hinged, state);
            let mut state = apart.or_where_not(are_far, state);
            if hinged.lt(state).any() {
                let are_beside = are_beside(token, &ones, &others, squared_thickness)
                    | are_beside(token, &others, &ones, squared_thickness);
                state = apart.or_where_not(are_beside, state);
            }
            let mut states = Pack8::splat(APART);
            state.store(&mut states);
            for second in 0..other.count {
                let state = states.lanes()[second];
                if state != APART {
                    let is_hinged = state == HINGED;
                    self.meetings.push(Meeting { lanes: [first, second], is_hinged });
                }
            }
        }
    }
}

/// Loads the triangles of a cell.
#[inline(always)]
fn load<L: Lane<Pack = Pack8>>(token: L::Token, corners: &Corners) -> [V3<L>; 3] {
    [V3::load(token, &corners[0]), V3::load(token, &corners[1]), V3::load(token, &corners[2])]
}

/// A triangle of a cell, in all lanes.
#[inline(always)]
fn splat_lane<L: Lane<Pack = Pack8>>(
    token: L::Token,
    corners: &Corners,
    lane: usize,
) -> [V3<L>; 3] {
    [
        V3::splat_lane(token, &corners[0], lane),
        V3::splat_lane(token, &corners[1], lane),
        V3::splat_lane(token, &corners[2], lane),
    ]
}

/// The gap of triangles along the axis between their middles, negative if they overlap along it. All numbers are products
/// with the axis, which is three times as long as the distance of the middles.
struct Gap<L> {
    width: L,
    squared_axis: L,
}

impl<L: Lane> Gap<L> {
    #[inline(always)]
    fn between(one: &[V3<L>; 3], other: &[V3<L>; 3]) -> Self {
        let axis = one[0] + one[1] + one[2] - (other[0] + other[1] + other[2]);
        let least = axis.dot(one[0]).min(axis.dot(one[1])).min(axis.dot(one[2]));
        let greatest = axis.dot(other[0]).max(axis.dot(other[1])).max(axis.dot(other[2]));
        Self { width: least - greatest, squared_axis: axis.dot(axis) }
    }

    /// Whether the width is zero. That of triangles with a common corner is exactly zero if the plane through it is between
    /// them, else negative.
    #[inline(always)]
    fn is_none(&self, token: L::Token) -> L::Mask {
        self.width.abs().lt(L::splat(token, f32::MIN_POSITIVE))
    }

    /// Whether the gap is wider than the thickness.
    #[inline(always)]
    fn is_wider(&self, token: L::Token, squared_thickness: L) -> L::Mask {
        L::splat(token, 0.0).lt(self.width)
            & (squared_thickness * self.squared_axis).lt(self.width * self.width)
    }
}

/// Whether the plane of one triangle keeps it farther than the thickness from the other, on the same side at the start and
/// at the end.
#[inline(always)]
fn are_beside<L: Lane>(
    token: L::Token,
    one: &[[V3<L>; 3]; 2],
    other: &[[V3<L>; 3]; 2],
    squared_thickness: L,
) -> L::Mask {
    let start = sides(token, &one[0], &other[0], squared_thickness);
    let end = sides(token, &one[1], &other[1], squared_thickness);
    (start[0] & end[0]) | (start[1] & end[1])
}

/// Whether a triangle is farther than the thickness above, and whether it is below, the plane of another.
#[inline(always)]
fn sides<L: Lane>(
    token: L::Token,
    [a, b, c]: &[V3<L>; 3],
    other: &[V3<L>; 3],
    squared_thickness: L,
) -> [L::Mask; 2] {
    let zero = L::splat(token, 0.0);
    let normal = (*b - *a).cross(*c - *a);
    let far = squared_thickness * normal.dot(normal);
    let [first, second, third] =
        [normal.dot(other[0] - *a), normal.dot(other[1] - *a), normal.dot(other[2] - *a)];
    let least = first.min(second).min(third);
    let greatest = first.max(second).max(third);
    [zero.lt(least) & far.lt(least * least), greatest.lt(zero) & far.lt(greatest * greatest)]
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::contact::itself::crossing::crossing;
    use crate::contact::itself::pairs::EdgeTriangle;
    use crate::contact::itself::swept::end_at;

    const THICKNESS: f32 = 5e-3;

    /// A number from −0.5 to 0.5.
    fn noise(index: usize) -> f32 {
        let mixed = (index as u32 + 1).wrapping_mul(2_654_435_769);
        let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(2_246_822_519);
        (mixed >> 8) as f32 / (1 << 24) as f32 - 0.5
    }

    /// A cell of triangles, and the meetings of its triangles with those of another, all at rest.
    fn meetings(cells: [&[[u32; 3]]; 2], positions: &[Vec3]) -> Vec<Meeting> {
        let paths: Vec<Path> = positions.iter().map(|&at| [end_at(at); 2]).collect();
        let cells = cells.map(|triangles| {
            let last = triangles.len() - 1;
            let corner =
                |corner: usize| core::array::from_fn(|lane| triangles[lane.min(last)][corner]);
            Cell {
                triangles: 0..triangles.len() as u32,
                particles: triangles.iter().flatten().copied().collect(),
                corners: core::array::from_fn(corner),
                neighbours: Vec::new(),
            }
        });
        let around = Swept::around(&cells[1].particles, &paths).widened(0.5 * THICKNESS);
        let triangles = cells.map(|cell| {
            let mut triangles = TrianglePaths::empty();
            triangles.set(&cell, &paths, THICKNESS);
            triangles
        });
        let mut meetings = Vec::new();
        find_meetings([&triangles[0], &triangles[1]], &around, THICKNESS, &mut meetings);
        meetings
    }

    /// Whether an edge of one triangle passes through the other.
    fn cross(triangles: [[u32; 3]; 2], positions: &[Vec3]) -> bool {
        let passes = |[a, b, c]: [u32; 3], triangle| {
            let edges = [[a, b], [b, c], [c, a]];
            edges.iter().any(|&edge| {
                crossing(&EdgeTriangle { index: 0, edge, triangle, patches: [0; 2] }, positions)
                    .is_some()
            })
        };
        let [one, other] = triangles;
        passes(one, other) || passes(other, one)
    }

    #[test]
    fn triangles_that_cross_meet_and_most_that_are_apart_do_not() {
        let (mut crossing, mut found) = (0, 0);
        for round in 0..50 {
            let position = |index: usize| {
                let [triangle, at] = [index / 3, 9 * index + 432 * round];
                let middle = Vec3::new(noise(triangle), noise(triangle + 50), noise(triangle + 90));
                middle + Vec3::new(noise(at), noise(at + 301), noise(at + 602))
            };
            let positions: Vec<Vec3> = (0..39).map(position).collect();
            let triangles: Vec<[u32; 3]> =
                (0..13).map(|it| [3 * it, 3 * it + 1, 3 * it + 2]).collect();
            let (one, other) = triangles.split_at(8);
            let meetings = meetings([one, other], &positions);
            found += meetings.len();
            for (first, &of_one) in one.iter().enumerate() {
                for (second, &of_other) in other.iter().enumerate() {
                    let crosses = cross([of_one, of_other], &positions);
                    let lanes = [first, second];
                    crossing += usize::from(crosses);
                    let meeting = Meeting { lanes, is_hinged: false };
                    assert!(!crosses || meetings.contains(&meeting), "{round}: {lanes:?}");
                }
            }
        }
        assert!(crossing > 50 && found < 3 * crossing, "{found} found, {crossing} cross");
    }

    #[test]
    fn triangles_about_a_corner_are_hinged_unless_they_lie_upon_each_other() {
        let flat = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.0, 1.0)];
        let beyond = flat.map(|at| Vec3::new(-at.x, 0.1 * at.x, -at.z));
        let upon = flat.map(|at| Vec3::new(at.x, 1e-3 * at.x, at.z - 0.2 * at.x));
        for (other, is_hinged) in [(beyond, true), (upon, false)] {
            let positions = [flat[0], flat[1], flat[2], other[1], other[2]];
            let meetings = meetings([&[[0, 1, 2]], &[[0, 3, 4]]], &positions);
            assert_eq!(meetings, [Meeting { lanes: [0, 0], is_hinged }]);
        }
    }
}
