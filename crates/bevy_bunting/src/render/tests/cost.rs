//! The cost of showing cloth.

use std::time::Instant;

use super::*;

/// Prints the cost of showing a flag of 33 × 33 particles with their mesh and with one of 65 × 65 vertices, without Bevy's upload of its mesh: `cargo test
/// --release -p bevy_bunting --features render --lib -- --ignored --nocapture cost`.
#[test]
#[ignore = "it measures"]
fn cost_of_a_visible_flag() {
    for subdivision in [ClothSubdivision::NONE, ClothSubdivision { edge: 1.0, halvings: 1 }] {
        println!("{subdivision:?}");
        print_cost(subdivision);
    }
}

fn print_cost(subdivision: ClothSubdivision) {
    const FLAGS: usize = 64;
    const FRAMES: usize = 200;
    let mut app = app(TICK);
    let shape = ClothMesh::grid(33, 33, 1.5, 1.0);
    for _ in 0..FLAGS {
        let flag = spawn(&mut app, ());
        app.world_mut().entity_mut(flag).insert((shape.clone(), subdivision));
    }
    run(&mut app, 50);
    let mut durations = [const { Vec::new() }; 3];
    for _ in 0..FRAMES {
        run(&mut app, 1);
        let world = app.world_mut();
        for mut state in world.query::<&mut ClothState>().iter_mut(world) {
            state.set_changed();
        }
        for mut surface in world.query::<&mut ClothSurface>().iter_mut(world) {
            surface.positions.iter_mut().for_each(|position| *position *= 1.01);
        }
        let began = Instant::now();
        world.run_system_cached(crate::render::bounds::bound_cloths).expect("cloths have bounds");
        let bounded = Instant::now();
        world.run_system_cached(crate::render::write::write_visible).expect("cloths have meshes");
        let written = Instant::now();
        world
            .run_system_cached(crate::render::subdivide::subdivide_cloths)
            .expect("they are drawn");
        durations[0].push(bounded - began);
        durations[1].push(written - bounded);
        durations[2].push(written.elapsed());
    }
    for (what, mut durations) in ["bounds", "mesh", "choice"].into_iter().zip(durations) {
        durations.sort();
        let each = durations[0].as_secs_f64() * 1e3 / FLAGS as f64;
        println!("{what}: at least {each:.5} ms a flag and frame");
    }
}
