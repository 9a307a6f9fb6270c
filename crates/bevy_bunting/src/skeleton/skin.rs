//! The skin of a cloth: which joints move which vertices.

use bevy_ecs::prelude::*;
use bevy_math::Mat4;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;

/// Default of [`ClothSkin::snap_speed`], m/s. Smaller: blows and kicks count as snaps and do not swing the cloth. Larger:
/// snaps whip it.
const SNAP_SPEED: f32 = 15.0;

/// Binds the vertices of a [`ClothMesh`](crate::ClothMesh) to the joints of a skeleton, as a skinned mesh is bound. Each
/// vertex has an *animated place*: where linear blend skinning by the joints would have it. The cloth starts there.
///
/// Pinned vertices (those of an [`Attachment`](crate::Attachment), and of weight 0, see
/// [`ClothMesh::with_weights`](crate::ClothMesh::with_weights)) follow their joints exactly. Free ones are held near their
/// places by [`SkinLimits`](crate::SkinLimits), if there are any. The cloth's frame is still the target of its
/// [`Attachment`](crate::Attachment), which should be a bone that moves as the body does, or else its own transform; its
/// anchors hold nothing. Triangles whose vertices all have weight 0 are not simulated and do not follow joints: leave them
/// to the skinned mesh.
///
/// Joints may be moved in any schedule, as by animation in `PostUpdate` before `TransformSystems::Propagate`. As the frames of
/// cloths, they are resampled at the time of each tick. Where the skin gets other joints, pins move to them within one and a
/// half seconds. A [`ClothSurface`](crate::ClothSurface) is moved to the pose of the frame that is shown, at the beginning of
/// `TransformSystems::Propagate`.
///
/// With the feature `render`, `ClothFromMesh` makes this component of Bevy's `SkinnedMesh`.
///
/// # Errors
///
/// A skin that does not fit the mesh is reported as [`ClothError::Skin`](crate::ClothError::Skin): the cloth keeps its last
/// valid skin or, if it never had one, is simulated without. A joint that is despawned is reported as [`ClothError::MissingJoint`](crate::ClothError::MissingJoint), and
/// stays where it was in the cloth's frame.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_ecs::prelude::*;
/// use bevy_math::Mat4;
/// use bevy_transform::prelude::*;
///
/// let mut world = World::new();
/// let neck = world.spawn(Transform::default()).id();
/// let cape = ClothMesh::grid(17, 17, 1.0, 1.2);
/// // All vertices follow one joint.
/// let rigid = ([0; 4], [1.0, 0.0, 0.0, 0.0]);
/// let skin = ClothSkin::new([(neck, Mat4::IDENTITY)])
///     .with_vertices(core::iter::repeat_n(rigid, cape.vertex_count()));
/// world.spawn((cape, skin, Attachment::new(neck, ClothEdge::Top)));
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothSkin {
    /// The joints.
    #[entities]
    pub joints: Vec<Entity>,
    /// For each joint the inverse of its pose when the mesh was bound to it, in the space of the mesh.
    pub inverse_bind_poses: Vec<Mat4>,
    /// For each vertex, four indices of joints.
    pub joint_indices: Vec<[u16; 4]>,
    /// For each vertex, the weights of these joints: not negative, not all zero. They are divided by their sum.
    pub joint_weights: Vec<[f32; 4]>,
    /// Change of a joint's velocity in the cloth's frame between two frames or ticks, in m/s, above which the pose has
    /// jumped: the cloth then moves along with its places, without being accelerated. A turn counts by the change of velocity
    /// of a point 1 m away.
    pub snap_speed: f32,
}

impl Default for ClothSkin {
    fn default() -> Self {
        Self::new([])
    }
}

