//! The direction in which a sweep goes over its constraints.

/// The indices below `count`, from the last to the first if `is_backwards`.
#[inline(always)]
pub(super) fn sweep_order(count: usize, is_backwards: bool) -> impl Iterator<Item = usize> {
    (0..count).map(move |at| if is_backwards { count - 1 - at } else { at })
}

#[cfg(test)]
mod tests {
    use super::sweep_order;

    #[test]
    fn a_backward_sweep_goes_from_the_last_to_the_first() {
        assert!(sweep_order(3, false).eq([0, 1, 2]));
        assert!(sweep_order(3, true).eq([2, 1, 0]));
    }
}
