//! A triangular sail on a mast, sheeted by its clew, in a wind: of a cloth as stiff as sails are.

use std::sync::Arc;

use bunting_solver::{
    ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, PinGroups, StepLimits,
};
use glam::{Vec2, Vec3};

use crate::{
    meshes::net,
    product::TICK,
    scenes::ticks,
    stability::{case::HardCase, lone::Lone},
    stats::{percentile, worse},
};

/// Cells along each side.
const CELLS: u32 = 32;
/// Length of luff and foot, m.
const SIZE: f32 = 3.0;
/// Wind, m/s.
const WIND: Vec3 = Vec3::new(0.3, 0.0, 11.0);
/// Time until the sail is full, s, and time in which its force is averaged.
const FULL: [f64; 2] = [5.0, 1.0];
/// Factor by which figures may exceed the converged ones.
const FACTOR: f64 = 1.15;
/// Stiffness of warp and weft, N/m, and what sails have with 32 substeps of 16 passes: the strain that one link in a hundred
/// exceeds, %, the depth of the belly, m, and the force on the clew, N.
const SAILS: [(f32, [f64; 3]); 2] = [(2e3, [22.1, 0.922, 228.0]), (1e5, [2.71, 0.331, 986.0])];

pub(super) fn cases() -> impl Iterator<Item = HardCase> {
    SAILS.into_iter().flat_map(|(stiffness, converged)| {
        let figures = sail(stiffness, StepLimits::default());
        let names = [
            ("strain", "99 % of warp and weft, %"),
            ("belly", "depth, m"),
            ("force", "on the clew, N"),
        ];
        let rows = names.into_iter().zip(figures).zip(converged);
        let rows = rows.map(move |(((name, figure), worst), right)| {
            let name = format!("sail of {stiffness:.0e} N/m: {name}");
            HardCase::new(name, 0, figure, worst, FACTOR * right)
        });
        rows.collect::<Vec<_>>()
    })
}

/// Strain, belly and force of a sail.
fn sail(stiffness: f32, limits: StepLimits) -> [f64; 3] {
    let (fabric, clew) = cut();
    let material = FabricMaterial {
        area_density: 0.25,
        warp_stiffness: stiffness,
        weft_stiffness: stiffness,
        shear_stiffness: 0.2 * stiffness,
        bend_stiffness: 1e-3,
        damping: 1.0,
        ..FabricMaterial::FLAG_POLYESTER
    };
    let drive = Drive { wind: WIND, ..Drive::default() };
    let start = ClothSnapshot::at_rest(&fabric);
    let mut sail = Lone::new(&fabric, &start, material, drive).within(limits);
    let groups = Arc::new(PinGroups::new(&fabric, &[Vec::new(), vec![clew]]));
    let pivots = || vec![[Vec3::ZERO; 2]; 2];
    sail.batch.report_pins(0, Some((&groups, pivots()))).expect("a lane");
    sail.run(FULL[0]);
    let mut impulse = Vec3::ZERO;
    for _ in 0..ticks(FULL[1]) {
        sail.tick();
        impulse += sail.batch.pin_reactions(0)[1].impulse;
    }
    let force = f64::from(impulse.length() / (ticks(FULL[1]) as f32 * TICK));
    let mut strains: Vec<f64> = fabric
        .links()
        .iter()
        .map(|link| {
            let [from, to] = link.particles.map(|at| sail.positions[at as usize]);
            f64::from(from.distance(to) / link.rest_length) - 1.0
        })
        .collect();
    strains.sort_by(f64::total_cmp);
    let belly = sail.positions.iter().map(|at| f64::from(at.z)).fold(0.0, worse);
    [100.0 * percentile(&strains, 0.99), belly, force]
}

/// The sail, held by its luff and its clew, with the particle of the latter. The tack is the origin.
fn cut() -> (Arc<Fabric>, u32) {
    let row = |up: u32| (0..up).map(|row| CELLS + 1 - row).sum::<u32>();
    let cell = SIZE / CELLS as f32;
    let vertices = (0..=CELLS).flat_map(|up| (0..=CELLS - up).map(move |along| (along, up)));
    let positions: Vec<Vec3> =
        vertices.map(|(along, up)| cell * Vec3::new(along as f32, up as f32, 0.0)).collect();
    let mut indices = Vec::new();
    for up in 0..CELLS {
        for along in 0..CELLS - up {
            let (here, above) = (row(up) + along, row(up + 1) + along);
            indices.extend([here, here + 1, above]);
            if along + 1 < CELLS - up {
                indices.extend([here + 1, above + 1, above]);
            }
        }
    }
    let uv = positions.iter().map(|at| Vec2::new(at.x, -at.y)).collect();
    let held = (0..=CELLS).map(row).chain([CELLS]);
    let fabric = net(&FabricBuilder::new(positions, indices).uv(uv).pin(held));
    let clew = fabric.particle_of_vertex()[CELLS as usize];
    (fabric, clew)
}
