//! Meshes at random, as artists might model them.

use std::{collections::BTreeMap, f32::consts::TAU};

use bunting_solver::FabricBuilder;
use glam::{DVec2, Vec2, Vec3};

use super::{garments, pieces::largest_piece};
use crate::meshes::{Random, Sheet, Triangulation, around, sphere, torus};

/// What a mesh is like.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
pub enum Family {
    /// A sheet that lies in a plane.
    Flat,
    /// A sheet that is bent, or bulges.
    Curved,
    /// A tube or a funnel.
    Tube,
    /// One or two panels of quads.
    QuadGarment,
    /// One or two panels of triangles.
    TriangleGarment,
    /// A ball, a bowl or a torus.
    Round,
}

impl Family {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Flat,
        Self::Curved,
        Self::Tube,
        Self::QuadGarment,
        Self::TriangleGarment,
        Self::Round,
    ];
}

/// A mesh of a family with some of its vertices pinned.
pub fn mesh(family: Family, random: &mut Random) -> FabricBuilder {
    let mesh = match family {
        Family::Flat => {
            let sheet = flat(random);
            placed(&sheet, random, |at| at)
        }
        Family::Curved => curved(random),
        Family::Tube => tube(random),
        Family::QuadGarment => garments::of_quads(random),
        Family::TriangleGarment => garments::of_triangles(random),
        Family::Round => round(random),
    };
    pinned(mesh, random)
}

fn triangulation(random: &mut Random) -> Triangulation {
    [Triangulation::Delaunay, Triangulation::Quads, Triangulation::Scan][random.below(3)]
}

/// A sheet of a shape at random, whose middle is the origin.
fn flat(random: &mut Random) -> Sheet {
    let [columns, rows] = [9 + random.below(22), 9 + random.below(22)];
    let size = DVec2::new(columns as f64, rows as f64) * random.within(0.02, 0.06);
    let mut sheet = Sheet::new(triangulation(random), [columns, rows], size, 1);
    let half = 0.5 * size.as_vec2();
    for at in &mut sheet.positions {
        *at += Vec3::new(-half.x, half.y, 0.0);
    }
    let (shape, part, skew) =
        (random.below(6), random.within(0.3, 0.7) as f32, random.next() as f32);
    let is_cloth = |at: Vec2| match shape {
        0 => true,
        1 => at.length() < 1.0,
        2 => at.length() > part,
        3 => at.x.abs() < 0.5 * (1.0 - at.y),
        4 => at.x < part || at.y > part,
        _ => at.x.abs() > part || at.y > -part,
    };
    let in_shape = |at: Vec3| is_cloth(Vec2::new(at.x / half.x, at.y / half.y));
    let corners = sheet.indices.chunks_exact(3);
    let kept = corners.filter(|of| {
        in_shape(of.iter().map(|&at| sheet.positions[at as usize]).sum::<Vec3>() / 3.0)
    });
    let indices = of_largest_piece(&kept.flatten().copied().collect::<Vec<u32>>());
    let leans = if skew > 0.7 { skew - 0.5 } else { 0.0 };
    let positions = sheet.positions.iter().map(|at| *at + Vec3::X * leans * at.y);
    Sheet { positions: positions.collect(), indices }
}

