//! Colours: runs of constraints that share no particle.
//!
//! Gauss–Seidel in row order pumps energy along the rows and chains each constraint to the last;
//! in colour order neighbours in the stream are independent.

use core::hash::Hash;
use core::ops::Range;
use std::collections::HashMap;

/// Where each colour begins and ends in a list of constraints.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Colours(Vec<Range<usize>>);

impl Colours {
    /// The ranges, one a colour, in the order in which they are solved.
    #[must_use]
    pub fn ranges(&self) -> &[Range<usize>] {
        &self.0
    }
}

/// Sorts constraints by the smallest colour that no earlier one of their particles has, keeping the
/// order within a colour. Constraints of a lower `rank` come first, whatever their colour.
pub(crate) fn colour<C>(
    particle_count: usize,
    constraints: Vec<C>,
    particles: impl Fn(&C) -> &[u32],
    rank: impl Fn(&C) -> u32,
) -> (Vec<C>, Colours) {
    let mut taken: Vec<Vec<bool>> = vec![Vec::new(); particle_count];
    let mut keyed: Vec<((u32, usize), C)> = constraints
        .into_iter()
        .map(|constraint| {
            let members = particles(&constraint);
            let is_free = |colour: usize| {
                let has = |&particle: &u32| taken[particle as usize].get(colour) == Some(&true);
                !members.iter().any(has)
            };
            let colour = (0..).find(|&colour| is_free(colour)).unwrap_or_default();
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

/// Replaces values that are equal but for rounding by indices into a table of the distinct ones. The keys
/// are their [`rounded_bits`].
pub(crate) struct Classes<K> {
    keys: HashMap<K, u32>,
}

/// Bits of an f32 that a class ignores: values within 2⁻¹² of one another are one class.
const CLASS_ROUNDING_BITS: u32 = 12;

/// Bits of a value, equal for values of one class.
pub(crate) fn rounded_bits(value: f32) -> u32 {
    (value.to_bits() + (1 << (CLASS_ROUNDING_BITS - 1))) >> CLASS_ROUNDING_BITS
}

impl<K: Eq + Hash> Classes<K> {
    pub fn new() -> Self {
        Self { keys: HashMap::new() }
    }

    /// The class of a value, and whether it is new: then it is the next in the table.
    pub fn class_of(&mut self, key: K) -> (u32, bool) {
        let next = self.keys.len() as u32;
        let class = *self.keys.entry(key).or_insert(next);
        (class, class == next)
    }
}
