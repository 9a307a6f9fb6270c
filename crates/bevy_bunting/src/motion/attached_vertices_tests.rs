//! Tests of the choice of vertices.

use bunting_solver::Grid;

use super::*;

#[test]
fn edges_corners_and_predicates() {
    let uv = Grid::new(3, 2, 1.0, 1.0).uvs();
    let choose = |vertices: AttachedVertices| vertices.choose(&uv);
    assert_eq!(choose(ClothEdge::Left.into()), [0, 3]);
    assert_eq!(choose(ClothEdge::Right.into()), [2, 5]);
    assert_eq!(choose(ClothEdge::Top.into()), [0, 1, 2]);
    assert_eq!(choose(ClothEdge::Bottom.into()), [3, 4, 5]);
    assert_eq!(choose(ClothCorner::TopRight.into()), [2]);
    assert_eq!(choose(ClothCorner::BottomLeft.into()), [3]);
    let within = AttachedVertices::Within { low: Vec2::splat(0.5), high: Vec2::ONE };
    assert_eq!(choose(within), [4, 5]);
    let mesh = ClothMesh::grid(3, 2, 1.0, 1.0);
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
