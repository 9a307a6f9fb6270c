//! Charts of meshes that are no rectangles but map onto one: tapered sheets, capes and pennants by their four corners,
//! and funnels by their two rims.
//!
//! Two functions are found whose gradients are the smallest: one has fixed values on two opposite sides of the mesh, the
//! other on the other two (around a funnel it grows by one period). Each has its gradient along the sides on which it is
//! free, so that lines of the one cross lines of the other, and the sides, at right angles. Where the map is conformal, as
//! of funnels, that holds everywhere. A function of each coordinate alone then spaces rows and columns evenly in the mean,
//! which keeps the angles.

mod border;
mod regular;

use glam::{DMat4, DVec2, DVec3, DVec4, Vec2, Vec3};

use self::border::{Sides, sides};
use super::chart::{Chart, border_length};
use super::gradient_fit::GradientFit;
use super::warps::warps_of_rows;
use crate::fabric::mesh::{RestMesh, Surface};

pub(super) use self::regular::is_regular;

/// Particles and places of a mesh that is cut open.
struct Cut {
    /// The particle at each place.
    particles: Vec<u32>,
    /// Three places for each triangle.
    triangles: Vec<[u32; 3]>,
    /// How far each place lies beyond its particle, in periods.
    turns: Vec<f64>,
}

impl Chart {
    /// The chart of a mesh that maps onto a rectangle, or onto a strip that closes; none of one that has other corners
    /// or rims.
    pub(super) fn mapped(mesh: &RestMesh, surface: &Surface) -> Option<Self> {
        let sides = sides(mesh, surface)?;
        let corners = mesh.triangles.iter().map(|corners| mesh.positions_of(*corners));
        let corners = corners.map(|corners| corners.map(Vec3::as_dvec3));
        let count = mesh.positions.len();
        let fit = GradientFit::new(&mesh.triangles, corners, &surface.triangle_areas, count);
        let (cut, coordinates) = match sides {
            Sides::Four(sides) => {
                let mut fixed = vec![[None; 2]; count];
                for (axis, [zero, one]) in [[3, 1], [0, 2]].into_iter().enumerate() {
                    sides[zero].iter().for_each(|&at| fixed[at as usize][axis] = Some(0.0));
                    sides[one].iter().for_each(|&at| fixed[at as usize][axis] = Some(1.0));
                }
                let cut = Cut {
                    particles: (0..count as u32).collect(),
                    triangles: mesh.triangles.clone(),
                    turns: vec![0.0; count],
                };
                (cut, flattest(&fit, &fixed, [0.5; 2], |_| [DVec3::ZERO; 2])?)
            }
            Sides::Rims(rims) => {
                let mut fixed = vec![[None; 2]; count];
                for (rim, value) in rims.iter().zip([0.0, 1.0]) {
                    rim.iter().for_each(|&at| fixed[at as usize][0] = Some(value));
                }
                let cut = border::cut_open(mesh, &rims)?;
                let turning = |triangle: usize| {
                    let turns = cut.triangles[triangle].map(|place| cut.turns[place as usize]);
                    [DVec3::ZERO, -fit.gradient(triangle, turns)]
                };
                let coordinates = flattest(&fit, &fixed, [0.5, 0.0], turning)?;
                (cut, coordinates)
            }
        };
        let values = |axis: usize| {
            let places = cut.particles.iter().map(|&particle| coordinates[particle as usize][axis]);
            places.collect::<Vec<f64>>()
        };
        let along = values(0);
        let across: Vec<f64> =
            values(1).iter().zip(&cut.turns).map(|(value, turn)| value + turn).collect();
        let is_closed = cut.particles.len() > mesh.positions.len();
        let [along, across] = [(&along, true), (&across, !is_closed)].map(|(values, is_spaced)| {
            Coordinate::of(&fit, surface, &cut.triangles, values, is_spaced)
        });
        let (along, across) = (along?, across?);
        let extent = Vec2::new(along.length, across.length);
        let mut positions: Vec<Vec2> =
            along.values.iter().zip(&across.values).map(|(&x, &y)| Vec2::new(x, y)).collect();
        // The second axis points down the rows of a grid, seen from the front.
        if doubled_area(&positions, &cut.triangles) > 0.0 {
            let last = positions.iter().map(|at| at.x).fold(f32::MIN, f32::max);
            positions.iter_mut().for_each(|at| at.x = last - at.x);
        }
        Some(Self::closed(Self {
            warps: warps_of_rows(mesh, surface, &positions, &cut.triangles)?,
            positions,
            own_places: cut.particles.len(),
            particles: cut.particles,
            is_closed: false,
            of_mesh: (0..cut.triangles.len() as u32).collect(),
            triangles: cut.triangles,
            warp_cos2: 1.0,
            plane: None,
            area: extent.element_product(),
            border: border_length(mesh, surface),
            extent,
        }))
    }
}

