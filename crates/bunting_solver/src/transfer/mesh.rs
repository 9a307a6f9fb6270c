//! Interpolation between two meshes of one surface.

use glam::Vec3;
use parry3d::query::PointQueryWithLocation;
use parry3d::shape::TriMesh;

use super::interpolation::Interpolation;
use crate::fabric::Fabric;

/// Distance from the coarse triangles, as a fraction of the square root of the fabric's area, below which a
/// particle counts as on them. Smaller: flat meshes get offsets of rounding errors. Larger: shallow curves
/// are flattened.
const FLAT: f32 = 1e-4;

/// For each fine particle: barycentric weights on the coarse triangle nearest to it at rest, and its offset
/// from this triangle. None if the coarse mesh has no triangles that can be searched.
pub(super) fn nearest(fine: &Fabric, coarse: &Fabric) -> Option<(Interpolation, RestOffsets)> {
    let mesh = TriMesh::new(coarse.rest_positions().to_vec(), coarse.triangles().to_vec()).ok()?;
    let mut interpolation = Interpolation::default();
    let mut offsets = RestOffsets::default();
    let extent = fine.area().sqrt();
    for (particle, &rest) in fine.rest_positions().iter().enumerate() {
        let (point, (triangle, location)) = mesh.project_local_point_and_get_location(rest, false);
        let corners = coarse.triangles()[triangle as usize];
        let weights = location.barycentric_coordinates()?;
        let row = corners.into_iter().zip(weights);
        interpolation.push(row.filter(|(_, weight)| *weight != 0.0));
        let offset = rest - point.point;
        if offset.length() > FLAT * extent {
            let axes = axes(corners, coarse.rest_positions());
            let along = axes.map(|axis| axis.dot(offset));
            offsets.0.push(RestOffset { particle: particle as u32, corners, along });
        }
    }
    Some((interpolation, offsets))
}

/// Offsets of fine particles from the coarse triangles at rest, along axes that turn with the triangles.
#[derive(Clone, Debug, Default)]
pub(super) struct RestOffsets(Vec<RestOffset>);

#[derive(Clone, Debug)]
struct RestOffset {
    particle: u32,
    corners: [u32; 3],
    /// Components along the triangle's axes, m.
    along: [f32; 3],
}

impl RestOffsets {
    /// Adds the offsets to interpolated positions, m.
    pub fn add(&self, coarse: &[Vec3], fine: &mut [Vec3]) {
        for RestOffset { particle, corners, along } in &self.0 {
            let axes = axes(*corners, coarse).into_iter().zip(along);
            fine[*particle as usize] += axes.map(|(axis, &along)| axis * along).sum::<Vec3>();
        }
    }
}

/// Unit vectors along a triangle's first edge, across it in the plane, and along the normal.
fn axes(corners: [u32; 3], positions: &[Vec3]) -> [Vec3; 3] {
    let [a, b, c] = corners.map(|corner| positions[corner as usize]);
    let along = (b - a).normalize_or_zero();
    let normal = (b - a).cross(c - a).normalize_or_zero();
    [along, normal.cross(along), normal]
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{Quat, Vec3};

    use crate::batch::snapshot::ClothSnapshot;
    use crate::fabric::{FabricBuilder, FabricMaterial, Grid, Resolution};
    use crate::transfer::LevelTransfer;

    /// A quarter of a tube, as a mesh of triangles, held along one side, and its next level.
    fn cape() -> (Arc<crate::Fabric>, Arc<crate::Fabric>, LevelTransfer) {
        let grid = Grid::new(17, 17, 1.0, 1.0);
        let bend = |at: &Vec3| {
            let angle = 1.5 * at.x;
            Vec3::new(libm::sinf(angle) / 1.5, at.y, (1.0 - libm::cosf(angle)) / 1.5)
        };
        let positions = grid.positions().iter().map(bend).collect();
        let triangles = grid.triangles(false).into_iter().flatten().collect();
        let cape = FabricBuilder::new(positions, triangles).uv(grid.uvs());
        let cape = cape.pin_where(|_, uv| uv.y == 0.0);
        let [fine, coarse] = [0.0625, 0.125]
            .map(|size| cape.resampled(Resolution::CellSize(size)).expect("a cape").fabric);
        let transfer = LevelTransfer::of_surface(&fine, &coarse).expect("one surface");
        (fine, coarse, transfer)
    }

    #[test]
    fn a_bent_mesh_gets_its_shape_back_however_it_is_turned() {
        let (fine, coarse, transfer) = cape();
        let turn = Quat::from_rotation_y(2.0);
        let turned: Vec<Vec3> = coarse.rest_positions().iter().map(|at| turn * *at).collect();
        let mut up: Vec<Vec3> = transfer.smooth.interpolate(&turned).collect();
        let error = |positions: &[Vec3]| {
            let pairs = positions.iter().zip(fine.rest_positions());
            pairs.map(|(at, rest)| at.distance(turn * *rest)).fold(0.0, f32::max)
        };
        assert!(error(&up) > 2e-3, "{}", error(&up));
        transfer.offsets.add(&turned, &mut up);
        assert!(error(&up) < 2e-4, "{}", error(&up));
    }

    #[test]
    fn a_mesh_at_rest_stays_where_it_is() {
        let (fine, coarse, transfer) = cape();
        let material = FabricMaterial::COTTON;
        let rest = [&fine, &coarse].map(|fabric| ClothSnapshot::at_rest(fabric));
        let moved = [
            transfer.restrict(&rest[0], &material, Vec3::ZERO),
            transfer.prolong(&rest[1], &material, Vec3::ZERO),
        ];
        for (moved, rest) in moved.iter().zip([&rest[1], &rest[0]]) {
            for (at, rest) in moved.positions.iter().zip(&rest.positions) {
                assert!(at.distance(*rest) < 3e-4, "{at} {rest}");
            }
        }
    }

    #[test]
    fn linear_fields_are_interpolated_nearly_exactly() {
        let (fine, coarse, transfer) = cape();
        let field = |at: &Vec3| Vec3::new(at.y, 2.0 * at.y + 1.0, 0.5);
        let values: Vec<Vec3> = coarse.rest_positions().iter().map(field).collect();
        for (value, rest) in transfer.spread(&values).zip(fine.rest_positions()) {
            assert!(value.distance(field(rest)) < 2e-2, "{value} {}", field(rest));
        }
    }
}
