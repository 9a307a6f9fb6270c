//! Error over time of the grid and of meshes, each solved by yarns and by Gauss–Seidel.
//!
//! All are the square metre of the scene `swing`, so that one reference holds for all of them: the converged grid,
//! whose surface is interpolated at the places of particles, and of the vertices that they carry. A square of triangles
//! becomes a grid; without one of its lower corners, which the swing hardly feels, it becomes a net.

use std::sync::Arc;

use bunting_solver::{
    Carried, ClothBatch, ClothSnapshot, Drive, Fabric, FabricMaterial, LaneCount, Resampled,
    StepSettings,
};
use glam::{DVec2, DVec3, Vec3};
use serde::Serialize;

use crate::{
    meshes::{Sheet, Triangulation, resampled},
    observation::COMPARED_TICKS,
    output::{
        plot::{Axes, Mark, Plot, Series},
        table::{Table, figure, figure_or_dash},
    },
    product::{TICK, fabric, material},
    reference::Reference,
    scenes::Scene,
    simulation::{Simulation, in_double},
    stats::rms_distance,
    timing::Timing,
};

/// Particles along each side.
const SIZE: usize = 33;
/// Entry of `COMPARED_TICKS` at which the error is taken: 0.4 s.
const COMPARED: usize = 1;
/// Runs of which the shortest tick counts, since anything else that runs on the machine adds to it.
const RUNS: usize = 10;
/// Substeps and passes of yarns.
const YARNS: [[u32; 2]; 6] = [[1, 2], [2, 1], [2, 2], [4, 2], [8, 2], [16, 4]];
/// Substeps of Gauss–Seidel, of one pass each.
const GAUSS_SEIDEL: [u32; 5] = [5, 10, 20, 40, 80];
/// Substeps of rapier.
#[cfg(feature = "peers")]
const RAPIER: [usize; 3] = [4, 10, 20];

/// One method with its settings on one cloth.
#[derive(Clone, Debug, Serialize)]
pub struct MeshRow {
    /// Mesh.
    pub mesh: &'static str,
    /// Number of particles.
    pub particles: usize,
    /// Method.
    pub method: &'static str,
    /// Substeps a tick.
    pub substeps: usize,
    /// Passes a substep.
    pub passes: usize,
    /// Errors and times.
    #[serde(flatten)]
    pub measured: Measured,
}

/// What is measured of a method.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Measured {
    /// Shortest time of a tick, µs.
    pub us_min: f64,
    /// Shortest time in which the mesh's vertices are carried, µs; none if they are the particles.
    pub us_carry: Option<f64>,
    /// Distance of the particles from the reference after 0.4 s, m RMS.
    pub rms_error_m: f64,
    /// The same of the mesh's vertices, which lie on chords between particles.
    pub rms_carried_m: f64,
}

/// A cloth of the scene.
struct Subject {
    mesh: &'static str,
    fabric: Arc<Fabric>,
    /// How vertices follow; none if they are the particles.
    carried: Option<Carried>,
    /// Converged positions of particles and of vertices, m.
    converged: [Vec<DVec3>; 2],
}

impl Subject {
    fn of_grid(scene: &Scene, surface: &[DVec3]) -> Self {
        let fabric = fabric(scene);
        let converged = all_interpolated(surface, fabric.rest_positions());
        Self { mesh: "grid", fabric, carried: None, converged: [converged.clone(), converged] }
    }

    fn of_sheet(mesh: &'static str, sheet: &Sheet, surface: &[DVec3]) -> Self {
        let resampled = resampled(&sheet.builder(0.0, |at| at.y == 0.0));
        let Resampled { fabric, carried, .. } = resampled.expect("a cloth");
        let places = [fabric.rest_positions(), &sheet.positions];
        let converged = places.map(|places| all_interpolated(surface, places));
        Self { mesh, fabric, carried: Some(carried), converged }
    }

    /// The grid, a square of as many vertices, which becomes a grid, and one that becomes a net as it lacks a corner.
    fn all(scene: &Scene, surface: &[DVec3]) -> [Self; 3] {
        let sheet = Sheet::new(Triangulation::Delaunay, [SIZE; 2], DVec2::ONE, 1);
        [
            Self::of_grid(scene, surface),
            Self::of_sheet("Delaunay", &sheet, surface),
            Self::of_sheet("net", &sheet.clone().without_corner(), surface),
        ]
    }

