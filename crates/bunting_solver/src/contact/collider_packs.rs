//! Colliders of one kind in the lanes of a batch, and the particles near them.

use core::ops::Range;

use crate::constants::LEAST_LENGTH;
use crate::contact::lane_shapes::{Affine, AffinePacks, Kind, ShapePacks};
use crate::contact::reach::LONGER;
use crate::contact::substep::Contact;
use crate::contact::triangles::LaneTriangles;
use crate::simd::lane::{Kernel, Lane, Mask, Pack};
use crate::simd::vec3::{Pack3, V3};

/// Part of the clearance by which a particle may be farther from a shape than it must be and touches it. Larger: particles that a shape hits
/// are pushed along the plane that was nearest before, though they enter it through another one. Smaller: by rounding, particles that are
/// pressed against a shape count as entering it, and are solved one by one.
const TOUCHING: f32 = 0.1;

/// A collider of a cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Member {
    /// Index of the cloth in the batch.
    pub cloth: usize,
    /// Index of the collider among the cloth's.
    pub collider: usize,
}

/// Colliders of one kind, at most one in each lane, and the particles near them.
#[derive(Clone, Debug)]
pub(crate) struct ColliderPacks<P: Pack> {
    /// Index of the colliders among those of their cloths, and their kind. Sets are solved in this order.
    pub key: (usize, Kind),
    pub members: Vec<Member>,
    pub near: Vec<NearPack<P>>,
    /// For each pack of the batch, its index in `near`, or [`NOT_NEAR`].
    places: Vec<u32>,
    shape: ShapePacks<P>,
    /// The triangles near the particles, of colliders that consist of triangles.
    pub(super) triangles: Option<LaneTriangles<P>>,
    /// From the cloth's frame into the collider's, at the start and at the end of the substep.
    pub(super) into_collider: [AffinePacks<P>; 2],
    /// From the collider's frame into the cloth's, at the end of the substep.
    pub(super) into_cloth: AffinePacks<P>,
    /// From a point in the collider's frame to its motion in the substep.
    pub(super) into_motion: AffinePacks<P>,
    clearance: P,
    friction: P,
    /// The substep that has begun, counted from one.
    substep: u32,
    /// One in lanes whose contacts are solved here, zero in others.
    pub solved: P,
    /// Square of the longest push along a surface in each lane, m².
    longest: P,
}

const NOT_NEAR: u32 = u32::MAX;

/// Particles that may touch a collider.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearPack<P: Pack> {
    /// Index of the pack.
    pub pack: u32,
    /// One in lanes whose particle may touch the lane's collider, zero in others.
    active: P,
    /// What each particle does.
    touch: P,
    /// What the collider has pushed the particles in this substep, m, in the cloth's frame.
    pub pushed: Pack3<P>,
    /// Unit normals of the surface where the particles touch, in the collider's frame.
    pub normal: Pack3<P>,
    /// Sizes of the accelerations by the steady parts of the pushes, m/s².
    pub steady: P,
    /// Changes of velocity by the pushes, m/s, of which the collider feels the opposite.
    pub gained: Pack3<P>,
}

/// What a particle does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LaneTouch {
    None,
    /// It is pushed along the surface.
    Slides,
    /// It enters the shape or is in it, and must be looked at by itself.
    Enters,
}

/// [`LaneTouch`] as numbers in lanes.
const SLIDES: f32 = 1.0;
const ENTERS: f32 = 2.0;

impl<P: Pack> NearPack<P> {
    fn new(pack: u32) -> Self {
        let zero = P::splat(0.0);
        Self {
            pack,
            active: zero,
            touch: zero,
            pushed: [zero; 3],
            normal: [zero; 3],
            steady: zero,
            gained: [zero; 3],
        }
    }

    pub(super) fn touch(&self, lane: usize) -> LaneTouch {
        match self.touch.lanes()[lane] {
            SLIDES => LaneTouch::Slides,
            ENTERS => LaneTouch::Enters,
            _ => LaneTouch::None,
        }
    }
}

