//! The cloth of a parasol: panels between ribs, and a valance that hangs from the rim.

use std::f32::consts::{PI, TAU};

use bevy::prelude::*;
use bevy_bunting::prelude::*;

/// Number of ribs, each between two panels.
pub const RIBS: u32 = 8;

/// Length of a rib seen from above, m.
pub const RADIUS: f32 = 1.45;

/// Height of the top above the rim, m.
pub const FALL: f32 = 0.62;

/// Length of the valance in the middle of a panel, m.
pub const VALANCE: f32 = 0.24;

/// Length of the valance at the ribs, as a fraction of [`VALANCE`]: the hem is scalloped.
const SCALLOP: f32 = 0.7;

/// Bulge of a panel at the rim, as a fraction of the panel's width: cloth is never perfectly taut.
const BULGE: f32 = 0.035;

/// Vertices from one rib to the next.
const PANEL: u32 = 12;

/// Rings of vertices from the top to the rim.
const RINGS: u32 = 14;

/// Rows of vertices of the valance below the rim.
const ROWS: u32 = 5;

/// Fractions of the radius up to which vertices are rigid, and from which on they are simulated; in between
/// they blend.
const INNER: (f32, f32) = (0.45, 0.75);

/// A canopy in the frame of its top. The first and the last column coincide: a seam.
pub fn mesh() -> ClothMesh {
    let columns = RIBS * PANEL + 1;
    let nodes = || (0..=RINGS + ROWS).flat_map(|ring| (0..columns).map(move |at| (ring, at)));
    let index = |ring: u32, column: u32| ring * columns + column;
    let positions = nodes().map(|(ring, column)| position(ring, column)).collect();
    let uv = nodes().map(|(ring, column)| {
        Vec2::new(column as f32 / (columns - 1) as f32, ring as f32 / (RINGS + ROWS) as f32)
    });
    let cells = (0..RINGS + ROWS).flat_map(|ring| (1..columns).map(move |right| (ring, right)));
    let indices = cells.flat_map(|(ring, right)| {
        let left = right - 1;
        let [a, b] = [index(ring, left), index(ring, right)];
        let [c, d] = [index(ring + 1, left), index(ring + 1, right)];
        match ring {
            // The ring at the top is one point.
            0 => vec![a, c, d],
            _ if (ring + right).is_multiple_of(2) => vec![a, c, d, a, d, b],
            _ => vec![a, c, b, b, c, d],
        }
    });
    let weights = nodes().map(|(ring, column)| weight(ring, column)).collect();
    ClothMesh::triangles(positions, indices.collect(), uv.collect()).with_weights(weights)
}

/// The end of a rib, in the frame of the top, m.
pub fn rib_end(rib: u32) -> Vec3 {
    let angle = TAU * rib as f32 / RIBS as f32;
    Vec3::new(RADIUS * angle.cos(), -FALL, -RADIUS * angle.sin())
}

fn position(ring: u32, column: u32) -> Vec3 {
    let (rib, along) = (column / PANEL % RIBS, (column % PANEL) as f32 / PANEL as f32);
    let [left, right] = [rib, rib + 1].map(rib_end);
    // The rim is a chord from rib to rib, plus a bulge up and outwards.
    let out = left.cross(right).normalize();
    let bulge = BULGE * left.distance(right) * (PI * along).sin();
    let rim = left.lerp(right, along) + bulge * out;
    if ring <= RINGS {
        return rim * (ring as f32 / RINGS as f32);
    }
    let length = VALANCE * (SCALLOP + (1.0 - SCALLOP) * (PI * along).sin());
    rim - Vec3::Y * length * ((ring - RINGS) as f32 / ROWS as f32)
}

/// Weight of a vertex: 0 (rigid) on the ribs and the inner part of the canopy, 1 (simulated) at the
/// rim and on the valance.
fn weight(ring: u32, column: u32) -> f32 {
    match ring {
        ring if ring > RINGS => 1.0,
        _ if column.is_multiple_of(PANEL) => 0.0,
        ring => {
            let fraction = ring as f32 / RINGS as f32;
            let weight = ((fraction - INNER.0) / (INNER.1 - INNER.0)).clamp(0.0, 1.0);
            weight * weight * (3.0 - 2.0 * weight)
        }
    }
}
