//! Checks of a mesh before a fabric is built from it.

use super::source::FabricBuilder;
use crate::fabric::error::FabricError;

impl FabricBuilder {
    /// Checks that counts and indices fit one another, and that positions, texture coordinates and the
    /// welding distance are finite.
    pub(super) fn validate(&self) -> Result<(), FabricError> {
        if let Some(grid) = &self.grid {
            grid.validate()?;
        }
        if self.indices.is_empty() {
            return Err(FabricError::Empty);
        }
        if !self.indices.len().is_multiple_of(3) {
            return Err(FabricError::IndexCount { count: self.indices.len() });
        }
        let vertices = self.positions.len();
        if let Some(at) = self.indices.iter().position(|&index| index as usize >= vertices) {
            return Err(FabricError::IndexOutOfRange {
                triangle: at / 3,
                vertex: self.indices[at],
                vertices,
            });
        }
        if let Some(&vertex) = self.pinned.iter().find(|&&vertex| vertex as usize >= vertices) {
            return Err(FabricError::PinOutOfRange { vertex, vertices });
        }
        if let Some(vertex) = self.positions.iter().position(|position| !position.is_finite()) {
            return Err(FabricError::NotFinite { vertex });
        }
        if !self.uv.is_empty() && self.uv.len() != vertices {
            return Err(FabricError::UvCount { uvs: self.uv.len(), vertices });
        }
        if let Some(merged) = &self.merged
            && merged.len() != vertices
        {
            return Err(FabricError::MergeCount { numbers: merged.len(), vertices });
        }
        if self.pinned_before_uv && !self.uv.is_empty() {
            return Err(FabricError::PinnedBeforeUv);
        }
        if let Some(vertex) = self.uv.iter().position(|uv| !uv.is_finite()) {
            return Err(FabricError::UvNotFinite { vertex });
        }
        for (region, of) in self.regions.iter().enumerate() {
            let is_valid = of.validate(vertices, !self.uv.is_empty());
            is_valid.map_err(|source| FabricError::Region { region, source })?;
        }
        match self.weld_distance {
            Some(distance) if !(distance >= 0.0 && distance.is_finite()) => {
                Err(FabricError::WeldDistance { distance })
            }
            _ => self.check_points(),
        }
    }
}
