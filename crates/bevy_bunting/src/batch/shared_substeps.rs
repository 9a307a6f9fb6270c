//! How many substeps the cloths of one kind take, so that their batches cost least together.
//!
//! A batch takes as long with one cloth as with all of its lanes occupied. So cloths that need few substeps may cost less in
//! free lanes beside cloths that need more. The choice is a pure function of what each cloth needs and takes, and of costs
//! that are the same on every machine: of batches of one, eight and sixteen lanes, whatever width the machine has.

use bevy_ecs::entity::Entity;

use crate::lod::batch_costs::BatchCosts;

/// Lanes of the widest batches that are counted with.
const LANES: usize = 16;

/// Cost of what the cloths take now, over the least, up to which they stay. Smaller: cloths change batches, and with them their
/// substeps, each time that another one needs more or less. Larger: costs more.
const STAYS: f32 = 1.05;

/// A cloth among those of its kind, which could lie in one batch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Member {
    pub entity: Entity,
    /// The kind: what could lie in one batch.
    pub kind: usize,
    /// Substeps that it needs.
    pub needed: u32,
    /// Most substeps that its limits allow.
    pub most: u32,
    /// Substeps that it takes: as input those of the last tick.
    pub taken: u32,
    /// Whether it takes no more substeps than it needs, since its contacts cost more than its lane.
    pub bound: bool,
    /// What acts on it, m/s²: of cloths that need the same, the one with the greatest load takes more first.
    pub load: f32,
}

/// Cloths of one kind that need the same number of substeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Need {
    substeps: u32,
    /// Cloths that may take more.
    free: usize,
    /// Cloths that may not.
    bound: usize,
}

/// Lets each of the cloths of one kind take so many substeps that all batches cost least, and none fewer than it needs.
/// `costs` are those of a substep.
pub(crate) fn share(members: &mut [Member], costs: &BatchCosts) {
    let needs = needs(members);
    if needs.len() < 2 {
        members.iter_mut().for_each(|member| member.taken = member.needed);
        return;
    }
    for member in &mut *members {
        let is_known = needs.iter().any(|need| need.substeps == member.taken);
        if member.bound || member.taken < member.needed || !is_known {
            member.taken = member.needed;
        }
    }
    let free = || members.iter().filter(|member| !member.bound);
    let taking = |need: &Need| free().filter(|member| member.taken == need.substeps).count();
    let present: Vec<usize> = needs.iter().map(taking).collect();
    let least = least_counts(&needs, costs);
    let mut alike = vec![0; needs.len()];
    alike[0] = present.iter().sum();
    let most = (STAYS * cost(&needs, &least, costs)).min(cost(&needs, &alike, costs));
    if cost(&needs, &present, costs) > most {
        take(members, &needs, &least);
    }
}

/// The numbers of substeps that are needed, the greatest first.
fn needs(members: &[Member]) -> Vec<Need> {
    let mut substeps: Vec<u32> = members.iter().map(|member| member.needed).collect();
    substeps.sort_unstable_by_key(|&substeps| core::cmp::Reverse(substeps));
    substeps.dedup();
    let count = |substeps: u32, bound: bool| {
        members.iter().filter(|it| it.needed == substeps && it.bound == bound).count()
    };
    let need =
        |substeps| Need { substeps, free: count(substeps, false), bound: count(substeps, true) };
    substeps.into_iter().map(need).collect()
}

/// Cost of all batches if so many free cloths take each number of substeps, µs.
fn cost(needs: &[Need], counts: &[usize], costs: &BatchCosts) -> f32 {
    needs.iter().zip(counts).map(|(need, &count)| cost_of(need, count, costs)).sum()
}

/// Cost of the batches of one number of substeps with so many free cloths, µs.
fn cost_of(need: &Need, free: usize, costs: &BatchCosts) -> f32 {
    need.substeps as f32 * costs.of((free + need.bound) as u32)
}

/// Numbers of free cloths for some of the greatest numbers of substeps.
#[derive(Clone, Debug, Default)]
struct Begun {
    counts: Vec<usize>,
    /// Their sum.
    placed: usize,
    /// µs.
    cost: f32,
}

/// How many free cloths take each number of substeps where all batches cost least, and of several such choices the one in
/// which the fewest take more than they need.
fn least_counts(needs: &[Need], costs: &BatchCosts) -> Vec<usize> {
    let all: usize = needs.iter().map(|need| need.free).sum();
    let mut begun = vec![Begun::default()];
    let mut needed = 0;
    for (index, need) in needs.iter().enumerate() {
        needed += need.free;
        let is_last = index + 1 == needs.len();
        let mut next: Vec<Begun> = Vec::new();
        for start in &begun {
            let left = all - start.placed;
            let fewest = if is_last { left } else { needed.saturating_sub(start.placed) };
            // As many as a batch holds would be cheaper in one with fewer substeps.
            for count in fewest..=left.min(fewest + LANES - 1) {
                let placed = start.placed + count;
                let cost = start.cost + cost_of(need, count, costs);
                let known = next.iter().position(|it| it.placed == placed);
                if known.is_some_and(|known| next[known].cost <= cost) {
                    continue;
                }
                let mut counts = start.counts.clone();
                counts.push(count);
                let new = Begun { counts, placed, cost };
                match known {
                    Some(known) => next[known] = new,
                    None => next.push(new),
                }
            }
        }
        begun = next;
    }
    begun.pop().map(|it| it.counts).unwrap_or_default()
}

/// Lets so many free cloths take each number of substeps: those that need it; of the others those that take it now, and then
/// those that need and bear the most.
fn take(members: &mut [Member], needs: &[Need], counts: &[usize]) {
    let mut open: Vec<&mut Member> = members.iter_mut().filter(|member| !member.bound).collect();
    for (&Need { substeps, .. }, &count) in needs.iter().zip(counts) {
        open.sort_by(|a, b| {
            let first = |it: &Member| (it.needed == substeps, it.taken == substeps, it.needed);
            let by_load = b.load.total_cmp(&a.load);
            first(b).cmp(&first(a)).then(by_load).then(a.entity.cmp(&b.entity))
        });
        let rest = open.split_off(count);
        open.into_iter().for_each(|member| member.taken = substeps);
        open = rest;
    }
}

#[cfg(test)]
#[path = "shared_substeps_tests.rs"]
mod tests;
