//! Tests of the choice of levels with made-up cloths.

use super::*;
use crate::lod::batch_costs::BatchCosts;

const LIMITS: Limits =
    Limits { budget: 1000.0, refine_above: 1.0, coarsen_below: 0.5, switches: usize::MAX };

/// Four levels, each with four times the cost and half the error of the next coarser one.
fn table() -> LevelTable {
    let costs = [400.0, 100.0, 25.0, 6.25].map(|sixteen: f32| BatchCosts {
        one: 0.4 * sixteen,
        eight: 0.6 * sixteen,
        sixteen: Some(sixteen),
        most_single: 1,
        pool: None,
        per_cloth: 0.0,
        change: 0.0,
    });
    LevelTable::new(vec![0.001, 0.01, 0.02, 0.04], costs.to_vec(), vec![0; 4], 1.0)
}

fn cloth(level: u32, pixels_per_metre: f32) -> Candidate {
    Candidate {
        table: 0,
        level,
        pixels_per_metre,
        importance: pixels_per_metre * pixels_per_metre,
        ready: true,
        fresh: false,
        fixed: false,
        may_be_still: false,
        on_screen: true,
    }
}

/// Repeats the choice until the cloths have followed it. Returns the last choice.
fn settle(cloths: &mut [Candidate], limits: &Limits) -> Choice {
    let mut governor = Governor::default();
    let mut last = Choice::default();
    for _ in 0..200 {
        last = governor.choose(&[table()], cloths, limits).clone();
        for &(cloth, to) in &last.switches {
            cloths[cloth].level = to as u32;
        }
    }
    assert_eq!(last.switches, [], "it comes to rest");
    last
}

fn levels(cloths: &[Candidate]) -> Vec<u32> {
    cloths.iter().map(|cloth| cloth.level).collect()
}

#[test]
fn with_time_to_spare_each_cloth_has_its_wanted_level() {
    // 0.02 m are 1.2 px, 0.01 m are 0.6 px: no coarser than the second level.
    let mut cloths = [cloth(3, 60.0), cloth(3, 10.0), cloth(0, 10.0), cloth(3, 2000.0)];
    let choice = settle(&mut cloths, &LIMITS);
    assert_eq!(levels(&cloths), [1, 3, 3, 0]);
    assert_eq!(choice.held_back, 0);
}

#[test]
fn a_step_without_gain_has_no_worth_however_near_the_cloth() {
    let alike = LevelTable { errors: vec![0.01; 5], ..table() };
    let endless = Candidate { importance: f32::INFINITY, ..cloth(3, 1e9) };
    let choice = Governor::default().choose(&[alike], &[endless], &LIMITS).clone();
    assert_eq!(choice.switches, [(0, 0)]);
}

#[test]
fn between_the_thresholds_nothing_changes() {
    // The second level has 0.75 px, the third 1.5.
    for level in [1, 2] {
        let limits = Limits { refine_above: 2.0, ..LIMITS };
        let mut cloths = [cloth(level, 75.0)];
        settle(&mut cloths, &limits);
        assert_eq!(levels(&cloths), [level]);
    }
}

#[test]
fn the_sum_of_costs_stays_within_the_budget_and_the_nearest_gain() {
    let mut cloths: Vec<Candidate> = (0..300).map(|index| cloth(3, 900.0 - index as f32)).collect();
    let mut before: Option<Vec<u32>> = None;
    for budget in [150.0, 500.0, 1000.0, 4000.0, 9000.0] {
        let limits = Limits { budget, ..LIMITS };
        let choice = settle(&mut cloths, &limits);
        assert!(choice.cost <= budget, "{} of {budget}", choice.cost);
        assert_eq!(choice.held_back > 0, budget < 9000.0, "{budget}");
        let now = levels(&cloths);
        // The list is sorted by distance; no cloth is coarser than one behind it.
        assert!(now.is_sorted(), "{budget}: {now:?}");
        // A larger budget makes no cloth coarser.
        assert!(before.is_none_or(|before| now.iter().zip(before).all(|(now, then)| *now <= then)));
        before = Some(now);
    }
}

