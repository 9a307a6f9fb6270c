//! Cloths that may touch one another in a tick, wherever their lanes are.

#[cfg(feature = "render")]
use bunting_solver::ContactPoint;
use bunting_solver::{ClothBatch, ClothGroup, GroupLanes, GroupMember};

use crate::batch::group::Group;
use crate::batch::lane_handle::LaneHandle;

/// A cloth that may touch others.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TouchingCloth {
    pub lane: LaneHandle,
    pub member: GroupMember,
}

/// Cloths that may touch one another in a tick.
#[derive(Debug, Default)]
pub(crate) struct TouchingCloths {
    lanes: Vec<LaneHandle>,
    members: Vec<GroupMember>,
    group: ClothGroup,
}

impl TouchingCloths {
    /// Replaces the cloths.
    pub fn set(&mut self, cloths: &[TouchingCloth]) {
        self.lanes.clear();
        self.lanes.extend(cloths.iter().map(|cloth| cloth.lane));
        self.members.clear();
        self.members.extend(cloths.iter().map(|cloth| cloth.member));
    }

    /// The contacts of the cloth in a lane with itself and with the others, in the world; none if it is not among them.
    #[cfg(feature = "render")]
    pub fn contact_points(&self, lane: LaneHandle) -> Option<Vec<ContactPoint>> {
        let member = self.lanes.iter().position(|&it| it == lane)?;
        Some(self.group.contact_points(member))
    }

    pub fn lanes(&self) -> &[LaneHandle] {
        &self.lanes
    }

    /// Begins a tick, in which all batches have begun.
    pub fn begin_tick(&mut self, groups: &mut [Group]) {
        let Self { lanes, members, group } = self;
        group.set_members(members, &mut Lanes { lanes, groups });
    }

    /// Begins a substep, before any batch integrates.
    pub fn begin_substep(&mut self, groups: &mut [Group]) {
        let Self { lanes, group, .. } = self;
        group.begin_substep(&mut Lanes { lanes, groups });
    }

    /// Keeps the cloths apart, after the batches have solved their constraints.
    pub fn solve(&mut self, groups: &mut [Group]) {
        let Self { lanes, group, .. } = self;
        group.solve(&mut Lanes { lanes, groups });
    }
}

struct Lanes<'a> {
    lanes: &'a [LaneHandle],
    groups: &'a mut [Group],
}

impl GroupLanes for Lanes<'_> {
    fn lane(&mut self, member: usize) -> (&mut ClothBatch, usize) {
        let LaneHandle { group, batch, lane } = self.lanes[member];
        (&mut self.groups[group].batches[batch].batch, lane)
    }
}