    /// The shortest times and the errors of a method.
    fn measure<S: Simulation>(&self, start: impl Fn() -> S) -> Measured {
        let (mut time, mut carrying) = (Timing::default(), Timing::default());
        let mut errors = [f64::NAN; 2];
        let [converged, converged_vertices] = &self.converged;
        for _ in 0..RUNS {
            let mut cloth = start();
            (0..COMPARED_TICKS[COMPARED]).for_each(|_| time.time(|| cloth.tick()));
            errors = [rms_distance(&in_double(cloth.positions()), converged); 2];
            if let Some(carried) = &self.carried {
                let mut vertices = Vec::new();
                carrying.time(|| vertices = carried.positions(cloth.positions()));
                errors[1] = rms_distance(&in_double(&vertices), converged_vertices);
            }
        }
        Measured {
            us_min: time.min(),
            us_carry: self.carried.is_some().then(|| carrying.min()),
            rms_error_m: errors[0],
            rms_carried_m: errors[1],
        }
    }
}

/// Every method on every mesh.
#[must_use]
pub fn rows() -> Vec<MeshRow> {
    let scene = Scene::swing(SIZE);
    let reference = Reference::of(&scene);
    let surface = &reference.observation.compared[COMPARED];
    let yarns = YARNS.map(|[substeps, passes]| {
        ("yarns", StepSettings { passes, ..StepSettings::yarns(substeps) })
    });
    let gauss_seidel = GAUSS_SEIDEL.map(|it| ("Gauss–Seidel", StepSettings::gauss_seidel(it)));
    let mut rows = Vec::new();
    for subject in Subject::all(&scene, surface) {
        let Subject { mesh, fabric, .. } = &subject;
        let row = |method, [substeps, passes]: [usize; 2], measured| MeshRow {
            mesh,
            particles: fabric.particle_count(),
            method,
            substeps,
            passes,
            measured,
        };
        for (method, settings) in yarns.into_iter().chain(gauss_seidel) {
            let measured = subject.measure(|| Cloth::new(fabric, material(&scene), settings));
            let effort = [settings.substeps, settings.passes].map(|it| it as usize);
            rows.push(row(method, effort, measured));
        }
        #[cfg(feature = "peers")]
        for substeps in RAPIER {
            use crate::peers::rapier::{Elasticity, Rapier};
            let start =
                || Rapier::of(fabric, &level(fabric), &scene, Elasticity::Constraints, substeps);
            rows.push(row("rapier 0.36", [substeps, 1], subject.measure(start)));
        }
    }
    rows
}

/// The particles of a fabric in the scene's level pose, m.
fn level(fabric: &Fabric) -> Vec<Vec3> {
    fabric.rest_positions().iter().map(|at| Vec3::new(at.x, 0.0, -at.y)).collect()
}

/// A lone cloth that begins level, without air.
struct Cloth {
    batch: ClothBatch,
    settings: StepSettings,
    positions: Vec<Vec3>,
    velocities: Vec<Vec3>,
}

impl Cloth {
    fn new(fabric: &Arc<Fabric>, material: FabricMaterial, settings: StepSettings) -> Self {
        let (positions, velocities) = (level(fabric), vec![Vec3::ZERO; fabric.particle_count()]);
        let mut batch = ClothBatch::new(Arc::clone(fabric), LaneCount::One);
        let start = ClothSnapshot::new(positions.clone(), velocities.clone());
        batch.insert(&start, material).expect("a good cloth");
        batch.drive(0, Drive { air_density: 0.0, ..Drive::default() }).expect("a good drive");
        Self { batch, settings, positions, velocities }
    }
}

impl Simulation for Cloth {
    fn tick(&mut self) {
        self.batch.step(TICK, self.settings);
        self.batch.copy_positions(0, &mut self.positions);
        self.batch.copy_velocities(0, &mut self.velocities);
    }

    fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    fn velocities(&self) -> &[Vec3] {
        &self.velocities
    }
}

/// The surface between the vertices of a grid at places of the square at rest, m.
fn all_interpolated(vertices: &[DVec3], places: &[Vec3]) -> Vec<DVec3> {
    places.iter().map(|at| interpolated(vertices, *at)).collect()
}