/// The lanes of a pack whose particles slide.
#[inline(always)]
pub(super) fn slides<L: Lane>(token: L::Token, near: &NearPack<L::Pack>) -> L::Mask {
    let touch = L::load(token, &near.touch);
    L::splat(token, 0.0).lt(touch) & touch.lt(L::splat(token, ENTERS))
}

impl<P: Pack> ColliderPacks<P> {
    /// An empty set in a batch of a number of packs.
    pub fn new(key: (usize, Kind), pack_count: usize) -> Self {
        let zero = P::splat(0.0);
        Self {
            key,
            members: Vec::new(),
            near: Vec::new(),
            places: vec![NOT_NEAR; pack_count],
            shape: ShapePacks::new(key.1),
            triangles: (key.1 == Kind::Triangles).then(LaneTriangles::new),
            into_collider: [AffinePacks::zero(); 2],
            into_cloth: AffinePacks::zero(),
            into_motion: AffinePacks::zero(),
            clearance: zero,
            friction: zero,
            substep: 0,
            solved: zero,
            longest: zero,
        }
    }

    /// Adds a particle that may touch the collider of its lane. Returns the index of its pack among those near the collider.
    pub fn add(&mut self, (pack, lane): (usize, usize)) -> usize {
        let place = &mut self.places[pack];
        if *place == NOT_NEAR {
            *place = self.near.len() as u32;
            self.near.push(NearPack::new(pack as u32));
        }
        let index = *place as usize;
        self.near[index].active.lanes_mut()[lane] = 1.0;
        index
    }

    /// The particles of a pack that has been added.
    pub fn of_pack(&self, pack: usize) -> &NearPack<P> {
        &self.near[self.places[pack] as usize]
    }

    /// Writes a collider into the lanes of its cloth.
    pub(super) fn fill(&mut self, lanes: &Range<usize>, contact: &Contact) {
        self.substep = contact.substep();
        if self.triangles.is_none()
            && let Some(form) = contact.closed_form()
        {
            self.shape.fill(lanes, form);
        }
        let changes = contact.to_collider();
        for (packs, change) in self.into_collider.iter_mut().zip(changes) {
            packs.fill(lanes, change);
        }
        self.into_cloth.fill(lanes, &contact.to_cloth());
        self.into_motion.fill(lanes, &contact.to_motion());
        self.clearance.lanes_mut()[lanes.clone()].fill(contact.clearance());
        self.friction.lanes_mut()[lanes.clone()].fill(contact.friction());
    }

    /// The longest push along a surface in some lanes, m.
    pub fn longest_push(&self, lanes: Range<usize>) -> f32 {
        self.longest.lanes()[lanes].iter().fold(0.0_f32, |most, &of_lane| most.max(of_lane)).sqrt()
    }

    /// Whether a particle of some lanes enters its collider, or is in it.
    pub fn enters(&self, lanes: Range<usize>) -> bool {
        let enters = |near: &NearPack<P>| near.touch.lanes()[lanes.clone()].contains(&ENTERS);
        self.near.iter().any(enters)
    }

    /// Forgets what the collider has pushed.
    pub fn forget_pushes(&mut self) {
        self.near.iter_mut().for_each(|near| near.pushed = [P::splat(0.0); 3]);
    }

    /// Moves particles out of the colliders, from where they would be without the pushes of this substep so far, with friction.
    /// Those of lanes that are not solved here, and those that enter, return there. Fills `entering` with the indices, in `near`, of packs
    /// of which a particle enters.
    pub fn press(
        &mut self,
        start: &[Pack3<P>],
        position: &mut [Pack3<P>],
        entering: &mut Vec<usize>,
    ) {
        P::run(Press { set: self, start, position, entering });
    }
}

struct Press<'a, P: Pack> {
    set: &'a mut ColliderPacks<P>,
    /// Positions at the start of the substep, m.
    start: &'a [Pack3<P>],
    position: &'a mut [Pack3<P>],
    entering: &'a mut Vec<usize>,
}

