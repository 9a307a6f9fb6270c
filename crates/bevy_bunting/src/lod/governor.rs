//! How finely each cloth is simulated, so that all together stay within the budget.
//!
//! A pure function of what is wanted and what it costs, without a world, a clock or a float that
//! depends on the machine:
//!
//! 1. Every cloth starts at its coarsest level. Each step to a finer one that it wants gains error
//!    that is no longer seen, and costs time: steps are sorted by gain over cost, in buckets, which is
//!    linear in their number.
//! 2. In that order each step is taken if the sum of costs stays within the budget. Costs are those
//!    of whole batches: the ninth cloth of a batch of sixteen lanes is free, and what is free goes to
//!    the next in line.
//! 3. Cloths move towards these levels, at most so many a tick and none too soon after its last
//!    change, the coarser first; none becomes finer while there is no room for it. A change costs
//!    time, too: as long as any is due, the levels leave room for the dearest. Cloths that have not been
//!    simulated yet begin at these levels.

/// How many times more a step is worth that is taken already, so that two cloths of the same worth
/// do not take turns: changes cost time. What a step is worth goes with the fifth power of the distance:
/// this is half of it.
const LOYALTY: f32 = 8.0;

/// Part of the budget that what is not simulated yet may fill, so that costs that waver do not open
/// and close a batch by turns.
const NEW_PART: f32 = 0.95;

/// Part of the budget that changes are given room at most: those that cost more come all the same.
const MOST_RESERVED: f32 = 0.25;

/// Bits of a gain over cost that are dropped to make its bucket: leaves the exponent and four bits, a
/// resolution of 1/16.
const BUCKET_SHIFT: u32 = 19;

/// Buckets for every positive float.
const BUCKETS: usize = 1 << (31 - BUCKET_SHIFT);

/// What batches of one level cost in a tick, µs, by width. A batch that is filled in part costs as
/// much as a full one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BatchCosts {
    /// One lane.
    pub one: f32,
    /// Eight lanes.
    pub eight: f32,
    /// Sixteen lanes; none where batches are not as wide.
    pub sixteen: Option<f32>,
    /// Most cloths that ride alone, each in a batch of one, beside full ones; beside eight, one less.
    pub alone: u32,
    /// What each cloth costs besides.
    pub each: f32,
    /// What it costs, once, to change between this level and a coarser one in somebody's picture.
    pub change: f32,
}

impl BatchCosts {
    /// Cost of so many cloths, µs.
    fn of(&self, cloths: u32) -> f32 {
        let (bits, widest) = self.widest();
        // Asked so often that a division would count.
        let full = cloths >> bits;
        let rest = match cloths - (full << bits) {
            rest if rest <= self.alone => rest as f32 * self.one,
            ..=8 => self.eight,
            rest if rest - 8 < self.alone => self.eight + (rest - 8) as f32 * self.one,
            _ => widest,
        };
        full as f32 * widest + rest + cloths as f32 * self.each
    }

    /// Cost of a cloth among many, µs.
    fn share(&self) -> f32 {
        let (bits, cost) = self.widest();
        cost / (1 << bits) as f32 + self.each
    }

    /// The widest batch: the binary logarithm of its lanes, and its cost, µs.
    fn widest(&self) -> (u32, f32) {
        self.sixteen.map_or((3, self.eight), |sixteen| (4, sixteen))
    }
}

/// Cloths that share their fabrics.
#[derive(Clone, Debug, Default)]
pub(crate) struct Kind {
    /// Error of each level, the finest first, m.
    pub errors: Vec<f32>,
    /// Costs of each level.
    pub costs: Vec<BatchCosts>,
}

/// A cloth that is simulated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    /// Which of the kinds.
    pub kind: u32,
    /// Its level.
    pub level: u32,
    /// Pixels that a metre takes at the cloth.
    pub scale: f32,
    /// What a pixel of error counts: the pixels that it is seen over.
    pub weight: f32,
    /// Whether its last change is long enough ago.
    pub ready: bool,
    /// Whether its level is not ours to choose: it only costs.
    pub fixed: bool,
    /// Whether it has not been simulated yet: it begins at the level that is chosen, which is no change.
    pub fresh: bool,
    /// Whether it is in a picture.
    pub seen: bool,
}

/// What the choice keeps to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Greatest sum of costs, µs.
    pub budget: f32,
    /// Error from which a finer level is wanted, px.
    pub refine_above: f32,
    /// Error below which a coarser level does, px.
    pub coarsen_below: f32,
    /// Most changes in a tick of what is seen, and of what is not, which cost little.
    pub switches: usize,
}

/// What was chosen.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Choice {
    /// Which cloths change, and to which level.
    pub switches: Vec<(usize, usize)>,
    /// Sum of costs in this tick, µs.
    pub cost: f32,
    /// Cloths that are coarser than they should be for want of time.
    pub held_back: usize,
}

/// A step of a cloth to the next finer level.
#[derive(Clone, Copy, Debug, Default)]
struct Step {
    cloth: u32,
    /// The finer level.
    to: u32,
    bucket: u32,
}

