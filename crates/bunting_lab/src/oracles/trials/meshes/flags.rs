//! Flags on meshes, beside flags on grids.

use std::sync::Arc;

use bunting_solver::{Drive, Fabric, FabricMaterial};
use glam::{DVec3, Vec2, Vec3};

use super::cloth::Cloth;
use super::limits::{REST, bound};
use super::materials::STANDARD;
use super::square::{ROUNDING, TRIANGULATIONS, square};
use crate::{meshes::Triangulation, oracles::Case};

/// How much more than the grid's a mesh's strain in wind may be.
const FLAG: f64 = 1.25;
/// Particles along each side of the grid that flags are compared with.
const GRID: usize = 33;
/// Small deflections from which flags begin, m. The mean tip of one flight of twelve seconds differs from that of others by
/// 3 mm.
const DEFLECTIONS: [f32; 3] = [1e-4, 2e-4, -1e-4];

/// Mean position of the edge that rests at x = 1 m, between whose particles it is straight, m.
fn mean_of_edge(cloth: &Cloth) -> DVec3 {
    let particles = cloth.fabric.rest_positions().iter().zip(&cloth.positions);
    let at_edge = particles.filter(|(rest, _)| rest.x > 1.0 - ROUNDING);
    let mut edge: Vec<(f32, DVec3)> = at_edge.map(|(rest, at)| (rest.y, at.as_dvec3())).collect();
    edge.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let pieces = edge.windows(2).map(|ends| {
        let [(from, a), (to, b)] = [ends[0], ends[1]];
        a.midpoint(b) * f64::from(to - from)
    });
    pieces.sum::<DVec3>() / f64::from(edge[edge.len() - 1].0 - edge[0].0)
}

/// A flag in a wind, and its surface in each tick.
struct Flag {
    cloth: Cloth,
    /// Mean position of the edge that flies, m, over the ticks so far.
    tip: Vec<DVec3>,
}

impl Flag {
    /// A flag that has flown for two seconds in a wind, m/s, from a small deflection, m.
    fn new(triangulation: Option<Triangulation>, wind: f32, deflection: f32) -> Self {
        let fabric = square(triangulation, GRID, 0.0, |at| at.x == 0.0);
        let material = FabricMaterial { damping: 0.2, ..STANDARD };
        let mut cloth = Cloth::new(fabric, material, |at| at + Vec3::Z * deflection * at.y);
        let wind = Vec3::new(wind, 0.0, 0.15 * wind);
        cloth.drive(Drive { wind, ..Drive::default() });
        cloth.run(2.0);
        Self { cloth, tip: Vec::new() }
    }

    /// Flies on for twelve seconds. Each tick's positions are passed on.
    fn fly(&mut self, mut each: impl FnMut(&[Vec3])) -> DVec3 {
        for _ in 0..720 {
            self.cloth.tick();
            self.tip.push(mean_of_edge(&self.cloth));
            each(&self.cloth.positions);
        }
        self.tip.iter().sum::<DVec3>() / self.tip.len() as f64
    }
}

/// Changes of length of a mesh's edges, relative, over several ticks.
struct EdgeStrains<'a> {
    fabric: &'a Fabric,
    all: Vec<f32>,
}

impl<'a> EdgeStrains<'a> {
    fn new(fabric: &'a Fabric) -> Self {
        Self { fabric, all: Vec::new() }
    }

    fn add(&mut self, positions: &[Vec3]) {
        let sides = self.fabric.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let length = |of: &[Vec3], [a, b]: [u32; 2]| of[a as usize].distance(of[b as usize]);
        let rest = self.fabric.rest_positions();
        let strain = |ends| length(positions, ends) / length(rest, ends) - 1.0;
        self.all.extend(sides.map(strain));
    }

    /// The mean magnitude, and the strain that one edge in a thousand exceeds.
    fn sizes(mut self) -> [f64; 2] {
        let sum: f64 = self.all.iter().map(|strain| f64::from(strain.abs())).sum();
        let (count, place) = (self.all.len(), self.all.len() * 999 / 1000);
        let (_, large, _) = self.all.select_nth_unstable_by(place, f32::total_cmp);
        [sum / count as f64, f64::from(*large)]
    }
}

