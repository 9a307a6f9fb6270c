//! Clothes of about a thousand vertices as artists model them, each with its texture and the vertices that hold it.

use std::f32::consts::{PI, TAU};

use bunting_solver::{FabricBuilder, FabricMaterial};
use glam::{DVec2, Vec2, Vec3};

use super::{CANDIDATES, Random, Sheet, Triangulation, ball_with_poles, delaunay, farthest};

/// Fabric of the garments.
pub(crate) const FABRIC: FabricMaterial = FabricMaterial {
    area_density: 0.2,
    warp_stiffness: 1e4,
    weft_stiffness: 1e4,
    shear_stiffness: 200.0,
    bend_stiffness: 2e-5,
    ..FabricMaterial::FLAG_POLYESTER
};
/// Radii of the waist and the hem of the skirts, m, and their length along the cloth.
const SKIRT: [f32; 3] = [0.13, 0.35, 0.6];
/// Vertices around the skirts, and along them.
const SKIRT_CELLS: [usize; 2] = [35, 30];
/// Widths of the cape at its top and at its hem, m, and its height.
const CAPE: [f32; 3] = [0.4, 0.9, 1.0];
/// Radius of the hole in the sheet that has one, m.
const HOLE: f32 = 0.2;
/// Radius of the ball, m.
const BALL: f32 = 0.3;
/// Size of a cell of the shirt, m.
const SHIRT_CELL: f32 = 0.035;
/// Distance below which vertices of a seam are one particle, m.
const SEAM: f32 = 1e-4;

/// A mesh with its texture.
#[derive(Clone, Debug)]
pub(crate) struct Garment {
    /// Name.
    pub name: &'static str,
    /// Positions of the vertices at rest, m.
    pub positions: Vec<Vec3>,
    /// Texture coordinates, m.
    pub uv: Vec<Vec2>,
    /// Three vertices a triangle.
    pub indices: Vec<u32>,
    /// Whether each vertex is held.
    pub is_held: Vec<bool>,
}

impl Garment {
    fn new(
        name: &'static str,
        positions: Vec<Vec3>,
        uv: Vec<Vec2>,
        indices: Vec<u32>,
        is_held: impl Fn(Vec3) -> bool,
    ) -> Self {
        let is_held = positions.iter().map(|at| is_held(*at)).collect();
        Self { name, positions, uv, indices, is_held }
    }

    /// All of them.
    pub fn all() -> [Self; 8] {
        [
            irregular_rectangle(),
            disk(0.5, 1000),
            sheet_with_hole(),
            irregular_skirt(),
            skirt_of_quads(),
            shirt(),
            tapered_cape(),
            closed_ball(),
        ]
    }

    /// The garment as a cloth that hangs from what holds it.
    pub fn builder(&self) -> FabricBuilder {
        let held = (0..).zip(&self.is_held).filter(|(_, is_held)| **is_held);
        FabricBuilder::new(self.positions.clone(), self.indices.clone())
            .uv(self.uv.clone())
            .weld_distance(SEAM)
            .pin(held.map(|(vertex, _)| vertex))
    }
}

/// The texture of a sheet in the plane.
fn flat(positions: &[Vec3]) -> Vec<Vec2> {
    positions.iter().map(|at| Vec2::new(at.x, -at.y)).collect()
}

fn irregular_rectangle() -> Garment {
    let Sheet { positions, indices } = Sheet::new(Triangulation::Delaunay, [32, 32], DVec2::ONE, 1);
    let uv = flat(&positions);
    Garment::new("irregular rectangle", positions, uv, indices, |at| at.y == 0.0)
}

