//! Regions of the material that an artist has painted into a mesh.

use bevy_ecs::prelude::*;
use bevy_mesh::Mesh;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::MaterialRegion;

use crate::cloth::error::ClothError;
use crate::cloth::regions::ClothRegions;
use crate::render::painted_weights::VertexPaint;

/// A region of a cloth's material that an artist has painted into its mesh: 0 is outside, 1 within, values beyond count as these. The
/// factors are those of a [`MaterialRegion`].
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // What is painted green is leather.
/// let paint = VertexPaint::Color(ColorChannel::Green);
/// let leather = PaintedRegion { paint, bending: 300.0, density: 4.0, ..PaintedRegion::default() };
/// let collar = ClothFromMesh { regions: vec![leather], ..ClothFromMesh::painted() };
/// # assert_eq!(collar.regions[0].stretch, 1.0);
/// ```
#[derive(Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
pub struct PaintedRegion {
    /// Where the mesh has the values.
    pub paint: VertexPaint,
    /// Factor on the stiffnesses of warp, weft and shear.
    pub stretch: f32,
    /// Factor on the bending stiffness.
    pub bending: f32,
    /// Factor on the area density.
    pub density: f32,
}

impl Default for PaintedRegion {
    fn default() -> Self {
        Self { paint: VertexPaint::default(), stretch: 1.0, bending: 1.0, density: 1.0 }
    }
}

impl PaintedRegion {
    fn read(&self, entity: Entity, mesh: &Mesh) -> Result<MaterialRegion, ClothError> {
        let values = self.paint.values(entity, mesh)?;
        let weights = values.into_iter().map(|value| value.clamp(0.0, 1.0)).collect();
        let Self { stretch, bending, density, .. } = *self;
        Ok(MaterialRegion { stretch, bending, density, ..MaterialRegion::vertices(weights) })
    }
}

/// The regions that are painted into a mesh; none if there are none to be read.
///
/// # Errors
///
/// The mesh does not have the values in a format that can be read.
pub(super) fn painted_regions(
    painted: &[PaintedRegion],
    entity: Entity,
    mesh: &Mesh,
) -> Result<Option<ClothRegions>, ClothError> {
    if painted.is_empty() {
        return Ok(None);
    }
    let regions: Result<Vec<MaterialRegion>, ClothError> =
        painted.iter().map(|region| region.read(entity, mesh)).collect();
    regions.map(|regions| Some(ClothRegions(regions)))
}