/// The surface between the vertices of a grid at a place of the square at rest, m: cubic along both axes (Catmull and
/// Rom 1974), since chords between vertices lie beside a curved surface by as much as good methods err.
fn interpolated(vertices: &[DVec3], rest: Vec3) -> DVec3 {
    let cells = (SIZE - 1) as f64;
    let places = [f64::from(rest.x) * cells, f64::from(-rest.y) * cells];
    let [column, row] = places.map(|at| at.floor().clamp(0.0, cells - 1.0));
    let along = |row: usize| {
        spline(column as usize, places[0] - column, |column| vertices[row * SIZE + column])
    };
    spline(row as usize, places[1] - row, along)
}

/// The cubic through `values` between numbers `at` and `at + 1`; beyond the last value the line goes straight on.
fn spline(at: usize, part: f64, values: impl Fn(usize) -> DVec3) -> DVec3 {
    let (from, to) = (values(at), values(at + 1));
    let before = if at == 0 { 2.0 * from - to } else { values(at - 1) };
    let after = if at + 2 < SIZE { values(at + 2) } else { 2.0 * to - from };
    let (start, end) = (0.5 * (to - before), 0.5 * (after - from));
    let (square, cube) = (part.powi(2), part.powi(3));
    from * (2.0 * cube - 3.0 * square + 1.0)
        + start * (cube - 2.0 * square + part)
        + to * (3.0 * square - 2.0 * cube)
        + end * (cube - square)
}

/// The rows as a table.
#[must_use]
pub fn table(rows: &[MeshRow]) -> Table {
    let cells = |row: &MeshRow| {
        vec![
            row.mesh.into(),
            row.particles.to_string(),
            row.method.into(),
            row.substeps.to_string(),
            row.passes.to_string(),
            figure(row.measured.us_min),
            figure_or_dash(row.measured.us_carry),
            figure(row.measured.rms_error_m),
            figure(row.measured.rms_carried_m),
        ]
    };
    Table {
        name: "pareto_meshes".into(),
        title: format!("swing, grid and meshes of {SIZE} × {SIZE} vertices, alone"),
        headers: vec![
            "mesh",
            "particles",
            "method",
            "substeps",
            "passes",
            "least µs/tick",
            "µs to carry the mesh",
            "RMS error m",
            "of the carried mesh",
        ],
        rows: rows.iter().map(cells).collect(),
    }
}

/// The rows as a plot, a series for each method on each mesh.
#[must_use]
pub fn plot(rows: &[MeshRow]) -> Plot {
    let of_series =
        |one: &MeshRow, other: &MeshRow| (one.mesh, one.method) == (other.mesh, other.method);
    let series = rows.chunk_by(of_series).map(|rows| Series {
        name: format!("{}, {}", rows[0].method, rows[0].mesh),
        points: rows.iter().map(|row| (row.measured.us_min, row.measured.rms_error_m)).collect(),
        mark: Mark::Line,
    });
    Plot {
        name: "pareto_meshes".into(),
        title: format!("A grid and meshes of {} vertices swing: error over time", SIZE * SIZE),
        labels: [
            "least time of one cloth's tick, µs".into(),
            "RMS position error of particles after 0.4 s, m".into(),
        ],
        axes: Axes::Logarithmic,
        series: series.collect(),
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::{SIZE, interpolated};

    #[test]
    fn a_curved_surface_is_interpolated_far_more_closely_than_by_chords() {
        let surface = |x: f64, y: f64| DVec3::new(x, (3.0 * x + 2.0 * y).sin() / 3.0, y * y);
        let at = |vertex: usize| (vertex as f64) / (SIZE - 1) as f64;
        let vertices: Vec<DVec3> =
            (0..SIZE * SIZE).map(|it| surface(at(it % SIZE), at(it / SIZE))).collect();
        for (x, y) in [(0.512, 0.487), (0.131, 0.77), (1.0, 0.4), (0.0, 0.0), (0.3, 1.0)] {
            let found = interpolated(&vertices, Vec3::new(x, -y, 0.0));
            let expected = surface(x.into(), y.into());
            assert!(found.distance(expected) < 1e-5, "{found} {expected}");
        }
    }
}