/// A disk of Delaunay triangles about the origin of a radius, m, with about `count` vertices, held by a sixth of its border.
pub(crate) fn disk(radius: f32, count: usize) -> Garment {
    let mut random = Random::of_seed(5);
    // Triangles are about equilateral.
    let spacing = (2.0 * std::f64::consts::PI / (3.0_f64.sqrt() * count as f64)).sqrt();
    let around = (std::f64::consts::TAU / spacing).round() as usize;
    let border = (0..around).map(|at| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * at as f64 / around as f64);
        DVec2::new(sin, cos)
    });
    let mut points: Vec<DVec2> = border.collect();
    while points.len() < count {
        let candidates = (0..2 * CANDIDATES).map(|_| 2.0 * random.place() - 1.0);
        let inside = candidates.filter(|at| at.length() < 1.0 - 0.5 * spacing);
        points.extend(farthest(inside, &points, |_| 1.0));
    }
    // The triangulation wants coordinates of this order, and no four points on one circle.
    let scaled: Vec<DVec2> = points.iter().map(|at| *at * 30.0 + 1e-5 * random.place()).collect();
    let indices = delaunay::triangulate(&scaled).into_iter().flatten().map(|at| at as u32);
    let positions: Vec<Vec3> = points.iter().map(|at| radius * at.as_vec2().extend(0.0)).collect();
    let uv = flat(&positions);
    let top = radius * (PI / 6.0).cos() - 1e-4;
    Garment::new("disk", positions, uv, indices.collect(), move |at| {
        at.y > top && at.length() > radius - 1e-4
    })
}

fn sheet_with_hole() -> Garment {
    let sheet = Sheet::new(Triangulation::Delaunay, [34, 34], DVec2::ONE, 1);
    let mesh = sheet.with_hole(HOLE);
    let positions = mesh.positions().to_vec();
    let uv = flat(&positions);
    let indices = mesh.indices().to_vec();
    Garment::new("sheet with a hole", positions, uv, indices, |at| at.y == 0.0)
}

/// A sheet of 1 × 1 rolled up to the side of a cone that is cut off, with its texture.
fn skirt(name: &'static str, sheet: Sheet) -> Garment {
    let [waist, hem, length] = SKIRT;
    let drop = (length.powi(2) - (hem - waist).powi(2)).sqrt();
    let place = |at: &Vec3| {
        let radius = waist - (hem - waist) * at.y;
        let (sin, cos) = libm::sincosf(TAU * at.x);
        Vec3::new(radius * sin, drop * at.y, radius * cos)
    };
    // A rectangle, as artists unwrap skirts: the warp runs around, the weft down.
    let unrolled = |at: &Vec3| Vec2::new(0.5 * TAU * (waist + hem) * at.x, -length * at.y);
    let positions = sheet.positions.iter().map(place).collect();
    let uv = sheet.positions.iter().map(unrolled).collect();
    Garment::new(name, positions, uv, sheet.indices, |at| at.y == 0.0)
}

fn irregular_skirt() -> Garment {
    skirt("irregular skirt", Sheet::new(Triangulation::Delaunay, SKIRT_CELLS, DVec2::ONE, 1))
}

fn skirt_of_quads() -> Garment {
    let [columns, rows] = SKIRT_CELLS.map(|count| count as u32);
    let vertices = (0..rows).flat_map(|row| (0..=columns).map(move |column| (column, row)));
    let place = |(column, row): (u32, u32)| {
        Vec3::new(column as f32 / columns as f32, -(row as f32) / (rows - 1) as f32, 0.0)
    };
    let cells = (0..rows - 1).flat_map(|row| (0..columns).map(move |column| (column, row)));
    let indices = cells.flat_map(|(column, row)| {
        let [a, b] = [row, row + 1].map(|row| row * (columns + 1) + column);
        [a, b, a + 1, a + 1, b, b + 1]
    });
    let sheet = Sheet { positions: vertices.map(place).collect(), indices: indices.collect() };
    skirt("skirt of quads", sheet)
}

fn tapered_cape() -> Garment {
    let [top, hem, height] = CAPE;
    let size = DVec2::new(1.0, height.into());
    let mut sheet = Sheet::new(Triangulation::Quads, [26, 38], size, 1);
    for at in &mut sheet.positions {
        at.x = (at.x - 0.5) * (top - (hem - top) * at.y / height);
    }
    let uv = flat(&sheet.positions);
    Garment::new("tapered cape", sheet.positions, uv, sheet.indices, |at| at.y == 0.0)
}

