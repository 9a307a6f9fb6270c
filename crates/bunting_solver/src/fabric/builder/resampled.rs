//! A surface that is simulated with particles of its own, and carries the mesh that it was made from.

use super::source::FabricBuilder;
use crate::fabric::carried::Carried;
use crate::fabric::error::FabricError;
use crate::fabric::fabric::Fabric;
use crate::fabric::mesh::RestMesh;
use crate::fabric::quads::Net;

/// A fabric whose particles lie on lines along warp and weft, made from a mesh, and how that mesh follows it.
#[derive(Clone, Debug)]
pub struct Resampled {
    /// What is simulated.
    pub fabric: Fabric,
    /// How the mesh follows.
    pub carried: Carried,
}

impl FabricBuilder {
    /// Builds a fabric whose cells have about a given size, m, whatever the triangles of the mesh; by default as many particles as the
    /// mesh has.
    ///
    /// # Errors
    ///
    /// A [`FabricError`] names the defect of the mesh and its location.
    pub fn resampled(self, cell: Option<f32>) -> Result<Resampled, FabricError> {
        self.validate()?;
        let welded = self.weld();
        let place_of_vertex = welded.particle_of_vertex.clone();
        let (mesh, surface) =
            RestMesh::new(&self.positions, &self.uv, &self.indices, self.pinned, welded)?;
        let (net, rows, heights) =
            Net::resampled(&mesh, &surface, cell.map(f64::from)).ok_or(FabricError::Empty)?;
        let fabric = Fabric::of_nodes(net, self.tethered);
        Ok(Resampled { fabric, carried: Carried { rows, heights, place_of_vertex } })
    }
}
