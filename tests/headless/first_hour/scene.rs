//! Item 9: all components of a cloth reflect fully, and survive a round trip through a scene file.

use bevy_bunting::bunting_solver::{FabricMaterial, LaneCount};
use bevy_bunting::parry3d::shape::SharedShape;
use bevy_bunting::prelude::*;
use bevy_ecs::entity::{EntityHashMap, SceneEntityMapper};
use bevy_ecs::prelude::*;
use bevy_ecs::reflect::{AppTypeRegistry, ReflectComponent};
use bevy_ecs::relationship::RelationshipHookMode;
use bevy_math::{Vec2, Vec3};
use bevy_reflect::serde::{
    ReflectDeserializer, ReflectDeserializerProcessor, ReflectSerializer,
    ReflectSerializerProcessor,
};
use bevy_reflect::{
    FromReflect, GetPath, PartialReflect, ReflectRef, TypeRegistration, TypeRegistry,
};
use bevy_transform::prelude::*;
use bunting_tests::{FLAG, Seen, app, run, state};
use serde::de::DeserializeSeed;
use serde::{Deserialize, Deserializer, Serializer};

/// Serialises entities as numbers, as scenes do.
struct Entities;

impl ReflectSerializerProcessor for Entities {
    fn try_serialize<S: Serializer>(
        &self,
        value: &dyn PartialReflect,
        _: &TypeRegistry,
        serializer: S,
    ) -> Result<Result<S::Ok, S>, S::Error> {
        match value.try_downcast_ref::<Entity>() {
            Some(entity) => serializer.serialize_u64(entity.to_bits()).map(Ok),
            None => Ok(Err(serializer)),
        }
    }
}

impl ReflectDeserializerProcessor for Entities {
    fn try_deserialize<'de, D: Deserializer<'de>>(
        &mut self,
        registration: &TypeRegistration,
        _: &TypeRegistry,
        deserializer: D,
    ) -> Result<Result<Box<dyn PartialReflect>, D>, D::Error> {
        if registration.type_id() != core::any::TypeId::of::<Entity>() {
            return Ok(Err(deserializer));
        }
        let entity = Entity::from_bits(u64::deserialize(deserializer)?);
        Ok(Ok(Box::new(entity).into_partial_reflect()))
    }
}

/// Serialises as RON all components of an entity that a scene would hold.
fn save(world: &World, entity: Entity) -> Vec<String> {
    let types = world.resource::<AppTypeRegistry>().read();
    let entity = world.entity(entity);
    let reflected = types.iter().filter_map(|registered| {
        let value = registered.data::<ReflectComponent>()?.reflect(entity)?;
        Some(value.as_partial_reflect())
    });
    reflected
        .map(|value| {
            ron::to_string(&ReflectSerializer::with_processor(value, &types, &Entities))
                .unwrap_or_else(|error| panic!("{}: {error}", value.reflect_type_path()))
        })
        .collect()
}

/// Loads the components of saved entities as scenes do: only saved entities can be referenced.
fn load(world: &mut World, saved: &[(Entity, Vec<String>)]) -> Vec<Entity> {
    let types = world.resource::<AppTypeRegistry>().clone();
    let types = types.read();
    let mut loaded: EntityHashMap<Entity> =
        saved.iter().map(|(entity, _)| (*entity, world.spawn_empty().id())).collect();
    for (entity, components) in saved {
        let entity = loaded[entity];
        for text in components {
            let value = read(text, &types);
            let path = value.get_represented_type_info().expect("a type").type_path();
            let registered = types.get_with_type_path(path).expect("registered");
            let component = registered.data::<ReflectComponent>().expect("a component");
            SceneEntityMapper::world_scope(&mut loaded, world, |world, mapper| {
                let mut entity = world.entity_mut(entity);
                let mode = RelationshipHookMode::Skip;
                component.apply_or_insert_mapped(&mut entity, &*value, &types, mapper, mode);
            });
        }
    }
    saved.iter().map(|(entity, _)| loaded[entity]).collect()
}