#[test]
fn free_lanes_are_used_by_the_next_cloths() {
    // The budget has room for one batch at the finest level, which all cloths want.
    let mut cloths: Vec<Candidate> = (0..40).map(|index| cloth(3, 2000.0 - index as f32)).collect();
    let limits = Limits { budget: 720.0, ..LIMITS };
    settle(&mut cloths, &limits);
    let finest = levels(&cloths).iter().filter(|level| **level == 0).count();
    assert_eq!(finest, 16);
}

#[test]
fn over_the_budget_cloths_become_coarser_at_once() {
    let mut cloths = vec![cloth(0, 2000.0); 64];
    cloths.iter_mut().for_each(|cloth| cloth.ready = false);
    let limits = Limits { switches: 8, ..LIMITS };
    let choice = settle(&mut cloths, &limits);
    assert!(choice.cost <= limits.budget);
    assert!(choice.held_back > 0);
}

#[test]
fn levels_leave_room_for_changes() {
    let mut table = table();
    for (costs, change) in table.costs.iter_mut().zip([200.0, 50.0, 10.0, 0.0]) {
        costs.change = change;
    }
    let limits = Limits { switches: 1, ..LIMITS };
    let mut governor = Governor::default();
    let mut cloths: Vec<Candidate> = (0..40).map(|index| cloth(3, 900.0 - index as f32)).collect();
    let mut changes = 0;
    for tick in 0..400 {
        // Every 20 ticks another cloth comes nearest.
        cloths[tick / 20].pixels_per_metre = 2000.0;
        let choice = governor.choose(core::slice::from_ref(&table), &cloths, &limits).clone();
        assert!(choice.cost <= limits.budget, "{} in tick {tick}", choice.cost);
        for &(cloth, to) in &choice.switches {
            changes += usize::from(to == 0);
            cloths[cloth].level = to as u32;
        }
    }
    assert!(changes >= 16, "{changes}");
}

/// A storm makes all cloths four times as dear at once.
#[test]
fn a_rise_of_costs_is_met_by_many_changes() {
    let mut table = table();
    for (costs, change) in table.costs.iter_mut().zip([200.0, 50.0, 10.0, 0.0]) {
        costs.change = change;
    }
    let limits = Limits { switches: 1, ..LIMITS };
    let mut governor = Governor::default();
    let mut cloths = vec![cloth(3, 2000.0); 32];
    let mut choose = |table: &LevelTable, cloths: &mut [Candidate]| {
        let choice = governor.choose(core::slice::from_ref(table), cloths, &limits).clone();
        for &(cloth, to) in &choice.switches {
            cloths[cloth].level = to as u32;
        }
        choice
    };
    for _ in 0..200 {
        let choice = choose(&table, &mut cloths);
        assert!(choice.switches.len() <= 1 && choice.cost <= limits.budget);
    }
    assert!(cloths.iter().filter(|cloth| cloth.level == 0).count() >= 16);
    for costs in &mut table.costs {
        costs.one *= 4.0;
        costs.eight *= 4.0;
        costs.sixteen = costs.sixteen.map(|cost| 4.0 * cost);
    }
    let mut before = levels(&cloths);
    let mut ticks = 0;
    loop {
        let without = LevelCounts::default().count(
            core::slice::from_ref(&table),
            &cloths,
            before.iter().copied(),
        );
        let choice = choose(&table, &mut cloths);
        let excess = without - limits.budget;
        let change = |&(cloth, _): &(usize, usize)| table.costs[before[cloth] as usize].change;
        // One change is always made, and the dearest costs 200 µs.
        assert!(choice.switches.iter().map(change).sum::<f32>() <= excess.max(200.0));
        if choice.cost <= limits.budget {
            break;
        }
        before = levels(&cloths);
        ticks += 1;
    }
    // One change a tick would take as many ticks as cloths become coarser.
    assert!(ticks <= 8, "{ticks} ticks over the budget");
}

#[test]
fn cloths_on_no_screen_have_a_number_of_changes_of_their_own() {
    let unseen = |index: usize| index.is_multiple_of(2);
    let cloths: Vec<Candidate> =
        (0..8).map(|index| Candidate { on_screen: !unseen(index), ..cloth(0, 1.0) }).collect();
    let limits = Limits { switches: 2, ..LIMITS };
    let choice = Governor::default().choose(&[table()], &cloths, &limits).clone();
    let (of_unseen, of_seen): (Vec<usize>, Vec<usize>) =
        choice.switches.iter().map(|&(index, _)| index).partition(|&index| unseen(index));
    assert_eq!((of_unseen, of_seen), (vec![0, 2], vec![1, 3]));
}

