//! The sides of a mesh that maps onto a rectangle: four between the corners of its border, or two rims.

use std::collections::{BTreeMap, VecDeque};

use super::Cut;
use crate::fabric::mesh::{RestMesh, Surface};

/// Least angle by which the border turns at a corner, rad. Smaller: rounded sides have corners. Larger: corners of more
/// than 130° are none.
const CORNER: f32 = 0.87;

/// Length of border on both sides of a vertex over which it turns at a corner, in mean edges of the border. Smaller: corners
/// that are cut off are two.
const WITHIN: f32 = 1.2;

/// The particles on the sides of a mesh.
pub(super) enum Sides {
    /// One after the other around the mesh, each with both of its corners.
    Four([Vec<u32>; 4]),
    /// Of a mesh that is closed around an axis.
    Rims([Vec<u32>; 2]),
}

/// The sides of a mesh; none of one that has other corners or rims.
pub(super) fn sides(mesh: &RestMesh, surface: &Surface) -> Option<Sides> {
    let (particles, edges) = (mesh.positions.len(), surface.edges.len());
    // Euler's characteristic: 1 of a disk, 0 of a ring.
    let characteristic = particles as i64 - edges as i64 + mesh.triangles.len() as i64;
    let loops = loops(mesh, surface)?;
    let corners: Vec<Vec<usize>> =
        loops.iter().map(|border| corners(mesh, border)).collect::<Option<_>>()?;
    match (&loops[..], &corners[..], characteristic) {
        ([border], [corners], 1) => {
            let [a, b, c, d] = corners[..] else { return None };
            let side = |from: usize, to: usize| {
                let to = if to > from { to } else { to + border.len() };
                (from..=to).map(|at| border[at % border.len()]).collect()
            };
            Some(Sides::Four([side(a, b), side(b, c), side(c, d), side(d, a)]))
        }
        ([one, other], [a, b], 0) if a.is_empty() && b.is_empty() => {
            Some(Sides::Rims([one.clone(), other.clone()]))
        }
        _ => None,
    }
}

/// The borders of a mesh, each in the order of its particles, with the mesh to the left; none if two of them touch.
fn loops(mesh: &RestMesh, surface: &Surface) -> Option<Vec<Vec<u32>>> {
    let mut next = BTreeMap::new();
    for edge in surface.edges.iter().filter(|edge| edge.other_side.is_none()) {
        let triangle = mesh.triangles[edge.side.triangle as usize];
        let opposite = triangle.iter().position(|&at| at == edge.side.opposite)?;
        let [from, to] = [1, 2].map(|by| triangle[(opposite + by) % 3]);
        if next.insert(from, to).is_some() {
            return None;
        }
    }
    let mut loops = Vec::new();
    while let Some((&first, _)) = next.first_key_value() {
        let mut border = Vec::new();
        let mut at = first;
        while let Some(to) = next.remove(&at) {
            border.push(at);
            at = to;
        }
        if at != first {
            return None;
        }
        loops.push(border);
    }
    Some(loops)
}

/// The places on a border at which it turns sharply to the mesh's side; none if it turns as sharply to the other.
fn corners(mesh: &RestMesh, border: &[u32]) -> Option<Vec<usize>> {
    let mut angles: BTreeMap<u32, f32> = border.iter().map(|&at| (at, 0.0)).collect();
    for triangle in &mesh.triangles {
        let corners = mesh.positions_of(*triangle);
        for at in 0..3 {
            if let Some(angle) = angles.get_mut(&triangle[at]) {
                let [to, from] = [1, 2].map(|by| corners[(at + by) % 3] - corners[at]);
                *angle += to.angle_between(from);
            }
        }
    }
    let count = border.len();
    let turns: Vec<f32> = border.iter().map(|at| core::f32::consts::PI - angles[at]).collect();
    let at = |place: usize| mesh.positions[border[place % count] as usize];
    let lengths: Vec<f32> = (0..count).map(|place| at(place).distance(at(place + 1))).collect();
    let within = WITHIN * lengths.iter().sum::<f32>() / count as f32;
    // The turn of the border near each place, and the places near it.
    let near = |place: usize| {
        let mut near = vec![place];
        for forwards in [true, false] {
            let (mut to, mut length) = (place, 0.0);
            while near.len() < count {
                length += lengths[if forwards { to } else { (to + count - 1) % count }];
                to = if forwards { (to + 1) % count } else { (to + count - 1) % count };
                if length > within || near.contains(&to) {
                    break;
                }
                near.push(to);
            }
        }
        near
    };
    let near: Vec<Vec<usize>> = (0..count).map(near).collect();
    let turn = |places: &Vec<usize>| places.iter().map(|&place| turns[place]).sum::<f32>();
    let sharpness: Vec<f32> = near.iter().map(turn).collect();
    if sharpness.iter().any(|&turn| turn < -CORNER) {
        return None;
    }
    // The sharpest place of those near one another.
    let is_sharpest = |place: usize| {
        let key = |at: usize| (turns[at], at);
        let others = near[place].iter().flat_map(|&at| &near[at]);
        others.into_iter().all(|&other| key(other) <= key(place))
    };
    let is_corner = |&place: &usize| sharpness[place] > CORNER && is_sharpest(place);
    Some((0..count).filter(is_corner).collect())
}

