//! Tests of the choice of vertices.

use super::*;

#[test]
fn edges_corners_and_predicates() {
    let mesh = ClothMesh::grid(3, 2, 1.0, 1.0);
    let choose = |vertices: AttachedVertices| vertices.choose(&mesh);
    assert_eq!(choose(ClothEdge::Left.into()), [0, 3]);
    assert_eq!(choose(ClothEdge::Right.into()), [2, 5]);
    assert_eq!(choose(ClothEdge::Top.into()), [0, 1, 2]);
    assert_eq!(choose(ClothEdge::Bottom.into()), [3, 4, 5]);
    assert_eq!(choose(ClothCorner::TopRight.into()), [2]);
    assert_eq!(choose(ClothCorner::BottomLeft.into()), [3]);
    let within = AttachedVertices::Within { low: Vec2::splat(0.5), high: Vec2::ONE };
    assert_eq!(choose(within), [4, 5]);
    let list = AttachedVertices::list_where(&mesh, |uv| uv.x > 0.4 && uv.y > 0.5);
    assert_eq!(choose(list), [4, 5]);
    assert_eq!(choose(AttachedVertices::List(vec![4])), [4]);
    // Points at vertices are these.
    let beside = MeshPoint { vertices: [0, 1, 3], weights: [0.5, 0.5, 0.0] };
    let at_corner = MeshPoint { vertices: [0, 1, 3], weights: [0.0, 0.0, 1.0] };
    let points = AttachedVertices::Points(vec![beside, at_corner]);
    assert_eq!(points.points().collect::<Vec<_>>(), [beside]);
    assert_eq!(choose(points), [3]);
}

#[test]
fn places_and_boxes_are_those_of_the_mesh() {
    let sheet = ClothMesh::sheet(3, 3, 2.0, 4.0);
    let choose = |vertices: AttachedVertices| vertices.choose(&sheet);
    // Columns from x = -1 to 1, rows from z = -2 to 2.
    let places = vec![Vec3::new(-1.0, 0.0, -2.0), Vec3::new(0.9, 5.0, 0.1), Vec3::ZERO];
    assert_eq!(choose(AttachedVertices::Nearest(places)), [0, 5, 4]);
    let far = AttachedVertices::InBox { low: Vec3::new(-9.0, -0.1, 0.5), high: Vec3::splat(9.0) };
    assert_eq!(choose(far), [6, 7, 8]);
    assert_eq!(choose(AttachedVertices::InBox { low: Vec3::ONE, high: Vec3::ZERO }), [0; 0]);
    assert_eq!(choose(7.into()), [7]);
    let place = |vertices: AttachedVertices| vertices.first_place(&sheet);
    let corner = place(ClothCorner::BottomRight.into()).expect("a corner");
    assert!(corner.distance(Vec3::new(1.0, 0.0, 2.0)) < 1e-6, "{corner}");
    assert_eq!(place(AttachedVertices::Rigid), None);
    assert_eq!(place(99.into()), None);
    let point = MeshPoint { vertices: [0, 1, 3], weights: [0.5, 0.5, 0.0] };
    let point = place(AttachedVertices::Points(vec![point])).expect("a point");
    assert!(point.distance(Vec3::new(-0.5, 0.0, -2.0)) < 1e-6, "{point}");
}

#[test]
fn a_border_is_followed_all_around_across_its_seam() {
    // A tube of two rings of five vertices, of which the first and the last are at one place.
    let ring = |y: f32| {
        (0..5).map(move |at| {
            let (x, z) = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][at % 4];
            Vec3::new(x, y, z)
        })
    };
    let positions: Vec<Vec3> = ring(1.0).chain(ring(0.0)).collect();
    let cell = |at: u32| [at, at + 5, at + 1, at + 1, at + 5, at + 6];
    let tube = ClothMesh::triangles(positions, (0..4).flat_map(cell).collect(), Vec::new());
    let border = |y: f32| AttachedVertices::Border { near: Vec3::new(0.9, y, 0.3) }.choose(&tube);
    assert_eq!(border(1.2), [0, 1, 2, 3, 4]);
    assert_eq!(border(0.1), [5, 6, 7, 8, 9]);
    let grid = AttachedVertices::Border { near: Vec3::ZERO }.choose(&ClothMesh::grid(3, 3, 1., 1.));
    assert_eq!(grid, [0, 1, 2, 3, 5, 6, 7, 8]);
    let bad = ClothMesh::triangles(vec![Vec3::ZERO; 3], vec![0, 1, 7], Vec::new());
    assert_eq!(AttachedVertices::Border { near: Vec3::ZERO }.choose(&bad), [0; 0]);
}
