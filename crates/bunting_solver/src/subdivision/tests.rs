//! Tests of subdivided surfaces.

use glam::{Vec2, Vec3};

use super::{Subdivision, SubdivisionBuffers};
use crate::fabric::{Fabric, FabricBuilder, Grid};
use crate::simd::level::{has_fused_products, with_every_instruction_set};

/// Rounding of sums of some ten terms of up to two metres, m.
const ROUNDING: f32 = 2e-6;

const STEPS: u32 = 2;

fn grid(columns: u32, rows: u32) -> (Fabric, Vec<u32>) {
    let builder = FabricBuilder::grid(Grid::new(columns, rows, 2.0, 1.0));
    let indices = builder.indices().to_vec();
    (builder.build().expect("a grid"), indices)
}

/// A disc of rings of six triangles, twelve and so on: irregular at its border only.
fn disc() -> (Fabric, Vec<u32>) {
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
    let builder = FabricBuilder::new(axial.iter().map(place).collect(), indices.clone());
    (builder.build().expect("a disc"), indices)
}

/// A grid as a mesh of triangles, irregular everywhere.
fn triangles() -> (Fabric, Vec<u32>) {
    let (grid, indices) = grid(17, 9);
    let builder = FabricBuilder::new(grid.rest_positions().to_vec(), indices.clone());
    (builder.build().expect("a mesh"), indices)
}

fn surface(subdivision: &Subdivision, positions: &[Vec3]) -> [Vec<Vec3>; 2] {
    let count = subdivision.attributes().rows().len();
    let (mut drawn, mut normals) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
    let mut buffers = SubdivisionBuffers::default();
    subdivision.evaluate(positions, &mut buffers, &mut drawn, &mut normals);
    [drawn, normals].map(|values| values.into_iter().map(Vec3::from).collect())
}

fn lifted(fabric: &Fabric, height: impl Fn(Vec2) -> f32) -> Vec<Vec3> {
    fabric.rest_positions().iter().map(|at| at.truncate().extend(height(at.truncate()))).collect()
}

#[test]
fn planes_stay_planes_and_particles_stay_in_place() {
    for (fabric, indices) in [grid(7, 5), grid(2, 2), grid(3, 2), disc(), triangles()] {
        let subdivision = Subdivision::new(&fabric, &indices, STEPS);
        let slope = |at: Vec2| 0.5 * at.x - 0.25 * at.y;
        let up = Vec3::new(-0.5, 0.25, 1.0).normalize();
        let positions = lifted(&fabric, slope);
        let [drawn, normals] = surface(&subdivision, &positions);
        for (at, normal) in drawn.iter().zip(&normals) {
            assert!((at.z - slope(at.truncate())).abs() < ROUNDING, "{at}");
            assert!((*normal - up).length() < 1e-4, "{normal}");
        }
        let wavy = lifted(&fabric, |at| libm::sinf(5.0 * at.x) * libm::cosf(3.0 * at.y));
        let [drawn, _] = surface(&subdivision, &wavy);
        for (vertex, &particle) in fabric.particle_of_vertex().iter().enumerate() {
            assert_eq!(drawn[subdivision.kept()[vertex] as usize], wavy[particle as usize]);
        }
    }
}

#[test]
fn parabolas_stay_parabolas_on_grids_and_inside_regular_meshes() {
    let height = |at: Vec2| at.x * at.x - 0.5 * at.x * at.y + 2.0 * at.y * at.y;
    let up =
        |at: Vec2| Vec3::new(-2.0 * at.x + 0.5 * at.y, 0.5 * at.x - 4.0 * at.y, 1.0).normalize();
    let (fabric, indices) = grid(9, 5);
    let subdivision = Subdivision::new(&fabric, &indices, STEPS);
    let [drawn, normals] = surface(&subdivision, &lifted(&fabric, height));
    for (at, normal) in drawn.iter().zip(&normals) {
        assert!((at.z - height(at.truncate())).abs() < ROUNDING, "{at}");
        assert!((*normal - up(at.truncate())).length() < 1e-4, "{at}");
    }
    let (fabric, indices) = disc();
    let subdivision = Subdivision::new(&fabric, &indices, 1);
    let [drawn, _] = surface(&subdivision, &lifted(&fabric, height));
    let inside = drawn.iter().filter(|at| at.truncate().length() < 0.4);
    assert!(inside.clone().count() > 30);
    for at in inside {
        assert!((at.z - height(at.truncate())).abs() < ROUNDING, "{at}");
    }
}

#[test]
fn the_border_does_not_depend_on_the_interior() {
    for (fabric, indices) in [grid(7, 5), disc(), triangles()] {
        let subdivision = Subdivision::new(&fabric, &indices, STEPS);
        let mut positions = lifted(&fabric, |at| libm::sinf(4.0 * at.x + at.y));
        let [before, _] = surface(&subdivision, &positions);
        let border = border(subdivision.triangles());
        assert!(border.len() > 20);
        let inner = self::border(fabric.triangles());
        for particle in 0..fabric.particle_count() as u32 {
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
    for (fabric, indices) in [grid(9, 9), triangles()] {
        let positions = lifted(&fabric, |at| libm::sinf(6.0 * at.x) * 0.2);
        let turn = |steps: u32| {
            let subdivision = Subdivision::new(&fabric, &indices, steps);
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
    for (fabric, indices) in [grid(7, 5), disc(), triangles()] {
        let subdivision = Subdivision::new(&fabric, &indices, STEPS);
        let rest = fabric.rest_positions();
        let [drawn, _] = surface(&subdivision, rest);
        let area = |&corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| drawn[corner as usize]);
            0.5 * (b - a).cross(c - a).z
        };
        let areas: Vec<f32> = subdivision.triangles().iter().map(area).collect();
        assert!(areas.iter().all(|&area| area > 0.0));
        assert!((areas.iter().sum::<f32>() - fabric.area()).abs() < 1e-4 * fabric.area());
        for (row, at) in subdivision.attributes().rows().zip(&drawn) {
            let of = |vertex: u32| rest[fabric.particle_of_vertex()[vertex as usize] as usize];
            let mean: Vec3 = row.iter().map(|&(vertex, weight)| of(vertex) * weight).sum();
            assert!((mean - *at).length() < ROUNDING, "{mean} {at}");
        }
    }
}

#[test]
fn instruction_sets_that_fuse_give_the_same_bits() {
    let (fabric, indices) = grid(17, 13);
    let subdivision = Subdivision::new(&fabric, &indices, STEPS);
    let positions = lifted(&fabric, |at| libm::sinf(7.0 * at.x) * libm::cosf(5.0 * at.y));
    let surface = || surface(&subdivision, &positions);
    let all = with_every_instruction_set(|| has_fused_products().then(surface));
    let all: Vec<_> = all.into_iter().flatten().collect();
    assert!(all.iter().all(|one| *one == all[0]));
}
