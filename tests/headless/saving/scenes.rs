//! Scenes of all that a tick reads.

use std::f32::consts::PI;
use std::time::Duration;

use bevy_bunting::prelude::*;
use bevy_bunting::{ClothSurface, CostTable, LodCosts};
use bevy_ecs::prelude::*;
use bevy_math::{Mat4, Quat, Vec3};
use bevy_transform::prelude::*;
use bunting_tests::TICK;

use super::app_with_ids::{AppWithIds, InFrames, InTicks};

/// Tick in which the pole of the sheets at rest begins to move.
pub const POLE_MOVES: f32 = 1280.0;

/// A flag.
const FLAG: ClothMesh = ClothMesh::grid(17, 9, 1.5, 1.0);

/// A material that comes to rest.
const DAMPED: FabricMaterial = FabricMaterial { damping: 2.0, ..FabricMaterial::COTTON };

fn swings(time: f32) -> Transform {
    let at = Vec3::new((3.0 * time).sin(), 2.0 + 0.2 * (7.0 * time).cos(), 0.4 * time);
    Transform::from_translation(at).with_rotation(Quat::from_rotation_y((2.0 * time).sin()))
}

fn goes_round(time: f32) -> Transform {
    Transform::from_xyz(1.2 * (1.5 * time).cos(), -0.4, 1.2 * (1.5 * time).sin())
}

fn comes_near(time: f32) -> Transform {
    Transform::from_xyz(0.0, 0.0, 14.0 - 6.0 * time)
}

/// Flags on poles that are moved in ticks and in frames.
pub fn moving_targets(app: &mut AppWithIds) -> Vec<Entity> {
    let poles = [
        app.spawn((Transform::default(), InTicks(swings))),
        app.spawn((Transform::default(), InFrames(swings))),
    ];
    let inertia = ClothInertia { max_speed: 2.0, ..ClothInertia::new(0.3, 0.5) };
    let mut flags: Vec<Entity> = poles
        .iter()
        .map(|&pole| {
            app.spawn((FLAG, Attachment::new(pole, ClothEdge::Left), ClothSurface::default()))
        })
        .collect();
    flags.push(app.spawn((FLAG, Attachment::new(poles[0], ClothEdge::Left), inertia)));
    flags
}

/// Flags in gusts, in a region, behind a vehicle, and near a blast.
pub fn gusts(app: &mut AppWithIds) -> Vec<Entity> {
    app.spawn(WindField::steady(Vec3::new(5.0, 0.0, 1.0)).with_gusts(3.0, 0.7, 5));
    let draught = WindField::steady(4.0 * Vec3::Z).with_gusts(2.0, 1.0, 3);
    app.spawn((
        draught,
        WindRegion::cuboid(Vec3::splat(2.0), 1.0),
        Transform::from_xyz(2.0, 0.0, 0.0),
    ));
    app.spawn((WindWake::new(6.0), Transform::default(), InTicks(goes_round)));
    app.spawn((
        WindBlast { age: -0.9, ..WindBlast::new(40.0, 2.0) },
        Transform::from_xyz(-3.0, 0.0, 1.0),
    ));
    let flag =
        |at: f32| (FLAG, Attachment::in_place(ClothEdge::Left), Transform::from_xyz(at, 0.0, 0.0));
    let mut flags: Vec<Entity> = (0..11).map(|index| app.spawn(flag(0.4 * index as f32))).collect();
    flags.push(app.spawn((flag(-1.0), WindPerParticle)));
    flags
}

