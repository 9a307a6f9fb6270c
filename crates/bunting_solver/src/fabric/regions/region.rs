//! A region of a cloth and what its material is there.

use glam::Vec2;

use super::factors;
use super::region_error::RegionError;

/// Number of values of a curve of depth that is given as a function. Fewer: steep curves are flattened. More: equal curves
/// take longer to compare.
const DEPTH_VALUES: u16 = 33;

/// A region of a cloth in which its material differs, by factors on stiffness, bending stiffness and area density.
///
/// Within the region a factor counts as it is, outside as 1, and where the weight w of the region lies between 0 and 1 as
/// 1 + w (factor − 1). The factors of several regions are multiplied. A region that is narrower than the cells of the simulation counts
/// by the part of them that it covers: a batten is as stiff at every resolution.
///
/// ```
/// use bunting_solver::{FabricBuilder, Grid, MaterialRegion};
/// use glam::Vec2;
///
/// // A sail with a batten of 4 cm, 20,000 times as stiff as its cloth, and a hem that is three times as heavy.
/// let batten = MaterialRegion::uv_line(Vec2::new(0.0, 0.3), Vec2::new(1.0, 0.3), 0.04).bending(2e4);
/// let hem = MaterialRegion::uv_box(Vec2::new(0.0, 0.97), Vec2::ONE).density(3.0).stretch(2.0);
/// let sail = FabricBuilder::grid(Grid::new(33, 65, 2.0, 4.0)).regions([batten, hem]).build()?;
/// # assert!(sail.mass_area() > 8.1);
/// # Ok::<(), bunting_solver::FabricError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "bevy_reflect",
    derive(bevy_reflect::Reflect),
    type_path = "bunting_solver",
    reflect(Debug, PartialEq, Clone)
)]
pub struct MaterialRegion {
    /// Where it is.
    pub shape: RegionShape,
    /// Factor on the stiffnesses of warp, weft and shear: from 0.001 to a million.
    #[cfg_attr(feature = "bevy_reflect", reflect(default = "one"))]
    pub stretch: f32,
    /// Factor on the bending stiffness: 0, or from 0.001 to a million.
    #[cfg_attr(feature = "bevy_reflect", reflect(default = "one"))]
    pub bending: f32,
    /// Factor on the area density: from 0.001 to a million.
    #[cfg_attr(feature = "bevy_reflect", reflect(default = "one"))]
    pub density: f32,
}

/// Where a [`MaterialRegion`] is, and with what weight from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "bevy_reflect",
    derive(bevy_reflect::Reflect),
    type_path = "bunting_solver",
    reflect(Debug, PartialEq, Clone)
)]
pub enum RegionShape {
    /// A weight for each vertex of the mesh.
    Vertices(Vec<f32>),
    /// A rectangle of the texture.
    UvBox {
        /// One corner.
        from: Vec2,
        /// The opposite corner.
        to: Vec2,
    },
    /// A strip along a straight line of the texture.
    UvLine {
        /// Texture coordinates of one end.
        from: Vec2,
        /// Those of the other end.
        to: Vec2,
        /// Width of the strip on the cloth, m.
        width: f32,
    },
    /// An image over the texture coordinates from 0 to 1, which repeats beyond.
    Image {
        /// Number of pixels in a row.
        columns: u32,
        /// A weight for each pixel, row by row; the first one is at the texture coordinates (0, 0).
        weights: Vec<f32>,
    },
    /// Weights by the distance along the cloth to the nearest pin: the first at pins, the last at the farthest particle, others evenly in
    /// between. Cloth without pins has the last one.
    Depth(Vec<f32>),
}

#[cfg(feature = "bevy_reflect")]
fn one() -> f32 {
    1.0
}

impl MaterialRegion {
    /// Least factor but for a bending of 0. Smaller: single particles swing so fast that they dominate the cloth's substeps.
    pub const LEAST_FACTOR: f32 = factors::LEAST;

