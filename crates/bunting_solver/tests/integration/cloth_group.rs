//! Tests of contacts of cloths with one another.

use std::f32::consts::TAU;
use std::sync::Arc;

use bunting_solver::{
    ClothBatch, ClothGroup, ClothSnapshot, Drive, Fabric, FabricBuilder, FabricMaterial,
    FrameMotion, Grid, GroupLanes, GroupMember, LaneCount, StepSettings,
};
use glam::{Quat, Vec3};

use crate::common::{free_tube, longest_link};

const TICK: f32 = 1.0 / 60.0;
const SETTINGS: StepSettings = StepSettings { passes: 2, ..StepSettings::yarns(2) };
/// Distance of cloths, m.
const THICKNESS: f32 = 5e-3;

/// Cloths in a batch each.
struct Batches(Vec<ClothBatch>);

impl GroupLanes for Batches {
    fn lane(&mut self, member: usize) -> (&mut ClothBatch, usize) {
        (&mut self.0[member], 0)
    }
}

impl Batches {
    /// Advances by a tick.
    fn step(&mut self, group: &mut ClothGroup, members: &[GroupMember]) {
        self.0.iter_mut().for_each(|batch| batch.begin_tick(TICK, SETTINGS));
        group.set_members(members, self);
        for _ in 0..SETTINGS.substeps {
            group.begin_substep(self);
            self.0.iter_mut().for_each(ClothBatch::integrate);
            self.0.iter_mut().for_each(ClothBatch::solve_constraints);
            group.solve(self);
            self.0.iter_mut().for_each(ClothBatch::update_velocities);
        }
    }

    fn positions(&self, cloth: usize) -> Vec<Vec3> {
        let mut positions = Vec::new();
        self.0[cloth].copy_positions(0, &mut positions);
        positions
    }
}

/// The frame of the world.
const HERE: (Vec3, Quat) = (Vec3::ZERO, Quat::IDENTITY);

/// A sheet of half a metre in the plane y = 0 of its frame.
fn sheet(particles: u32, is_held: bool) -> (Arc<Fabric>, ClothSnapshot) {
    let mut grid = FabricBuilder::grid(Grid::new(particles, particles, 0.5, 0.5));
    if is_held {
        grid = grid.pin_where(|_, uv| uv.x == 0.0 || uv.x == 1.0 || uv.y == 0.0 || uv.y == 1.0);
    }
    let fabric = Arc::new(grid.build().expect("a good fabric"));
    let mut start = ClothSnapshot::at_rest(&fabric);
    start.positions.iter_mut().for_each(|at| *at = Vec3::new(at.x, 0.0, -at.y));
    (fabric, start)
}

fn batch(
    (fabric, start): &(Arc<Fabric>, ClothSnapshot),
    material: FabricMaterial,
    lanes: LaneCount,
    frame: (Vec3, Quat),
) -> ClothBatch {
    let mut batch = ClothBatch::new(Arc::clone(fabric), lanes);
    let mut start = start.clone();
    start.positions.iter_mut().for_each(|at| *at = frame.1.inverse() * (*at - frame.0));
    let lane = batch.insert(&start, material).expect("a good cloth");
    let gravity = frame.1.inverse() * (-9.81 * Vec3::Y);
    batch.drive(lane, Drive { gravity, ..Drive::NONE }).expect("a good drive");
    batch
}

fn member(frame: (Vec3, Quat)) -> GroupMember {
    GroupMember {
        thickness: THICKNESS,
        memberships: 1,
        filters: 1,
        start: frame,
        motion: FrameMotion::NONE,
        carrier: Vec3::ZERO,
    }
}

/// The frame of the lower sheet, whose pins are in its own plane: xy.
fn lying() -> (Vec3, Quat) {
    (Vec3::ZERO, Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2))
}

/// Lets a sheet fall on one of another fabric, material, frame and width, whose border is held. Returns the positions of
/// both in the world.
fn fall(lanes: LaneCount, filters: u32) -> [Vec<Vec3>; 2] {
    let (lower, upper) = (sheet(17, true), sheet(13, false));
    let turned = (Vec3::new(3.0, -1.0, 2.0), Quat::from_rotation_y(0.6));
    let frames = [lying(), turned];
    let mut upper = upper;
    upper.1.positions.iter_mut().for_each(|at| *at += Vec3::new(0.013, 0.03, 0.017));
    let held = ClothSnapshot::at_rest(&lower.0);
    let mut low = ClothBatch::new(Arc::clone(&lower.0), lanes);
    low.insert(&held, FabricMaterial::COTTON).expect("a good cloth");
    let gravity = frames[0].1.inverse() * (-9.81 * Vec3::Y);
    low.drive(0, Drive { gravity, ..Drive::NONE }).expect("a good drive");
    let silk = FabricMaterial { area_density: 0.06, ..FabricMaterial::FLAG_POLYESTER };
    let mut batches = Batches(vec![low, batch(&upper, silk, LaneCount::One, frames[1])]);
    let mut members = frames.map(member);
    members[1].filters = filters;
    let mut group = ClothGroup::default();
    for _ in 0..90 {
        batches.step(&mut group, &members);
    }
    [0, 1].map(|cloth| {
        let (origin, turn) = frames[cloth];
        batches.positions(cloth).iter().map(|&at| origin + turn * at).collect()
    })
}

