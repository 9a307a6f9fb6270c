//! Meshes of all kinds.

use bunting_solver::{Fabric, FabricBuilder, Grid};
use glam::{Vec2, Vec3};

use crate::common::irregular;
use crate::common::trousers;

/// The ends of the sides of all triangles.
pub fn sides(fabric: &Fabric) -> impl Iterator<Item = [u32; 2]> {
    fabric.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
}

/// Strain between two vertices, given the positions of all, m.
pub fn strain(fabric: &Fabric, positions: &[Vec3], ends: [u32; 2]) -> f32 {
    let length = |of: &[Vec3]| of[ends[0] as usize].distance(of[ends[1] as usize]);
    length(positions) / length(fabric.rest_positions()) - 1.0
}

/// A sheet of a width, m, that becomes narrower downwards by a part of it.
pub fn narrowed(flat: &FabricBuilder, width: f32, by: f32) -> FabricBuilder {
    let narrow = |at: &Vec3| Vec3::new((at.x - 0.5) * width * (1.0 + by * at.y), at.y, 0.0);
    let positions = flat.positions().iter().map(narrow).collect();
    FabricBuilder::new(positions, flat.indices().to_vec())
}

/// Radius of a square metre that is rolled up until its sides meet, m.
pub const CLOSED: f32 = 1.0 / core::f32::consts::TAU;

/// A mesh of a square metre that is bent about a vertical axis, and closed where the radius is 1 m/2π: there its
/// texture has a seam.
pub fn bent(flat: &FabricBuilder, radius: f32) -> FabricBuilder {
    bent_with(flat, radius, flat.uvs().to_vec())
}

/// The same with another texture, or none.
pub fn bent_with(flat: &FabricBuilder, radius: f32, uv: Vec<Vec2>) -> FabricBuilder {
    let around = |at: &Vec3| {
        let (sin, cos) = libm::sincosf(at.x / radius);
        Vec3::new(radius * sin, at.y, radius * cos)
    };
    let positions = flat.positions().iter().map(around).collect();
    let builder = FabricBuilder::new(positions, flat.indices().to_vec());
    let builder = builder.uv(uv).weld_distance(1e-5);
    builder.pin_where(|at, _| at.y == 0.0)
}

/// The mesh of a square metre rolled up to a funnel with an upper and a lower radius, m.
pub fn funnel(flat: &FabricBuilder, [upper, lower]: [f32; 2]) -> FabricBuilder {
    let place = |at: &Vec3| {
        let (sin, cos) = libm::sincosf(at.x / CLOSED);
        let wide = upper + (upper - lower) * at.y;
        Vec3::new(wide * sin, at.y, wide * cos)
    };
    let positions = flat.positions().iter().map(place).collect();
    let builder = FabricBuilder::new(positions, flat.indices().to_vec());
    builder.weld_distance(1e-5).pin_where(|at, _| at.y == 0.0)
}

/// A flat mesh of a square metre of two pieces that share a seam halfway down; the warp of the lower one runs down.
pub fn of_two_pieces(flat: &FabricBuilder, is_pinned: fn(Vec3) -> bool) -> FabricBuilder {
    let (mut positions, mut uv) = (Vec::new(), Vec::new());
    for corners in flat.indices().as_chunks().0 {
        let corners: [Vec3; 3] = corners.map(|corner| flat.positions()[corner as usize]);
        let is_low = corners.iter().map(|at| at.y).sum::<f32>() < -1.5;
        for at in corners {
            positions.push(at);
            uv.push(if is_low { Vec2::new(3.0 + at.y, at.x) } else { Vec2::new(at.x, at.y) });
        }
    }
    let indices = (0..positions.len() as u32).collect();
    let builder = FabricBuilder::new(positions, indices).uv(uv).weld_distance(1e-6);
    builder.pin_where(|at, _| is_pinned(at))
}

/// A sheet with a slit of a millimetre from the middle of its lower edge up to its centre.
pub fn with_a_slit(flat: &FabricBuilder, is_pinned: fn(Vec3) -> bool) -> FabricBuilder {
    let count = flat.positions().len() as u32;
    let n = libm::sqrtf(count as f32) as u32;
    let middle = n / 2;
    let in_slit = |vertex: u32| vertex % n == middle && vertex / n > middle;
    let mut positions = flat.positions().to_vec();
    let mut other_side = Vec::new();
    for vertex in (0..count).filter(|&vertex| in_slit(vertex)) {
        positions[vertex as usize].x -= 5e-4;
        other_side.push(flat.positions()[vertex as usize] + Vec3::X * 5e-4);
    }
    positions.extend(other_side);
    let mut indices = flat.indices().to_vec();
    for corners in indices.as_chunks_mut::<3>().0 {
        let is_right = corners.iter().any(|vertex| vertex % n > middle);
        let opened = corners.iter_mut().filter(|vertex| is_right && in_slit(**vertex));
        opened.for_each(|vertex| *vertex = count + *vertex / n - middle - 1);
    }
    let builder = FabricBuilder::new(positions, indices);
    builder.pin_where(|at, _| is_pinned(at))
}

