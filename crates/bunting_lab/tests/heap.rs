//! Test of the counted memory. It is alone in its program, since other tests would allocate meanwhile.

use std::hint::black_box;

use bevy_bunting::{ClothBatches, ClothEffort, LodSet};
use bevy_transform::systems::StaticTransformOptimizations;
use bunting_lab::{
    commands::memory,
    fleet::Fleet,
    game,
    heap::{allocations_of, held_by},
    product::DEFAULT,
    scenes::Scene,
};
use glam::Vec3;

#[test]
fn memory_is_counted() {
    memory_grows_with_the_number_of_particles();
    the_plugin_steps_as_plain_calls_do_and_allocates_nothing();
}

/// What the plugin costs over plain calls of the solver, in numbers that no other program of the machine changes: batches,
/// substeps and allocations of eight flags that fly.
fn the_plugin_steps_as_plain_calls_do_and_allocates_nothing() {
    /// Flags: a full batch of eight lanes.
    const FLAGS: usize = 8;
    const N: u32 = 33;
    /// Updates until all buffers are as long as they become, and those that are counted.
    const WARM_UP: usize = 120;
    const COUNTED: usize = 600;
    /// Greatest number of allocations in those updates: of lists that still grow. Were there one in each tick, it would be 600.
    const GROWTHS: usize = 5;
    let mut plain = Fleet::new(Scene::flag(N as usize), FLAGS, DEFAULT);
    let mut app = game::app_in_wind([DEFAULT]);
    // Otherwise Bevy looks for changed transforms in tasks of the pool, which it allocates in each update.
    app.insert_resource(StaticTransformOptimizations::Disabled);
    for flag in 0..FLAGS {
        game::spawn_flag(&mut app, N, Vec3::X * flag as f32, LodSet::default());
    }
    plain.advance(WARM_UP);
    (0..WARM_UP).for_each(|_| app.update());
    let world = app.world_mut();
    assert_eq!(world.resource::<ClothBatches>().batch_count(), plain.batches_mut().len());
    let mut efforts = world.query::<&ClothEffort>();
    assert!(efforts.iter(world).all(|effort| effort.settings() == plain.settings()));
    assert_eq!(allocations_of(|| plain.advance(COUNTED)), 0);
    let allocations = allocations_of(|| (0..COUNTED).for_each(|_| app.update()));
    assert!(allocations <= GROWTHS, "{allocations} allocations");
}

fn memory_grows_with_the_number_of_particles() {
    let (_list, held) = held_by(|| {
        // `black_box` keeps the compiler from removing the unused memory.
        drop(black_box(vec![0_u8; 1 << 20]));
        let mut list: Vec<u64> = black_box(Vec::with_capacity(10));
        list.reserve_exact(1000);
        list
    });
    assert_eq!(held, 8000);
    let json = memory::run().json;
    let bytes = |list: &str, key: &str| -> Vec<u64> {
        let rows = json[list].as_array().expect(list).iter();
        rows.map(|row| row[key].as_u64().expect(key)).collect()
    };
    let fabrics = bytes("fabrics", "bytes");
    assert_eq!(fabrics.len(), 4);
    assert!(fabrics.windows(2).all(|pair| pair[0] > 2 * pair[1]), "{fabrics:?}");
    // A particle takes at least a position, a velocity and a normal in each lane, and 150 to 200 bytes with
    // the state of the integrator and the constraints. The single-cloth layout also stores the fabric's
    // numbers in each lane.
    for row in json["batches"].as_array().expect("batches") {
        let n = row["n"].as_u64().expect("n");
        let lanes = row["lanes"].as_u64().expect("lanes");
        let least = n * n * lanes * 36;
        let most = if lanes == 1 { 60 } else { 8 } * least;
        let held = row["bytes"].as_u64().expect("bytes");
        assert!((least..most).contains(&held), "{row}");
    }
}