/// A mesh with two rims, cut open along the shortest way from one to the other; none if there is no such way.
pub(super) fn cut_open(mesh: &RestMesh, [first, second]: &[Vec<u32>; 2]) -> Option<Cut> {
    let count = mesh.positions.len();
    let mut around = vec![Vec::new(); count];
    for (index, corners) in (0_u32..).zip(&mesh.triangles) {
        corners.iter().for_each(|&corner| around[corner as usize].push(index));
    }
    // Breadth first: the way meets each rim in one particle.
    let mut from: Vec<Option<u32>> = vec![None; count];
    first.iter().for_each(|&at| from[at as usize] = Some(at));
    let mut next: VecDeque<u32> = first.iter().copied().collect();
    let mut is_end = vec![false; count];
    second.iter().for_each(|&at| is_end[at as usize] = true);
    let mut end = None;
    while let Some(at) = next.pop_front() {
        if is_end[at as usize] {
            end = Some(at);
            break;
        }
        let neighbours = around[at as usize].iter().flat_map(|&of| mesh.triangles[of as usize]);
        for neighbour in neighbours {
            if from[neighbour as usize].is_none() {
                from[neighbour as usize] = Some(at);
                next.push_back(neighbour);
            }
        }
    }
    let mut way = vec![end?];
    while let Some(&last) = way.last()
        && let Some(before) = from[last as usize]
        && before != last
    {
        way.push(before);
    }
    let mut particles: Vec<u32> = (0..count as u32).collect();
    let mut triangles = mesh.triangles.clone();
    let mut turns = vec![0.0; count];
    for (index, &at) in way.iter().enumerate() {
        let before = index.checked_sub(1).map(|index| way[index]);
        let after = way.get(index + 1).copied();
        let place = particles.len() as u32;
        particles.push(at);
        turns.push(1.0);
        for triangle in on_the_left(mesh, &around[at as usize], at, before, after)? {
            for corner in &mut triangles[triangle as usize] {
                if *corner == at {
                    *corner = place;
                }
            }
        }
    }
    Some(Cut { particles, triangles, turns })
}

/// The triangles around a particle on the left of a way through it; none if one of those around it has no corner there.
fn on_the_left(
    mesh: &RestMesh,
    around: &[u32],
    at: u32,
    before: Option<u32>,
    after: Option<u32>,
) -> Option<Vec<u32>> {
    // Each triangle with the corners after and before the particle, counter-clockwise.
    let others = |&triangle: &u32| {
        let corners = mesh.triangles[triangle as usize];
        let own = corners.iter().position(|&corner| corner == at)?;
        Some((triangle, [1, 2].map(|by| corners[(own + by) % 3])))
    };
    let around: Vec<(u32, [u32; 2])> = around.iter().map(others).collect::<Option<_>>()?;
    let mut left = Vec::new();
    // From the edge to the next particle counter-clockwise up to the edge to the one before, or to the border.
    if let Some(after) = after {
        let mut edge = after;
        while Some(edge) != before
            && let Some(&(triangle, [_, next])) = around.iter().find(|(_, [to, _])| *to == edge)
            && !left.contains(&triangle)
        {
            left.push(triangle);
            edge = next;
        }
    } else if let Some(before) = before {
        // From the edge to the particle before clockwise up to the border.
        let mut edge = before;
        while let Some(&(triangle, [next, _])) = around.iter().find(|(_, [_, from])| *from == edge)
            && !left.contains(&triangle)
        {
            left.push(triangle);
            edge = next;
        }
    }
    Some(left)
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;

    #[test]
    fn triangles_that_do_not_meet_a_particle_are_no_side_of_a_way() {
        let mesh = RestMesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::NEG_Y],
            uv: vec![Vec2::ZERO; 5],
            triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [1, 2, 3]],
            particle_of_vertex: (0..5).collect(),
            areas: vec![1.0; 5],
            inverse_areas: vec![1.0; 5],
        };
        let left = |around: &[u32]| on_the_left(&mesh, around, 0, Some(4), Some(2));
        assert_eq!(left(&[0, 1, 2]), Some(vec![1, 2]));
        assert_eq!(left(&[0, 1, 3]), None);
    }
}