/// The triangles of a mesh outside a circle, hung from its top.
pub fn with_a_hole(fabric: &FabricBuilder) -> FabricBuilder {
    let at = fabric.positions();
    let is_kept = |corner: &u32| at[*corner as usize].distance(Vec3::new(0.4, -0.6, 0.0)) > 0.21;
    let triangles = fabric.indices().as_chunks::<3>().0.iter();
    let kept = triangles.filter(|corners| corners.iter().all(is_kept));
    let mut used: Vec<u32> = kept.clone().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let number = |corner: &u32| used.binary_search(corner).expect("a corner") as u32;
    let indices = kept.flatten().map(number).collect();
    let of_used = |from: &[Vec2]| used.iter().map(|&at| from[at as usize]).collect();
    let builder = FabricBuilder::new(used.iter().map(|&it| at[it as usize]).collect(), indices);
    builder.uv(of_used(fabric.uvs())).pin_where(|at, _| at.y == 0.0)
}

/// A sheet drawn out to a disk, hung from two vertices of its rim.
pub fn disk(flat: &FabricBuilder) -> FabricBuilder {
    let round = |at: &Vec3| {
        let (x, y) = (2.0 * at.x - 1.0, 2.0 * at.y + 1.0);
        let wide = |other: f32| libm::sqrtf(1.0 - 0.5 * other * other);
        Vec3::new(x * wide(y), y * wide(x), 0.0) * 0.56
    };
    let positions: Vec<Vec3> = flat.positions().iter().map(round).collect();
    let is_at_rim = |at: &Vec3| at.length() > 0.559 && at.y > 0.0;
    let rim: Vec<u32> =
        (0..).zip(&positions).filter(|(_, at)| is_at_rim(at)).map(|(it, _)| it).collect();
    let builder = FabricBuilder::new(positions, flat.indices().to_vec());
    builder.pin([rim[1], rim[rim.len() / 2]])
}

/// A round part of a ball of 0.7 m, hung from its upper rim.
pub fn cap(flat: &FabricBuilder) -> FabricBuilder {
    let disk = disk(flat);
    let on_ball = |at: &Vec3| {
        let (out, up) = libm::sincosf(at.length() / 0.7);
        (at.normalize_or_zero() * out + Vec3::Z * up) * 0.7
    };
    let positions = disk.positions().iter().map(on_ball).collect();
    let builder = FabricBuilder::new(positions, disk.indices().to_vec());
    builder.pin_where(|at, _| at.y > 0.42)
}

/// One row of quads, hung from a corner.
pub fn ribbon() -> FabricBuilder {
    let place = |at: u32| Vec3::new((at % 40) as f32 / 39.0, -0.03 * (at / 40) as f32, 0.0);
    let quad = |at: u32| [at, at + 40, at + 1, at + 1, at + 40, at + 41];
    let builder =
        FabricBuilder::new((0..80).map(place).collect(), (0..39).flat_map(quad).collect());
    builder.pin([0])
}

/// A mesh of each kind, by name.
pub fn of_all_kinds() -> [(&'static str, FabricBuilder); 9] {
    let flat = irregular(21, 0.0);
    let holed = with_a_hole(&flat);
    [
        ("hole", bent(&holed, 0.3)),
        ("closed with a hole", bent(&holed, CLOSED)),
        ("closed", bent(&flat, CLOSED)),
        ("disk", bent(&disk(&flat), 0.4)),
        ("cap", cap(&flat)),
        ("pieces", of_two_pieces(&flat, |at| at.y == 0.0)),
        ("slit", with_a_slit(&flat, |at| at.y == 0.0)),
        ("trousers", trousers()),
        ("funnel", funnel(&flat, [CLOSED, 2.0 * CLOSED])),
    ]
}

/// A mesh without its pins.
pub fn unpinned(mesh: &FabricBuilder) -> FabricBuilder {
    let free = FabricBuilder::new(mesh.positions().to_vec(), mesh.indices().to_vec());
    free.uv(mesh.uvs().to_vec()).weld_distance(1e-5)
}

/// A sheet of a metre whose columns are ten times as wide at one end as at the other, bent about its rows to a radius, held by its
/// narrow or its wide end.
pub fn graded(radius: Option<f32>, is_held: fn(f32) -> bool) -> FabricBuilder {
    const COLUMNS: u32 = 21;
    let even = FabricBuilder::grid(Grid::new(COLUMNS, 17, 1.0, 1.0));
    let place = |at: &Vec3| {
        let x = (libm::powf(10.0, at.x) - 1.0) / 9.0;
        match radius {
            Some(radius) => {
                let (sin, cos) = libm::sincosf(at.y / radius);
                Vec3::new(x, radius * sin, radius * cos)
            }
            None => Vec3::new(x, at.y, 0.0),
        }
    };
    let positions = even.positions().iter().map(place).collect();
    let mesh = FabricBuilder::new(positions, even.indices().to_vec());
    mesh.pin_where(|at, _| is_held(at.x))
}