/// Chooses levels. Keeps its memory from tick to tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Governor {
    steps: Vec<Step>,
    sorted: Vec<Step>,
    bucket_ends: Vec<u32>,
    wanted: Vec<u32>,
    chosen: Vec<u32>,
    counts: Counts,
    worth: Vec<f32>,
    /// Where the levels of each kind begin in `worth`.
    firsts: Vec<usize>,
    choice: Choice,
}

impl Governor {
    /// Chooses a level for every cloth, and who moves towards it now.
    pub fn choose(&mut self, kinds: &[Kind], cloths: &[Candidate], limits: &Limits) -> &Choice {
        self.appraise(kinds);
        self.collect_steps(kinds, cloths, limits);
        self.sort_steps();
        self.take_steps(kinds, cloths, limits.budget);
        let due = self.dearest_change(kinds, cloths).min(MOST_RESERVED * limits.budget);
        if due > 0.0 {
            self.take_steps(kinds, cloths, limits.budget - due);
        }
        self.switch(kinds, cloths, limits);
        &self.choice
    }

    /// Error in metres that a step to each level saves, over what it costs. A step is never worth more
    /// than the one before it, so that none is taken out of turn.
    fn appraise(&mut self, kinds: &[Kind]) {
        self.worth.clear();
        self.firsts.clear();
        for kind in kinds {
            let (first, mut least) = (self.worth.len(), f32::MAX);
            self.firsts.push(first);
            self.worth.resize(first + kind.errors.len(), 0.0);
            for level in (0..kind.errors.len().saturating_sub(1)).rev() {
                let gain = kind.errors[level + 1] - kind.errors[level];
                let cost = kind.costs[level].share() - kind.costs[level + 1].share();
                // A finer level that costs nothing is worth any price.
                let value = if cost > 0.0 { gain.max(0.0) / cost } else { f32::MAX };
                least = least.min(value);
                self.worth[first + level] = least;
            }
        }
    }

    fn collect_steps(&mut self, kinds: &[Kind], cloths: &[Candidate], limits: &Limits) {
        self.steps.clear();
        self.wanted.clear();
        for (index, cloth) in cloths.iter().enumerate() {
            let errors = &kinds[cloth.kind as usize].errors;
            if cloth.fixed {
                self.wanted.push(cloth.level);
                continue;
            }
            let wanted = wanted_level(errors, cloth, limits);
            let coarsest = errors.len() as u32 - 1;
            self.wanted.push(wanted);
            let importance = cloth.scale * cloth.weight;
            for to in (wanted..coarsest).rev() {
                let loyalty = if cloth.level <= to { LOYALTY } else { 1.0 };
                let worth = self.worth[self.firsts[cloth.kind as usize] + to as usize];
                let value = (importance * worth * loyalty).clamp(0.0, f32::MAX);
                let bucket = BUCKETS as u32 - 1 - (value.to_bits() >> BUCKET_SHIFT);
                self.steps.push(Step { cloth: index as u32, to, bucket });
            }
        }
    }

    /// Greatest worth first; equals in the order of the cloths.
    fn sort_steps(&mut self) {
        self.bucket_ends.clear();
        self.bucket_ends.resize(BUCKETS, 0);
        for step in &self.steps {
            self.bucket_ends[step.bucket as usize] += 1;
        }
        let mut end = 0;
        for bucket in &mut self.bucket_ends {
            end += core::mem::replace(bucket, end);
        }
        self.sorted.clear();
        self.sorted.resize(self.steps.len(), Step::default());
        for step in &self.steps {
            let place = &mut self.bucket_ends[step.bucket as usize];
            self.sorted[*place as usize] = *step;
            *place += 1;
        }
    }

    fn take_steps(&mut self, kinds: &[Kind], cloths: &[Candidate], budget: f32) {
        let coarsest = |cloth: &Candidate| kinds[cloth.kind as usize].errors.len() as u32 - 1;
        let first = |cloth: &Candidate| if cloth.fixed { cloth.level } else { coarsest(cloth) };
        self.chosen.clear();
        self.chosen.extend(cloths.iter().map(first));
        let mut cost = self.counts.count(kinds, cloths, self.chosen.iter().copied());
        for step in &self.sorted {
            let index = step.cloth as usize;
            if self.chosen[index] != step.to + 1 {
                continue;
            }
            let cloth = &cloths[index];
            let part = if cloth.level <= step.to { 1.0 } else { NEW_PART };
            let more = self.counts.difference(kinds, cloth.kind, step.to + 1, step.to);
            if more <= 0.0 || cost + more <= part * budget {
                cost += more;
                self.counts.shift(cloth.kind, step.to + 1, step.to);
                self.chosen[index] = step.to;
            }
        }
        let pairs = self.chosen.iter().zip(&self.wanted);
        self.choice.held_back = pairs.filter(|(chosen, wanted)| chosen > wanted).count();
    }

    /// The greatest cost of any change that is due.
    fn dearest_change(&self, kinds: &[Kind], cloths: &[Candidate]) -> f32 {
        let pairs = cloths.iter().zip(&self.chosen);
        pairs.map(|(cloth, &to)| cloth.cost_of_change(kinds, to)).fold(0.0, f32::max)
    }