#[test]
fn within_the_budget_the_dwell_is_kept() {
    for level in [0, 3] {
        let scale = if level == 0 { 1.0 } else { 2000.0 };
        let mut cloths = [Candidate { ready: false, ..cloth(level, scale) }];
        assert_eq!(settle(&mut cloths, &LIMITS).switches, []);
        assert_eq!(levels(&cloths), [level]);
    }
}

#[test]
fn cloths_at_fixed_levels_cost_but_do_not_change() {
    let own = Candidate { fixed: true, ..cloth(0, 1.0) };
    let mut cloths = vec![own; 32];
    cloths.push(cloth(3, 2000.0));
    let choice = settle(&mut cloths, &Limits { budget: 900.0, ..LIMITS });
    assert_eq!(levels(&cloths)[..32], [0; 32]);
    assert_eq!(cloths[32].level, 1, "what is left does not pay for more");
    assert_eq!(choice.cost, 840.0);
}

#[test]
fn fluctuating_costs_change_nothing() {
    let mut cloths: Vec<Candidate> = (0..100).map(|index| cloth(3, 900.0 - index as f32)).collect();
    settle(&mut cloths, &LIMITS);
    let mut governor = Governor::default();
    for wave in [0.99, 1.01, 0.98, 1.0] {
        let mut table = table();
        table
            .costs
            .iter_mut()
            .for_each(|costs| costs.sixteen = costs.sixteen.map(|cost| wave * cost));
        assert_eq!(governor.choose(&[table], &cloths, &LIMITS).switches, [], "{wave}");
    }
}

#[test]
fn no_cloths_cost_nothing() {
    let choice = Governor::default().choose(&[], &[], &LIMITS).clone();
    assert_eq!(choice, Choice::default());
}

#[test]
fn a_cloth_is_held_still_only_where_there_is_no_time_for_all_coarsest_levels() {
    let small = |pixels: f32| Candidate { may_be_still: true, ..cloth(3, pixels) };
    // Three batches of sixteen lanes, 6.25 µs each, at the coarsest level.
    let mut cloths: Vec<Candidate> = (0..48).map(|index| small(100.0 - index as f32)).collect();
    let limits = |budget: f32| Limits { budget, ..LIMITS };
    settle(&mut cloths, &limits(19.0));
    assert_eq!(levels(&cloths), [3; 48]);
    let choice = settle(&mut cloths, &limits(13.0));
    assert!(choice.cost <= 13.0);
    let still = |cloths: &[Candidate]| -> Vec<usize> {
        (0..cloths.len()).filter(|&index| cloths[index].level == 4).collect()
    };
    assert_eq!(still(&cloths), (32..48).collect::<Vec<_>>(), "the smallest");
    assert_eq!(choice.held_back, 48);

    // What may not be still is not, though it is smaller.
    cloths.iter_mut().for_each(|cloth| cloth.level = 3);
    cloths[47].may_be_still = false;
    settle(&mut cloths, &limits(13.0));
    assert_eq!(still(&cloths), (31..47).collect::<Vec<_>>());

    // A near cloth is not refined at the price of one that stops.
    let mut with_a_near_one: Vec<Candidate> = (0..65).map(|_| small(100.0)).collect();
    with_a_near_one.push(cloth(3, 2000.0));
    settle(&mut with_a_near_one, &limits(37.0));
    assert_eq!(levels(&with_a_near_one), [3; 66]);

    // New cloths do not begin before there is time for them.
    cloths.iter_mut().for_each(|cloth| (cloth.level, cloth.fresh) = (3, true));
    let choice = Governor::default().choose(&[table()], &cloths, &limits(13.0)).clone();
    assert!(choice.switches.iter().filter(|(_, to)| *to == 4).count() >= 15, "{choice:?}");
    settle(&mut cloths, &limits(1000.0));
    assert!(still(&cloths).is_empty());
}
