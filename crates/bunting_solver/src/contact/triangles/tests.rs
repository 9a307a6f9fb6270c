use glam::Vec3;
use parry3d::query::{PointQuery, Ray};
use parry3d::shape::{Ball, Cuboid, HeightField, SharedShape, TriMesh, TriMeshFlags, Triangle};
use parry3d::utils::Array2;

use super::{LaneTriangles, Near, TriangleCells};
use crate::contact::ground;
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::registers::Pack8;
use crate::simd::vec3::{Pack3, V3, set_lane3};

const WIDTH: f32 = 0.04;

fn cells_of(shape: &SharedShape) -> TriangleCells {
    let mut cells = None;
    TriangleCells::begin_tick(&mut cells, shape, [0.5 * WIDTH, 4.0 * WIDTH], 1000);
    cells.expect("triangles")
}

fn mesh((corners, triangles): (Vec<Vec3>, Vec<[u32; 3]>), flags: TriMeshFlags) -> SharedShape {
    SharedShape::new(TriMesh::with_flags(corners, triangles, flags).expect("a mesh"))
}

/// Closed meshes, one with sharp edges; an open one; a polyhedron; ground with a hole.
fn shapes() -> [SharedShape; 5] {
    let closed = TriMeshFlags::ORIENTED | TriMeshFlags::MERGE_DUPLICATE_VERTICES;
    let ball = Ball::new(0.3).to_trimesh(12, 9);
    let hull = SharedShape::convex_hull(&ball.0).expect("a hull");
    let heights = Array2::new(9, 9, (0..81).map(|at| 0.1 * libm::sinf(at as f32)).collect());
    let mut field = HeightField::new(heights, Vec3::new(1.2, 1.0, 1.2));
    field.set_cell_status(2, 3, parry3d::shape::HeightFieldCellStatus::CELL_REMOVED);
    [
        mesh(ball.clone(), closed),
        mesh(Cuboid::new(Vec3::new(0.4, 0.02, 0.3)).to_trimesh(), closed),
        mesh(ball, TriMeshFlags::empty()),
        hull,
        SharedShape::new(field),
    ]
}

/// Points in a box around the shapes.
fn points(count: u32) -> impl Iterator<Item = Vec3> {
    let number = |index: u32, step: f32| (index as f32 * step).fract() - 0.5;
    (1..count).map(move |index| {
        Vec3::new(number(index, 0.618_034), number(index, 0.754_878), number(index, 0.569_84))
    })
}

/// Signed distance from a shape, m, negative inside. Open meshes have no inside.
fn distance(shape: &SharedShape, at: Vec3) -> f32 {
    if let Some(field) = shape.as_heightfield() {
        let away = field.project_local_point(at, false).point.distance(at);
        return if ground::depth(field, at).is_some_and(|depth| depth > 0.0) {
            -away
        } else {
            away
        };
    }
    let is_open = shape.as_trimesh().is_some_and(|mesh| mesh.pseudo_normals().is_none());
    let nearest = shape.project_local_point_and_get_feature(at).0;
    let away = nearest.point.distance(at);
    if nearest.is_inside && !is_open { -away } else { away }
}

#[test]
fn cells_tell_what_a_search_tells() {
    for (index, shape) in shapes().iter().enumerate() {
        let mut cells = cells_of(shape);
        let mut near = 0;
        for at in points(12_000) {
            let expected = distance(shape, at);
            match cells.nearest(at) {
                Near::At { away, is_inside } => {
                    near += 1;
                    let found = if is_inside { -away.length() } else { away.length() };
                    assert!(
                        (found - expected).abs() < 1e-5,
                        "{index}: {at}, {found} of {expected}"
                    );
                }
                Near::Outside => assert!(expected > 0.99 * WIDTH, "{index}: {at}, {expected}"),
                Near::Inside => assert!(expected < -0.99 * WIDTH, "{index}: {at}, {expected}"),
            }
        }
        assert!(near > 500, "{index}: {near}");
    }
}

