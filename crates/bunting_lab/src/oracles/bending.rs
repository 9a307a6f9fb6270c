//! Strips that bend under their own weight.

use std::f64::consts::{FRAC_PI_2, PI};

use faer::{Mat, Side};
use glam::DVec2;

use super::root::bisect;

/// Lateral buckling of a narrow strip on edge: q L³/√(EI·C).
pub const LATERAL_BUCKLING: f64 = 12.853763;
/// Self-weight buckling of a column (Greenhill 1881): w L³/B.
pub const SELF_WEIGHT_COLUMN: f64 = 7.837347;
/// Runge–Kutta steps along the cantilever.
const STEPS: usize = 4000;
/// Step of the logarithm of the tip's angle in the search for the first equilibrium.
const SCAN: f64 = 0.25;

/// How far the free end of a quarter arc moves that is clamped where it is level, under a small load along its length: level
/// and up, in units of the radius, given w R³/B (Castigliano 1879). The moment at the angle a from the clamp is
/// w R² (cos a − (π/2 − a) sin a).
#[must_use]
pub fn quarter_arc(load: f64) -> DVec2 {
    load * DVec2::new(PI / 8.0, FRAC_PI_2 - 1.25 - PI * PI / 16.0)
}

/// Critical w L³/B of a column of square cells, clamped in the middle of one more cell below the first. The
/// column's two sides are rigid links joined by springs of B/2l each, and carry `masses` at the upper ends of
/// the links, in units of a whole row's mass.
///
/// Small tilts θ of the links of a row store ¼ B/l (θₖ − θₖ₋₁)² on each side, twice that at the clamp, whose
/// hinge covers half a link, and by twist B/l (θ − θ')² where the tilts θ and θ' of the two sides differ.
/// Each tilt lowers the masses above by ½ l θ². The critical load is therefore the least eigenvalue of the
/// stored energy relative to the lowering.
///
/// # Panics
///
/// When a mass is not positive.
#[must_use]
pub fn column_of_links(masses: &[[f64; 2]]) -> f64 {
    let rows = masses.len();
    let borne = |at: usize| masses[at / 2..].iter().map(|row| row[at % 2]).sum::<f64>();
    let spring =
        |joint: usize| if joint == 0 { 1.0 } else { 0.5 * f64::from(u8::from(joint < rows)) };
    let twist = 2.0;
    let stiffness = |one: usize, other: usize| match (one / 2).abs_diff(other / 2) {
        0 if one == other => spring(one / 2) + spring(one / 2 + 1) + twist,
        0 => -twist,
        1 if one % 2 == other % 2 => -0.5,
        _ => 0.0,
    };
    let matrix = Mat::from_fn(2 * rows, 2 * rows, |one, other| {
        stiffness(one, other) / (borne(one) * borne(other)).sqrt()
    });
    let loads = matrix.self_adjoint_eigenvalues(Side::Lower).expect("a finite symmetric matrix");
    loads[0] * (rows as f64).powi(3)
}

/// A horizontally clamped strip under its own weight, over its length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cantilever {
    /// Reach of the tip, W/L.
    pub reach: f64,
    /// Drop of the tip, H/L.
    pub drop: f64,
}

impl Cantilever {
    /// The equilibrium reached by loading quasi-statically from flat, with Γ = σ g L³/B.
    ///
    /// θ'' = −Γ(1−s) cos θ, θ(0) = θ'(1) = 0 (Romero et al. 2021, "Physical validation of simulators in
    /// computer graphics"), solved by shooting from the tip in φ = π/2 − θ. The search is over the logarithm
    /// of φ at the tip, since φ(1) is as small as exp(−2/3 √Γ).
    #[must_use]
    pub fn new(gamma: f64) -> Self {
        let overshoots = |logarithm: f64| shoot(gamma, logarithm.exp()).angle > FRAC_PI_2;
        let mut high = -gamma.sqrt();
        while !overshoots(high) {
            high += SCAN;
        }
        let shot = shoot(gamma, bisect(high - SCAN, high, overshoots).exp());
        Self { reach: shot.reach, drop: shot.drop }
    }

    /// The ratio H/W, which Romero et al. tabulate.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        self.drop / self.reach
    }
}

/// State of the integration on its way from the tip to the clamp.
#[derive(Clone, Copy)]
struct Shot {
    angle: f64,
    slope: f64,
    reach: f64,
    drop: f64,
}

impl Shot {
    /// Derivatives with respect to the distance t from the tip.
    fn rate(self, gamma: f64, t: f64) -> Self {
        let (sine, cosine) = self.angle.sin_cos();
        Self { angle: self.slope, slope: gamma * t * sine, reach: sine, drop: cosine }
    }

    fn moved(self, rate: Self, h: f64) -> Self {
        Self {
            angle: self.angle + rate.angle * h,
            slope: self.slope + rate.slope * h,
            reach: self.reach + rate.reach * h,
            drop: self.drop + rate.drop * h,
        }
    }
}

/// Classical Runge–Kutta from the tip, where φ is `tip`, to the clamp.
fn shoot(gamma: f64, tip: f64) -> Shot {
    let h = 1.0 / STEPS as f64;
    let mut shot = Shot { angle: tip, slope: 0.0, reach: 0.0, drop: 0.0 };
    for k in 0..STEPS {
        let t = k as f64 * h;
        let a = shot.rate(gamma, t);
        let b = shot.moved(a, 0.5 * h).rate(gamma, t + 0.5 * h);
        let c = shot.moved(b, 0.5 * h).rate(gamma, t + 0.5 * h);
        let d = shot.moved(c, h).rate(gamma, t + h);
        shot = shot.moved(a, h / 6.0).moved(b, h / 3.0).moved(c, h / 3.0).moved(d, h / 6.0);
    }
    shot
}
