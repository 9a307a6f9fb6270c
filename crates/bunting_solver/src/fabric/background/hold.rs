//! Whether a grid is held where its mesh is.

use glam::Vec2;

use super::on_chart::OnChart;
use crate::fabric::mesh::RestMesh;

/// Greatest distance of a pinned particle from a pinned node, in cells. Larger: a cloth hangs by less than its pins.
const HELD_WITHIN: f32 = 0.8;

/// The same for a pinned particle beside which no other is pinned. Larger: its node follows free particles as well, and
/// edges at the pin may be strained by more than 100 %.
const SINGLE_HELD_WITHIN: f32 = 0.1;

/// How a grid holds its mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Hold {
    /// Near some pins no node is pinned.
    Loose,
    /// Near each pin a node is pinned.
    NearPins,
    /// At each pin without neighbours that are pinned a node is, too, and near all others.
    AtPins,
}

impl Hold {
    /// How nodes hold a mesh.
    pub fn of(OnChart { mesh, chart, grid, .. }: &OnChart, nodes: &RestMesh) -> Self {
        let spacing = Vec2::from(grid.spacing());
        let last = Vec2::new((grid.columns - 1) as f32, (grid.rows - 1) as f32);
        let distance = |at: Vec2| {
            let cell = (at / spacing).floor().min(last - 1.0).max(Vec2::ZERO);
            let corners = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE].map(|corner| cell + corner);
            let pinned = corners.into_iter().filter(|node| {
                let index = grid.index(node.x as u32, node.y as u32);
                nodes.is_pinned(index) && nodes.areas[index as usize] > 0.0
            });
            pinned.map(|node| node.distance(at / spacing)).fold(f32::INFINITY, f32::min)
        };
        let is_single = single_pins(mesh);
        let places = chart.particles.iter().zip(&chart.positions).take(chart.own_places);
        let pinned = places.filter(|(particle, _)| mesh.is_pinned(**particle));
        let of_pin = |(&particle, &at): (&u32, &Vec2)| match distance(at) {
            far if far >= HELD_WITHIN => Self::Loose,
            far if is_single[particle as usize] && far >= SINGLE_HELD_WITHIN => Self::NearPins,
            _ => Self::AtPins,
        };
        pinned.map(of_pin).min().unwrap_or(Self::AtPins)
    }
}

/// Whether no neighbour of each particle is pinned.
fn single_pins(mesh: &RestMesh) -> Vec<bool> {
    let mut is_single = vec![true; mesh.positions.len()];
    for &[a, b, c] in &mesh.triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            is_single[from as usize] &= !mesh.is_pinned(to);
            is_single[to as usize] &= !mesh.is_pinned(from);
        }
    }
    is_single
}
