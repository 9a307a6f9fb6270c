//! Weights of vertices that an artist has painted into a mesh.

use bevy_ecs::intern::Interner;
use bevy_ecs::prelude::*;
use bevy_mesh::{Mesh, VertexAttributeValues};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::cloth::error::ClothError;

/// Names of attributes in errors.
static KEYS: Interner<str> = Interner::new();

/// Weights of a cloth's vertices, see [`ClothMesh::with_weights`](crate::ClothMesh::with_weights), read from
/// values that an artist has painted into the mesh.
///
/// A vertex whose value is that of [`free`](Self::free) is simulated, one whose value is that of
/// [`pinned`](Self::pinned) is pinned; values beyond them count as these, and between them the weight grows
/// evenly. Where both are equal, vertices with at least this value are pinned and all others are simulated.
///
/// ```
/// use bevy_bunting::{ColorChannel, PaintedWeights, VertexPaint};
///
/// // What is painted red is pinned; half red is half as free.
/// let by_color = PaintedWeights::default();
/// // At 0.5 and above pinned, below it free.
/// let by_attribute = PaintedWeights::above(VertexPaint::Attribute("Pin".to_owned()), 0.5);
/// # assert_eq!(by_color.paint, VertexPaint::Color(ColorChannel::Red));
/// # assert_eq!((by_attribute.free, by_attribute.pinned), (0.5, 0.5));
/// ```
#[derive(Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
pub struct PaintedWeights {
    /// Where the mesh has the values.
    pub paint: VertexPaint,
    /// Value of a vertex that is simulated fully.
    pub free: f32,
    /// Value of a vertex that is pinned.
    pub pinned: f32,
}

/// Distances of [`SkinLimits`](crate::SkinLimits), such as the greatest distances of particles from their animated places,
/// read from values that an artist has painted into the mesh. They grow evenly with the value, also beyond 0 and 1.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // Green is play: none at 0, half a metre at 1.
/// let paint = VertexPaint::Color(ColorChannel::Green);
/// let max_distance = Some(PaintedDistance { paint, at_zero: 0.0, at_one: 0.5 });
/// let cape = ClothFromMesh { max_distance, ..ClothFromMesh::painted() };
/// # assert!(cape.weights.is_some());
/// ```
#[derive(Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Debug, PartialEq, Clone)]
pub struct PaintedDistance {
    /// Where the mesh has the values.
    pub paint: VertexPaint,
    /// Distance where the value is 0, m.
    pub at_zero: f32,
    /// Distance where the value is 1, m.
    pub at_one: f32,
}

impl PaintedDistance {
    /// The distances of a mesh's vertices, m.
    ///
    /// # Errors
    ///
    /// The mesh does not have the values in a format that can be read.
    pub(super) fn read(&self, entity: Entity, mesh: &Mesh) -> Result<Vec<f32>, ClothError> {
        let values = self.paint.values(entity, mesh)?;
        let distance = |value: f32| self.at_zero + (self.at_one - self.at_zero) * value;
        Ok(values.into_iter().map(distance).collect())
    }
}

/// Values that a mesh has for each vertex.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // Blender exports a vertex group as an attribute of the mesh.
/// let group = VertexPaint::Attribute("Pin".to_owned());
/// # assert_ne!(group, VertexPaint::Color(ColorChannel::Red));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum VertexPaint {
    /// A channel of the vertex colours, `Mesh::ATTRIBUTE_COLOR`. Bevy's `StandardMaterial` multiplies its
    /// colour with them: paint the alpha channel if the paint should not be seen on an opaque material.
    Color(ColorChannel),
    /// The attribute whose `MeshVertexAttribute::name` this is, of the format `Float32`.
    Attribute(String),
}

/// A channel of vertex colours.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// let paint = VertexPaint::Color(ColorChannel::Alpha);
/// # assert_ne!(paint, VertexPaint::Color(ColorChannel::default()));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum ColorChannel {
    /// Red.
    #[default]
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
    /// Alpha.
    Alpha,
}

impl Default for VertexPaint {
    fn default() -> Self {
        Self::Color(ColorChannel::default())
    }
}

impl Default for PaintedWeights {
    /// The red channel: 0 is simulated, 1 is pinned.
    fn default() -> Self {
        Self { paint: VertexPaint::default(), free: 0.0, pinned: 1.0 }
    }
}

impl PaintedWeights {
    /// Pins vertices with at least this value, and simulates all others fully.
    #[must_use]
    pub const fn above(paint: VertexPaint, threshold: f32) -> Self {
        Self { paint, free: threshold, pinned: threshold }
    }

    /// The weights of a mesh's vertices.
    ///
    /// # Errors
    ///
    /// The mesh does not have the values in a format that can be read.
    pub(super) fn read(&self, entity: Entity, mesh: &Mesh) -> Result<Vec<f32>, ClothError> {
        let values = self.paint.values(entity, mesh)?;
        Ok(values.into_iter().map(|value| self.weight(value)).collect())
    }

    fn weight(&self, value: f32) -> f32 {
        if self.free == self.pinned {
            return if value >= self.pinned { 0.0 } else { 1.0 };
        }
        ((self.pinned - value) / (self.pinned - self.free)).clamp(0.0, 1.0)
    }
}

impl VertexPaint {
    /// The value of each vertex.
    ///
    /// # Errors
    ///
    /// The mesh does not have the values in a format that can be read.
    pub(super) fn values(&self, entity: Entity, mesh: &Mesh) -> Result<Vec<f32>, ClothError> {
        let missing = || ClothError::NotPainted { entity, key: self.key() };
        self.find(mesh).ok_or_else(missing)
    }

    /// Name of the attribute that has the values. Names are kept for good, so that errors can be copied.
    fn key(&self) -> &'static str {
        match self {
            Self::Color(_) => Mesh::ATTRIBUTE_COLOR.name,
            Self::Attribute(name) => KEYS.intern(name).0,
        }
    }

    fn find(&self, mesh: &Mesh) -> Option<Vec<f32>> {
        match self {
            Self::Color(channel) => match mesh.try_attribute(Mesh::ATTRIBUTE_COLOR).ok()? {
                VertexAttributeValues::Float32x4(colors) => {
                    Some(colors.iter().map(|color| color[*channel as usize]).collect())
                }
                _ => None,
            },
            Self::Attribute(name) => {
                let named = |(attribute, _): &(&bevy_mesh::MeshVertexAttribute, _)| {
                    attribute.name == name.as_str()
                };
                match mesh.try_attributes().ok()?.find(named)?.1 {
                    VertexAttributeValues::Float32(values) => Some(values.clone()),
                    _ => None,
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_become_weights() {
        let weights = |free: f32, pinned: f32| {
            let painted = PaintedWeights { free, pinned, ..PaintedWeights::default() };
            [-1.0, 0.0, 0.25, 0.5, 1.0, 2.0].map(|value| painted.weight(value))
        };
        assert_eq!(weights(0.0, 1.0), [1.0, 1.0, 0.75, 0.5, 0.0, 0.0]);
        assert_eq!(weights(1.0, 0.0), [0.0, 0.0, 0.25, 0.5, 1.0, 1.0]);
        assert_eq!(weights(0.5, 0.5), [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    }
}
