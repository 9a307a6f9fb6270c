use std::f32::consts::TAU;

use glam::{DVec3, Vec3};

use super::{Condition, Observed, Surface};

/// Vertices along each side of the sheet.
const SIZE: u32 = 21;
/// Error of figures in single precision, %; of angles, °.
const ROUNDING: f64 = 1e-3;

/// A square metre in the plane.
fn sheet() -> (Vec<Vec3>, Surface) {
    let cell = 1.0 / (SIZE - 1) as f32;
    let vertices = (0..SIZE).flat_map(|row| (0..SIZE).map(move |column| (column, row)));
    let rest: Vec<Vec3> =
        vertices.map(|(x, y)| cell * Vec3::new(x as f32, y as f32, 0.0)).collect();
    let cells = (0..SIZE - 1).flat_map(|row| (0..SIZE - 1).map(move |column| (column, row)));
    let triangles = cells.flat_map(|(column, row)| {
        let [a, b] = [row * SIZE + column, (row + 1) * SIZE + column];
        [[a, a + 1, b + 1], [a, b + 1, b]]
    });
    let surface = Surface::new(&rest, &triangles.collect::<Vec<_>>());
    (rest, surface)
}

fn moved(rest: &[Vec3], to: impl Fn(Vec3) -> Vec3) -> Vec<Vec3> {
    rest.iter().map(|at| to(*at)).collect()
}

fn condition(surface: &Surface, positions: &[Vec3]) -> Condition {
    let mut observed = Observed::new(surface.clone());
    observed.observe(positions);
    observed.condition()
}

#[test]
fn a_turned_and_moved_surface_is_as_at_rest() {
    let (rest, surface) = sheet();
    let turn = glam::Quat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7);
    let condition = condition(&surface, &moved(&rest, |at| turn * at + Vec3::new(1.0, 2.0, 3.0)));
    assert_eq!(condition.compressed, [0.0; 2]);
    assert!(condition.roughness < ROUNDING, "{condition:?}");
}

#[test]
fn triangles_are_counted_by_their_areas() {
    let (rest, surface) = sheet();
    // A quarter of the columns lose a tenth of their width, a tenth of them a quarter.
    let narrow = |x: f32| x - 0.1 * x.clamp(0.1, 0.35) - 0.25 * x.clamp(0.5, 0.6);
    let found = condition(&surface, &moved(&rest, |at| Vec3::new(narrow(at.x), at.y, 0.0)));
    let [below, of_some] = found.compressed;
    assert!((below - 10.0).abs() < ROUNDING && (of_some - 35.0).abs() < ROUNDING, "{found:?}");
}

#[test]
fn a_zigzag_is_rough_and_a_fold_is_not() {
    let (rest, surface) = sheet();
    let cell = 1.0 / (SIZE - 1) as f32;
    let in_double =
        |positions: &[Vec3]| positions.iter().map(|at| at.as_dvec3()).collect::<Vec<DVec3>>();
    // Columns up and down by a tenth of a cell: neighbouring cells lie at 2 atan(.2) to one another, their diagonals at
    // nothing; of three pairs one is across a column.
    let zigzag =
        |at: Vec3| if ((at.x / cell).round() as u32).is_multiple_of(2) { 0.0 } else { 0.2 * cell };
    let rough = surface.roughness(&in_double(&moved(&rest, |at| at + Vec3::Z * zigzag(at))));
    let expected = 2.0 * 0.2_f64.atan().to_degrees() / 3.0_f64.sqrt();
    assert!((0.7..1.05).contains(&(rough / expected)), "{rough}°, not {expected}°");
    // A wave of twenty cells with the same greatest slope.
    let wave = |at: Vec3| 0.2 / TAU * (TAU * at.x).sin();
    let smooth = surface.roughness(&in_double(&moved(&rest, |at| at + Vec3::Z * wave(at))));
    assert!(smooth < 0.1 * rough, "{smooth}°, and {rough}°");
}

#[test]
fn a_shape_that_is_sharp_at_rest_is_not_rough() {
    let (flat, _) = sheet();
    let bent = moved(&flat, |at| Vec3::new(at.x, at.y, (at.x - 0.5).abs()));
    let (_, of_flat) = sheet();
    let triangles: Vec<[u32; 3]> =
        of_flat.triangles.iter().map(|it| it.corners.map(|at| at as u32)).collect();
    let surface = Surface::new(&bent, &triangles);
    let positions: Vec<DVec3> = bent.iter().map(|at| at.as_dvec3()).collect();
    assert_eq!(surface.roughness(&positions), 0.0);
    assert!(of_flat.roughness(&positions) > 1.0);
}