impl<P: Pack> Kernel<P> for Press<'_, P> {
    #[inline(always)]
    fn run<L: Lane<Pack = P>>(self, token: L::Token) {
        let set = self.set;
        let zero = L::splat(token, 0.0);
        let [at_start, at_end] = [
            Affine::<L>::load(token, &set.into_collider[0]),
            Affine::<L>::load(token, &set.into_collider[1]),
        ];
        let into_cloth = Affine::<L>::load(token, &set.into_cloth);
        let clearance = L::load(token, &set.clearance);
        let friction = L::load(token, &set.friction);
        let solved = L::load(token, &set.solved);
        let mut longest = zero;
        for (index, near) in set.near.iter_mut().enumerate() {
            let pack = near.pack as usize;
            let present: V3<L> = V3::load(token, &self.position[pack]);
            let end = present - V3::load(token, &near.pushed);
            let to = at_end.moved(end);
            let triangles = set.triangles.as_ref().map(|all| (all, index));
            let shapes = NearShapes { shape: &set.shape, triangles, clearance };
            let (distance, normal) = shapes.nearest(token, to);
            let depth = clearance - distance;
            let from = at_start.moved(V3::load(token, &self.start[pack]));
            let moved = to - from;
            // A convex shape lies below its planes: a path whose ends are above one does not enter the shape. Nor does a path enter other shapes
            // that is shorter than its end is far from them.
            let approach = if triangles.is_some() {
                L::splat(token, LONGER) * moved.dot(moved).sqrt()
            } else {
                normal.dot(moved)
            };
            let is_above = zero.lt(distance) & approach.lt(distance);
            let clear = zero.or_where_not(is_above & depth.lt(zero), L::load(token, &near.active));
            let touches = zero.lt(clear * solved);
            if !touches.any() {
                near.touch = P::splat(0.0);
                end.store(&mut self.position[pack]);
                near.pushed = [P::splat(0.0); 3];
                continue;
            }
            let mut push = Slide { normal, shift: slid(token, moved, normal, depth, friction) };
            let mut slides = touches & is_above;
            let entering = L::splat(token, ENTERS).or_where_not(touches, zero);
            let entering = zero.or_where_not(slides, entering);
            let enters = zero.lt(entering);
            if enters.any() {
                let start = match &mut set.triangles {
                    Some(all) => all.nearest_start(token, (index, set.substep), from, clearance),
                    None => set.shape.nearest(token, from),
                };
                let triangles = set.triangles.as_ref().map(|all| (all, index));
                let shapes = NearShapes { shape: &set.shape, triangles, clearance };
                let pressed = Pressed { start, to, moved, clearance, friction };
                let (is_pressed, other) = pressed.slide(token, &shapes);
                push = other.or_where_not(enters, push);
                slides = slides | (enters & is_pressed);
            }
            let to = (end + into_cloth.turned(push.shift)).or_where_not(slides, end);
            to.store(&mut self.position[pack]);
            let pushed = to - end;
            longest = longest.max(pushed.dot(pushed));
            pushed.store(&mut near.pushed);
            push.normal.store(&mut near.normal);
            L::splat(token, SLIDES).or_where_not(slides, entering).store(&mut near.touch);
            if (enters & L::splat(token, SLIDES).lt(L::load(token, &near.touch))).any() {
                self.entering.push(index);
            }
        }
        longest.store(&mut set.longest);
    }
}

/// The shapes near the particles of a pack.
struct NearShapes<'a, L: Lane> {
    shape: &'a ShapePacks<L::Pack>,
    /// Those of all packs, and the index of the pack among these.
    triangles: Option<(&'a LaneTriangles<L::Pack>, usize)>,
    clearance: L,
}

