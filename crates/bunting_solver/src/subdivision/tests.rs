//! Tests of subdivided surfaces.

use glam::{Vec2, Vec3};

use super::{Subdivision, SubdivisionBuffers};
use crate::fabric::Grid;
use crate::simd::level::{has_fused_products, with_every_instruction_set};

/// Rounding of sums of some ten terms of up to two metres, m.
const ROUNDING: f32 = 2e-6;

const STEPS: u32 = 2;

/// Particles at rest, m, and what is drawn through them.
struct Drawn {
    rest: Vec<Vec3>,
    subdivision: Subdivision,
}

impl Drawn {
    /// Of a mesh whose vertices are particles.
    fn of_mesh(rest: Vec<Vec3>, indices: &[u32], steps: u32) -> Self {
        let particles: Vec<u32> = (0..rest.len() as u32).collect();
        let subdivision = Subdivision::of_mesh(&rest, &particles, indices, steps);
        Self { rest, subdivision }
    }
}

fn grid([columns, rows]: [u32; 2], steps: u32) -> Drawn {
    let grid = Grid::new(columns, rows, 2.0, 1.0);
    Drawn { rest: grid.positions(), subdivision: Subdivision::of_grid(&grid, steps) }
}

/// A disc of rings of six triangles, twelve and so on: irregular at its border only.
fn disc(steps: u32) -> Drawn {
    const RINGS: i32 = 4;
    let axial: Vec<(i32, i32)> = (-RINGS..=RINGS)
        .flat_map(|q| (-RINGS..=RINGS).map(move |r| (q, r)))
        .filter(|(q, r)| (q + r).abs() <= RINGS)
        .collect();
    let index = |q: i32, r: i32| axial.iter().position(|&at| at == (q, r)).map(|at| at as u32);
    let mut indices = Vec::new();
    for &(q, r) in &axial {
        for [b, c] in [[(q + 1, r), (q, r + 1)], [(q + 1, r - 1), (q + 1, r)]] {
            if let [Some(a), Some(b), Some(c)] = [index(q, r), index(b.0, b.1), index(c.0, c.1)] {
                indices.extend([a, b, c]);
            }
        }
    }
    let place = |&(q, r): &(i32, i32)| {
        Vec3::new(q as f32 + 0.5 * r as f32, 0.75_f32.sqrt() * r as f32, 0.0) * 0.2
    };
    Drawn::of_mesh(axial.iter().map(place).collect(), &indices, steps)
}

/// A grid as a mesh of triangles, irregular everywhere.
fn triangles(steps: u32) -> Drawn {
    let grid = Grid::new(17, 9, 2.0, 1.0);
    Drawn::of_mesh(grid.positions(), grid.triangles(false).as_flattened(), steps)
}

fn surface(subdivision: &Subdivision, positions: &[Vec3]) -> [Vec<Vec3>; 2] {
    let count = subdivision.attributes().rows().len();
    let (mut drawn, mut normals) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
    let mut buffers = SubdivisionBuffers::default();
    subdivision.evaluate(positions, &mut buffers, &mut drawn, &mut normals);
    [drawn, normals].map(|values| values.into_iter().map(Vec3::from).collect())
}

fn lifted(rest: &[Vec3], height: impl Fn(Vec2) -> f32) -> Vec<Vec3> {
    rest.iter().map(|at| at.truncate().extend(height(at.truncate()))).collect()
}

#[test]
fn planes_stay_planes_and_particles_stay_in_place() {
    let grids = [[7, 5], [2, 2], [3, 2]].map(|size| grid(size, STEPS));
    for Drawn { rest, subdivision } in grids.into_iter().chain([disc(STEPS), triangles(STEPS)]) {
        let slope = |at: Vec2| 0.5 * at.x - 0.25 * at.y;
        let up = Vec3::new(-0.5, 0.25, 1.0).normalize();
        let positions = lifted(&rest, slope);
        let [drawn, normals] = surface(&subdivision, &positions);
        for (at, normal) in drawn.iter().zip(&normals) {
            assert!((at.z - slope(at.truncate())).abs() < ROUNDING, "{at}");
            assert!((*normal - up).length() < 1e-4, "{normal}");
        }
        let wavy = lifted(&rest, |at| libm::sinf(5.0 * at.x) * libm::cosf(3.0 * at.y));
        let [drawn, _] = surface(&subdivision, &wavy);
        for (vertex, at) in wavy.iter().enumerate() {
            assert_eq!(drawn[subdivision.kept()[vertex] as usize], *at);
        }
    }
}