/// Heights of the upper sheet's particles over the nearest ones of the lower sheet, m.
fn heights([lower, upper]: &[Vec<Vec3>; 2]) -> Vec<f32> {
    let over = |at: &Vec3| {
        let flat = |it: &Vec3| (it.x - at.x).powi(2) + (it.z - at.z).powi(2);
        let nearest = lower.iter().min_by(|a, b| flat(a).total_cmp(&flat(b))).expect("a particle");
        at.y - nearest.y
    };
    upper.iter().map(over).collect()
}

fn median(mut values: Vec<f32>) -> f32 {
    values.sort_by(f32::total_cmp);
    values[values.len() / 2]
}

#[test]
fn a_sheet_comes_to_rest_on_another_if_their_layers_touch() {
    let on = median(heights(&fall(LaneCount::One, 1)));
    assert!((0.5 * THICKNESS..1.5 * THICKNESS).contains(&on), "{on}");
    let through = median(heights(&fall(LaneCount::One, 2)));
    assert!(through < -1.0, "{through}");
}

#[test]
fn cloths_have_the_same_bits_at_every_width() {
    let bits = |lanes| {
        fall(lanes, 1).map(|sheet| -> Vec<[u32; 3]> {
            sheet.iter().map(|at| at.to_array().map(f32::to_bits)).collect()
        })
    };
    let one = bits(LaneCount::One);
    for &lanes in LaneCount::available() {
        assert!(bits(lanes) == one, "{lanes:?}");
    }
}

#[test]
fn contacts_turn_a_flag_about_its_pole_no_faster_than_it_falls() {
    let held = sheet(17, true);
    let grid = FabricBuilder::grid(Grid::new(13, 13, 0.4, 0.4));
    let fabric = grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric");
    let mut start = ClothSnapshot::at_rest(&fabric);
    // The flag is level, with its pole above one side of the sheet, and swings down.
    let level = |at: &Vec3| Vec3::new(at.x + 0.05, 0.05, -at.y);
    start.positions = start.positions.iter().map(level).collect();
    let flag = (Arc::new(fabric), start);
    let frames = [lying(), (Vec3::new(0.05, 0.05, 0.0), lying().1)];
    let material = FabricMaterial::FLAG_POLYESTER;
    let mut batches = Batches(vec![
        batch(&held, material, LaneCount::One, frames[0]),
        batch(&flag, material, LaneCount::One, frames[1]),
    ]);
    let members = frames.map(member);
    let mut group = ClothGroup::default();
    let mut fastest = 0.0_f32;
    for _ in 0..120 {
        batches.step(&mut group, &members);
        let velocities = batches.0[1].snapshot(0).velocities;
        fastest = velocities.iter().fold(fastest, |most, velocity| most.max(velocity.length()));
    }
    assert!(fastest < 1.5, "{fastest} m/s, and 1.0 m/s by a fall of 5 cm");
}

/// Greatest distance of a particle from the pin of its column of 13 × 13, over that at rest.
fn drawn_out(fabric: &Fabric, at: &[Vec3]) -> f32 {
    let rest = fabric.rest_positions();
    let free = (0..rest.len()).filter(|&particle| !fabric.is_pinned(particle));
    let part = |particle: usize| at[particle].distance(at[particle % 13]) / -rest[particle].y;
    free.map(part).fold(0.0, f32::max)
}

