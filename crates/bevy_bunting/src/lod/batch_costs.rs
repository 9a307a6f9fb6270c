//! Costs of the batches of one level.

/// Costs in a tick of batches of one level, by width, µs. A partly filled batch costs as much as a full one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BatchCosts {
    /// Cost of a batch of one lane, µs.
    pub one: f32,
    /// Cost of a batch of eight lanes, µs.
    pub eight: f32,
    /// Cost of a batch of sixteen lanes, µs; none where batches are at most eight wide.
    pub sixteen: Option<f32>,
    /// Greatest number of cloths in batches of one lane beside full batches; one fewer beside a batch of
    /// eight lanes that is not full.
    pub most_single: u32,
    /// Cost of each cloth besides its batch, µs.
    pub per_cloth: f32,
    /// Cost of one change between this level and a coarser one on a screen, µs.
    pub change: f32,
}

impl BatchCosts {
    /// Cost of a number of cloths in a tick, µs.
    pub fn of(&self, cloths: u32) -> f32 {
        let (bits, widest) = self.widest();
        // Shifts replace a division, since the governor calls this in its innermost loop.
        let full = cloths >> bits;
        let rest = match cloths - (full << bits) {
            rest if rest <= self.most_single => rest as f32 * self.one,
            ..=8 => self.eight,
            rest if rest - 8 < self.most_single => self.eight + (rest - 8) as f32 * self.one,
            _ => widest,
        };
        full as f32 * widest + rest + cloths as f32 * self.per_cloth
    }

    /// Cost in a tick of one more cloth among many, µs.
    pub fn of_one_among_many(&self) -> f32 {
        let (bits, cost) = self.widest();
        cost / (1 << bits) as f32 + self.per_cloth
    }

    /// Binary logarithm of the widest batch's number of lanes, and its cost, µs.
    fn widest(&self) -> (u32, f32) {
        self.sixteen.map_or((3, self.eight), |sixteen| (4, sixteen))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_filled_batch_costs_a_full_one() {
        let costs = BatchCosts {
            one: 1.0,
            eight: 3.0,
            sixteen: Some(5.0),
            most_single: 1,
            per_cloth: 0.5,
            change: 0.0,
        };
        let expected = [0.0, 1.5, 4.0, 7.0, 9.5, 13.0, 14.5];
        assert_eq!([0, 1, 2, 8, 9, 16, 17].map(|count| costs.of(count)), expected);
        let narrow = BatchCosts { sixteen: None, ..costs };
        assert_eq!([8, 9, 16].map(|count| narrow.of(count)), [7.0, 8.5, 14.0]);
        let single = BatchCosts { most_single: 3, ..costs };
        let counts = [1, 2, 3, 4, 8, 9, 10, 11, 16, 17, 19];
        let each = counts.map(|count| single.of(count));
        assert_eq!(each, [1.5, 3.0, 4.5, 5.0, 7.0, 8.5, 10.0, 10.5, 13.0, 14.5, 17.5]);
    }
}
