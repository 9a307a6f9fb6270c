//! Curved meshes that wind has blown about and a jerk has pulled: in still air they must come to rest.

use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial, FrameMotion, Grid,
    LaneCount, StepLimits, StepSettings,
};
use glam::{DVec2, Vec3};

use super::run::{AT_REST, GRAVITY, advance, fastest};
use crate::meshes::{Sheet, Triangulation, around, ball_with_poles, net, sphere, torus};
use crate::product::TICK;
use crate::stability::case::HardCase;

/// Velocity of the wind in the first seconds, m/s.
const WIND: Vec3 = Vec3::new(2.0, 1.0, 5.0);
/// Time for which it blows, s.
const BLOWN: f32 = 4.0;
/// Movement of the frame in the tick after that, m.
const JERK: Vec3 = Vec3::new(0.12, 0.1, -0.12);
/// Damping in the still air that follows, 1/s.
const DAMPING: f32 = 4.0;
/// Time from then on until the speed is measured, s.
const SETTLING: f32 = 20.0;
/// Time without damping after that, s: motion that grows by a quarter each second is seen by then.
const UNDAMPED: f32 = 30.0;
/// Stretch stiffnesses of the lanes, N/m, and their area densities, kg/m².
const MATERIALS: [(f32, f32); 8] = [
    (500.0, 0.05),
    (500.0, 0.3),
    (2e3, 0.1),
    (2e3, 0.5),
    (8e3, 0.1),
    (8e3, 1.0),
    (2e4, 0.05),
    (2e4, 0.3),
];

/// Substeps beyond what the weight needs, as a storm takes.
const MANY_SUBSTEPS: u32 = 8;

/// Cases of a saddle, a wave, a sheet with a hole and trousers that hang from an edge, of a tube, a ring and a sheet of
/// long cells that hang from two vertices, of a dome, a sheet, a disk, a ball and a bowl that hang from one, and of a
/// torus that hangs from its upper ring; of trousers, the torus, the ball and the bowl with many substeps, too; of the sheet, the ball and
/// the bowl without damping at the end, too.
pub(super) fn cases() -> Vec<HardCase> {
    let meshes = [
        ("saddle", bent(33, 11, |u, v| Vec3::new(u, v, 0.6 * (u * u - v * v)))),
        ("wave", bent(29, 12, |u, v| Vec3::new(u, v, 0.05 * (6.0 * u).sin()))),
        (
            "tube",
            hung(
                around(24, 27, |down, azimuth| {
                    Vec3::new(0.3 * azimuth.cos(), -down, 0.3 * azimuth.sin())
                }),
                &[0, 12],
            ),
        ),
        (
            "ring",
            hung(
                around(27, 24, |out, azimuth| {
                    (0.2 + 0.4 * out) * Vec3::new(azimuth.cos(), azimuth.sin(), 0.0)
                }),
                &[0, 3],
            ),
        ),
        (
            "dome",
            hung(
                around(24, 16, |down, azimuth| {
                    let polar = 0.15 + 1.4 * down;
                    let outwards = Vec3::new(azimuth.cos(), 0.0, azimuth.sin());
                    0.4 * (polar.sin() * outwards + polar.cos() * Vec3::Y)
                }),
                &[0],
            ),
        ),
        (
            "disk",
            hung(
                around(48, 11, |out, azimuth| {
                    (0.02 + 0.4 * out) * Vec3::new(azimuth.cos(), 0.5 * azimuth.sin(), 0.0)
                }),
                &[528],
            ),
        ),
        ("sheet with a hole", holed(26, 21)),
        ("pair of trousers", garment()),
        ("sheet of long cells", grid(Grid::new(31, 16, 0.44, 0.5), &[0, 30])),
        ("torus", torus_held_above()),
    ];
    let settled = |substeps| move |(name, fabric)| Settled::new(name, fabric, substeps);
    let by_need = meshes.into_iter().map(settled(None));
    let with_many = [
        ("pair of trousers", garment()),
        ("torus", torus_held_above()),
        ("ball with poles", ball()),
        ("bowl", bowl()),
    ];
    let with_many = with_many.into_iter().map(settled(Some(MANY_SUBSTEPS)));
    let from_a_point = [("sheet", sheet()), ("ball with poles", ball()), ("bowl", bowl())];
    let from_a_point = from_a_point.into_iter().map(settled(None));
    let with_both_cases = from_a_point.flat_map(|mesh| [mesh.at_rest(), mesh.undamped()]);
    by_need.chain(with_many).map(|mesh| mesh.at_rest()).chain(with_both_cases).collect()
}

/// A square sheet that hangs from a corner.
fn sheet() -> Arc<Fabric> {
    grid(Grid::new(17, 17, 1.0, 1.0), &[0])
}

/// Trousers that hang from their waist.
fn garment() -> Arc<Fabric> {
    net(&trousers().pin_where(|at, _| at.y == 0.0))
}

/// A torus that hangs from its upper ring.
fn torus_held_above() -> Arc<Fabric> {
    net(&torus(25, 10, 0.06).pin_where(|at, _| at.y > 0.055))
}

/// A ball that hangs from its upper pole.
fn ball() -> Arc<Fabric> {
    net(&ball_with_poles(24, 12, 0.3).pin_where(|at, _| at.y > 0.299))
}

/// A bowl upside down that hangs from a vertex of its small hole.
fn bowl() -> Arc<Fabric> {
    hung(around(24, 8, sphere([0.2, 1.6])), &[0])
}

