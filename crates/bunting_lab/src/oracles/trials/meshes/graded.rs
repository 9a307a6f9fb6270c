//! Meshes whose triangles are much larger on one side than on the other.

use bunting_solver::{Drive, FabricBuilder};
use glam::Vec3;

use super::cloth::Cloth;
use super::materials::ISOTROPIC;
use super::square::ROUNDING;
use crate::{
    meshes::{Sheet, net},
    oracles::{Case, stretch::hung_strip},
    scenes::GRAVITY,
};

/// Number of vertices.
const COUNT: usize = 1089;
/// Radius of the bent sheets, m.
const RADIUS: f32 = 0.3;

/// δ/L of a sheet of each ratio of sizes, flat and bent about its direction of growth, hung from either side.
pub(super) fn cases() -> Vec<Case> {
    // Edges of the largest triangles of the last one are 28° of its arc.
    let kinds = [(10.0, false, 0.03), (3.0, true, 0.03), (10.0, true, 0.05)];
    let of_kind = |(ratio, is_bent, tolerance): (f64, bool, f64)| {
        let sheet = Sheet::graded(COUNT, ratio);
        let bend = |at: &Vec3| {
            let (sin, cos) = (at.y / RADIUS).sin_cos();
            if is_bent { Vec3::new(at.x, RADIUS * sin, RADIUS * cos) } else { *at }
        };
        let positions: Vec<Vec3> = sheet.positions.iter().map(bend).collect();
        let uv: Vec<_> = sheet.positions.iter().map(|at| at.truncate()).collect();
        [("fine", 0.0, 1.0), ("coarse", 1.0, 0.0)].map(|(side, held, free)| {
            let mesh = FabricBuilder::new(positions.clone(), sheet.indices.clone()).uv(uv.clone());
            let fabric = net(&mesh.pin_where(|at, _| at.x == held));
            let mut cloth = Cloth::new(fabric, ISOTROPIC, |at| at);
            let down = Vec3::X * (free - held);
            let gravity = down * GRAVITY as f32;
            cloth.drive(Drive { gravity, air_density: 0.0, ..Drive::default() });
            cloth.run(4.0);
            let sunk = (cloth.mean(|at| (at.x - free).abs() < ROUNDING).x - f64::from(free))
                * f64::from(down.x);
            let density = f64::from(ISOTROPIC.area_density);
            let shape = if is_bent { "bent mesh" } else { "mesh" };
            Case::new(
                format!("{shape} graded 1 : {ratio}, hung from its {side} side"),
                hung_strip(density, GRAVITY, 1.0, f64::from(ISOTROPIC.warp_stiffness)),
                sunk,
                tolerance,
            )
        })
    };
    kinds.into_iter().flat_map(of_kind).collect()
}
