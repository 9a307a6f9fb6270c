//! The probes of a batch when the tick began, by which the motion of its cloths is measured.

/// The ends of the probes when the tick began.
#[derive(Clone, Debug)]
pub(crate) struct ProbeMotion<P> {
    /// Positions of both ends of each probe, m.
    pub starts: Vec<[[P; 3]; 2]>,
    /// Length of the tick, s.
    pub tick: f32,
}

impl<P> Default for ProbeMotion<P> {
    fn default() -> Self {
        Self { starts: Vec::new(), tick: 0.0 }
    }
}
