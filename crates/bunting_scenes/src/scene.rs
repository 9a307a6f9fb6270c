//! What a scene file says.

use std::collections::BTreeMap;

use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3};
use bunting_solver::FabricMaterial;
use serde::Deserialize;

use crate::material::{MaterialRecipe, preset};

/// A scene: flags on poles and vehicles, the wind that moves them and the path of the one who
/// looks. Lengths in metres, speeds in metres a second; y is up, the ground is y = 0.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// The wind; several add up.
    pub winds: Vec<Wind>,
    /// Who looks at the scene, and from where.
    pub viewer: Viewer,
    /// Resolutions of the flags.
    pub levels: Levels,
    /// Materials of this scene, beside the presets, by name.
    #[serde(default)]
    pub materials: BTreeMap<String, MaterialRecipe>,
    /// Vehicles by name.
    #[serde(default)]
    pub vehicles: BTreeMap<String, Vehicle>,
    /// The flags.
    pub flags: Vec<Flag>,
}

impl Scene {
    /// The material of this name: the scene's own, else a preset.
    #[must_use]
    pub fn material(&self, name: &str) -> Option<FabricMaterial> {
        self.materials.get(name).map_or_else(|| preset(name), MaterialRecipe::material)
    }
}

/// A wind that is the same everywhere, with gusts.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wind {
    /// Mean velocity, m/s.
    pub velocity: Vec3,
    /// Greatest departure of gusts from the mean along each axis, m/s.
    #[serde(default)]
    pub gust_strength: f32,
    /// How often gusts come, 1/s.
    #[serde(default = "Wind::default_gust_frequency")]
    pub gust_frequency: f32,
    /// Chooses the gusts.
    #[serde(default)]
    pub seed: i32,
}

impl Wind {
    const fn default_gust_frequency() -> f32 {
        0.5
    }
}

/// The one who looks at the scene.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Viewer {
    /// The way that the viewer goes.
    pub track: Route,
    /// The point that the viewer looks at, m.
    pub looks_at: Vec3,
}

/// A closed way through the given points, and the speed along it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Route {
    /// At least three points, m. A smooth curve joins them and the last to the first.
    pub waypoints: Vec<Vec3>,
    /// Speed, m/s; at most [`Route::MAX_SPEED`].
    pub speed: f32,
    /// How far along the way the ride begins, m.
    #[serde(default)]
    pub start: f32,
}

impl Route {
    /// The highest speed for which cloth on a vehicle is made, m/s.
    pub const MAX_SPEED: f32 = 20.0;
}

/// Resolutions of the flags, each half as fine as the one before.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Levels {
    /// Particles along either edge of a flag at the finest level: 2ⁿ + 1.
    pub finest: u32,
    /// Distances from the viewer at which a flag goes to the next coarser level, m, ascending.
    pub switch_distances: Vec<f32>,
}

/// A vehicle on its track.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vehicle {
    /// The glTF file that it looks like, below `assets/`. Forward is −z, the ground is y = 0.
    pub model: String,
    /// The way that it drives.
    pub track: Route,
    /// Where a flag pole stands on it, m, in the vehicle's frame.
    pub socket: Vec3,
}

/// A flag on a pole.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flag {
    /// What its pole stands on.
    pub on: Footing,
    /// Height of the pole, m.
    pub pole: f32,
    /// Length along the wind and height along the pole, m.
    pub size: Vec2,
    /// A material of the scene, or a preset.
    pub material: String,
    /// What is printed on it.
    #[serde(default)]
    pub design: Design,
}

/// What a flag pole stands on.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Footing {
    /// The ground, at a place in m.
    Ground {
        /// To the right of the scene's origin.
        x: f32,
        /// Towards the viewer from the scene's origin.
        z: f32,
    },
    /// The socket of the vehicle of this name.
    Vehicle(String),
}

/// What is printed on a flag. Colours are red, green and blue from 0 to 255.
#[derive(Component, Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Design {
    /// Stripes along the pole, from the pole to the fly.
    Pales(Vec<[u8; 3]>),
    /// Stripes along the wind, from top to bottom.
    Bars(Vec<[u8; 3]>),
    /// A cross upon a field, off centre towards the pole.
    Cross {
        /// Colour of the field.
        field: [u8; 3],
        /// Colour of the cross.
        cross: [u8; 3],
    },
    /// A disc upon a field.
    Disc {
        /// Colour of the field.
        field: [u8; 3],
        /// Colour of the disc.
        disc: [u8; 3],
    },
    /// Two colours in squares, so many along the pole.
    Chequers {
        /// The two colours.
        colours: [[u8; 3]; 2],
        /// Squares along the pole.
        rows: u8,
    },
}

impl Default for Design {
    /// Undyed cloth.
    fn default() -> Self {
        Self::Bars(vec![[236, 232, 220]])
    }
}
