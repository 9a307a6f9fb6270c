//! Air inside a cloth: the pressure by which it pushes on the cloth's triangles.
//!
//! A pressure p pushes on a triangle of area A and normal n with the force p A n, a third of it on each corner. At each
//! particle these are p S, with S = ∂V/∂x, the gradient of the volume V behind the triangles: their net force and moment are
//! nil where the cloth is closed, and all that the pressure depends on are sums over S:
//!
//! - the volume V = ⅓ Σ (x − c)·S, by the divergence theorem, for any point c where the cloth is closed, and the middle of
//!   its border elsewhere;
//! - the area of its mouth as a vector, Σ S, which is zero where the cloth is closed;
//! - the rate at which its volume grows, Σ v·S;
//! - the acceleration of that rate by a unit of pressure, Σ w |S|², with w the inverse masses.
//!
//! Each substep adds the push to the prediction, as gravity is added, at the predicted positions, so that it hardly lags behind
//! the motion. Volume and pressure are computed in each substep: once a tick would be too seldom, since air of 10⁵ Pa in a
//! ball of 20 cm vibrates with 400 Hz.
//!
//! Two limits keep this explicit force stable. The directions of links are frozen in a substep, so that a tension T by the
//! pressure must not be more than about σ l²/τ²: more pressure is not exerted ([`push`]). And air that answers faster to a change of its
//! volume than the substep resolves counts as softer ([`sealed`]). Both fall with the square of the substep, and the tension is a load by
//! which hosts choose substeps.

mod air;
mod canopy;
mod gradient;
mod push;
mod sealed;
mod set;
mod state;

pub use air::Pressure;
pub(crate) use state::LanePressure;