/// A sheet of about `columns` × `rows` vertices that hangs from its top edge, given the place of each point of the unit
/// square, whose middle is the origin.
fn bent(columns: usize, rows: usize, at: impl Fn(f32, f32) -> Vec3) -> Arc<Fabric> {
    let sheet = Sheet::new(Triangulation::Quads, [columns, rows], DVec2::ONE, 1);
    let places = sheet.positions.iter().map(|place| at(place.x - 0.5, place.y + 0.5));
    let top = (0..).zip(&sheet.positions).filter(|(_, place)| place.y > -1e-6);
    let top: Vec<u32> = top.map(|(vertex, _)| vertex).collect();
    net(&FabricBuilder::new(places.collect(), sheet.indices.clone()).pin(top))
}

/// A sheet of about `columns` × `rows` vertices and a metre with a hole of 0.6 m in its middle, which hangs from its top edge.
fn holed(columns: usize, rows: usize) -> Arc<Fabric> {
    let sheet = Sheet::new(Triangulation::Delaunay, [columns, rows], DVec2::ONE, 1);
    net(&sheet.with_hole(0.3).pin_where(|at, _| at.y == 0.0))
}

/// Trousers of a front and a back of quads of 4 cm, sewn along their sides, which bulge away from the seams.
pub(super) fn trousers() -> FabricBuilder {
    let is_cloth = |column: i32, row: i32| {
        (-6..6).contains(&column) && (row < 7 || !(-1..1).contains(&column))
    };
    let bulge = |column: i32, row: i32| {
        let is_cloth = |across, down| is_cloth(column + across, row + down);
        let is_within =
            |by: i32| (-by..by).all(|across| (-by..by).all(|down| is_cloth(across, down)));
        [0.0, 0.06, 0.08][(1..3).filter(|by| is_within(*by)).count()]
    };
    let cells = (0..25).flat_map(|row| (-6..6).map(move |column| (column, row)));
    let mut corners = Vec::new();
    for (column, row) in cells.filter(|(column, row)| is_cloth(*column, *row)) {
        for (side, order) in [(1.0, [0, 1, 2, 3]), (-1.0, [3, 2, 1, 0])] {
            let around = [(0, 0), (0, 1), (1, 1), (1, 0)];
            corners.extend(order.map(|at: usize| {
                let (column, row) = (column + around[at].0, row + around[at].1);
                Vec3::new(0.04 * column as f32, -0.04 * row as f32, side * bulge(column, row))
            }));
        }
    }
    let quads = (0..corners.len() as u32).step_by(4);
    let indices = quads.flat_map(|at| [0, 1, 2, 0, 2, 3].map(|by| at + by)).collect();
    FabricBuilder::new(corners, indices).weld_distance(1e-4)
}

/// A mesh that hangs from some of its vertices.
fn hung(mesh: FabricBuilder, from: &[u32]) -> Arc<Fabric> {
    net(&mesh.pin(from.iter().copied()))
}

/// A grid that hangs from some of its vertices.
fn grid(grid: Grid, from: &[u32]) -> Arc<Fabric> {
    let grid = FabricBuilder::grid(grid).pin(from.iter().copied());
    Arc::new(grid.build().expect("a good grid"))
}

/// A mesh in eight lanes of polyester that has been blown about and pulled, and has had time to come to rest.
struct Settled {
    name: String,
    batch: ClothBatch,
    settings: StepSettings,
}

impl Settled {
    /// With the substeps that its weight needs, or others.
    fn new(name: &str, fabric: Arc<Fabric>, substeps: Option<u32>) -> Self {
        let by_need = StepLimits::default().of_fabric(&fabric, TICK, GRAVITY);
        let settings = StepSettings { substeps: substeps.unwrap_or(by_need.substeps), ..by_need };
        let mut batch = ClothBatch::new(Arc::clone(&fabric), LaneCount::Eight);
        let still = Drive::default();
        for material in materials() {
            let lane =
                batch.insert(&ClothSnapshot::at_rest(&fabric), material).expect("a good cloth");
            batch.drive(lane, Drive { wind: WIND, ..still }).expect("a good drive");
        }
        advance(&mut batch, BLOWN, settings);
        set_damping(&mut batch, DAMPING);
        let motion = FrameMotion { translation: JERK, ..FrameMotion::NONE };
        drive(&mut batch, Drive { motion, ..still });
        batch.step(TICK, settings);
        drive(&mut batch, still);
        advance(&mut batch, SETTLING, settings);
        let with = substeps.map_or(String::new(), |count| format!(", {count} substeps"));
        Self { name: format!("{name} that was pulled{with}"), batch, settings }
    }

    /// Case of the greatest RMS speed of the lanes.
    fn at_rest(&self) -> HardCase {
        let name = format!("{}: at rest", self.name);
        HardCase::new(name, 0, "RMS speed, m/s", fastest(&self.batch), AT_REST)
    }

    /// The same after a time without damping.
    fn undamped(mut self) -> HardCase {
        set_damping(&mut self.batch, 0.0);
        advance(&mut self.batch, UNDAMPED, self.settings);
        self.name += ", without damping";
        self.at_rest()
    }
}

/// The materials of the lanes.
fn materials() -> [FabricMaterial; MATERIALS.len()] {
    MATERIALS.map(|(stiffness, area_density)| FabricMaterial {
        area_density,
        warp_stiffness: stiffness,
        weft_stiffness: stiffness,
        shear_stiffness: 0.05 * stiffness,
        ..FabricMaterial::FLAG_POLYESTER
    })
}

/// Sets the damping of all lanes, 1/s.
fn set_damping(batch: &mut ClothBatch, damping: f32) {
    for (lane, material) in materials().into_iter().enumerate() {
        let material = FabricMaterial { damping, ..material };
        batch.set_material(lane, material).expect("a good material");
    }
}

/// Drives all lanes alike.
fn drive(batch: &mut ClothBatch, drive: Drive) {
    (0..MATERIALS.len()).for_each(|lane| batch.drive(lane, drive).expect("a good drive"));
}