/// A sheet and a net that fall on colliders, one of which moves and two of which report.
pub fn colliders(app: &mut AppWithIds) -> Vec<Entity> {
    app.spawn((
        ClothCollider::cuboid(Vec3::new(3.0, 0.5, 3.0)),
        Transform::from_xyz(0.0, -1.5, 0.0),
    ));
    let ball = ClothCollider { features: true, ..ClothCollider::ball(0.3) };
    app.spawn((ball, Transform::default(), InTicks(goes_round), ClothReactions::default()));
    app.spawn((
        ClothCollider::capsule(0.4, 0.15),
        Transform::from_xyz(0.2, -0.6, -0.8),
        ClothReactions::default(),
    ));
    let lies = |x: f32, z: f32| {
        Transform::from_xyz(x, 0.0, z).with_rotation(Quat::from_rotation_x(0.5 * PI))
    };
    let net = ClothMesh::triangles(
        (0..25).map(|at| Vec3::new((at % 5) as f32, -(at / 5) as f32, 0.0) * 0.2).collect(),
        (0..16)
            .map(|cell| cell / 4 * 5 + cell % 4)
            .flat_map(|at| [at, at + 5, at + 1, at + 1, at + 5, at + 6])
            .collect(),
        Vec::new(),
    );
    vec![
        app.spawn((ClothMesh::grid(17, 17, 1.0, 1.0), lies(-0.3, -0.3), ClothSurface::default())),
        app.spawn((net, ClothResolution::Particles(90), lies(0.0, -0.1))),
    ]
}

/// A cape that two joints lead, one in ticks and one in frames.
pub fn skins(app: &mut AppWithIds) -> Vec<Entity> {
    const COUNT: usize = 13;
    fn shrugs(time: f32) -> Transform {
        let at = Vec3::new(1.0 - 0.1 * (4.0 * time).sin().abs(), 0.1 * (6.0 * time).sin(), 0.0);
        Transform::from_translation(at).with_rotation(Quat::from_rotation_x(0.3 * time.sin()))
    }
    fn nods(time: f32) -> Transform {
        Transform::from_rotation(Quat::from_rotation_x(0.4 * (5.0 * time).sin()))
    }
    let hips = app.spawn((Transform::default(), InTicks(swings)));
    let joints = [
        app.spawn((Transform::default(), InFrames(nods), ChildOf(hips))),
        app.spawn((Transform::from_xyz(1.0, 0.0, 0.0), InTicks(shrugs), ChildOf(hips))),
    ];
    let poses = [Mat4::IDENTITY, Mat4::from_translation(Vec3::NEG_X)];
    let vertices = (0..COUNT * COUNT).map(|vertex| {
        let part = (vertex % COUNT) as f32 / (COUNT - 1) as f32;
        ([0, 1, 0, 0], [1.0 - part, part, 0.0, 0.0])
    });
    let skin = ClothSkin::new(joints.into_iter().zip(poses)).with_vertices(vertices);
    let cape = ClothMesh::grid(COUNT as u32, COUNT as u32, 1.0, 1.0);
    let held = Attachment::new(hips, ClothEdge::Top);
    let limits = SkinLimits { max_distance: 0.3.into(), ..SkinLimits::default() };
    vec![
        app.spawn((cape.clone(), held.clone(), skin.clone(), ClothSurface::default())),
        app.spawn((cape, held, skin, limits)),
    ]
}

/// Flags whose levels change as a viewer comes near, by distance and by a budget.
pub fn levels(app: &mut AppWithIds) -> Vec<Entity> {
    app.world_mut().resource_mut::<ClothBudget>().costs = LodCosts::Fixed(CostTable::default());
    app.spawn(WindField::steady(Vec3::new(4.0, 0.0, 1.0)));
    app.spawn((LodViewer::default(), comes_near(0.0), InTicks(comes_near)));
    let by_distance = (0..4).map(|index| (LodSet::new([8.0 + index as f32, 12.0]), index));
    let by_budget = (4..9).map(|index| (LodSet::automatic(3), index));
    let flags = by_distance.chain(by_budget).map(|(levels, index)| {
        let place = Transform::from_xyz(0.3 * index as f32, 0.0, -0.5 * index as f32);
        let held = Attachment::in_place(ClothEdge::Left);
        app.spawn((FLAG, levels, held, place, ClothSurface::default()))
    });
    flags.collect()
}

/// The scene of [`levels`] with a budget below the cost of all coarsest levels: some flags are held still.
pub fn little_time(app: &mut AppWithIds) -> Vec<Entity> {
    let flags = levels(app);
    app.world_mut().resource_mut::<ClothBudget>().tick = Duration::from_micros(30);
    flags
}