impl<L: Lane> NearShapes<'_, L> {
    /// Distance of points from the surface, m, and the unit normals of the nearest planes. Within a shape the distance is only known to be at most
    /// zero.
    #[inline(always)]
    fn nearest(&self, token: L::Token, at: V3<L>) -> (L, V3<L>) {
        match self.triangles {
            Some((triangles, pack)) => triangles.nearest(token, pack, at, self.clearance),
            None => self.shape.nearest(token, at),
        }
    }

    /// Whether paths from outside do not cross the surface, given the sum of the distances of their ends, m. Of surfaces with an inside the ends
    /// tell.
    #[inline(always)]
    fn stays_before(&self, token: L::Token, path: V3<L>, distances: L) -> L::Mask {
        let zero = L::splat(token, 0.0);
        let is_closed = match self.triangles {
            Some((triangles, pack)) => L::load(token, triangles.is_closed(pack)),
            None => L::splat(token, 1.0),
        };
        let length = L::splat(token, LONGER) * path.dot(path).sqrt();
        zero.lt(is_closed) | length.lt(distances)
    }
}

/// A push along a surface.
#[derive(Clone, Copy)]
struct Slide<L> {
    /// Unit normal of the surface.
    normal: V3<L>,
    /// Displacement, m.
    shift: V3<L>,
}

impl<L: Lane> Slide<L> {
    #[inline(always)]
    fn or_where_not(self, mask: L::Mask, other: Self) -> Self {
        Self {
            normal: self.normal.or_where_not(mask, other.normal),
            shift: self.shift.or_where_not(mask, other.shift),
        }
    }
}

/// The displacement, m, of a particle that has moved and is too deep by `depth`, with friction, which shortens its slide by at most its
/// coefficient times the depth (Coulomb's cone).
#[inline(always)]
fn slid<L: Lane>(token: L::Token, moved: V3<L>, normal: V3<L>, depth: L, friction: L) -> V3<L> {
    let slide = moved.minus_scaled(normal, normal.dot(moved));
    let length = slide.dot(slide).sqrt().max(L::splat(token, LEAST_LENGTH));
    let held = (friction * depth / length).min(L::splat(token, 1.0));
    (normal * depth).minus_scaled(slide, held)
}

/// Particles that touched the shape before, and are pressed into it.
struct Pressed<L> {
    /// Distances of the starts of the paths from the shape, m, and unit normals there.
    start: (L, V3<L>),
    /// Ends of the paths, in the collider's frame, m.
    to: V3<L>,
    moved: V3<L>,
    clearance: L,
    friction: L,
}

impl<L: Lane> Pressed<L> {
    /// The slide along the plane that was nearest before, and for which particles it holds: as
    /// [`Surface::project`](crate::contact::surface::Surface::project), others enter the shape from afar, or have been in it.
    #[inline(always)]
    fn slide(&self, token: L::Token, shapes: &NearShapes<L>) -> (L::Mask, Slide<L>) {
        let zero = L::splat(token, 0.0);
        let (height, normal) = self.start;
        let depth = self.clearance - (height + normal.dot(self.moved));
        let near = L::splat(token, 1.0 + TOUCHING) * self.clearance;
        let touched = zero.lt(height) & height.lt(near);
        let shift = slid(token, self.moved, normal, depth.max(zero), self.friction);
        // Beside an edge this point may lie within another face.
        let (distance, other) = shapes.nearest(token, self.to + shift);
        let stays =
            zero.lt(distance) & shapes.stays_before(token, self.moved + shift, height + distance);
        let missing = (self.clearance - distance).max(zero);
        let shift = shift.plus_scaled(other, missing);
        (touched & zero.lt(depth) & stays, Slide { normal, shift })
    }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use parry3d::shape::SharedShape;

    use super::{ColliderPacks, LaneTouch, Member};
    use crate::contact::closed_form::ClosedForm;
    use crate::contact::collider::Collider;
    use crate::contact::lane_shapes::Kind;
    use crate::contact::substep::Contact;
    use crate::fabric::FabricMaterial;
    use crate::simd::lane::Pack;
    use crate::simd::registers::Pack8;
    use crate::simd::vec3::{Pack3, lane3, set_lane3};
    use crate::step::Drive;
    use crate::step::clock::Clock;

    /// Vectors whose coordinates are between −½ and ½.
    fn places() -> impl Iterator<Item = Vec3> {
        let number = |index: i32, step: f32| (index as f32 * step).fract() - 0.5;
        let at = move |index| {
            Vec3::new(number(index, 0.618_034), number(index, 0.754_878), number(index, 0.569_84))
        };
        (1..).map(at)
    }

