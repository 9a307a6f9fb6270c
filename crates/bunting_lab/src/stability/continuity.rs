//! The same cloth of other triangles: it should hang where it hung.

use bunting_solver::{ClothSnapshot, Drive, FabricMaterial, Resampled, Resolution};
use glam::Vec3;

use super::{case::HardCase, lone::Lone};
use crate::{
    meshes::{
        changes::{Change, Changed},
        clothes::{FABRIC, Garment},
    },
    stats::worse,
};

/// Time for which the cloths hang, s.
const HANGING: f64 = 10.0;
/// Damping in that time, 1/s.
const DAMPING: f32 = 2.0;
/// Height of the waves with which they begin, m, as a flat cloth does not leave its plane by itself.
const RIPPLE: f32 = 1e-3;
/// Waves along x and y, 1/m: functions of the place, so that all begin alike.
const WAVES: Vec3 = Vec3::new(5.0, 3.0, 0.0);
/// Greatest change as a part of the size.
const LIMIT: f64 = 0.01;
/// Least distance of the tip's vertices from pins, over the greatest: where folds lie along a hem is not given by the cloth, as
/// waves twice as high show, so that of a skirt it is the whole hem.
const FARTHEST: f32 = 0.99;

/// Cases of a sheet, a disk, a skirt and a cape, each changed in several ways, and, for comparison, begun otherwise.
pub fn cases(_quick: bool) -> Vec<HardCase> {
    let [mut rectangle, disk, _, skirt, _, _, cape, _] = Garment::all();
    let is_corner = |at: &Vec3| at.y == 0.0 && (at.x == 0.0 || at.x == 1.0);
    rectangle.is_held = rectangle.positions.iter().map(is_corner).collect();
    [rectangle, disk, skirt, cape].iter().flat_map(of_garment).collect()
}

fn of_garment(garment: &Garment) -> Vec<HardCase> {
    let before = hung(garment, RIPPLE);
    let (tip, size) = (tip(garment), size(garment));
    let compare = |name: &str, now: &[Vec3]| {
        let name = format!("{}, {name}", garment.name);
        let sunk = (lowest(now) - lowest(&before)).abs() / size;
        let [then, there] = [&before[..], now].map(|positions| middle(positions, &tip));
        let moved = f64::from(there.distance(then)) / size;
        [
            HardCase::new(
                format!("{name}: sag"),
                0,
                "change of the lowest place, of the size",
                sunk,
                LIMIT,
            ),
            HardCase::new(
                format!("{name}: tip"),
                0,
                "way of the mean of what is farthest from pins, of the size",
                moved,
                LIMIT,
            ),
        ]
    };
    let mut cases = Vec::from(compare("waves twice as high", &hung(garment, 2.0 * RIPPLE)));
    for (change, name) in Change::ALL {
        let Changed { garment: changed, vertices } = change.of(garment);
        let places = hung(&changed, RIPPLE);
        let now: Vec<Vec3> = vertices.iter().map(|&vertex| places[vertex as usize]).collect();
        cases.extend(compare(name, &now));
    }
    cases
}

/// Positions of the vertices of a garment that has hung in still air, in cells of the default size, m.
fn hung(garment: &Garment, ripple: f32) -> Vec<Vec3> {
    let resampled = garment.builder().resampled(Resolution::Auto);
    let Resampled { fabric, carried, .. } = resampled.expect("a good mesh");
    let mut start = ClothSnapshot::at_rest(&fabric);
    for (particle, at) in start.positions.iter_mut().enumerate() {
        if !fabric.is_pinned(particle) {
            at.z += ripple * libm::sinf(WAVES.dot(*at));
        }
    }
    let material = FabricMaterial { damping: DAMPING, ..FABRIC };
    let mut cloth = Lone::new(&fabric, &start, material, Drive::default());
    cloth.run(HANGING);
    carried.positions(&cloth.positions)
}

/// The vertices that are farthest from those that are held.
fn tip(garment: &Garment) -> Vec<usize> {
    let with_pins = || garment.positions.iter().zip(&garment.is_held);
    let held: Vec<Vec3> = with_pins().filter(|(_, is_held)| **is_held).map(|(at, _)| *at).collect();
    let away = |at: &Vec3| held.iter().map(|pin| pin.distance(*at)).fold(f32::INFINITY, f32::min);
    let away: Vec<f32> = garment.positions.iter().map(away).collect();
    let farthest = away.iter().copied().fold(0.0, f32::max);
    (0..away.len()).filter(|vertex| away[*vertex] >= FARTHEST * farthest).collect()
}

/// Mean position of vertices, m.
fn middle(positions: &[Vec3], vertices: &[usize]) -> Vec3 {
    vertices.iter().map(|at| positions[*at]).sum::<Vec3>() / vertices.len() as f32
}

/// The longest side of the box around a garment at rest, m.
fn size(garment: &Garment) -> f64 {
    let low = garment.positions.iter().copied().reduce(Vec3::min);
    let high = garment.positions.iter().copied().reduce(Vec3::max);
    f64::from((high.expect("vertices") - low.expect("vertices")).max_element())
}

/// Height of the lowest place, m; no number if one is none.
fn lowest(positions: &[Vec3]) -> f64 {
    -positions.iter().map(|at| -f64::from(at.y)).fold(f64::NEG_INFINITY, worse)
}
