//! Packs of constraints that are solved in the order of a list.
//!
//! Solving constraints that share no particle in another order, or at once, does not change a bit. So the constraints
//! of a list are packed such that of two with a common particle the earlier one lies in an earlier pack. The packs, one
//! after the other, then move particles as the list does, and backwards as the list does backwards.

/// Packs of indices into a list of constraints, given the particles of each. A pack has no more than `most`.
pub(super) fn packs_in_order<'a>(
    most: usize,
    particle_count: usize,
    constraints: impl Iterator<Item = &'a [u32]>,
) -> Vec<Vec<usize>> {
    let mut packs: Vec<Vec<usize>> = Vec::new();
    // For each particle the pack after the last one that moves it, and the first pack that is not full.
    let mut next_of = vec![0; particle_count];
    let mut first_open = 0;
    for (index, particles) in constraints.enumerate() {
        let after = particles.iter().map(|&particle| next_of[particle as usize]);
        let mut at = after.fold(first_open, usize::max);
        while packs.get(at).is_some_and(|pack| pack.len() == most) {
            at += 1;
        }
        packs.resize(packs.len().max(at + 1), Vec::new());
        packs[at].push(index);
        for &particle in particles {
            next_of[particle as usize] = at + 1;
        }
        while packs.get(first_open).is_some_and(|pack| pack.len() == most) {
            first_open += 1;
        }
    }
    packs
}

#[cfg(test)]
mod tests {
    use super::packs_in_order;

    #[test]
    fn constraints_with_a_common_particle_keep_their_order() {
        let constraints: [[u32; 2]; 7] = [[0, 1], [2, 3], [1, 2], [4, 5], [6, 7], [8, 9], [3, 4]];
        let packs = packs_in_order(3, 10, constraints.iter().map(|pair| &pair[..]));
        assert_eq!(packs, [vec![0, 1, 3], vec![2, 4, 5], vec![6]]);
        let pack_of = |wanted| packs.iter().position(|pack| pack.contains(&wanted));
        for (later, one) in constraints.iter().enumerate() {
            for (earlier, other) in constraints[..later].iter().enumerate() {
                if one.iter().any(|particle| other.contains(particle)) {
                    assert!(pack_of(earlier) < pack_of(later), "{earlier} and {later}");
                }
            }
        }
    }
}