/// Sheets that fall on one another and on themselves.
pub fn layers(app: &mut AppWithIds) -> Vec<Entity> {
    app.spawn((
        ClothCollider::cuboid(Vec3::new(2.0, 0.5, 2.0)),
        Transform::from_xyz(0.0, -0.5, 0.0),
    ));
    app.spawn((ClothCollider::ball(0.1), Transform::from_xyz(0.0, 0.1, 0.0)));
    let sheet = |size: u32, height: f32| {
        let at = Transform::from_xyz(-0.25, height, -0.25)
            .with_rotation(Quat::from_rotation_x(0.5 * PI));
        let both = (
            ClothCollision { thickness: 5e-3, levels: 1 },
            SelfCollision { thickness: 5e-3, levels: 1 },
        );
        (ClothMesh::grid(size, size, 0.5, 0.5), ClothMaterial(DAMPED), at, both)
    };
    let mut sheets = vec![app.spawn(sheet(13, 0.3)), app.spawn(sheet(17, 0.25))];
    sheets.push(app.spawn((
        ClothMesh::grid(11, 21, 0.3, 0.6),
        Transform::from_xyz(0.8, 0.5, 0.0),
        SelfCollision { thickness: 4e-3, levels: 1 },
    )));
    sheets
}

/// Sheets on two poles: pinned, sprung, on a rail, and grabbed.
pub fn anchors(app: &mut AppWithIds) -> Vec<Entity> {
    fn sways(time: f32) -> Transform {
        Transform::from_xyz(1.0 + 0.1 * (4.0 * time).sin(), 0.0, 0.0)
    }
    fn pulls(time: f32) -> Transform {
        Transform::from_xyz(0.5, -1.0, 0.3 * (3.0 * time).sin())
    }
    let poles = [
        app.spawn((Transform::default(), InTicks(swings))),
        app.spawn((Transform::from_xyz(1.0, 0.0, 0.0), InFrames(sways))),
    ];
    let offset = Transform::from_xyz(-1.0, 0.0, 0.0);
    let right = Anchor::new(poses_target(poles), ClothEdge::Right).with_offset(offset);
    let sheet = ClothMesh::grid(13, 13, 1.0, 1.0);
    let held = |anchor: Anchor| Attachment::new(poles[0], ClothEdge::Left).with_anchor(anchor);
    let rail = AnchorHold::Rail {
        points: vec![Vec3::new(0.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0)],
        ring_mass: 0.02,
        friction: 0.1,
    };
    let on_rail = Anchor { hold: rail, ..Anchor::new(poles[0], ClothEdge::Top) };
    let grabbed = app.spawn((sheet.clone(), Attachment::in_place(ClothEdge::Top)));
    app.spawn((ClothGrab::within(grabbed, 0.25), pulls(0.0), InTicks(pulls)));
    vec![
        app.spawn((sheet.clone(), held(right.clone()), AnchorReactions::default())),
        app.spawn((sheet.clone(), held(right.with_stiffness(60.0)), AnchorReactions::default())),
        app.spawn((
            sheet,
            Attachment::new(poles[0], AttachedVertices::List(Vec::new())).with_anchor(on_rail),
        )),
        grabbed,
    ]
}

/// The second pole, on which right edges are held.
fn poses_target(poles: [Entity; 2]) -> Entity {
    poles[1]
}

/// Sheets that come to rest one after the other, and a pole that moves late.
pub fn rest(app: &mut AppWithIds) -> Vec<Entity> {
    fn waits(time: f32) -> Transform {
        Transform::from_xyz(3.0, 0.5 * (time - POLE_MOVES * TICK).max(0.0), 0.0)
    }
    app.spawn((ClothCollider::ball(0.2), Transform::from_xyz(9.0, 3.0, 0.0)));
    let pole = app.spawn((Transform::default(), InTicks(waits)));
    let sheet = |damping: f32| {
        let material = ClothMaterial(FabricMaterial { damping, ..FabricMaterial::COTTON });
        (ClothMesh::grid(9, 9, 1.0, 1.0), material)
    };
    let swings = Transform::from_rotation(Quat::from_rotation_x(0.2));
    vec![
        app.spawn((sheet(2.0), Attachment::in_place(ClothEdge::Top), swings)),
        app.spawn((
            sheet(2.5),
            Attachment::in_place(ClothEdge::Top),
            Transform { translation: 2.0 * Vec3::X, ..swings },
        )),
        app.spawn((sheet(2.0), Attachment::new(pole, ClothEdge::Top))),
    ]
}
