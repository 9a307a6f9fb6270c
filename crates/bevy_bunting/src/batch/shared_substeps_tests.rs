//! Tests of the choice of substeps.

use super::*;
use crate::batch::cost_kind::CostKind;
use crate::lod::cost_table::CostTable;
use bunting_solver::{LaneCount, StepSettings};

/// Costs of a substep of flags of 33 × 33, and of cloths with short rows.
fn costs() -> [BatchCosts; 2] {
    [(1089, 3), (289, 1)].map(|(particles, most_single)| {
        let settings = StepSettings { substeps: 1, ..StepSettings::default() };
        let of = |lanes| {
            CostTable::default().batch(CostKind { particles, settings, lanes, mixed: false })
        };
        let eight = of(LaneCount::Eight);
        BatchCosts {
            one: of(LaneCount::One),
            eight,
            sixteen: Some(1.5 * eight),
            most_single,
            ..BatchCosts::default()
        }
    })
}

/// So many cloths that need each number of substeps, and take what they need.
fn members(needs: &[(u32, usize)]) -> Vec<Member> {
    let needed = needs.iter().flat_map(|&(substeps, count)| vec![substeps; count]);
    let member = |(index, needed)| Member {
        entity: Entity::from_raw_u32(index as u32).expect("a small index"),
        kind: 0,
        needed,
        most: 16,
        taken: needed,
        bound: false,
        load: 0.0,
    };
    needed.enumerate().map(member).collect()
}

/// Numbers of cloths that take each number of substeps.
fn taken(members: &[Member]) -> Vec<(u32, usize)> {
    let mut all: Vec<u32> = members.iter().map(|member| member.taken).collect();
    all.sort_unstable();
    all.chunk_by(|a, b| a == b).map(|same| (same[0], same.len())).collect()
}

fn shared(needs: &[(u32, usize)], costs: &BatchCosts) -> Vec<(u32, usize)> {
    let mut members = members(needs);
    share(&mut members, costs);
    assert!(members.iter().all(|member| member.taken >= member.needed), "{members:?}");
    taken(&members)
}

/// Cost of cloths that take so many substeps, µs.
fn cost_of_all(taken: &[(u32, usize)], costs: &BatchCosts) -> f32 {
    taken.iter().map(|&(substeps, count)| substeps as f32 * costs.of(count as u32)).sum()
}

/// The least cost of all ways in which cloths may take as many substeps as others need, µs.
fn least_of_all(needs: &[(u32, usize)], costs: &BatchCosts) -> f32 {
    fn of(needs: &[(u32, usize)], carried: usize, costs: &BatchCosts) -> f32 {
        let Some(&(substeps, count)) = needs.first() else {
            return if carried == 0 { 0.0 } else { f32::INFINITY };
        };
        // Some of those that need at most so many stay, and the others take more.
        let own = carried + count;
        (0..=own)
            .map(|stay| {
                substeps as f32 * costs.of(stay as u32) + of(&needs[1..], own - stay, costs)
            })
            .fold(f32::INFINITY, f32::min)
    }
    of(needs, 0, costs)
}

#[test]
fn the_sum_of_all_batches_is_least() {
    let [long, short] = costs();
    let counts = [0, 1, 2, 3, 5, 8, 11];
    for costs in [long, short] {
        for index in 0..counts.len().pow(3) {
            let digit = |place: u32| counts[index / counts.len().pow(place) % counts.len()];
            let [a, b, c] = [0, 1, 2].map(digit);
            let mut needs = vec![(2, a), (3, b), (5, c)];
            needs.retain(|&(_, count)| count > 0);
            let cost = cost_of_all(&shared(&needs, &costs), &costs);
            let least = least_of_all(&needs, &costs);
            assert!(cost <= 1.001 * STAYS * least, "{needs:?}: {cost} µs, {least} µs");
            let all = cost_of_all(&[(5, a + b + c)], &costs);
            assert!(c == 0 || cost <= 1.001 * all, "{needs:?}: {cost} µs, {all} µs");
        }
    }
}

#[test]
fn flags_that_need_different_substeps_share_a_batch() {
    let [long, short] = costs();
    assert_eq!(shared(&[(2, 5), (3, 3)], &long), [(3, 8)]);
    // One batch of each, and no lane empty.
    assert_eq!(shared(&[(2, 11), (5, 5)], &long), [(2, 8), (5, 8)]);
    // Sixteen lanes cost less than twice eight.
    assert_eq!(shared(&[(2, 11), (3, 5)], &long), [(3, 16)]);
    // Few cloths with long rows are alone in their batches, and pay for themselves.
    assert_eq!(shared(&[(2, 1), (8, 1)], &long), [(2, 1), (8, 1)]);
    assert_eq!(shared(&[(2, 8), (16, 1)], &long), [(2, 8), (16, 1)]);
    assert_eq!(shared(&[(2, 4), (3, 4)], &short), [(3, 8)]);
    assert_eq!(shared(&[(2, 8), (5, 8)], &short), [(2, 8), (5, 8)]);
}

#[test]
fn cloths_with_contacts_take_what_they_need() {
    let [long, _] = costs();
    let mut members = members(&[(2, 5), (3, 3)]);
    members[0].bound = true;
    share(&mut members, &long);
    assert_eq!(taken(&members), [(2, 1), (3, 7)]);
    assert_eq!(members[0].taken, 2);
}

#[test]
fn cloths_stay_where_little_is_saved() {
    let [long, _] = costs();
    let mut members = members(&[(2, 5), (3, 3)]);
    share(&mut members, &long);
    // One needs fewer, and seven, too, lie in one batch.
    members[7].needed = 2;
    share(&mut members, &long);
    assert_eq!(taken(&members), [(3, 8)]);
    // None needs more than two.
    members.iter_mut().for_each(|member| member.needed = 2);
    share(&mut members, &long);
    assert_eq!(taken(&members), [(2, 8)]);
}

#[test]
fn the_order_of_the_cloths_does_not_matter() {
    let [long, _] = costs();
    let mut members = members(&[(2, 11), (5, 5)]);
    for (index, member) in members.iter_mut().enumerate() {
        member.load = (7 * index % 16) as f32;
    }
    let mut turned: Vec<Member> = members.iter().rev().copied().collect();
    share(&mut members, &long);
    share(&mut turned, &long);
    turned.reverse();
    assert_eq!(members, turned);
    // Those with the greatest loads take more.
    let least = |substeps: u32| {
        let of = members.iter().filter(|it| it.needed == 2 && it.taken == substeps);
        of.map(|it| it.load).fold(f32::INFINITY, f32::min)
    };
    let greatest = |substeps: u32| {
        let of = members.iter().filter(|it| it.needed == 2 && it.taken == substeps);
        of.map(|it| it.load).fold(0.0, f32::max)
    };
    assert!(least(5) > greatest(2), "{members:?}");
}