    /// Greatest factor. Larger: beside it the rest of the cloth is rounding.
    pub const GREATEST_FACTOR: f32 = factors::GREATEST;

    /// A region with a shape, in which the material does not differ yet.
    #[must_use]
    pub const fn new(shape: RegionShape) -> Self {
        Self { shape, stretch: 1.0, bending: 1.0, density: 1.0 }
    }

    /// A weight from 0 to 1 for each vertex of the mesh, as an artist paints them. Between vertices they are interpolated.
    #[must_use]
    pub const fn vertices(weights: Vec<f32>) -> Self {
        Self::new(RegionShape::Vertices(weights))
    }

    /// A rectangle of the texture, between two opposite corners: a hem, a patch, a collar.
    #[must_use]
    pub const fn uv_box(from: Vec2, to: Vec2) -> Self {
        Self::new(RegionShape::UvBox { from, to })
    }

    /// A strip of a width in metres along a straight line of the texture: a batten, a bone, a seam.
    #[must_use]
    pub const fn uv_line(from: Vec2, to: Vec2, width: f32) -> Self {
        Self::new(RegionShape::UvLine { from, to, width })
    }

    /// Weights from 0 to 1 of the pixels of an image with so many columns, row by row.
    #[must_use]
    pub const fn image(columns: u32, weights: Vec<f32>) -> Self {
        Self::new(RegionShape::Image { columns, weights })
    }

    /// A weight from 0 to 1 by the depth: 0 at pins, 1 at the particle that is farthest from them along the cloth.
    ///
    /// ```
    /// use bunting_solver::MaterialRegion;
    ///
    /// // Ten times as stiff in bending at the pins, as it is at the far end: a skirt that stands at the waist.
    /// let stands = MaterialRegion::depth(|depth| (1.0 - depth) * (1.0 - depth)).bending(10.0);
    /// ```
    #[must_use]
    pub fn depth(weight: impl Fn(f32) -> f32) -> Self {
        let last = f32::from(DEPTH_VALUES - 1);
        let weights = (0..DEPTH_VALUES).map(|at| weight(f32::from(at) / last));
        Self::new(RegionShape::Depth(weights.collect()))
    }

    /// Sets the factor on the stiffnesses of warp, weft and shear.
    #[must_use]
    pub const fn stretch(mut self, factor: f32) -> Self {
        self.stretch = factor;
        self
    }

    /// Sets the factor on the bending stiffness.
    #[must_use]
    pub const fn bending(mut self, factor: f32) -> Self {
        self.bending = factor;
        self
    }

    /// Sets the factor on the area density.
    #[must_use]
    pub const fn density(mut self, factor: f32) -> Self {
        self.density = factor;
        self
    }

    /// Checks that the region can be used on a mesh with a number of vertices, with or without texture coordinates.
    ///
    /// # Errors
    ///
    /// A [`RegionError`] names the first thing that is wrong, and what to do.
    pub fn validate(&self, vertices: usize, has_uv: bool) -> Result<(), RegionError> {
        let is_factor = |value: f32| (Self::LEAST_FACTOR..=Self::GREATEST_FACTOR).contains(&value);
        let factors =
            [("stretch", self.stretch), ("bending", self.bending), ("density", self.density)];
        for (name, value) in factors {
            let vanishes = name == "bending" && value == 0.0;
            if !is_factor(value) && !vanishes {
                return Err(RegionError::Factor { name, value });
            }
        }
        let weights = match &self.shape {
            RegionShape::Vertices(weights) if weights.len() != vertices => {
                return Err(RegionError::WeightCount { weights: weights.len(), vertices });
            }
            RegionShape::Vertices(weights) => weights,
            RegionShape::Depth(weights) if weights.is_empty() => {
                return Err(RegionError::Rows { weights: 0, columns: 1 });
            }
            RegionShape::Depth(weights) => weights,
            _ if !has_uv => return Err(RegionError::NoUv),
            RegionShape::Image { columns, weights } => {
                let is_whole = *columns > 0 && weights.len().is_multiple_of(*columns as usize);
                if !is_whole || weights.is_empty() {
                    return Err(RegionError::Rows { weights: weights.len(), columns: *columns });
                }
                weights
            }
            RegionShape::UvBox { from, to } => return finite([*from, *to]),
            RegionShape::UvLine { from, to, width } => {
                finite([*from, *to])?;
                if from == to {
                    return Err(RegionError::Place { name: "length", value: 0.0 });
                }
                if !(*width > 0.0 && width.is_finite()) {
                    return Err(RegionError::Place { name: "width", value: *width });
                }
                return Ok(());
            }
        };
        match weights.iter().position(|weight| !(0.0..=1.0).contains(weight)) {
            Some(index) => Err(RegionError::Weight { index, weight: weights[index] }),
            None => Ok(()),
        }
    }

