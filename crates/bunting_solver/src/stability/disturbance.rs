//! For how long what has acted on a free cloth changes its angular momentum: see [`spin`](crate::stability::spin).

/// Number of substeps in which a change of velocity has an effect by extrapolation. Each leaves √0.1 of it (the root of
/// z² − γ₁ z − γ₂), so that 10⁻⁵ remains. Smaller: a part of what has acted is taken back.
const EXTRAPOLATED: u8 = 10;

/// Number of substeps, the present one included, in which what has acted from outside changes the angular momentum, by
/// itself or by extrapolation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Disturbance(u8);

impl Disturbance {
    /// Begins a substep in which something acts on the cloth from outside, or nothing.
    pub fn begin_substep(&mut self, acts: bool) {
        self.0 = if acts { EXTRAPOLATED } else { self.0.saturating_sub(1) };
    }

    /// Something else acts on the cloth in this substep.
    pub fn disturb(&mut self) {
        self.0 = EXTRAPOLATED;
    }
}