/// The places of a mesh's vertices on the surface of a grid of a square metre, interpolated by cubics through the nodes
/// (Catmull and Rom 1974).
fn laid_on_grid(rest: &[Vec3], nodes: &[Vec3]) -> Vec<Vec3> {
    let last = GRID as i32 - 1;
    // Beyond the border the surface is continued straight on.
    let along_row = |column: i32, row: i32| {
        let node = |column: i32| nodes[row as usize * GRID + column as usize];
        let inside = column.clamp(0, last);
        node(inside) * 2.0 - node(2 * inside - column)
    };
    let node = |column: i32, row: i32| {
        let inside = row.clamp(0, last);
        along_row(column, inside) * 2.0 - along_row(column, 2 * inside - row)
    };
    let weights = |t: f32| {
        let (squared, cubed) = (t * t, t * t * t);
        [
            squared - 0.5 * (cubed + t),
            1.5 * cubed - 2.5 * squared + 1.0,
            2.0 * squared - 1.5 * cubed + 0.5 * t,
            0.5 * (cubed - squared),
        ]
    };
    let lay = |at: &Vec3| {
        let place = Vec2::new(at.x, -at.y) * last as f32;
        let cell = place.floor().min(Vec2::splat((last - 1) as f32));
        let across = weights(place.x - cell.x);
        let rows = (-1..).zip(weights(place.y - cell.y));
        rows.flat_map(|(down, row)| {
            (-1..).zip(across).map(move |(right, of)| (right, down, of * row))
        })
        .map(|(right, down, weight)| node(cell.x as i32 + right, cell.y as i32 + down) * weight)
        .sum()
    };
    rest.iter().map(lay).collect()
}

/// Mean strain of a flag's edges, beside that of the same edges on the surface of the grid: cloth of this material shears
/// by 2 %, which strains edges the more the closer they run to 45°. The strain that one edge in a thousand exceeds, beside
/// that of the grid's own edges, as cubics overshoot in folds. The mean position of the tip, beside those of grids that
/// began as differently.
pub(super) fn cases(wind: f32) -> Vec<Case> {
    let meshes = TRIANGULATIONS.map(|triangulation| {
        DEFLECTIONS.map(|deflection| Flag::new(Some(triangulation), wind, deflection))
    });
    let fabrics = meshes.each_ref().map(|[mesh, ..]| Arc::clone(&mesh.cloth.fabric));
    let mut on_grid = fabrics.each_ref().map(|fabric| EdgeStrains::new(fabric));
    let grid_fabric = square(None, GRID, 0.0, |_| false);
    let mut of_grid = EdgeStrains::new(&grid_fabric);
    let tips = DEFLECTIONS.map(|deflection| {
        Flag::new(None, wind, deflection).fly(|nodes| {
            for strains in &mut on_grid {
                strains.add(&laid_on_grid(strains.fabric.rest_positions(), nodes));
            }
            of_grid.add(nodes);
        })
    });
    let of_all = |tips: [DVec3; 3]| tips.iter().sum::<DVec3>() / tips.len() as f64;
    let mean_tip = of_all(tips);
    let apart = tips.iter().map(|tip| tip.distance(mean_tip)).fold(0.0, f64::max);
    let [_, grids_large] = of_grid.sizes();
    let mut cases = Vec::new();
    for ((flags, on_grid), triangulation) in meshes.into_iter().zip(on_grid).zip(TRIANGULATIONS) {
        let mut strains = EdgeStrains::new(on_grid.fabric);
        let tip = of_all(flags.map(|mut flag| flag.fly(|positions| strains.add(positions))));
        let ([mean, large], [grids_mean, _]) = (strains.sizes(), on_grid.sizes());
        let name = format!("mesh in wind of {wind} m/s, {triangulation:?}");
        cases.extend([
            bound(format!("{name}, mean strain against the grid's"), FLAG * grids_mean, mean),
            bound(format!("{name}, 99.9 % strain against the grid's"), FLAG * grids_large, large),
            bound(
                format!("{name}, tip against the grid's, m"),
                apart.max(REST[1]),
                tip.distance(mean_tip),
            ),
        ]);
    }
    cases
}