/// The triangles of the largest piece that hangs together along edges.
fn of_largest_piece(indices: &[u32]) -> Vec<u32> {
    let (triangles, _) = indices.as_chunks::<3>();
    let sides = |at: usize| {
        let [a, b, c] = triangles[at];
        [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
    };
    let mut beside: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for at in 0..triangles.len() {
        sides(at).into_iter().for_each(|side| beside.entry(side).or_default().push(at));
    }
    let is_kept = largest_piece(triangles.len(), |at| {
        sides(at).iter().flat_map(|side| &beside[side]).copied().collect()
    });
    let kept = triangles.iter().zip(is_kept).filter(|(_, is_kept)| *is_kept);
    kept.flat_map(|(corners, _)| *corners).collect()
}

/// The vertices of a sheet that its triangles use, at their places in space, with a texture turned by an angle at random, or without.
fn placed(sheet: &Sheet, random: &mut Random, place: impl Fn(Vec3) -> Vec3) -> FabricBuilder {
    let mut number = vec![u32::MAX; sheet.positions.len()];
    let (mut positions, mut uv) = (Vec::new(), Vec::new());
    let numbered = |at: &u32| {
        let vertex = *at as usize;
        if number[vertex] == u32::MAX {
            number[vertex] = positions.len() as u32;
            positions.push(place(sheet.positions[vertex]));
            uv.push(sheet.positions[vertex].truncate());
        }
        number[vertex]
    };
    let indices = sheet.indices.iter().map(numbered).collect();
    let builder = FabricBuilder::new(positions, indices);
    if random.next() < 0.5 {
        return builder;
    }
    let turn = Vec2::from_angle(TAU * random.next() as f32);
    builder.uv(uv.into_iter().map(|at: Vec2| turn.rotate(at)).collect())
}

fn curved(random: &mut Random) -> FabricBuilder {
    let sheet = flat(random);
    let half = sheet.positions.iter().map(|at| at.x.abs()).fold(0.0, f32::max);
    let radius = half * random.within(0.4, 3.0) as f32;
    let bulge = [0.0, random.within(-0.4, 0.4) as f32 / half][random.below(2)];
    placed(&sheet, random, |at| {
        let (sin, cos) = (at.x / radius).sin_cos();
        Vec3::new(radius * sin, at.y, radius * cos + bulge * at.y * at.y)
    })
}

fn tube(random: &mut Random) -> FabricBuilder {
    let [columns, rows] = [12 + random.below(24), 8 + random.below(20)];
    let size = DVec2::new(1.0, rows as f64 / columns as f64 * random.within(0.6, 1.6));
    let sheet = Sheet::new(triangulation(random), [columns, rows], size, 1);
    let flare = [0.0, random.within(-0.7, 1.5) as f32][random.below(2)];
    let wave = [0.0, random.within(0.0, 0.15) as f32][random.below(2)];
    let notch = [0.0, random.within(0.1, 0.3) as f32][random.below(2)];
    let height = size.y as f32;
    let middle = Vec3::new(0.5, -random.next() as f32 * height, 0.0);
    let triangles = sheet
        .indices
        .chunks_exact(3)
        .filter(|of| of.iter().all(|&at| sheet.positions[at as usize].distance(middle) > notch));
    let indices = of_largest_piece(&triangles.flatten().copied().collect::<Vec<u32>>());
    let sheet = Sheet { indices, ..sheet };
    let place = |at: Vec3| {
        let radius = (1.0 - flare * at.y / height) / TAU;
        let (sin, cos) = (TAU * at.x).sin_cos();
        let down = at.y * (1.0 + wave * (3.0 * TAU * at.x).cos());
        Vec3::new(radius * sin, down, radius * cos)
    };
    placed(&sheet, random, place).weld_distance(1e-5)
}

fn round(random: &mut Random) -> FabricBuilder {
    let [columns, rings] = [8 + random.below(20) as u32, 6 + random.below(14) as u32];
    let first = random.within(0.1, 0.5) as f32;
    let last = random.within(1.5, 3.0) as f32;
    if random.next() < 0.5 {
        around(columns, rings, sphere([first, last]))
    } else {
        torus(columns, rings, 0.3 * first)
    }
}

/// The mesh, held by its uppermost vertices, by one, two or three of any, or by those around one.
fn pinned(mesh: FabricBuilder, random: &mut Random) -> FabricBuilder {
    let positions = mesh.positions();
    let (low, high) =
        positions.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), at| {
            (low.min(*at), high.max(*at))
        });
    let size = (high - low).length();
    let any = |random: &mut Random| positions[random.below(positions.len())];
    match random.below(5) {
        0 | 1 => mesh.pin_where(move |at, _| at.y > high.y - 1e-3 * size),
        2 => {
            let middle = any(random);
            mesh.pin_where(move |at, _| at.distance(middle) < 0.12 * size)
        }
        count => {
            let places: Vec<Vec3> = (0..count - 2 + random.below(2)).map(|_| any(random)).collect();
            mesh.pin_where(move |at, _| places.contains(&at))
        }
    }
}