/// A sheet on a vehicle turns and drives through another, such that the held edges of both cross.
#[test]
fn held_edges_that_cross_leave_cloths_whole() {
    /// How far cloths may be drawn out while the edges cross, where they cannot give way (34 %), and when these are apart (1 %).
    const CROSSING: f32 = 1.4;
    const APART: f32 = 1.05;
    let grid = FabricBuilder::grid(Grid::new(13, 13, 1.0, 1.0));
    let fabric = Arc::new(grid.pin_where(|at, _| at.y == 0.0).build().expect("a good fabric"));
    let mut behind = ClothSnapshot::at_rest(&fabric);
    behind.positions.iter_mut().for_each(|at| at.z += 0.03);
    let starts = [ClothSnapshot::at_rest(&fabric), behind];
    let sheet =
        |start| batch(&(Arc::clone(&fabric), start), FabricMaterial::COTTON, LaneCount::One, HERE);
    let mut batches = Batches(starts.map(sheet).into());
    let mut group = ClothGroup::default();
    let pose = |tick: usize| {
        let time = tick as f32 * TICK;
        (Vec3::new(2.0, 0.0, 1.0) * time, Quat::from_rotation_y(-time))
    };
    let mut farthest = [0.0; 2];
    for tick in 0..30 {
        let motion = FrameMotion::between(pose(tick), pose(tick + 1));
        let gravity = pose(tick + 1).1.inverse() * (-9.81 * Vec3::Y);
        batches.0[0].drive(0, Drive { gravity, motion, ..Drive::NONE }).expect("a good drive");
        let vehicle = GroupMember { motion, ..member(pose(tick)) };
        batches.step(&mut group, &[vehicle, member(HERE)]);
        let are_finite = |cloth: usize| batches.positions(cloth).iter().all(|at| at.is_finite());
        assert!(are_finite(0) && are_finite(1), "tick {tick}");
        farthest = [0, 1].map(|cloth| drawn_out(&fabric, &batches.positions(cloth)));
        assert!(farthest.iter().all(|it| *it < CROSSING), "tick {tick}: {farthest:?}");
    }
    assert!(farthest.iter().all(|it| *it < APART), "{farthest:?}");
}

/// A tube with its axis along x from the origin on: some particles around it, some along it, its radius, its length, m, and the vertices
/// that are pinned.
fn tube(
    [around, along]: [u32; 2],
    [radius, length]: [f32; 2],
    pinned: impl IntoIterator<Item = u32>,
) -> Arc<Fabric> {
    let upright = free_tube(around, radius, along - 1, length);
    let tube = upright.placed(Quat::from_rotation_z(-0.25 * TAU), Vec3::ZERO).pin(pinned);
    Arc::new(tube.build().expect("a good fabric"))
}

/// Two sleeves hang such that they pass through each other, and so do their pins, for ever.
#[test]
fn sleeves_that_begin_crossed_come_apart_without_shaking() {
    let fabric = tube([20, 17], [0.08, 0.5], 0..20);
    let hangs = Quat::from_rotation_z(-0.25 * TAU);
    let frames = [(Vec3::ZERO, hangs), (Vec3::new(0.15, 0.0, 0.0), hangs)];
    let sleeve = |(place, turn): (Vec3, Quat)| {
        let mut start = ClothSnapshot::at_rest(&fabric);
        start.positions.iter_mut().for_each(|at| *at = place + turn * *at);
        batch(&(Arc::clone(&fabric), start), FabricMaterial::COTTON, LaneCount::One, (place, turn))
    };
    let mut batches = Batches(frames.map(sleeve).into());
    let members = frames.map(member);
    let mut group = ClothGroup::default();
    let (mut fastest, mut last) = (0.0_f32, 0.0);
    for _ in 0..150 {
        batches.step(&mut group, &members);
        let velocities = [0, 1].map(|cloth| batches.0[cloth].snapshot(0).velocities);
        last = velocities.iter().flatten().map(|it| it.length()).fold(0.0, f32::max);
        fastest = fastest.max(last);
    }
    assert!(fastest < 2.0, "{fastest} m/s");
    assert!(last < 0.5, "{last} m/s after 2.5 s");
}

/// A tube hangs at a ring that is drawn through another tube, whose rim it cannot pass without creases.
#[test]
fn cloth_that_is_drawn_through_something_narrow_stays_whole() {
    const SPEED: f32 = 1.0;
    let outer = tube([24, 21], [0.06, 0.6], (0..24).chain(480..504));
    let inner = tube([14, 25], [0.03, 0.7], 336..350);
    let pose = |tick: usize| (Vec3::X * (SPEED * TICK * tick as f32 - 0.75), Quat::IDENTITY);
    let at_rest = |fabric: &Arc<Fabric>| {
        let start = ClothSnapshot::at_rest(fabric);
        batch(&(Arc::clone(fabric), start), FabricMaterial::COTTON, LaneCount::One, HERE)
    };
    let mut batches = Batches(vec![at_rest(&outer), at_rest(&inner)]);
    let mut group = ClothGroup::default();
    let mut longest = 0.0_f32;
    for tick in 0..90 {
        let motion = FrameMotion::between(pose(tick), pose(tick + 1));
        let drive = Drive { motion, ..Drive::default() };
        batches.0[1].drive(0, drive).expect("a good drive");
        batches.step(&mut group, &[member(HERE), GroupMember { motion, ..member(pose(tick)) }]);
        longest = longest.max(longest_link(&inner, &batches.positions(1)));
    }
    assert!(longest < 4.5, "{longest} of the length at rest");
}
