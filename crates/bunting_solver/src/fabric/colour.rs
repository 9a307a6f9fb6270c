//! Graph colouring: constraints of one colour share no particle.
//!
//! Gauss–Seidel in row order feeds energy along the rows, and each constraint waits for the one before. In
//! colour order neighbours in the list are independent.

use core::ops::Range;

/// Range of each colour in a list of constraints.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Colours(Vec<Range<usize>>);

impl Colours {
    /// The ranges, one per colour, in the order in which they are solved.
    pub fn ranges(&self) -> &[Range<usize>] {
        &self.0
    }

    /// Adds the colours of a list of constraints that follows.
    pub fn extend(&mut self, following: &Self) {
        let count = self.0.last().map_or(0, |range| range.end);
        self.0.extend(following.0.iter().map(|range| count + range.start..count + range.end));
    }
}

/// Gives each constraint the smallest colour that no earlier constraint of its particles has (greedy
/// colouring), and sorts the constraints by rank, then by colour, and otherwise in their former order.
pub(super) fn colour<C>(
    particle_count: usize,
    constraints: Vec<C>,
    particles: impl Fn(&C) -> &[u32],
    rank: impl Fn(&C) -> u32,
) -> (Vec<C>, Colours) {
    colour_up_to(usize::MAX, particle_count, constraints, particles, rank)
}

/// As [`colour`], but each colour has no more than `most` constraints.
pub(super) fn colour_up_to<C>(
    most: usize,
    particle_count: usize,
    constraints: Vec<C>,
    particles: impl Fn(&C) -> &[u32],
    rank: impl Fn(&C) -> u32,
) -> (Vec<C>, Colours) {
    let mut taken: Vec<Vec<bool>> = vec![Vec::new(); particle_count];
    let mut counts: Vec<usize> = Vec::new();
    let mut keyed: Vec<((u32, usize), C)> = constraints
        .into_iter()
        .map(|constraint| {
            let members = particles(&constraint);
            let is_free = |colour: usize| {
                let has = |&particle: &u32| taken[particle as usize].get(colour) == Some(&true);
                counts.get(colour).is_none_or(|&count| count < most) && !members.iter().any(has)
            };
            let colour = (0..).find(|&colour| is_free(colour)).unwrap_or_default();
            counts.resize(counts.len().max(colour + 1), 0);
            counts[colour] += 1;
            for &particle in members {
                let colours = &mut taken[particle as usize];
                colours.resize(colours.len().max(colour + 1), false);
                colours[colour] = true;
            }
            ((rank(&constraint), colour), constraint)
        })
        .collect();
    keyed.sort_by_key(|(key, _)| *key);

    let mut ranges: Vec<Range<usize>> = Vec::new();
    let mut last = None;
    for (index, (key, _)) in keyed.iter().enumerate() {
        match ranges.last_mut() {
            Some(range) if last == Some(*key) => range.end = index + 1,
            _ => ranges.push(index..index + 1),
        }
        last = Some(*key);
    }
    (keyed.into_iter().map(|(_, constraint)| constraint).collect(), Colours(ranges))
}

#[cfg(test)]
mod tests {
    use super::{colour, colour_up_to};

    #[test]
    fn constraints_of_one_colour_share_no_particle() {
        // A fan and a path: pairs and a triple.
        let constraints: Vec<Vec<u32>> =
            vec![vec![0, 1], vec![0, 2], vec![0, 3], vec![1, 2, 3], vec![3, 4], vec![4, 5]];
        let rank = |constraint: &Vec<u32>| u32::from(constraint.len() != 2);
        let (sorted, colours) = colour(6, constraints.clone(), |constraint| constraint, rank);
        let covered: usize = colours.ranges().iter().map(ExactSizeIterator::len).sum();
        assert_eq!(covered, constraints.len());
        assert!(constraints.iter().all(|constraint| sorted.contains(constraint)));
        assert_eq!(sorted[5], [1, 2, 3], "of the higher rank");
        assert_eq!(colours.ranges().len(), 4);
        for range in colours.ranges() {
            let mut particles: Vec<u32> = sorted[range.clone()].concat();
            let all = particles.len();
            particles.sort_unstable();
            particles.dedup();
            assert_eq!(particles.len(), all);
        }
    }

    #[test]
    fn a_colour_has_no_more_constraints_than_it_may() {
        let constraints: Vec<[u32; 2]> = (0..7).map(|at| [2 * at, 2 * at + 1]).collect();
        let (sorted, colours) = colour_up_to(3, 14, constraints.clone(), |pair| pair, |_| 0);
        assert_eq!(sorted, constraints);
        assert_eq!(colours.ranges(), [0..3, 3..6, 6..7]);
    }
}
