//! Tests of cloths that are made of skinned meshes.

use bevy_math::{Mat4, Quat};
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{MeshVertexAttribute, VertexFormat};

use super::*;

const PLAY: MeshVertexAttribute = MeshVertexAttribute::new("Play", 77_002, VertexFormat::Float32);

/// Scale of the skeleton.
const SCALE: f32 = 2.0;

/// The flag's mesh, skinned to a joint at each of its upper corners. Its left column is red.
fn skinned(app: &mut App) -> Mesh {
    let mesh = flag_mesh(app);
    let column = |vertex: usize| vertex % 9;
    let red = |vertex: usize| if column(vertex) == 0 { 1.0 } else { 0.0 };
    let right = |vertex: usize| column(vertex) as f32 / 8.0;
    mesh.with_inserted_attribute(
        Mesh::ATTRIBUTE_COLOR,
        (0..45).map(|vertex| [red(vertex), 0.0, 0.0, 1.0]).collect::<Vec<_>>(),
    )
    .with_inserted_attribute(PLAY, (0..45).map(right).collect::<Vec<f32>>())
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_JOINT_INDEX,
        VertexAttributeValues::Uint16x4(vec![[0, 1, 0, 0]; 45]),
    )
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_JOINT_WEIGHT,
        (0..45).map(|vertex| [1.0 - right(vertex), right(vertex), 0.0, 0.0]).collect::<Vec<_>>(),
    )
}

#[test]
fn a_skinned_mesh_becomes_a_cloth_that_its_skeleton_leads() {
    let mut app = app(TICK);
    let artists = skinned(&mut app);
    let rest = values(&artists, Mesh::ATTRIBUTE_POSITION).clone();
    let given = add(&mut app, artists);
    let bound = [Vec3::ZERO, 1.5 * Vec3::X].map(|at| Mat4::from_translation(-at)).to_vec();
    let poses = app.world().resource::<Assets<SkinnedMeshInverseBindposes>>().reserve_handle();
    let root = Transform::from_xyz(0.0, 1.0, 0.0).with_scale(Vec3::splat(SCALE));
    let root = app.world_mut().spawn(root).id();
    let turned = Transform::from_rotation(Quat::from_rotation_z(0.3));
    let right = Transform::from_xyz(1.5, 0.0, 0.0);
    let joints = [turned, right].map(|at| app.world_mut().spawn((at, ChildOf(root))).id());
    let skin = SkinnedMesh { inverse_bindposes: poses.clone(), joints: joints.to_vec() };
    let paint = VertexPaint::Attribute("Play".to_owned());
    let painted = |at_zero, at_one| Some(PaintedDistance { paint: paint.clone(), at_zero, at_one });
    let from = ClothFromMesh {
        max_distance: painted(0.1, 0.3),
        backstop_distance: painted(0.02, 0.03),
        backstop_radius: painted(0.5, 0.0),
        ..ClothFromMesh::painted()
    };
    let cloth = app.world_mut().spawn((given.clone(), skin, from, ClothSubdivision::NONE)).id();
    run(&mut app, 3);
    assert!(app.world().get::<ClothMesh>(cloth).is_none(), "its bind poses are not loaded");
    let mut assets = app.world_mut().resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
    assets.insert(poses.id(), bound.into()).expect("a reserved handle");
    run(&mut app, 40);
    assert_eq!(failures(&app), []);
    assert!(app.world().get::<SkinnedMesh>(cloth).is_none(), "the renderer does not skin it");
    assert!(app.world().get::<ClothSkin>(cloth).is_some());
    let shown = mesh(&app, cloth);
    assert!(!shown.contains_attribute(Mesh::ATTRIBUTE_JOINT_INDEX));
    let source = app.world().resource::<Assets<Mesh>>().get(&given.0).expect("kept");
    assert!(source.contains_attribute(Mesh::ATTRIBUTE_JOINT_INDEX));
    // The fabric has the size of the skeleton, and the red vertices are where the joints hold them.
    let fabric = app.world().get::<ClothState>(cloth).and_then(ClothState::fabric);
    let rest_of_fabric = fabric.expect("it is simulated").rest_positions();
    let width = rest_of_fabric.iter().map(|at| at.x).fold(0.0, f32::max);
    assert!((width - SCALE * 1.5).abs() < 1e-3, "{width}");
    let poses = joints.map(|joint| *app.world().get::<GlobalTransform>(joint).expect("placed"));
    let mut farthest = 0.0_f32;
    for (vertex, at) in positions(&app, cloth).iter().map(|&at| Vec3::from(at)).enumerate() {
        let part = (vertex % 9) as f32 / 8.0;
        let bound = Vec3::from(rest[vertex]);
        let left = poses[0].transform_point(bound) * (1.0 - part);
        let place = left + poses[1].transform_point(bound - 1.5 * Vec3::X) * part;
        let limit = if vertex % 9 == 0 { 1e-4 } else { 0.1 + 0.2 * part + 1e-4 };
        let away = at.distance(place);
        assert!(away < limit, "{away} m of {limit} m, vertex {vertex}");
        farthest = farthest.max(away);
    }
    assert!(farthest > 0.1, "the rest moves: {farthest}");
    let limits = app.world().get::<SkinLimits>(cloth).expect("they are painted");
    for (painted, at_zero, at_one) in
        [(&limits.backstop_distance, 0.02, 0.03), (&limits.backstop_radius, 0.5, 0.0)]
    {
        let even = (0..45).map(|vertex| at_zero + (at_one - at_zero) * (vertex % 9) as f32 / 8.0);
        assert_eq!(*painted, ByVertex::Each(even.collect()));
    }
}
