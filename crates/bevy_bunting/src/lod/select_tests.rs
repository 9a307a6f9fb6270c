//! Tests of a cloth's state before and after a change of level.

use std::time::Duration;

use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bunting_solver::ClothSnapshot;

use crate::batch::assign::assign_lanes;
use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::lod::lod_set::LodSet;
use crate::motion::attached_vertices::ClothEdge;
use crate::motion::attachment::Attachment;
use crate::schedule::{ClothSystems, ClothTick};
use crate::{ClothPlugins, WindField};

/// The state before the choice of levels, and after it.
#[derive(Resource, Default)]
struct Moved {
    before: ClothSnapshot,
    after: ClothSnapshot,
}

fn snapshot(cloths: &Query<&ClothInstance>, batches: &ClothBatches) -> ClothSnapshot {
    let lane = cloths.single().ok().and_then(ClothInstance::lane);
    lane.map_or_else(ClothSnapshot::default, |lane| batches.batch(lane).snapshot(lane.lane))
}

#[test]
fn a_change_of_level_transfers_positions_and_velocities() {
    let mut app = App::new();
    app.add_plugins((TimePlugin, ClothPlugins::default()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_micros(15_625)))
        .init_resource::<Moved>()
        .add_systems(
            ClothTick,
            (
                (|cloths: Query<&ClothInstance>,
                  batches: Res<ClothBatches>,
                  mut moved: ResMut<Moved>| {
                    moved.before = snapshot(&cloths, &batches);
                })
                .after(ClothSystems::Prepare)
                .before(ClothSystems::SelectLod),
                (|cloths: Query<&ClothInstance>,
                  batches: Res<ClothBatches>,
                  mut moved: ResMut<Moved>| {
                    moved.after = snapshot(&cloths, &batches);
                })
                .after(assign_lanes)
                .before(ClothSystems::Drive),
            ),
        );
    app.world_mut().spawn(WindField::steady(Vec3::new(3.0, 0.0, 4.0)));
    let levels = LodSet::new([10.0]).pinned_to(1);
    let attachment = Attachment::in_place(ClothEdge::Left);
    let cloth = app.world_mut().spawn((ClothMesh::grid(5, 5, 1.0, 1.0), levels, attachment)).id();
    (0..20).for_each(|_| app.update());
    app.world_mut().get_mut::<LodSet>(cloth).expect("levels").pinned = Some(0);
    app.update();

    let Moved { before, after } = app.world().resource::<Moved>();
    assert_eq!((before.velocities.len(), after.velocities.len()), (9, 25));
    assert!(before.velocities[8].length() > 0.1);
    let instance = app.world().get::<ClothInstance>(cloth).expect("a cloth");
    let levels = instance.levels.as_ref().expect("levels");
    let gravity = Vec3::NEG_Y * 9.81;
    let moved = levels.transfer(before.clone(), (1, 0), &instance.material, gravity);
    assert_eq!((&after.positions, &after.velocities), (&moved.positions, &moved.velocities));
}
