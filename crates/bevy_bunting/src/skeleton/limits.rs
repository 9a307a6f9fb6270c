//! Limits around the animated places of a cloth's particles.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::cloth::mesh::ClothMesh;
use crate::skeleton::by_vertex::ByVertex;
use crate::skeleton::skin::SkinError;

/// How far a cloth with a [`ClothSkin`](crate::ClothSkin) may go from where its skeleton alone would have it. Without this
/// component, and by default, free particles go anywhere. It may be changed at any time.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // Hardly any play at the shoulders, 60 cm at the hem; never more than 3 cm into the back.
/// let limits = SkinLimits {
///     max_distance: ByVertex::AlongV { top: 0.02, bottom: 0.6 },
///     backstop_distance: 0.03.into(),
///     backstop_radius: 0.5.into(),
///     ..SkinLimits::default()
/// };
/// # assert_eq!(limits.simulated, ByVertex::Same(1.0));
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct SkinLimits {
    /// Greatest distance of a free particle from its animated place, m; infinite where there is no limit.
    pub max_distance: ByVertex,
    /// Distance behind the animated place, against the animated normal, of the surface of a sphere that the particle cannot
    /// enter, m.
    pub backstop_distance: ByVertex,
    /// Radius of that sphere, m; zero where there is none. The larger, the flatter is what holds the cloth.
    pub backstop_radius: ByVertex,
    /// Weight from 0 to 1 with which the simulated position is shown; the rest is the animated place. It multiplies the
    /// weights of the [`ClothMesh`](crate::ClothMesh).
    pub simulated: ByVertex,
}

impl Default for SkinLimits {
    fn default() -> Self {
        Self {
            max_distance: ByVertex::Same(f32::INFINITY),
            backstop_distance: ByVertex::Same(0.0),
            backstop_radius: ByVertex::Same(0.0),
            simulated: ByVertex::Same(1.0),
        }
    }
}

/// The limits of all vertices.
#[derive(Debug)]
pub(crate) struct VertexLimits {
    /// m.
    pub max_distance: Vec<f32>,
    /// m.
    pub backstop_distance: Vec<f32>,
    /// m.
    pub backstop_radius: Vec<f32>,
    pub simulated: Vec<f32>,
}

impl SkinLimits {
    /// The limits of the vertices of a mesh.
    ///
    /// # Errors
    ///
    /// A list has not one number for each vertex, or a number is out of range.
    pub(crate) fn of(&self, mesh: &ClothMesh) -> Result<VertexLimits, SkinError> {
        let (count, uv) = (mesh.vertex_count(), mesh.uvs());
        let numbers = |name, rule: &ByVertex, is_good: fn(f32) -> bool| {
            let values = rule.values(count, &uv);
            if values.len() != count {
                return Err(SkinError::LimitCount { name, vertices: count });
            }
            match values.iter().position(|&value| !is_good(value)) {
                Some(vertex) => Err(SkinError::Limit { name, vertex, value: values[vertex] }),
                None => Ok(values),
            }
        };
        let is_length = |length: f32| length.is_finite() && length >= 0.0;
        Ok(VertexLimits {
            max_distance: numbers("max_distance", &self.max_distance, |at| at >= 0.0)?,
            backstop_distance: numbers(
                "backstop_distance",
                &self.backstop_distance,
                f32::is_finite,
            )?,
            backstop_radius: numbers("backstop_radius", &self.backstop_radius, is_length)?,
            simulated: numbers("simulated", &self.simulated, |at| (0.0..=1.0).contains(&at))?,
        })
    }
}
