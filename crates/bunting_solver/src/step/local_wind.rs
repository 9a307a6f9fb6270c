//! Wind at the particles of a batch, where it differs from particle to particle.

use glam::Quat;

use crate::simd::lane::Pack;
use crate::simd::vec3::Pack3;

/// Wind at the particles of a batch.
#[derive(Clone, Debug)]
pub(crate) struct LocalWind<P: Pack> {
    /// Velocities of the wind less those of the drive, along the axes at the end of the tick, m/s.
    pub winds: Vec<Pack3<P>>,
    /// The turn of directions in each lane from those axes to the ones at the end of the substep.
    pub turns: Vec<Quat>,
    /// Velocities of the particles less these, m/s.
    pub relative: Vec<Pack3<P>>,
    /// Positions while the air is summed, m.
    pub kept: Vec<Pack3<P>>,
}
