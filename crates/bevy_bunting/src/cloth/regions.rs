//! Regions of a cloth in which its material differs.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bunting_solver::{MaterialRegion, RegionShape};

use crate::cloth::error::ClothError;
use crate::cloth::mesh::ClothMesh;

/// Regions of a cloth in which its [`ClothMaterial`](crate::ClothMaterial) differs: hems, battens, leather collars, the bones of a skirt,
/// patches. Each has factors on the stiffness against stretch and shear, on that against bending, and on the area density; those of
/// regions that overlap are multiplied. Levels of detail keep them.
///
/// | [`MaterialRegion`] | Where |
/// | --- | --- |
/// | [`uv_line`](MaterialRegion::uv_line) | a strip of some width along a line of the texture |
/// | [`uv_box`](MaterialRegion::uv_box) | a rectangle of the texture |
/// | [`image`](MaterialRegion::image) | where an image is bright; `image_region` (feature `render`) reads Bevy's |
/// | [`vertices`](MaterialRegion::vertices) | by a weight for each vertex of the [`ClothMesh`](crate::ClothMesh) |
/// | [`depth`](MaterialRegion::depth) | by the distance from the pins, with any curve |
///
/// Regions are part of the fabric, which cloths share that are equal in all of it: a change builds it anew, while the cloth moves on.
/// What varies from cloth to cloth or from frame to frame is the material.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_math::Vec2;
///
/// // A sail with two battens of 5 cm, and a hem along its foot.
/// let batten = |v| MaterialRegion::uv_line(Vec2::new(0.0, v), Vec2::new(1.0, v), 0.05).bending(1e4);
/// let foot = MaterialRegion::uv_box(Vec2::new(0.0, 0.95), Vec2::ONE).stretch(2.0).density(2.0);
/// let sail = (
///     ClothMesh::grid(33, 49, 2.0, 3.0),
///     ClothRegions::new([batten(0.3), batten(0.6), foot]),
///     Attachment::in_place(ClothEdge::Left),
/// );
/// # assert_eq!(sail.1.0.len(), 3);
/// ```
///
/// # Errors
///
/// A [`ClothFailed`](crate::ClothFailed) event names a region that cannot be used. The cloth keeps its last valid regions; one that never
/// had any is not simulated until they change.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothRegions(
    /// The regions, in any order.
    pub Vec<MaterialRegion>,
);

impl ClothRegions {
    /// Some regions.
    #[must_use]
    pub fn new(regions: impl IntoIterator<Item = MaterialRegion>) -> Self {
        Self(regions.into_iter().collect())
    }
}

/// Checks the regions of a cloth with a mesh.
///
/// # Errors
///
/// [`ClothError::Region`].
pub(crate) fn check_regions(
    entity: Entity,
    regions: &[MaterialRegion],
    mesh: &ClothMesh,
) -> Result<(), ClothError> {
    let has_uv = match mesh {
        ClothMesh::Triangles { uv, .. } => !uv.is_empty(),
        ClothMesh::Grid { .. } | ClothMesh::Sheet { .. } => true,
    };
    for (region, of) in regions.iter().enumerate() {
        let is_valid = of.validate(mesh.vertex_count(), has_uv);
        is_valid.map_err(|source| ClothError::Region { entity, region, source })?;
    }
    Ok(())
}

/// Extends a key by what tells regions from others.
pub(crate) fn add_key(regions: &[MaterialRegion], key: &mut Vec<u32>) {
    key.push(regions.len() as u32);
    for MaterialRegion { shape, stretch, bending, density } in regions {
        let (kind, numbers, weights): (u32, Vec<f32>, &[f32]) = match shape {
            RegionShape::Vertices(weights) => (0, Vec::new(), weights),
            RegionShape::UvBox { from, to } => (1, vec![from.x, from.y, to.x, to.y], &[]),
            RegionShape::UvLine { from, to, width } => {
                (2, vec![from.x, from.y, to.x, to.y, *width], &[])
            }
            RegionShape::Image { columns, weights } => (3 + columns, Vec::new(), weights),
            RegionShape::Depth(weights) => (3, Vec::new(), weights),
        };
        key.extend([kind, weights.len() as u32]);
        let factors = [stretch, bending, density].into_iter();
        key.extend(factors.chain(&numbers).chain(weights).map(|number| number.to_bits()));
    }
}
