//! Snapshots as bytes: what was saved comes back, and whatever else the bytes are is told.

use bevy_app::App;
use bevy_bunting::prelude::*;
use bevy_bunting::{ClothSurface, SnapshotBytesError};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::prelude::*;
use bunting_tests::{bits, run};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;

use super::beside::{app_of_its_own, assert_all_finite, mesh};
use super::for_all;

/// Where the checksum is among the bytes of a snapshot, and where the state begins.
const CHECKSUM: usize = 12;
const STATE: usize = 16;

/// Updates after which a net is built beside the ticks.
const BUILT: usize = 5;

/// What is saved: a flag with springs, levels, layers and a surface.
#[derive(Clone, Copy, Debug)]
struct Saved {
    ticks: usize,
    level: usize,
    has_spring: bool,
    is_self_colliding: bool,
    is_net: bool,
}

fn saved() -> BoxedStrategy<Saved> {
    (2..40_usize, 0..2_usize, any::<[bool; 3]>())
        .prop_map(|(ticks, level, [has_spring, is_self_colliding, is_net])| Saved {
            ticks,
            level,
            has_spring,
            is_self_colliding,
            is_net,
        })
        .boxed()
}

impl Saved {
    /// The cloth in an app, after its ticks.
    fn app(self) -> (App, Entity) {
        let mut app = app_of_its_own();
        let wind = WindField::steady(Vec3::new(4.0, 0.0, 1.0)).with_gusts(2.0, 1.0, 1);
        app.world_mut().spawn(wind);
        let pole = app.world_mut().spawn(Transform::default()).id();
        let mut held = Attachment::new(pole, ClothEdge::Left);
        if self.has_spring {
            held = held.with_anchor(Anchor::new(pole, ClothCorner::TopRight).with_stiffness(20.0));
        }
        let lods = LodSet::new([50.0]).pinned_to(self.level);
        let cloth = (mesh(!self.is_net), held, lods);
        let read = (AnchorReactions::default(), ClothSurface::default());
        let mut cloth = app.world_mut().spawn((cloth, read));
        if self.is_self_colliding {
            cloth.insert(SelfCollision { thickness: 5e-3, levels: 2 });
        }
        let cloth = cloth.id();
        // Nets are built beside the ticks.
        run(&mut app, BUILT + self.ticks);
        (app, cloth)
    }
}

/// A change of bytes.
#[derive(Clone, Debug)]
enum Damage {
    Flip(Index, u8),
    Cut(Index),
    Insert(Index, Vec<u8>),
    /// Writes these four bytes.
    Write(Index, u32),
}

fn damage() -> BoxedStrategy<Damage> {
    let number = prop_oneof![
        any::<u32>(),
        Just(f32::NAN.to_bits()),
        Just(f32::INFINITY.to_bits()),
        Just(u32::MAX),
        Just(0),
    ];
    prop_oneof![
        4 => (any::<Index>(), 0..8_u8).prop_map(|(at, bit)| Damage::Flip(at, bit)),
        1 => any::<Index>().prop_map(Damage::Cut),
        1 => (any::<Index>(), vec(any::<u8>(), 1..9)).prop_map(|(at, it)| Damage::Insert(at, it)),
        4 => (any::<Index>(), number).prop_map(|(at, number)| Damage::Write(at, number)),
    ]
    .boxed()
}

/// The bytes with the changes, from a place on.
fn damaged(bytes: &[u8], from: usize, changes: &[Damage]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for change in changes {
        let rest = bytes.len() - from;
        let at = |index: &Index| from + index.index(rest.max(1));
        match change {
            Damage::Flip(index, bit) if rest > 0 => bytes[at(index)] ^= 1 << bit,
            Damage::Cut(index) => bytes.truncate(at(index)),
            Damage::Insert(index, more) => {
                let at = at(index).min(bytes.len());
                drop(bytes.splice(at..at, more.iter().copied()));
            }
            Damage::Write(index, number) => {
                let number = number.to_le_bytes();
                bytes[from..]
                    .iter_mut()
                    .skip(index.index(rest.max(1)))
                    .zip(number)
                    .for_each(|(it, to)| *it = to);
            }
            Damage::Flip(..) => {}
        }
    }
    bytes
}

#[test]
fn a_snapshot_comes_back_and_cloth_goes_on_with_the_same_bits() {
    let inputs = saved();
    for_all(24, inputs, |saved| {
        let (mut app, cloth) = saved.app();
        let snapshot = app.world().save_cloths().expect("it is simulated");
        let bytes = snapshot.to_bytes();
        let read = ClothWorldSnapshot::from_bytes(&bytes).expect("they are whole");
        assert_eq!(read.to_bytes(), bytes);
        run(&mut app, 5);
        let expected = bits(&app, cloth);
        app.world_mut().restore_cloths(&read).expect("the same cloth");
        run(&mut app, 5);
        assert_eq!(bits(&app, cloth), expected);
    });
}

#[test]
fn damaged_bytes_are_told() {
    let inputs = (saved(), vec(damage(), 1..4));
    for_all(24, inputs, |(saved, changes)| {
        let (app, cloth) = saved.app();
        let bytes = app.world().save_cloth(cloth).expect("it is simulated").to_bytes();
        let damaged = damaged(&bytes, 0, &changes);
        match ClothSnapshot::from_bytes(&damaged) {
            Ok(_) => assert_eq!(damaged, bytes),
            Err(error) => assert!(matches!(
                error,
                SnapshotBytesError::Foreign { .. }
                    | SnapshotBytesError::Version { .. }
                    | SnapshotBytesError::Damaged
            )),
        }
    });
}

/// As a machine elsewhere may send them on purpose.
#[test]
fn forged_bytes_with_a_right_checksum_are_told_or_simulated() {
    let inputs = (saved(), vec(damage(), 1..4), any::<bool>());
    for_all(96, inputs, |(saved, changes, whole_world)| {
        let (mut app, cloth) = saved.app();
        let world = app.world_mut();
        let bytes = if whole_world {
            world.save_cloths().expect("it is simulated").to_bytes()
        } else {
            world.save_cloth(cloth).expect("it is simulated").to_bytes()
        };
        let mut forged = damaged(&bytes, STATE, &changes);
        let checksum = crc32fast::hash(&forged[STATE..]);
        forged[CHECKSUM..STATE].copy_from_slice(&checksum.to_le_bytes());
        if whole_world {
            if let Ok(read) = ClothWorldSnapshot::from_bytes(&forged) {
                _ = world.restore_cloths(&read);
            }
        } else if let Ok(read) = ClothSnapshot::from_bytes(&forged) {
            _ = world.restore_cloth(cloth, &read);
        }
        run(&mut app, 5);
        assert_all_finite(&mut app);
    });
}