#[test]
fn short_paths_enter_where_a_search_says() {
    for (index, shape) in shapes().iter().enumerate() {
        let mut cells = cells_of(shape);
        let mut entered = 0;
        for (from, turn) in points(24_000).zip(points(24_000).skip(77)) {
            let to = from + 0.99 * WIDTH * turn.normalize();
            let path = Ray::new(from, to - from);
            // The polyhedron is solid for rays, and its inside no start of a path.
            if distance(shape, from) < 0.0 {
                continue;
            }
            let expected = shape.cast_local_ray_and_get_normal(&path, 1.0, true);
            let found = cells.entry(from, to);
            let (Some(expected), Some((at, normal))) = (&expected, &found) else {
                let grazed = distance(shape, to).abs().min(distance(shape, from).abs());
                assert!(expected.is_none() && found.is_none() || grazed < 1e-4, "{index}: {from}");
                continue;
            };
            entered += 1;
            assert!(path.point_at(expected.time_of_impact).distance(*at) < 1e-4, "{index}: {from}");
            assert!(normal.dot(to - from) < 0.0 && normal.is_normalized(), "{index}: {from}");
        }
        assert!(entered > 100, "{index}: {entered}");
    }
}

#[test]
fn what_cells_tell_does_not_depend_on_what_was_asked_before() {
    for shape in shapes() {
        let forwards: Vec<Vec3> = points(800).collect();
        let (mut one, mut other) = (cells_of(&shape), cells_of(&shape));
        let first: Vec<Near> = forwards.iter().map(|at| one.nearest(*at)).collect();
        let mut second: Vec<Near> = forwards.iter().rev().map(|at| other.nearest(*at)).collect();
        second.reverse();
        assert_eq!(format!("{first:?}"), format!("{second:?}"));
    }
}

/// Asks for the distances of points in lanes, m.
struct Ask<'a> {
    triangles: &'a LaneTriangles<Pack8>,
    at: &'a Pack3<Pack8>,
    within: f32,
    distance: &'a mut Pack8,
}

impl Kernel<Pack8> for Ask<'_> {
    #[inline(always)]
    fn run<L: Lane<Pack = Pack8>>(self, token: L::Token) {
        let (at, within) = (V3::load(token, self.at), L::splat(token, self.within));
        self.triangles.nearest(token, 0, at, within).0.store(self.distance);
    }
}

#[test]
fn lanes_tell_what_cells_tell() {
    let within = 0.2 * WIDTH;
    for (index, shape) in shapes().iter().enumerate() {
        let mut cells = cells_of(shape);
        let (mut near, mut unknown) = (0, 0);
        let all: Vec<Vec3> = points(12_000).collect();
        for chunk in all.chunks_exact(8) {
            let mut triangles = LaneTriangles::<Pack8>::new();
            let zero = Pack8::splat(0.0);
            let (mut pack, mut distances) = ([zero; 3], zero);
            for (lane, middle) in chunk.iter().enumerate() {
                let find = |found: &mut Vec<Triangle>| cells.within(*middle, WIDTH, found);
                let is_closed = shape.as_trimesh().is_none_or(|it| it.pseudo_normals().is_some());
                triangles.add((0, lane), *middle, is_closed, find);
                // Up to one and a half times as far as triangles are known.
                let moved = 1.5 * WIDTH * (lane as f32 / 7.0) * all[lane].normalize();
                set_lane3(&mut pack, lane, *middle + moved);
            }
            triangles.pack();
            let ask = Ask { triangles: &triangles, at: &pack, within, distance: &mut distances };
            Pack8::run(ask);
            for (lane, found) in distances.lanes().iter().enumerate() {
                let at = Vec3::from_array(pack.map(|of_axis| of_axis.lanes()[lane]));
                let expected = distance(shape, at);
                let known = WIDTH - at.distance(chunk[lane]);
                if *found == -1.0 {
                    // Deep inside, or not known.
                    assert!(known < within || distance(shape, chunk[lane]) < 0.0);
                    unknown += 1;
                } else if expected.abs() < 0.999 * known {
                    near += 1;
                    // Beside ground, and in its holes, lanes take for inside what is looked at by itself.
                    let is_beside = shape.as_heightfield().is_some() && *found < 0.0;
                    let expected = if is_beside { -expected.abs() } else { expected };
                    assert!((found - expected).abs() < 1e-5, "{index}: {at}, {found}, {expected}");
                } else {
                    assert!(*found <= expected.abs() + 1e-5, "{index}: {at}, {found}, {expected}");
                }
            }
        }
        assert!(near > 150 && unknown > 100, "{index}: {near}, {unknown}");
    }
}