    fn switch(&mut self, kinds: &[Kind], cloths: &[Candidate], limits: &Limits) {
        let switches = &mut self.choice.switches;
        switches.clear();
        let (mut left, mut changes) = ([limits.switches; 2], 0.0);
        let mut cost = self.counts.count(kinds, cloths, cloths.iter().map(|cloth| cloth.level));
        for (index, (cloth, &to)) in cloths.iter().zip(&self.chosen).enumerate() {
            if cloth.fresh && to != cloth.level {
                cost += self.counts.difference(kinds, cloth.kind, cloth.level, to);
                self.counts.shift(cloth.kind, cloth.level, to);
                switches.push((index, to as usize));
            }
        }
        for (index, (cloth, &to)) in cloths.iter().zip(&self.chosen).enumerate() {
            if cloth.fresh {
                continue;
            }
            let may = cloth.ready || cost > limits.budget;
            let left = &mut left[usize::from(cloth.seen)];
            if to > cloth.level && may && *left > 0 {
                *left -= 1;
                changes += cloth.cost_of_change(kinds, to);
                cost += self.counts.difference(kinds, cloth.kind, cloth.level, to);
                self.counts.shift(cloth.kind, cloth.level, to);
                switches.push((index, to as usize));
            }
        }
        for step in &self.sorted {
            let (cloth, to) = (&cloths[step.cloth as usize], self.chosen[step.cloth as usize]);
            let left = &mut left[usize::from(cloth.seen)];
            // Each cloth once: at the step that begins at its level.
            let may = cloth.ready && !cloth.fresh;
            if step.to + 1 != cloth.level || to >= cloth.level || !may || *left == 0 {
                continue;
            }
            let more = self.counts.difference(kinds, cloth.kind, cloth.level, to);
            let change = cloth.cost_of_change(kinds, to);
            let room = limits.budget - (changes + change).min(MOST_RESERVED * limits.budget);
            if more <= 0.0 || cost + more <= room {
                cost += more;
                changes += change;
                *left -= 1;
                self.counts.shift(cloth.kind, cloth.level, to);
                switches.push((step.cloth as usize, to as usize));
            }
        }
        self.choice.cost = cost + changes;
    }
}

impl Candidate {
    /// What it costs, once, to go to another level, µs. What nobody sees is changed without care.
    fn cost_of_change(&self, kinds: &[Kind], to: u32) -> f32 {
        let finer = &kinds[self.kind as usize].costs[self.level.min(to) as usize];
        if self.seen && !self.fresh && self.level != to { finer.change } else { 0.0 }
    }
}

/// The level that a cloth wants: as coarse as its error allows, and no other than its own without
/// need.
pub(crate) fn wanted_level(errors: &[f32], cloth: &Candidate, limits: &Limits) -> u32 {
    let pixels = |level: u32| cloth.scale * errors[level as usize];
    let mut level = cloth.level;
    while level > 0 && pixels(level) > limits.refine_above {
        level -= 1;
    }
    while level + 1 < errors.len() as u32 && pixels(level + 1) < limits.coarsen_below {
        level += 1;
    }
    level
}

/// Number of cloths of each kind at each level.
#[derive(Clone, Debug, Default)]
struct Counts {
    counts: Vec<u32>,
    stride: usize,
}

impl Counts {
    /// Counts the cloths at these levels, and sums up what they cost.
    fn count(
        &mut self,
        kinds: &[Kind],
        cloths: &[Candidate],
        levels: impl Iterator<Item = u32>,
    ) -> f32 {
        self.stride = kinds.iter().map(|kind| kind.errors.len()).max().unwrap_or(0);
        self.counts.clear();
        self.counts.resize(kinds.len() * self.stride, 0);
        for (cloth, level) in cloths.iter().zip(levels) {
            *self.at(cloth.kind, level) += 1;
        }
        let counts = self.counts.chunks(self.stride.max(1));
        let levels =
            kinds.iter().zip(counts).flat_map(|(kind, counts)| kind.costs.iter().zip(counts));
        levels.map(|(cost, &count)| cost.of(count)).sum()
    }

    /// What it costs more when one cloth goes from a level to another, µs.
    fn difference(&mut self, kinds: &[Kind], kind: u32, from: u32, to: u32) -> f32 {
        let costs = &kinds[kind as usize].costs;
        let (leaves, enters) = (&costs[from as usize], &costs[to as usize]);
        let (old, new) = (*self.at(kind, from), *self.at(kind, to));
        leaves.of(old - 1) - leaves.of(old) + enters.of(new + 1) - enters.of(new)
    }

    fn shift(&mut self, kind: u32, from: u32, to: u32) {
        *self.at(kind, from) -= 1;
        *self.at(kind, to) += 1;
    }

    fn at(&mut self, kind: u32, level: u32) -> &mut u32 {
        &mut self.counts[kind as usize * self.stride + level as usize]
    }
}

#[cfg(test)]
#[path = "governor_tests.rs"]
mod tests;
