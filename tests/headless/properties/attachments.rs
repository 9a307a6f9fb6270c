//! What holds a cloth, and what else is on its entity: any of it is used, or told.

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_transform::prelude::*;
use proptest::collection::vec;
use proptest::option::of;
use proptest::prelude::*;
use proptest::sample::select;

use super::beside::{flag_goes_on, mesh};
use super::for_all;
use super::numbers::{number, pose, thickness, uv, vector};

/// Who holds a cloth.
#[derive(Clone, Copy, Debug)]
enum Holder {
    Pole,
    /// An entity without a transform.
    Bare,
    /// An entity that was despawned.
    Gone,
    Itself,
}

#[derive(Clone, Debug)]
struct Held {
    holder: Holder,
    vertices: AttachedVertices,
    offset: Transform,
    hold: AnchorHold,
    break_force: f32,
}

fn vertices() -> BoxedStrategy<AttachedVertices> {
    let edges = [ClothEdge::Left, ClothEdge::Right, ClothEdge::Top, ClothEdge::Bottom];
    let corners = [ClothCorner::TopLeft, ClothCorner::TopRight, ClothCorner::BottomLeft];
    let weights = prop_oneof![3 => Just([0.5, 0.25, 0.25]), 1 => [number(), number(), number()]];
    let point = ([0..60_u32, 0..60, 0..60], weights)
        .prop_map(|(vertices, weights)| MeshPoint { vertices, weights });
    prop_oneof![
        4 => select(edges.to_vec()).prop_map(AttachedVertices::Edge),
        2 => vec(select(corners.to_vec()), 0..3).prop_map(AttachedVertices::Corners),
        2 => vec(0..60_u32, 0..5).prop_map(AttachedVertices::List),
        1 => (uv(), uv()).prop_map(|(low, high)| AttachedVertices::Within { low, high }),
        1 => vec(vector(), 0..3).prop_map(AttachedVertices::Nearest),
        1 => (vector(), vector()).prop_map(|(low, high)| AttachedVertices::InBox { low, high }),
        1 => vector().prop_map(|near| AttachedVertices::Border { near }),
        1 => vec(point, 0..3).prop_map(AttachedVertices::Points),
        1 => Just(AttachedVertices::Rigid),
    ]
    .boxed()
}

fn hold() -> BoxedStrategy<AnchorHold> {
    prop_oneof![
        2 => Just(AnchorHold::Rigid),
        2 => (number(), number())
            .prop_map(|(stiffness, max_force)| AnchorHold::Spring { stiffness, max_force }),
        1 => (vec(vector(), 0..4), number(), number()).prop_map(|(points, ring_mass, friction)| {
            AnchorHold::Rail { points, ring_mass, friction }
        }),
    ]
    .boxed()
}

fn held() -> BoxedStrategy<Held> {
    let holders =
        [Holder::Pole, Holder::Pole, Holder::Pole, Holder::Bare, Holder::Gone, Holder::Itself];
    let force = prop_oneof![2 => Just(f32::INFINITY), 1 => number()];
    (select(holders.to_vec()), vertices(), pose(), hold(), force)
        .prop_map(|(holder, vertices, offset, hold, break_force)| Held {
            holder,
            vertices,
            offset,
            hold,
            break_force,
        })
        .boxed()
}

fn inertia() -> BoxedStrategy<ClothInertia> {
    [number(), number(), number(), number(), number()]
        .prop_map(|[linear, angular, max_speed, max_acceleration, max_turn_rate]| ClothInertia {
            linear,
            angular,
            max_speed,
            max_acceleration,
            max_turn_rate,
        })
        .boxed()
}

fn air() -> BoxedStrategy<ClothPressure> {
    prop_oneof![
        number().prop_map(|pressure| ClothPressure::Constant { pressure }),
        (number(), number())
            .prop_map(|(pressure, ambient)| ClothPressure::Sealed { pressure, ambient }),
        number().prop_map(|coefficient| ClothPressure::Canopy { coefficient }),
    ]
    .boxed()
}

fn levels() -> BoxedStrategy<LodSet> {
    let choice = prop_oneof![
        vec(number(), 0..3).prop_map(LodSet::new),
        (0..4_usize).prop_map(LodSet::automatic),
    ];
    let pinned = prop_oneof![2 => Just(None), 1 => (0..4_usize).prop_map(Some)];
    (choice, number(), pinned)
        .prop_map(|(lods, bias, pinned)| LodSet { bias, pinned, ..lods })
        .boxed()
}

fn insert(cloth: &mut EntityWorldMut, component: Option<impl Bundle>) {
    if let Some(component) = component {
        cloth.insert(component);
    }
}

#[test]
fn a_cloth_is_held_by_anything_or_that_is_told() {
    let inputs = (any::<bool>(), held(), vec(held(), 0..3), pose(), pose(), pose());
    for_all(64, inputs, |(is_grid, target, anchors, place, pole, moved)| {
        let spawn = |app: &mut App| {
            let world = app.world_mut();
            let [gone, bare] = [(); 2].map(|()| world.spawn_empty().id());
            world.despawn(gone);
            let pole = world.spawn(pole).id();
            let cloth = world.spawn((mesh(is_grid), place, AnchorReactions::default())).id();
            let entity = |holder: Holder| match holder {
                Holder::Pole => pole,
                Holder::Bare => bare,
                Holder::Gone => gone,
                Holder::Itself => cloth,
            };
            let attachment =
                Attachment::new(entity(target.holder), target.vertices).with_offset(target.offset);
            let attachment = anchors.into_iter().fold(attachment, |attachment, held| {
                let anchor = Anchor::new(entity(held.holder), held.vertices);
                let anchor = anchor.with_hold(held.hold).with_offset(held.offset);
                attachment.with_anchor(Anchor { break_force: held.break_force, ..anchor })
            });
            world.entity_mut(cloth).insert(attachment);
            pole
        };
        let change = |app: &mut App, pole| {
            *app.world_mut().get_mut::<Transform>(pole).expect("a pole") = moved;
        };
        _ = flag_goes_on(spawn, change);
    });
}

#[test]
fn a_cloth_takes_any_components_or_they_are_told() {
    let inputs = (
        any::<bool>(),
        of(inertia()),
        of(thickness().prop_map(|thickness| SelfCollision { thickness, levels: 2 })),
        of(thickness().prop_map(|thickness| ClothCollision { thickness, levels: 2 })),
        of(vector().prop_map(ClothAcceleration)),
        of(number().prop_map(WindInfluence)),
        of(air()),
        of(levels()),
    );
    for_all(
        64,
        inputs,
        |(is_grid, inertia, layers, others, acceleration, influence, air, levels)| {
            let spawn = |app: &mut App| {
                let held = Attachment::in_place(ClothEdge::Left);
                let mut cloth = app.world_mut().spawn((mesh(is_grid), held));
                insert(&mut cloth, inertia);
                insert(&mut cloth, layers);
                insert(&mut cloth, others);
                insert(&mut cloth, acceleration);
                insert(&mut cloth, influence);
                insert(&mut cloth, air);
                insert(&mut cloth, levels);
            };
            _ = flag_goes_on(spawn, |_, ()| {});
        },
    );
}