#[test]
fn parabolas_stay_parabolas_on_grids_and_inside_regular_meshes() {
    let height = |at: Vec2| at.x * at.x - 0.5 * at.x * at.y + 2.0 * at.y * at.y;
    let up =
        |at: Vec2| Vec3::new(-2.0 * at.x + 0.5 * at.y, 0.5 * at.x - 4.0 * at.y, 1.0).normalize();
    let Drawn { rest, subdivision } = grid([9, 5], STEPS);
    let [drawn, normals] = surface(&subdivision, &lifted(&rest, height));
    for (at, normal) in drawn.iter().zip(&normals) {
        assert!((at.z - height(at.truncate())).abs() < ROUNDING, "{at}");
        assert!((*normal - up(at.truncate())).length() < 1e-4, "{at}");
    }
    let Drawn { rest, subdivision } = disc(1);
    let [drawn, _] = surface(&subdivision, &lifted(&rest, height));
    let inside = drawn.iter().filter(|at| at.truncate().length() < 0.4);
    assert!(inside.clone().count() > 30);
    for at in inside {
        assert!((at.z - height(at.truncate())).abs() < ROUNDING, "{at}");
    }
}

#[test]
fn the_border_does_not_depend_on_the_interior() {
    for (Drawn { rest, subdivision }, inner) in [
        (grid([7, 5], STEPS), border(&Grid::new(7, 5, 2.0, 1.0).triangles(false))),
        (disc(STEPS), border(disc(0).subdivision.triangles())),
        (triangles(STEPS), border(triangles(0).subdivision.triangles())),
    ] {
        let mut positions = lifted(&rest, |at| libm::sinf(4.0 * at.x + at.y));
        let [before, _] = surface(&subdivision, &positions);
        let border = border(subdivision.triangles());
        assert!(border.len() > 20);
        for particle in 0..rest.len() as u32 {
            if !inner.contains(&particle) {
                positions[particle as usize].z += 1.0;
            }
        }
        let [after, _] = surface(&subdivision, &positions);
        for &vertex in &border {
            assert_eq!(before[vertex as usize], after[vertex as usize]);
        }
        assert_ne!(before, after);
    }
}

/// The vertices on edges of one triangle.
fn border(triangles: &[[u32; 3]]) -> Vec<u32> {
    let edges: Vec<[u32; 2]> =
        triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let known: std::collections::HashSet<_> = edges.iter().copied().collect();
    let is_border = |&[a, b]: &[u32; 2]| !known.contains(&[b, a]);
    edges.into_iter().filter(is_border).flatten().collect()
}

/// The angle between neighbouring triangles goes to zero as they become smaller, which it does on a surface with
/// continuous tangents only.
#[test]
fn a_fold_becomes_smooth() {
    for of_steps in [|steps| grid([9, 9], steps), triangles] {
        let turn = |steps: u32| {
            let Drawn { rest, subdivision } = of_steps(steps);
            let positions = lifted(&rest, |at| libm::sinf(6.0 * at.x) * 0.2);
            let [drawn, _] = surface(&subdivision, &positions);
            let edges = subdivision.triangles().iter().flat_map(|&[a, b, c]| {
                let [at, to, third] = [a, b, c].map(|corner| drawn[corner as usize]);
                let normal = (to - at).cross(third - at).normalize();
                [[a, b], [b, c], [c, a]].map(|edge| (edge, normal))
            });
            let sides: std::collections::HashMap<[u32; 2], Vec3> = edges.collect();
            let cosine = |([a, b], normal): (&[u32; 2], &Vec3)| {
                sides.get(&[*b, *a]).map(|other| other.dot(*normal))
            };
            libm::acosf(sides.iter().filter_map(cosine).fold(1.0, f32::min))
        };
        let (one, three) = (turn(1), turn(3));
        assert!(three < 0.5 * one, "{three} rad after {one} rad");
    }
}

#[test]
fn triangles_face_to_the_front_and_attributes_keep_their_place() {
    for (Drawn { rest, subdivision }, drawn_before) in [
        (grid([7, 5], STEPS), grid([7, 5], 0)),
        (disc(STEPS), disc(0)),
        (triangles(STEPS), triangles(0)),
    ] {
        let [drawn, _] = surface(&subdivision, &rest);
        let area = |at: &[Vec3], corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| at[corner as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        let areas = |at: &[Vec3], of: &Subdivision| -> Vec<f32> {
            of.triangles().iter().map(|corners| area(at, corners)).collect()
        };
        let found = areas(&drawn, &subdivision);
        assert!(found.iter().all(|&area| area > 0.0));
        let [found, before] =
            [found, areas(&rest, &drawn_before.subdivision)].map(|areas| areas.iter().sum::<f32>());
        assert!((found / before - 1.0).abs() < 1e-4);
        for (row, at) in subdivision.attributes().rows().zip(&drawn) {
            let mean: Vec3 = row.iter().map(|&(at, weight)| rest[at as usize] * weight).sum();
            assert!((mean - *at).length() < ROUNDING, "{mean} {at}");
        }
    }
}

#[test]
fn instruction_sets_that_fuse_give_the_same_bits() {
    let Drawn { rest, subdivision } = grid([17, 13], STEPS);
    let positions = lifted(&rest, |at| libm::sinf(7.0 * at.x) * libm::cosf(5.0 * at.y));
    let surface = || surface(&subdivision, &positions);
    let all = with_every_instruction_set(|| has_fused_products().then(surface));
    let all: Vec<_> = all.into_iter().flatten().collect();
    assert!(all.iter().all(|one| *one == all[0]));
}