impl ClothSkin {
    /// A skin of joints with the inverses of their bind poses, without vertices.
    #[must_use]
    pub fn new(joints: impl IntoIterator<Item = (Entity, Mat4)>) -> Self {
        let (joints, inverse_bind_poses) = joints.into_iter().unzip();
        Self {
            joints,
            inverse_bind_poses,
            joint_indices: Vec::new(),
            joint_weights: Vec::new(),
            snap_speed: SNAP_SPEED,
        }
    }

    /// The skin with vertices: for each, the indices of four joints and their weights.
    #[must_use]
    pub fn with_vertices(
        mut self,
        vertices: impl IntoIterator<Item = ([u16; 4], [f32; 4])>,
    ) -> Self {
        (self.joint_indices, self.joint_weights) = vertices.into_iter().unzip();
        self
    }

    /// Checks the skin of a mesh with this number of vertices.
    pub(crate) fn validate(&self, vertices: usize) -> Result<(), SkinError> {
        let joints = self.joints.len();
        if self.inverse_bind_poses.len() != joints {
            let poses = self.inverse_bind_poses.len();
            return Err(SkinError::BindPoses { poses, joints });
        }
        for given in [self.joint_indices.len(), self.joint_weights.len()] {
            if given != vertices {
                return Err(SkinError::Count { given, vertices });
            }
        }
        let is_bad = |pose: &Mat4| !pose.is_finite();
        if let Some(joint) = self.inverse_bind_poses.iter().position(is_bad) {
            return Err(SkinError::BindPose { joint });
        }
        for (vertex, (indices, weights)) in
            self.joint_indices.iter().zip(&self.joint_weights).enumerate()
        {
            let is_good = |weight: &f32| weight.is_finite() && *weight >= 0.0;
            if !weights.iter().all(is_good) || weights.iter().all(|&weight| weight == 0.0) {
                return Err(SkinError::Weights { vertex });
            }
            let used = indices.iter().zip(weights).filter(|&(_, &weight)| weight > 0.0);
            if let Some(joint) = used.map(|(&joint, _)| joint).find(|&it| it as usize >= joints) {
                return Err(SkinError::Joint { vertex, joint, joints });
            }
        }
        Ok(())
    }
}

/// Why a [`ClothSkin`] or its [`SkinLimits`](crate::SkinLimits) cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SkinError {
    /// The number of bind poses differs from that of joints.
    #[error("{poses} inverse bind poses for {joints} joints: give one a joint")]
    BindPoses {
        /// Number of inverse bind poses.
        poses: usize,
        /// Number of joints.
        joints: usize,
    },
    /// A bind pose is infinite or not a number.
    #[error("the inverse bind pose of joint {joint} is not finite")]
    BindPose {
        /// Index of the joint.
        joint: usize,
    },
    /// The number of joint indices or weights differs from that of the mesh's vertices.
    #[error("joint indices or weights of {given} vertices for {vertices}: give each vertex four")]
    Count {
        /// Number of vertices that the skin has indices or weights for.
        given: usize,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// A vertex is bound to a joint that is not in the list.
    #[error("vertex {vertex} is bound to joint {joint}, but there are {joints}: list all joints")]
    Joint {
        /// Index of the vertex.
        vertex: usize,
        /// Index of the joint.
        joint: u16,
        /// Number of joints.
        joints: usize,
    },
    /// The joint weights of a vertex are negative, not finite, or all zero.
    #[error("the joint weights of vertex {vertex} must be positive or zero, and not all zero")]
    Weights {
        /// Index of the vertex.
        vertex: usize,
    },
    /// A limit is not given for each vertex.
    #[error("{name} is not given for each of {vertices} vertices")]
    LimitCount {
        /// The field of `SkinLimits`.
        name: &'static str,
        /// Number of vertices of the mesh.
        vertices: usize,
    },
    /// A limit is out of range.
    #[error("{name} of vertex {vertex} is {value}, which is out of range")]
    Limit {
        /// The field of `SkinLimits`.
        name: &'static str,
        /// Index of the vertex.
        vertex: usize,
        /// The invalid number.
        value: f32,
    },
}
