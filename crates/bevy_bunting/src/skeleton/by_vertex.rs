//! Numbers of a cloth's vertices.

use bevy_math::Vec2;
use bevy_reflect::Reflect;

/// A number of each vertex of a [`ClothMesh`](crate::ClothMesh).
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // 2 cm at the collar, 60 cm at the hem; and the same for all.
/// let play = ByVertex::AlongV { top: 0.02, bottom: 0.6 };
/// let backstop = ByVertex::from(0.03);
/// # assert_eq!(backstop, ByVertex::Same(0.03));
/// # let _ = SkinLimits { max_distance: play, ..SkinLimits::default() };
/// ```
#[derive(Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Debug, PartialEq, Clone)]
pub enum ByVertex {
    /// The same number for all vertices.
    Same(f32),
    /// One for each vertex.
    Each(Vec<f32>),
    /// Grows evenly with the texture coordinate v, which grows downwards: from one number at the least v to another at the
    /// greatest. The first number if the mesh has no texture coordinates.
    AlongV {
        /// At the least v.
        top: f32,
        /// At the greatest v.
        bottom: f32,
    },
}

impl ByVertex {
    /// The number of each of `count` vertices, given their texture coordinates, if they have any. An empty list where the
    /// number of numbers differs.
    pub(crate) fn values(&self, count: usize, uv: &[Vec2]) -> Vec<f32> {
        match self {
            Self::Same(value) => vec![*value; count],
            Self::Each(values) if values.len() == count => values.clone(),
            Self::Each(_) => Vec::new(),
            Self::AlongV { top, .. } if uv.len() != count => vec![*top; count],
            Self::AlongV { top, bottom } => {
                let least = uv.iter().map(|uv| uv.y).fold(f32::INFINITY, f32::min);
                let greatest = uv.iter().map(|uv| uv.y).fold(f32::NEG_INFINITY, f32::max);
                let extent = (greatest - least).max(f32::MIN_POSITIVE);
                let part = |uv: &Vec2| (uv.y - least) / extent;
                uv.iter().map(|uv| top + (bottom - top) * part(uv)).collect()
            }
        }
    }
}

impl From<f32> for ByVertex {
    fn from(value: f32) -> Self {
        Self::Same(value)
    }
}

impl From<Vec<f32>> for ByVertex {
    fn from(values: Vec<f32>) -> Self {
        Self::Each(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_follow_their_rule() {
        let uv = [0.25, 0.5, 0.75].map(|v| Vec2::new(0.0, v));
        assert_eq!(ByVertex::from(2.0).values(3, &[]), [2.0; 3]);
        assert_eq!(ByVertex::from(vec![1.0, 2.0, 3.0]).values(3, &[]), [1.0, 2.0, 3.0]);
        assert!(ByVertex::from(vec![1.0]).values(3, &[]).is_empty());
        let along = ByVertex::AlongV { top: 1.0, bottom: 3.0 };
        assert_eq!(along.values(3, &uv), [1.0, 2.0, 3.0]);
        assert_eq!(along.values(3, &[]), [1.0; 3]);
    }
}