fn read(text: &str, types: &TypeRegistry) -> Box<dyn PartialReflect> {
    let mut reader = ron::Deserializer::from_str(text).expect("RON");
    ReflectDeserializer::with_processor(types, &mut Entities)
        .deserialize(&mut reader)
        .unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn assert_saves(saved: &[String], components: &[&str]) {
    for name in components {
        let is_saved = saved.iter().any(|text| text.contains(&format!("::{name}\":")));
        assert!(is_saved, "{name} is not saved");
    }
}

fn weighted() -> ClothMesh {
    let weights = (0..45).map(|vertex| if vertex % 9 < 3 { 0.0 } else { 1.0 }).collect();
    ClothMesh::grid(9, 5, 1.0, 0.6).with_weights(weights)
}

#[test]
fn cloths_make_the_round_trip() {
    let material = FabricMaterial { damping: 0.7, ..FabricMaterial::SILK };
    let vertices = [
        AttachedVertices::Edge(ClothEdge::Top),
        AttachedVertices::Corners(vec![ClothCorner::TopLeft, ClothCorner::BottomRight]),
        AttachedVertices::List(vec![0, 9, 18]),
        AttachedVertices::Points(vec![MeshPoint::middle([0, 9, 10]), MeshPoint::at_vertex(8)]),
        AttachedVertices::Within { low: Vec2::ZERO, high: Vec2::new(0.2, 1.0) },
        AttachedVertices::Rigid,
    ];
    for vertices in vertices {
        let mesh = match vertices {
            AttachedVertices::Rigid => weighted(),
            _ => ClothMesh::grid(9, 5, 1.0, 0.6),
        };
        let held = Attachment::in_place(vertices).with_offset(Transform::from_xyz(0.0, 1.0, 0.0));
        let mut first = app();
        let cloth = (mesh, ClothMaterial(material), LodSet::new([8.0]), held, ClothPaused);
        let cloth = first.world_mut().spawn(cloth).id();
        run(&mut first, 5);
        let saved = save(first.world(), cloth);
        let components = ["ClothMesh", "ClothMaterial", "LodSet", "Attachment", "ClothPaused"];
        assert_saves(&saved, &components);
        let mut second = app();
        let loaded = load(second.world_mut(), &[(cloth, saved.clone())])[0];
        assert_eq!(save(second.world(), loaded), saved);
        let of = |entity, world: &World| world.get::<ClothMaterial>(entity).copied();
        assert_eq!(of(loaded, second.world()), of(cloth, first.world()));
        second.world_mut().entity_mut(loaded).remove::<ClothPaused>();
        run(&mut second, 5);
        assert!(!state(&second, loaded).positions().is_empty());
        assert!(second.world().resource::<Seen<ClothFailed>>().0.is_empty());
    }
}

#[test]
fn a_flag_is_loaded_with_its_pole() {
    let mut first = app();
    let pole = first.world_mut().spawn(Transform::from_xyz(1.0, 2.0, 3.0)).id();
    let flag = (FLAG, Attachment::new(pole, ClothEdge::Left));
    let flag = first.world_mut().spawn(flag).id();
    run(&mut first, 2);
    let saved = [pole, flag].map(|entity| (entity, save(first.world(), entity)));
    let mut second = app();
    // Other entities are spawned first, so that the loaded entities have different numbers than before.
    second.world_mut().spawn_batch([Transform::default(); 7]);
    let [pole, flag] = load(second.world_mut(), &saved)[..] else { panic!("two entities") };
    run(&mut second, 2);
    assert_eq!(second.world().get::<Attachment>(flag).map(|held| held.target), Some(pole));
    assert!(!state(&second, flag).positions().is_empty());
}

#[test]
fn colliders_winds_and_viewers_make_the_round_trip() {
    let mut first = app();
    let shapes = [
        SharedShape::ball(0.5),
        SharedShape::capsule_y(1.0, 0.2),
        SharedShape::cuboid(1.0, 2.0, 3.0),
        SharedShape::trimesh(vec![Vec3::ZERO, Vec3::X, Vec3::Z], vec![[0, 1, 2]]).expect("a mesh"),
    ];
    for shape in shapes {
        let collider = ClothCollider { margin: 0.01, friction: 0.4, ..ClothCollider::new(shape) };
        let wind = WindField::steady(Vec3::X).with_gusts(2.0, 0.5, 3);
        let all = first.world_mut().spawn((collider, wind, LodViewer::default())).id();
        run(&mut first, 2);
        let saved = save(first.world(), all);
        assert_saves(&saved, &["ClothCollider", "WindField", "LodViewer"]);
        let mut second = app();
        let loaded = load(second.world_mut(), &[(all, saved.clone())])[0];
        assert_eq!(save(second.world(), loaded), saved);
        let collider = second.world().get::<ClothCollider>(loaded).expect("a collider");
        let original = first.world().get::<ClothCollider>(all).expect("a collider");
        assert_eq!(collider.shape.shape_type(), original.shape.shape_type());
        assert_eq!(collider.shape.compute_local_aabb(), original.shape.compute_local_aabb());
    }
}

#[test]
fn settings_make_the_round_trip() {
    let limits = StepLimits { substeps: 2..=7, rate: 90, passes: 3, ..StepLimits::default() };
    let lanes = Some(LaneCount::Sixteen);
    let settings = ClothSettings { steps: vec![limits], lanes, ..ClothSettings::default() };
    let app = app();
    let types = app.world().resource::<AppTypeRegistry>().read();
    let text = ron::to_string(&ReflectSerializer::new(&settings, &types)).expect("RON");
    let loaded = ClothSettings::from_reflect(&*read(&text, &types)).expect("settings");
    assert_eq!(loaded, settings);
}

#[test]
fn an_inspector_sees_the_fields_of_a_material() {
    let material = ClothMaterial(FabricMaterial::SILK);
    let ReflectRef::TupleStruct(_) = material.reflect_ref() else { panic!("opaque") };
    let density = material.path::<f32>(".0.area_density").expect("a field");
    assert_eq!(*density, FabricMaterial::SILK.area_density);
}
