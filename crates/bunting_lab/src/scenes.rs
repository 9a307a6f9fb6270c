//! The standard scenes: one description that every method and the reference read.
//!
//! Axes: x to the right, y up, z towards the viewer; gravity is `GRAVITY` along −y. Vertex (i, j) of
//! a sheet has index `j * columns + i`; i counts along the warp (u, the sheet's width), j along the
//! weft (v, its height). A vertical sheet hangs in the plane z = 0 with row j = 0 on top; a horizontal
//! one lies in the plane y = 0 with row j at z = j·dy.

use std::f64::consts::PI;

use glam::{DVec3, dvec3};
use serde::Serialize;

/// Gravitational acceleration along −y, m/s².
pub const GRAVITY: f64 = 9.81;
/// Ticks a second of every scene.
pub const TICK_RATE: u32 = 60;

/// Whole ticks in `seconds`.
#[must_use]
pub fn ticks(seconds: f64) -> usize {
    (seconds * f64::from(TICK_RATE)).round() as usize
}
/// Time in which a hanging cloth comes to rest, s.
const HANG_SECONDS: f64 = 6.0;
/// Time at the end of a hanging scene over which strain is averaged, s.
const HANG_WINDOW: f64 = 1.0;
/// Length of the swing, s: cloth is chaotic, and later positions are not comparable.
const SWING_SECONDS: f64 = 0.6;
/// Time that a flag flies before its statistics begin, s.
const FLAG_SETTLING: f64 = 5.0;
/// Length of a flag's statistics, s.
const FLAG_WINDOW: f64 = 20.0;
/// Height in metres of the ripple that lets a flat vertical cloth leave its plane.
const RIPPLE: f64 = 1e-3;

/// The material of a cloth, in units that do not depend on the grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fabric {
    /// Area density σ, kg/m².
    pub density: f64,
    /// Uniaxial stretch stiffness along warp and weft, N/m.
    pub stretch: [f64; 2],
    /// Shear stiffness G, N/m.
    pub shear: f64,
    /// Bending stiffness B, N·m.
    pub bending: f64,
}

impl Fabric {
    /// The fabric of the standard scenes.
    pub const STANDARD: Self =
        Self { density: 0.2, stretch: [1e4, 1e4], shear: 200.0, bending: 2e-5 };
}

/// Vertices that are held in place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Pins {
    /// None.
    Free,
    /// Row j = 0.
    Top,
    /// Rows j = 0 and j = 1: a clamp that also holds the slope.
    TopClamp,
    /// Column i = 0.
    Left,
    /// The two ends of row j = 0.
    TopCorners,
    /// Rows j = 0 and j = last.
    TopAndBottom,
}

/// Pose of the sheet when it is released.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Pose {
    /// Flat in the plane z = 0.
    Vertical,
    /// In the plane z = 0, with a smooth ripple of the given height in metres, without which a flat sheet
    /// would never fold.
    Rippled(f64),
    /// Flat in the plane y = 0.
    Horizontal,
}

/// The air around the cloth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Air {
    /// Steady wind, m/s.
    pub wind: [f64; 3],
    /// Amplitude of the gust, m/s: the wind is `wind + gust · sin(gust_rate · t)`.
    pub gust: [f64; 3],
    /// Angular rate of the gust, rad/s.
    pub gust_rate: f64,
    /// Density times pressure coefficient ρ C_n, kg/m³.
    pub pressure: f64,
    /// Density times skin friction coefficient ρ C_t, kg/m³.
    pub friction: f64,
}

impl Air {
    /// No air at all.
    pub const VACUUM: Self =
        Self { wind: [0.0; 3], gust: [0.0; 3], gust_rate: 0.0, pressure: 0.0, friction: 0.0 };

    /// Velocity of the wind at time `t` seconds, m/s.
    #[must_use]
    pub fn wind_at(&self, t: f64) -> DVec3 {
        DVec3::from(self.wind) + DVec3::from(self.gust) * (self.gust_rate * t).sin()
    }

    /// Whether the air exerts no force.
    #[must_use]
    pub fn is_vacuum(&self) -> bool {
        self.pressure == 0.0 && self.friction == 0.0
    }
}

/// Purpose of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Measure {
    /// Strain once the cloth has come to rest.
    Rest,
    /// Positions against the reference.
    Positions,
    /// Means over the window: the motion itself is chaotic.
    Statistics,
}

/// A rectangular sheet and everything that acts on it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scene {
    /// Name in tables and in JSON.
    pub name: &'static str,
    /// Vertices along the warp.
    pub columns: usize,
    /// Vertices along the weft.
    pub rows: usize,
    /// Width along the warp, m.
    pub width: f64,
    /// Height along the weft, m.
    pub height: f64,
    /// The cloth's material.
    pub fabric: Fabric,
    /// Vertices that are held.
    pub pins: Pins,
    /// Pose of the sheet at the start.
    pub pose: Pose,
    /// Rate c at which free motion decays, 1/s: v ∝ exp(−c t).
    pub damping: f64,
    /// The air around the cloth.
    pub air: Air,
    /// Gravitational acceleration along −y, m/s².
    pub gravity: f64,
    /// Length of the run, s.
    pub seconds: f64,
    /// Length of the window at the end of the run over which figures are averaged, s.
    pub window: f64,
    /// Purpose of the scene.
    pub measure: Measure,
}

