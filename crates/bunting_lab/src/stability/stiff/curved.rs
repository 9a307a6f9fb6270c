//! Tubes, napkins and sheets in frames, of ordinary stiffness.

use std::sync::Arc;

use bunting_solver::{Drive, Fabric, FabricBuilder, FabricMaterial};
use glam::{DVec2, Vec3};

use super::rests::rests;
use crate::{
    flight::almost_at_rest,
    meshes::{Sheet, Triangulation, around, clothes::disk, net},
    stability::{case::HardCase, lone::Lone},
};

/// Radius and length of the tube, m, and its vertices around and along it.
const TUBE: ([f32; 2], u32) = ([0.03, 0.2], 32);
/// Bending stiffnesses of the tube, N·m: of denim and of felt.
const BENDING: [f32; 2] = [4e-5, 1e-3];
/// Radius of the napkin and of its pedestal, m, and its vertices.
const NAPKIN: ([f32; 2], usize) = ([0.075, 0.02], 393);
/// Length of a frame's sides over those of the sheet in it.
const FRAME: f32 = 1.01;
/// Vertices along each side of that sheet.
const SHEET: usize = 24;
/// Damping, 1/s, and the time after which all of them rest, s.
const DAMPING: f32 = 1.0;
const SETTLED: f64 = 10.0;

pub(super) fn cases() -> impl Iterator<Item = HardCase> {
    let tubes = BENDING.map(|bending| {
        let material = FabricMaterial { bend_stiffness: bending, ..FabricMaterial::FLAG_POLYESTER };
        hung(format!("level tube of {bending} N·m, held by a rim"), &tube(), material)
    });
    let of_napkin = [("cotton", FabricMaterial::COTTON), ("silk", FabricMaterial::SILK)];
    let napkins = of_napkin.map(|(name, material)| {
        hung(format!("napkin of {name} on a pedestal"), &napkin(), material)
    });
    tubes.into_iter().chain(napkins).chain([framed()])
}

/// Case of a cloth that hangs from its pins.
fn hung(name: String, fabric: &Arc<Fabric>, material: FabricMaterial) -> HardCase {
    let material = FabricMaterial { damping: DAMPING, ..material };
    let mut cloth = Lone::new(fabric, &almost_at_rest(fabric), material, Drive::default());
    rests(name, 0, cloth.late_speed(SETTLED))
}

/// A tube with a level axis, held by one rim.
fn tube() -> Arc<Fabric> {
    let ([radius, length], count) = TUBE;
    let mesh = around(count, count, |along, azimuth| {
        let (sin, cos) = libm::sincosf(azimuth);
        Vec3::new(length * along, radius * cos, radius * sin)
    });
    net(&mesh.pin_where(|at, _| at.x < 1e-6))
}

/// A round napkin, level, whose middle lies on a pedestal.
fn napkin() -> Arc<Fabric> {
    let ([radius, pedestal], count) = NAPKIN;
    let disk = disk(radius, count);
    let level = |at: &Vec3| Vec3::new(at.x, 0.0, -at.y);
    let positions = disk.positions.iter().map(level).collect();
    let mesh = FabricBuilder::new(positions, disk.indices).uv(disk.uv);
    net(&mesh.pin_where(|at, _| at.length() < pedestal))
}

/// An irregular sheet in a frame that is a little too large.
fn framed() -> HardCase {
    let sheet = Sheet::new(Triangulation::Delaunay, [SHEET; 2], DVec2::ONE, 1);
    let is_border =
        |at: Vec3| [at.x, -at.y].into_iter().any(|place| !(1e-6..1.0 - 1e-6).contains(&place));
    let fabric = sheet.fabric(0.0, is_border);
    let mut start = almost_at_rest(&fabric);
    start.positions.iter_mut().for_each(|at| *at *= FRAME);
    let material = FabricMaterial { damping: DAMPING, ..FabricMaterial::FLAG_POLYESTER };
    let mut cloth = Lone::new(&fabric, &start, material, Drive::default());
    rests("irregular sheet in a frame 1 % too large", 0, cloth.late_speed(SETTLED))
}
