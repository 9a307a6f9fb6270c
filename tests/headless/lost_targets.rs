//! Tests that a cloth that loses a target lets go what hung on that target only.

use bevy_app::prelude::*;
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{Seen, app, assert_finite, greatest, run, state, stretches};

/// Columns of a banner of 2 × 0.5 m.
const COLUMNS: usize = 33;

/// Greatest distance of a held vertex from its place on its target, m: rounding.
const TOLERANCE: f32 = 1e-5;

/// A banner on three masts: its left edge on the first, its right corners on the others.
struct Banner {
    app: App,
    masts: [Entity; 3],
    cloth: Entity,
}

impl Banner {
    fn new(offset: Transform) -> Self {
        let mut app = app();
        let mut mast = |at: Vec3| app.world_mut().spawn(Transform::from_translation(at)).id();
        let masts = [mast(Vec3::ZERO), mast(2.0 * Vec3::X), mast(2.0 * Vec3::X)];
        let corners = [ClothCorner::TopRight, ClothCorner::BottomRight];
        let anchor = |(mast, corner): (Entity, ClothCorner)| {
            Anchor::new(mast, corner).with_offset(Transform::from_xyz(-2.0, 0.0, 0.0))
        };
        let own = Attachment::new(masts[0], ClothEdge::Left).with_offset(offset);
        let attachment = Attachment {
            on_lost: TargetLost::Release,
            anchors: masts[1..].iter().copied().zip(corners).map(anchor).collect(),
            ..own
        };
        let size = Vec3::new(2.0, 0.5, 1.0) / offset.scale;
        let mesh = ClothMesh::grid(COLUMNS as u32, 9, size.x, size.y);
        let finest = LodSet { pinned: Some(0), ..LodSet::default() };
        let cloth = app.world_mut().spawn((mesh, attachment, finest)).id();
        run(&mut app, 30);
        Self { app, masts, cloth }
    }

    /// Despawns masts, and runs a second.
    fn lose(&mut self, masts: &[usize]) {
        for &mast in masts {
            let mast = self.masts[mast];
            self.app.world_mut().despawn(mast);
        }
        run(&mut self.app, 64);
        assert_finite(&self.app, self.cloth);
        assert_eq!(self.app.world().resource::<Seen<ClothFailed>>().0.len(), 0, "no error");
    }

    /// Positions in the world of the corners on the left, and on the right: upper and lower.
    fn corners(&self) -> [Vec3; 4] {
        let frame = self.app.world().get::<GlobalTransform>(self.cloth).expect("a transform");
        let positions = state(&self.app, self.cloth).positions();
        let lower = positions.len() - COLUMNS;
        [0, lower, COLUMNS - 1, positions.len() - 1].map(|at| frame.transform_point(positions[at]))
    }

    /// Whether the loss of masts was announced, of each once, and of no others.
    fn has_lost(&self, masts: &[Entity]) -> bool {
        let lost = &self.app.world().resource::<Seen<ClothTargetLost>>().0;
        let is_lost = |mast: &Entity| lost.iter().filter(|it| it.target == *mast).count() == 1;
        lost.len() == masts.len() && masts.iter().all(is_lost)
    }
}

#[test]
fn anchors_hold_without_the_attachments_own_target() {
    let mut banner = Banner::new(Transform::IDENTITY);
    banner.lose(&[0]);
    assert!(banner.has_lost(&banner.masts[..1]));
    let [left, _, upper, lower] = banner.corners();
    assert!(left.y < -0.5, "it falls: {left}");
    assert!(upper.distance(2.0 * Vec3::X) < TOLERANCE, "{upper}");
    assert!(lower.distance(Vec3::new(2.0, -0.5, 0.0)) < TOLERANCE, "{lower}");
    // The anchors are followed still.
    for mast in [1, 2] {
        let mast = banner.masts[mast];
        banner.app.world_mut().entity_mut(mast).insert(Transform::from_xyz(2.0, 0.2, 0.0));
    }
    run(&mut banner.app, 128);
    let upper = banner.corners()[2];
    assert!(upper.distance(Vec3::new(2.0, 0.2, 0.0)) < TOLERANCE, "{upper}");
}

#[test]
fn each_target_that_is_lost_lets_go_its_own_vertices() {
    let mut banner = Banner::new(Transform::IDENTITY);
    banner.lose(&[0, 1]);
    assert!(banner.has_lost(&banner.masts[..2]));
    let [left, _, upper, lower] = banner.corners();
    assert!(left.y < -0.5, "it falls: {left}");
    assert!(lower.distance(Vec3::new(2.0, -0.5, 0.0)) < TOLERANCE, "{lower}");
    assert!(upper.distance(2.0 * Vec3::X) > 0.1, "it falls: {upper}");
    banner.lose(&[2]);
    assert!(banner.has_lost(&banner.masts));
    assert!(banner.app.world().get::<Attachment>(banner.cloth).is_none());
    let lower = banner.corners()[3];
    assert!(lower.y < -2.0, "it falls: {lower}");
}

#[test]
fn anchors_that_are_lost_together_leave_the_attachments_own_target() {
    let mut banner = Banner::new(Transform::IDENTITY);
    banner.lose(&[1, 2]);
    assert!(banner.has_lost(&banner.masts[1..]));
    let [left, _, upper, _] = banner.corners();
    assert!(left.distance(Vec3::ZERO) < TOLERANCE, "{left}");
    assert!(upper.y < -0.5, "it falls: {upper}");
}

#[test]
fn a_released_cloth_keeps_its_size() {
    for lost in [&[0][..], &[0, 1, 2]] {
        let mut banner = Banner::new(Transform::from_scale(Vec3::new(2.0, 2.0, 1.0)));
        let width = |banner: &Banner| {
            let fabric = state(&banner.app, banner.cloth).fabric().expect("a fabric");
            fabric.rest_positions()[COLUMNS - 1].distance(fabric.rest_positions()[0])
        };
        assert_eq!(width(&banner), 2.0);
        banner.lose(lost);
        assert_eq!(width(&banner), 2.0);
        let most = greatest(stretches(&banner.app, banner.cloth));
        assert!(most < 1.1, "{most}");
    }
}