    /// The same region with other weights of vertices, if it has some.
    #[must_use]
    pub fn map_vertices(&self, weights: impl FnOnce(&[f32]) -> Vec<f32>) -> Self {
        match &self.shape {
            RegionShape::Vertices(of) => {
                Self { shape: RegionShape::Vertices(weights(of)), ..self.clone() }
            }
            _ => self.clone(),
        }
    }
}

/// Checks the coordinates of two points.
fn finite(points: [Vec2; 2]) -> Result<(), RegionError> {
    let mut coordinates = points.into_iter().flat_map(|at| at.to_array());
    match coordinates.find(|value| !value.is_finite()) {
        Some(value) => Err(RegionError::Place { name: "coordinate", value }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::{MaterialRegion, RegionError};

    #[test]
    fn bad_regions_say_what_is_wrong() {
        let check = |region: MaterialRegion| region.validate(4, true);
        let hem = || MaterialRegion::uv_box(Vec2::ZERO, Vec2::ONE);
        assert_eq!(check(hem().density(2.0).bending(0.0)), Ok(()));
        for (bad, of) in [
            (hem().stretch(f32::NAN), "stretch"),
            (hem().stretch(0.0), "stretch"),
            (hem().bending(-1.0), "bending"),
            (hem().bending(1e-9), "bending"),
            (hem().density(-2.0), "density"),
            (hem().density(f32::INFINITY), "density"),
        ] {
            assert!(matches!(check(bad), Err(RegionError::Factor { name, .. }) if name == of));
        }
        let few = check(MaterialRegion::vertices(vec![1.0; 3]));
        assert_eq!(few, Err(RegionError::WeightCount { weights: 3, vertices: 4 }));
        let wrong = check(MaterialRegion::vertices(vec![0.0, 1.0, 2.0, 0.0]));
        assert_eq!(wrong, Err(RegionError::Weight { index: 2, weight: 2.0 }));
        let wrong = check(MaterialRegion::depth(|depth| depth.sqrt() - 0.1));
        assert!(matches!(wrong, Err(RegionError::Weight { index: 0, .. })));
        let ragged = check(MaterialRegion::image(2, vec![0.0; 3]));
        assert_eq!(ragged, Err(RegionError::Rows { weights: 3, columns: 2 }));
        let line = |to: Vec2, width: f32| check(MaterialRegion::uv_line(Vec2::ZERO, to, width));
        assert!(matches!(line(Vec2::ZERO, 0.1), Err(RegionError::Place { name: "length", .. })));
        assert!(matches!(line(Vec2::ONE, 0.0), Err(RegionError::Place { name: "width", .. })));
        let nan = line(Vec2::new(0.5, f32::NAN), 0.1);
        assert!(matches!(nan, Err(RegionError::Place { name: "coordinate", .. })));
        assert_eq!(hem().validate(4, false), Err(RegionError::NoUv));
        assert_eq!(MaterialRegion::vertices(vec![1.0; 4]).validate(4, false), Ok(()));
    }
}
