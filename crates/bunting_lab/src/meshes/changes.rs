//! The same cloth of other triangles.

use std::collections::{BTreeMap, BTreeSet};

use glam::{Vec2, Vec3};

use super::{Random, Sheet, clothes::Garment};

/// Greatest shift of a vertex along each axis, as a part of the mean side of triangles.
const NOISE: f32 = 0.01;
/// Least area of a triangle on another diagonal, as a part of the two triangles. Smaller: slivers, and triangles that overlap.
const LEAST_PART: f32 = 0.15;
/// Distance within which vertices of a seam lie, m.
const TOGETHER: f32 = 1e-5;
/// Seed of orders and of noise.
const SEED: u64 = 23;

/// What is done to a mesh, of which the cloth should not know.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Change {
    /// A triangle of the lower border is left out.
    TriangleLess,
    /// A triangle is added to the lower border.
    TriangleMore,
    /// Vertices in another order.
    Permuted,
    /// Pairs of triangles that are cut along their other diagonal.
    OtherDiagonals,
    /// Vertices moved at random by a hundredth of the triangles' sides.
    Noise,
    /// Vertices in the middles of sides, nearly as many as there were.
    TwiceTheVertices,
}

/// A mesh that was changed.
pub(crate) struct Changed {
    /// The mesh.
    pub garment: Garment,
    /// The vertex that each one has become.
    pub vertices: Vec<u32>,
}