    /// Whatever is pushed in lanes is pushed as by itself, and nothing else that touches is left.
    #[test]
    fn lanes_push_as_single_particles_are_pushed() {
        let shapes = [
            SharedShape::ball(0.3),
            SharedShape::capsule(Vec3::new(-0.2, 0.1, 0.0), Vec3::new(0.2, 0.0, 0.1), 0.2),
            SharedShape::cuboid(0.3, 0.2, 0.25),
            SharedShape::round_cuboid(0.2, 0.2, 0.2, 0.1),
            SharedShape::cylinder(0.2, 0.3),
            SharedShape::halfspace(Vec3::new(0.0, 0.6, 0.8)),
        ];
        let material = FabricMaterial { thickness: 0.03, ..FabricMaterial::COTTON };
        let clock = Clock { begun: 1, ..Clock::default() };
        for (index, shape) in shapes.into_iter().enumerate() {
            let turn = Quat::from_rotation_x(0.3);
            let collider = Collider {
                to: (Vec3::new(0.005, 0.0, 0.01), turn * Quat::from_rotation_z(0.02)),
                ..Collider::fixed(shape, Vec3::ZERO, turn)
            };
            let drive = Drive::default();
            let contact = Contact::new(&material, &drive, &collider, &clock);
            let kind = ClosedForm::of(&*collider.shape.0).and_then(|form| Kind::of(&form));
            let mut set = ColliderPacks::<Pack8>::new((0, kind.expect("a kind")), 1);
            set.members.push(Member { cloth: 0, collider: 0 });
            set.fill(&(0..8), &contact);
            set.solved = Pack8::splat(1.0);
            for lane in 0..8 {
                set.add((0, lane));
            }
            let (mut slid, mut entered) = (0, 0);
            let mut ways = places().skip(5);
            for starts in places().take(4000).collect::<Vec<_>>().chunks(8) {
                let mut start: [Pack3<Pack8>; 1] = [[Pack8::splat(0.0); 3]];
                let mut position = start;
                for (lane, at) in starts.iter().enumerate() {
                    set_lane3(&mut start[0], lane, *at);
                    let way = 0.05 * ways.next().expect("a way");
                    set_lane3(&mut position[0], lane, *at + way);
                }
                let before = position[0];
                let mut entering = Vec::new();
                set.press(&start, &mut position, &mut entering);
                for (lane, at) in starts.iter().enumerate() {
                    let [before, after] = [&before, &position[0]].map(|pack| lane3(pack, lane));
                    let alone = contact.project(*at, before);
                    match set.near[0].touch(lane) {
                        LaneTouch::None => {
                            assert!(alone.is_none(), "{index}: {at} to {before}");
                            assert_eq!(after, before);
                        }
                        LaneTouch::Slides => {
                            slid += 1;
                            let alone = alone.expect("a push");
                            let expected = contact.pose.transform_point(alone.to);
                            let distance = after.distance(expected);
                            // At edges a particle that is pressed slides along the face that was nearest before.
                            assert!(
                                distance < 1e-5 || alone.to.distance(before) > 1e-3,
                                "{index}: {at} to {before}: {after}, not {expected}"
                            );
                            let pushed = lane3(&set.near[0].pushed, lane);
                            assert!(pushed.distance(after - before) < 1e-6);
                        }
                        LaneTouch::Enters => {
                            entered += 1;
                            assert!(entering == [0] && after == before, "{index}: {at}");
                        }
                    }
                }
                // Lanes that are not solved here return to where they would be without pushes.
                set.solved = Pack8::splat(0.0);
                set.press(&start, &mut position, &mut Vec::new());
                for lane in 0..8 {
                    let [before, after] = [&before, &position[0]].map(|pack| lane3(pack, lane));
                    assert!(before.distance(after) < 1e-6, "{index}: {before} {after}");
                }
                set.solved = Pack8::splat(1.0);
            }
            assert!(slid > 50 && entered > 50, "{index}: {slid} {entered}");
        }
    }
}
