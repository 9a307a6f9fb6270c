//! The time that the drawn surface of a flag takes: 33 × 33 particles, 65 × 65 vertices, as a grid and as a mesh.
//!
//! ```sh
//! cargo run --release -p bunting_lab --example subdivision
//! ```

use std::time::{Duration, Instant};

use bunting_solver::{FabricBuilder, Grid, Subdivision, SubdivisionBuffers};

const RUNS: usize = 2000;

fn main() {
    let grid = Grid::new(33, 33, 2.0, 1.0);
    let mesh = FabricBuilder::grid(grid);
    let (rest, indices) = (mesh.positions(), mesh.indices());
    let places: Vec<u32> = (0..).take(rest.len()).collect();
    for name in ["grid", "mesh"] {
        let began = Instant::now();
        let subdivision = match name {
            "grid" => Subdivision::of_grid(&grid, 1),
            _ => Subdivision::of_mesh(rest, &places, indices, 1),
        };
        let built = began.elapsed();
        let mut positions = rest.to_vec();
        for at in &mut positions {
            at.z = (7.0 * at.x).sin() * (5.0 * at.y).cos();
        }
        let count = subdivision.attributes().rows().len();
        let (mut drawn, mut normals) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
        let mut buffers = SubdivisionBuffers::default();
        let mut least = Duration::MAX;
        for _ in 0..RUNS {
            let began = Instant::now();
            subdivision.evaluate(&positions, &mut buffers, &mut drawn, &mut normals);
            least = least.min(began.elapsed());
        }
        println!("{name}: {count} vertices in {least:?}, built in {built:?}");
    }
}