/// A front and a back of quads with sleeves, sewn along shoulders and sides, which bulge away from the seams; held at the
/// shoulders.
fn shirt() -> Garment {
    const BODY: [i32; 2] = [8, 22];
    const SLEEVES: [i32; 2] = [15, 6];
    const NECK: i32 = 3;
    let is_cloth = |column: i32, row: i32| {
        let from_middle = if column < 0 { -column - 1 } else { column };
        (0..BODY[1]).contains(&row)
            && (from_middle < BODY[0] || from_middle < SLEEVES[0] && row < SLEEVES[1])
    };
    // Beyond an open border the cloth goes on as far as its bulge is concerned.
    let goes_on = |column: i32, row: i32| {
        let is_neck = row < 0 && (-NECK..NECK).contains(&column);
        let is_cuff =
            !(-SLEEVES[0]..SLEEVES[0]).contains(&column) && (0..SLEEVES[1]).contains(&row);
        let is_hem = row >= BODY[1] && (-BODY[0]..BODY[0]).contains(&column);
        is_cloth(column, row) || is_neck || is_cuff || is_hem
    };
    let bulge = |column: i32, row: i32| {
        let is_within = |by: i32| {
            (-by..by).all(|across| (-by..by).all(|down| goes_on(column + across, row + down)))
        };
        [0.0, 1.5, 2.2, 2.5][(1..4).take_while(|by| is_within(*by)).count()]
    };
    let cells = (0..BODY[1]).flat_map(|row| (-SLEEVES[0]..SLEEVES[0]).map(move |at| (at, row)));
    let (mut positions, mut uv) = (Vec::new(), Vec::new());
    for (column, row) in cells.filter(|(column, row)| is_cloth(*column, *row)) {
        for side in [1.0, -1.0] {
            let around = [(0, 0), (0, 1), (1, 1), (1, 0)];
            let order: [usize; 4] = if side > 0.0 { [0, 1, 2, 3] } else { [3, 2, 1, 0] };
            for (across, down) in order.map(|at| around[at]) {
                let (column, row) = (column + across, row + down);
                let at = Vec2::new(column as f32, row as f32);
                positions.push(SHIRT_CELL * Vec3::new(at.x, -at.y, side * bulge(column, row)));
                uv.push(SHIRT_CELL * Vec2::new(side * at.x, at.y));
            }
        }
    }
    let quads = (0..positions.len() as u32).step_by(4);
    let indices = quads.flat_map(|at| [0, 1, 2, 0, 2, 3].map(|by| at + by)).collect();
    let reach = (BODY[0] as f32 + 0.5) * SHIRT_CELL;
    Garment::new("shirt", positions, uv, indices, move |at| at.y == 0.0 && at.x.abs() < reach)
}

/// A ball of quads that hangs from what is around its upper pole. Its texture is in metres along circles of latitude and
/// along meridians.
fn closed_ball() -> Garment {
    const COLUMNS: u32 = 40;
    const RINGS: u32 = 24;
    let mesh = ball_with_poles(COLUMNS, RINGS, BALL);
    let (mut positions, mut uv) = (Vec::new(), Vec::new());
    for corners in mesh.indices().as_chunks::<3>().0 {
        let corners = corners.map(|at| mesh.positions()[at as usize]);
        let middle = corners.iter().sum::<Vec3>();
        for at in corners {
            // Azimuths are counted from the middle of the triangle, so that no triangle goes around the ball.
            let place = middle.with_y(0.0).angle_between(at.with_y(0.0));
            let turn = middle.cross(at).y.signum();
            let azimuth = if at.with_y(0.0).length() > 1e-3 * BALL { turn * place } else { 0.0 };
            positions.push(at);
            uv.push(BALL * Vec2::new(azimuth, libm::acosf((at.y / BALL).clamp(-1.0, 1.0))));
        }
    }
    let indices = (0..positions.len() as u32).collect();
    Garment::new("closed ball", positions, uv, indices, |at| at.y > 0.97 * BALL)
}