impl Change {
    /// All of them with their names.
    pub const ALL: [(Self, &'static str); 6] = [
        (Self::TriangleLess, "a triangle less"),
        (Self::TriangleMore, "a triangle more"),
        (Self::Permuted, "vertices permuted"),
        (Self::OtherDiagonals, "other diagonals"),
        (Self::Noise, "noise of 1 %"),
        (Self::TwiceTheVertices, "twice the vertices"),
    ];

    /// A changed mesh.
    pub fn of(self, garment: &Garment) -> Changed {
        let mut garment = garment.clone();
        let mut vertices: Vec<u32> = (0..garment.positions.len() as u32).collect();
        match self {
            Self::TriangleLess => {
                let (triangle, _) = lowest(&garment);
                garment.indices.drain(3 * triangle..3 * triangle + 3);
            }
            Self::TriangleMore => add_triangle(&mut garment),
            Self::Permuted => vertices = permute(&mut garment),
            Self::OtherDiagonals => cut_otherwise(&mut garment),
            Self::Noise => shake(&mut garment),
            Self::TwiceTheVertices => split(&mut garment),
        }
        Changed { garment, vertices }
    }
}

impl Sheet {
    /// The sheet without its lower right corner and the triangles there, so that it is no rectangle.
    ///
    /// # Panics
    ///
    /// When there is no vertex.
    #[must_use]
    pub fn without_corner(mut self) -> Self {
        let reach = |at: &Vec3| at.x - at.y;
        let corner = (0..self.positions.len())
            .max_by(|a, b| reach(&self.positions[*a]).total_cmp(&reach(&self.positions[*b])))
            .expect("a vertex");
        let last = self.positions.len() - 1;
        self.positions.swap_remove(corner);
        let triangles = self.indices.as_chunks::<3>().0.iter();
        let kept = triangles.filter(|corners| !corners.contains(&(corner as u32)));
        // The last vertex has taken the corner's place.
        let number = |at: &u32| if *at as usize == last { corner as u32 } else { *at };
        self.indices = kept.flatten().map(number).collect();
        self
    }
}

/// The triangles, by the sides along which they go around.
fn sides(garment: &Garment) -> BTreeMap<[u32; 2], usize> {
    let triangles = garment.indices.as_chunks::<3>().0.iter().enumerate();
    triangles.flat_map(|(at, &[a, b, c])| [[a, b], [b, c], [c, a]].map(|side| (side, at))).collect()
}

/// The corner of a triangle that is not on a side.
fn apex(garment: &Garment, triangle: usize, side: [u32; 2]) -> u32 {
    let corners = &garment.indices[3 * triangle..3 * triangle + 3];
    corners.iter().copied().find(|at| !side.contains(at)).expect("three corners")
}

/// The lowest side of the border with its triangle, whose third corner is inside: without it no vertex is left alone.
fn lowest(garment: &Garment) -> (usize, [u32; 2]) {
    let sides = sides(garment);
    let is_border = |[a, b]: &[u32; 2]| !sides.contains_key(&[*b, *a]);
    let border: BTreeSet<u32> =
        sides.keys().filter(|side| is_border(side)).flatten().copied().collect();
    let is_inside = |side: &[u32; 2], triangle: usize| {
        is_border(side) && !border.contains(&apex(garment, triangle, *side))
    };
    let height = |ends: [u32; 2]| ends.map(|at| garment.positions[at as usize].y).iter().sum();
    let found = sides.iter().filter(|(side, triangle)| is_inside(side, **triangle));
    let found = found.min_by(|(a, _), (b, _)| f32::total_cmp(&height(**a), &height(**b)));
    found.map(|(side, triangle)| (*triangle, *side)).expect("a border")
}

/// A triangle beyond the lowest side of the border, as large as that within it.
fn add_triangle(garment: &mut Garment) {
    let (triangle, [a, b]) = lowest(garment);
    let corners = [a, b, apex(garment, triangle, [a, b])].map(|at| at as usize);
    let [from, to, within] = corners.map(|at| garment.positions[at]);
    let [uv_from, uv_to, uv_within] = corners.map(|at| garment.uv[at]);
    let new = garment.positions.len() as u32;
    add_vertex(garment, from + to - within, uv_from + uv_to - uv_within);
    garment.indices.extend([b, a, new]);
}

/// Adds a vertex that nothing holds.
fn add_vertex(garment: &mut Garment, position: Vec3, uv: Vec2) {
    garment.positions.push(position);
    garment.uv.push(uv);
    garment.is_held.push(false);
}

/// Puts vertices into an order at random, and returns the new number of each.
fn permute(garment: &mut Garment) -> Vec<u32> {
    let mut random = Random::of_seed(SEED);
    let mut order: Vec<usize> = (0..garment.positions.len()).collect();
    (1..order.len()).rev().for_each(|at| order.swap(at, random.below(at + 1)));
    let mut number = vec![0; order.len()];
    (0..).zip(&order).for_each(|(new, old)| number[*old] = new);
    garment.positions = order.iter().map(|&old| garment.positions[old]).collect();
    garment.uv = order.iter().map(|&old| garment.uv[old]).collect();
    garment.is_held = order.iter().map(|&old| garment.is_held[old]).collect();
    garment.indices.iter_mut().for_each(|at| *at = number[*at as usize]);
    number
}

/// Two triangles beside one another: the ends of their common side, and their other corners. The first goes around from one end to
/// the other.
struct Pair {
    triangles: [usize; 2],
    ends: [u32; 2],
    apexes: [u32; 2],
}

/// Pairs that satisfy a condition, as many as are found one after the other, so that each triangle is in one.
fn pairs(garment: &Garment, is_wanted: impl Fn(&Pair) -> bool) -> Vec<Pair> {
    let sides = sides(garment);
    let mut is_taken = vec![false; garment.indices.len() / 3];
    let mut pairs = Vec::new();
    for (&ends, &first) in &sides {
        let Some(&second) = sides.get(&[ends[1], ends[0]]) else { continue };
        let triangles = [first, second];
        let pair = Pair { triangles, ends, apexes: triangles.map(|at| apex(garment, at, ends)) };
        if triangles.iter().all(|at| !is_taken[*at]) && is_wanted(&pair) {
            triangles.iter().for_each(|at| is_taken[*at] = true);
            pairs.push(pair);
        }
    }
    pairs
}

/// Cuts pairs of triangles along their other diagonals, where their texture is convex.
fn cut_otherwise(garment: &mut Garment) {
    let area = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(|at| garment.uv[at as usize]);
        (b - a).perp_dot(c - a)
    };
    let otherwise = |Pair { ends: [a, b], apexes: [c, d], .. }: &Pair| [[*a, *d, *c], [*d, *b, *c]];
    let is_convex = |pair: &Pair| {
        let areas = otherwise(pair).map(area);
        areas.iter().all(|part| part / areas.iter().sum::<f32>() > LEAST_PART)
    };
    for pair in pairs(garment, is_convex) {
        for (triangle, corners) in pair.triangles.into_iter().zip(otherwise(&pair)) {
            garment.indices[3 * triangle..3 * triangle + 3].copy_from_slice(&corners);
        }
    }
}

