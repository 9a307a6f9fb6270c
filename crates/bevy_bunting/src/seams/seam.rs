//! The component of a cloth that is sewn together.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

use crate::motion::attached_vertices::ClothEdge;
use crate::seams::error::SeamError;
use crate::seams::run::SeamRun;
use crate::seams::sewn::SewnCloth;

/// Edges of a cloth that are sewn to edges of the same cloth: a sheet becomes a tube, and flat panels that are pieces of one
/// [`ClothMesh`](crate::ClothMesh) become a garment, a bag or a tent.
///
/// Seams can be changed at any time: closed, opened, zipped up to a point. A cloth hangs from a seam as if it were of one piece. At each
/// level of detail the particles along both sides are sewn, those of the side with more of them to points between those of the other.
///
/// A seam that cannot be sewn is reported as [`ClothError::Seam`](crate::ClothError::Seam) and stays open; the others are sewn.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // A sleeve: a sheet whose left edge is sewn to its right edge, drawn together within a second.
/// let seam = Seam::new(ClothEdge::Left, ClothEdge::Right).with_closing(1.0);
/// let sleeve = (ClothMesh::grid(33, 17, 0.6, 0.4), ClothSeams::new([seam]));
/// # assert_eq!(sleeve.1.seams[0].closed, 1.0);
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(SewnCloth)]
pub struct ClothSeams {
    /// The seams.
    pub seams: Vec<Seam>,
}

impl ClothSeams {
    /// Some seams.
    #[must_use]
    pub fn new(seams: impl IntoIterator<Item = Seam>) -> Self {
        Self { seams: seams.into_iter().collect() }
    }
}

/// Two runs along a cloth that are sewn together, from their beginnings to their ends.
///
/// ```
/// use bevy_bunting::prelude::*;
///
/// // A zip that is closed up to the middle, and a lacing of 2 cm.
/// let zip = Seam::new(ClothEdge::Left, ClothEdge::Right).zipped_to(0.5);
/// let lacing = Seam::new(vec![0, 32], vec![544, 512]).with_length(0.02);
/// # assert!(zip.closed < lacing.closed);
/// ```
#[derive(Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Default, Debug, PartialEq, Clone)]
pub struct Seam {
    /// The two sides. Points at the same part of the length of both are sewn together.
    pub sides: [SeamRun; 2],
    /// Whether the second side runs from its end to its beginning.
    #[reflect(default)]
    pub reversed: bool,
    /// The part that is closed, from the beginning: 0 is open, 1 is closed, and what lies between is where the slider of a zip is.
    #[reflect(default = "all")]
    pub closed: f32,
    /// Greatest distance of the two sides, m: zero for a seam, more for a lacing.
    #[reflect(default)]
    pub length: f32,
    /// Time that an open seam takes to close, s: each gap becomes shorter evenly. With zero, and behind the slider of a zip, sides come
    /// together at 1 m/s.
    #[reflect(default)]
    pub closing: f32,
}

/// The part of a seam that is closed in a file that says nothing of it.
fn all() -> f32 {
    1.0
}

impl Default for Seam {
    /// The left edge and the right one.
    fn default() -> Self {
        Self::new(ClothEdge::Left, ClothEdge::Right)
    }
}

impl Seam {
    /// A closed seam of two runs.
    #[must_use]
    pub fn new(one: impl Into<SeamRun>, other: impl Into<SeamRun>) -> Self {
        let sides = [one.into(), other.into()];
        Self { sides, reversed: false, closed: 1.0, length: 0.0, closing: 0.0 }
    }

    /// Sews the end of the second side to the beginning of the first one.
    #[must_use]
    pub fn with_second_reversed(self) -> Self {
        Self { reversed: !self.reversed, ..self }
    }

    /// Closes within a time, s.
    #[must_use]
    pub fn with_closing(self, closing: f32) -> Self {
        Self { closing, ..self }
    }

    /// Laces the sides at most this far apart, m.
    #[must_use]
    pub fn with_length(self, length: f32) -> Self {
        Self { length, ..self }
    }

    /// Closes a part of it alone, from the beginning: 0 is none, 1 all.
    #[must_use]
    pub fn zipped_to(self, closed: f32) -> Self {
        Self { closed, ..self }
    }

    /// Opens it.
    pub fn open(&mut self) {
        self.closed = 0.0;
    }

    /// Closes it, within the time [`closing`](Self::closing) if it is open.
    pub fn close(&mut self) {
        self.closed = 1.0;
    }

    /// The first number that cannot be.
    pub(super) fn check_numbers(&self) -> Result<(), SeamError> {
        let numbers = [
            ("closed", self.closed, 1.0),
            ("length", self.length, f32::MAX),
            ("closing", self.closing, f32::MAX),
        ];
        match numbers.into_iter().find(|(_, value, most)| !(0.0..=*most).contains(value)) {
            Some((name, value, _)) => Err(SeamError::Number { name, value }),
            None => Ok(()),
        }
    }
}