impl Scene {
    /// One square metre of the standard fabric, n × n, hung vertically, undamped.
    fn square(name: &'static str, n: usize, pins: Pins, pose: Pose) -> Self {
        Self {
            name,
            columns: n,
            rows: n,
            width: 1.0,
            height: 1.0,
            fabric: Fabric::STANDARD,
            pins,
            pose,
            damping: 0.0,
            air: Air::VACUUM,
            gravity: GRAVITY,
            seconds: HANG_SECONDS,
            window: HANG_WINDOW,
            measure: Measure::Rest,
        }
    }

    /// A sheet that hangs from its top edge, damped by 2/s; at rest after 6 s.
    #[must_use]
    pub fn hang_top(n: usize) -> Self {
        Self { damping: 2.0, ..Self::square("hang_top", n, Pins::Top, Pose::Vertical) }
    }

    /// A sheet that hangs from its left side, damped by 2/s; at rest after 6 s.
    #[must_use]
    pub fn hang_side(n: usize) -> Self {
        Self { damping: 2.0, ..Self::square("hang_side", n, Pins::Left, Pose::Rippled(RIPPLE)) }
    }

    /// A sheet that hangs from its two upper corners, damped by 2/s; at rest after 6 s.
    #[must_use]
    pub fn hang_corners(n: usize) -> Self {
        Self {
            damping: 2.0,
            ..Self::square("hang_corners", n, Pins::TopCorners, Pose::Rippled(RIPPLE))
        }
    }

    /// A sheet held along one edge and released flat and horizontal, undamped.
    #[must_use]
    pub fn swing(n: usize) -> Self {
        Self {
            seconds: SWING_SECONDS,
            measure: Measure::Positions,
            ..Self::square("swing", n, Pins::Top, Pose::Horizontal)
        }
    }

    /// A flag held by its left side in a gusting wind of 6 m/s, damped by 0.3/s.
    #[must_use]
    pub fn flag(n: usize) -> Self {
        Self {
            damping: 0.3,
            air: Air {
                wind: [6.0, 0.0, 0.0],
                gust: [0.0, 0.0, 0.9],
                gust_rate: 1.7,
                pressure: 0.6,
                friction: 0.0,
            },
            seconds: FLAG_SETTLING + FLAG_WINDOW,
            window: FLAG_WINDOW,
            measure: Measure::Statistics,
            ..Self::square("flag", n, Pins::Left, Pose::Vertical)
        }
    }

    /// The five standard scenes at n × n.
    #[must_use]
    pub fn standard(n: usize) -> [Self; 5] {
        [
            Self::hang_top(n),
            Self::hang_side(n),
            Self::hang_corners(n),
            Self::swing(n),
            Self::flag(n),
        ]
    }

    /// Distance between neighbours along warp and weft, m.
    #[must_use]
    pub fn spacing(&self) -> [f64; 2] {
        [self.width / (self.columns - 1) as f64, self.height / (self.rows - 1) as f64]
    }

    /// Number of vertices.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.columns * self.rows
    }

    /// Whole ticks of the run.
    #[must_use]
    pub fn ticks(&self) -> usize {
        ticks(self.seconds)
    }

    /// First tick of the window over which figures are averaged.
    #[must_use]
    pub fn window_start(&self) -> usize {
        self.ticks() - ticks(self.window.min(self.seconds))
    }

    /// Positions at the start, m.
    #[must_use]
    pub fn positions(&self) -> Vec<DVec3> {
        let [dx, dy] = self.spacing();
        let place = |index: usize| {
            let (u, v) = ((index % self.columns) as f64 * dx, (index / self.columns) as f64 * dy);
            match self.pose {
                Pose::Vertical => dvec3(u, -v, 0.0),
                Pose::Rippled(height) => {
                    let wave =
                        (2.0 * PI * u / self.width).sin() * (1.5 * PI * v / self.height).sin();
                    dvec3(u, -v, height * wave)
                }
                Pose::Horizontal => dvec3(u, 0.0, v),
            }
        };
        (0..self.vertices()).map(place).collect()
    }

    /// Whether the vertex with this index is held.
    #[must_use]
    pub fn is_pinned(&self, index: usize) -> bool {
        let (i, j) = (index % self.columns, index / self.columns);
        match self.pins {
            Pins::Free => false,
            Pins::Top => j == 0,
            Pins::TopClamp => j < 2,
            Pins::Left => i == 0,
            Pins::TopCorners => j == 0 && (i == 0 || i + 1 == self.columns),
            Pins::TopAndBottom => j == 0 || j + 1 == self.rows,
        }
    }
}