/// Moves vertices that nothing holds at random, those of a seam together.
fn shake(garment: &mut Garment) {
    let mut random = Random::of_seed(SEED);
    let sides: Vec<f32> = sides(garment)
        .keys()
        .map(|ends| ends.map(|at| garment.positions[at as usize]))
        .map(|[from, to]| from.distance(to))
        .collect();
    let most = NOISE * sides.iter().sum::<f32>() / sides.len() as f32;
    let before = garment.positions.clone();
    let shifts: Vec<Vec3> = before
        .iter()
        .map(|_| Vec3::from([0; 3].map(|_| random.within(-1.0, 1.0) as f32)) * most)
        .collect();
    for (vertex, at) in garment.positions.iter_mut().enumerate() {
        let first = before.iter().position(|other| other.distance(before[vertex]) < TOGETHER);
        if let Some(first) = first.filter(|_| !garment.is_held[vertex]) {
            *at += shifts[first];
        }
    }
}

/// Puts a vertex into the middle of the common side of pairs.
fn split(garment: &mut Garment) {
    for Pair { triangles, ends: [a, b], apexes: [c, d] } in pairs(garment, |_| true) {
        let new = garment.positions.len() as u32;
        let [from, to] = [a, b].map(|at| at as usize);
        let position = garment.positions[from].midpoint(garment.positions[to]);
        add_vertex(garment, position, garment.uv[from].midpoint(garment.uv[to]));
        for (triangle, corners) in triangles.into_iter().zip([[a, new, c], [b, new, d]]) {
            garment.indices[3 * triangle..3 * triangle + 3].copy_from_slice(&corners);
        }
        garment.indices.extend([new, b, c, new, a, d]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area of the texture, m²; triangles that are turned over count against it.
    fn area(garment: &Garment) -> f32 {
        let corners = garment.indices.as_chunks::<3>().0.iter();
        let places = corners.map(|of| of.map(|at| garment.uv[at as usize]));
        places.map(|[a, b, c]| 0.5 * (b - a).perp_dot(c - a)).sum()
    }

    #[test]
    fn a_changed_mesh_covers_the_same_surface() {
        let [rectangle, disk, _, skirt, _, _, cape, _] = Garment::all();
        for garment in [rectangle, disk, skirt, cape] {
            let count = garment.positions.len();
            for (change, name) in Change::ALL {
                let Changed { garment: changed, vertices } = change.of(&garment);
                let name = format!("{}, {name}", garment.name);
                let ratio = area(&changed) / area(&garment);
                assert!((ratio - 1.0).abs() < 2e-3, "{name}: {ratio}");
                let moved = (0..count).map(|at| {
                    let now = changed.positions[vertices[at] as usize];
                    now.distance(garment.positions[at])
                });
                assert!(moved.fold(0.0, f32::max) < 1e-3, "{name}");
                assert!(changed.builder().build().is_ok(), "{name}");
            }
            let more = Change::TwiceTheVertices.of(&garment).garment.positions.len();
            assert!(5 * more > 9 * count, "{more} for {count}");
        }
    }
}
