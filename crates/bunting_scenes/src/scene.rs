//! The contents of a scene file.

use std::collections::BTreeMap;

use bevy_ecs::prelude::*;
use bevy_math::{Vec2, Vec3};
use bunting_solver::FabricMaterial;
use serde::Deserialize;

use crate::material::{MaterialRecipe, preset};

/// A scene: flags on poles and vehicles, the wind that moves them, and the path of a viewer. Lengths
/// in metres, speeds in metres a second; y is up, the ground is y = 0.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// The winds, whose velocities are added up.
    pub winds: Vec<Wind>,
    /// The viewer in whose picture errors of levels are measured.
    pub viewer: Viewer,
    /// Resolutions of the flags.
    pub levels: Levels,
    /// Materials in addition to the presets, by name.
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
    /// Frequency of gusts, 1/s.
    #[serde(default = "Wind::default_gust_frequency")]
    pub gust_frequency: f32,
    /// Seed of the gusts.
    #[serde(default)]
    pub seed: i32,
}

impl Wind {
    const fn default_gust_frequency() -> f32 {
        0.5
    }
}

/// A moving viewer.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Viewer {
    /// The path of the viewer.
    pub track: Route,
    /// The point at which the viewer looks, m.
    pub looks_at: Vec3,
}

/// A closed path, and the speed along it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Route {
    /// At least three points, m. A smooth curve joins them and the last to the first.
    pub waypoints: Vec<Vec3>,
    /// Speed, m/s; at most [`Route::MAX_SPEED`].
    pub speed: f32,
    /// Length along the path at time 0, m.
    #[serde(default)]
    pub start: f32,
}

impl Route {
    /// The greatest speed at which cloth on a vehicle is tested, m/s.
    pub const MAX_SPEED: f32 = 20.0;
}

/// Resolutions of the flags, each half as fine as the one before.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Levels {
    /// Particles along either edge of a flag at the finest level: 2ⁿ + 1.
    pub finest: u32,
    /// Distances from the viewer beyond which a flag has the next coarser level, m, ascending.
    pub switch_distances: Vec<f32>,
}

/// A vehicle on its track.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Vehicle {
    /// The glTF file, relative to `assets/`. Forward is −z, the ground is y = 0.
    pub model: String,
    /// The path along which it drives.
    pub track: Route,
    /// Foot of the vehicle's flag pole in the vehicle's frame, m.
    pub socket: Vec3,
}

/// A flag on a pole.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flag {
    /// The base of the flag's pole.
    pub on: Footing,
    /// Height of the pole, m.
    pub pole: f32,
    /// Length along the wind and height along the pole, m.
    pub size: Vec2,
    /// Name of a material of the scene, or of a preset.
    pub material: String,
    /// The printed design.
    #[serde(default)]
    pub design: Design,
}

/// The base of a flag pole.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Footing {
    /// A point on the ground, m.
    Ground {
        /// To the right of the scene's origin.
        x: f32,
        /// Towards the viewer from the scene's origin.
        z: f32,
    },
    /// The socket of the vehicle of this name.
    Vehicle(String),
}

/// A design printed on cloth. Colours are red, green and blue from 0 to 255.
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
    /// Squares of two colours.
    Chequers {
        /// The two colours.
        colours: [[u8; 3]; 2],
        /// Number of squares along the pole.
        rows: u8,
    },
}

impl Default for Design {
    /// Undyed cloth.
    fn default() -> Self {
        Self::Bars(vec![[236, 232, 220]])
    }
}