/// The two functions with gradients nearest to wanted ones, some of whose values are fixed. The others are looked for from these
/// values.
fn flattest(
    fit: &GradientFit,
    fixed: &[[Option<f64>; 2]],
    others: [f64; 2],
    wanted: impl Fn(usize) -> [DVec3; 2],
) -> Option<Vec<DVec2>> {
    let start = |fixed: &[Option<f64>; 2]| {
        DVec2::from([0, 1].map(|axis| fixed[axis].unwrap_or(others[axis])))
    };
    let start: Vec<DVec2> = fixed.iter().map(start).collect();
    let is_fixed = |particle: usize| fixed[particle].map(|fixed| fixed.is_some()).into();
    fit.solved(&start, is_fixed, wanted, |_| true)
}

/// Twice the area of the triangles in the plane.
fn doubled_area(positions: &[Vec2], triangles: &[[u32; 3]]) -> f32 {
    let doubled = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| positions[corner as usize]);
        (b - a).perp_dot(c - a)
    };
    triangles.iter().map(doubled).sum()
}

/// A coordinate of places, m.
struct Coordinate {
    values: Vec<f32>,
    /// From the first place to the last, in the mean over all lines.
    length: f32,
}

impl Coordinate {
    /// A coordinate from values between 0 and 1, if wanted one whose lines are evenly spaced in the mean; none if the
    /// values have no gradients.
    fn of(
        fit: &GradientFit,
        surface: &Surface,
        triangles: &[[u32; 3]],
        values: &[f64],
        is_spaced: bool,
    ) -> Option<Self> {
        // The spacing of lines, as a cubic of the value by least squares: each line counts as its length.
        let (mut normal, mut right) = (DMat4::ZERO, DVec4::ZERO);
        let (mut length, mut area) = (0.0, 0.0);
        for (triangle, places) in triangles.iter().enumerate() {
            let of_triangle = surface.triangle_areas[triangle];
            let of_corners = places.map(|place| values[place as usize]);
            let steepness = fit.gradient(triangle, of_corners).length();
            let weight = f64::from(of_triangle) * steepness;
            let middle = of_corners.iter().sum::<f64>() / 3.0;
            let powers = DVec4::new(1.0, middle, middle * middle, middle.powi(3));
            let column = powers * weight;
            normal += DMat4::from_cols(
                column * powers.x,
                column * powers.y,
                column * powers.z,
                column * powers.w,
            );
            right += powers * f64::from(of_triangle);
            length += weight;
            area += f64::from(of_triangle);
        }
        let mean = area / length;
        let cubic = if is_spaced { normal.inverse() * right } else { DVec4::X * mean };
        let integrated = cubic * DVec4::new(1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0);
        let integral = |at: f64| {
            at * (integrated.x + at * (integrated.y + at * (integrated.z + at * integrated.w)))
        };
        let whole = integral(1.0);
        let is_good = whole.is_finite()
            && (0..=8_u8).map(|eighth| f64::from(eighth) / 8.0).all(|at| {
                let spacing = cubic.dot(DVec4::new(1.0, at, at * at, at.powi(3)));
                spacing > LEAST_SPACING * whole
            });
        is_good.then(|| Self {
            values: values.iter().map(|&value| integral(value) as f32).collect(),
            length: whole as f32,
        })
    }
}

/// Least spacing of lines where they are densest before they are spaced evenly, as a part of the mean. Smaller: rows
/// that hardly differ become a whole part of the grid.
const LEAST_SPACING: f64 = 0.05;
