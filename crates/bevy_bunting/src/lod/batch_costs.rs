//! Costs of the batches of one level.

/// Costs of batches of one level in a tick by width, µs. A batch whose lanes are occupied in part costs as
/// much as a full one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BatchCosts {
    /// A batch of one lane.
    pub one: f32,
    /// A batch of eight lanes.
    pub eight: f32,
    /// A batch of sixteen lanes; none where batches are at most eight wide.
    pub sixteen: Option<f32>,
    /// Greatest number of cloths in batches of one lane beside full batches; beside one of eight lanes
    /// that is not full, one less.
    pub most_single: u32,
    /// Cost of each cloth besides its batch.
    pub per_cloth: f32,
    /// Cost of one change between this level and a coarser one on a screen.
    pub change: f32,
}

impl BatchCosts {
    /// Cost of a number of cloths in a tick, µs.
    pub fn of(&self, cloths: u32) -> f32 {
        let (bits, widest) = self.widest();
        // Shifts instead of a division: the governor asks for it in its innermost loop.
        let full = cloths >> bits;
        let rest = match cloths - (full << bits) {
            rest if rest <= self.most_single => rest as f32 * self.one,
            ..=8 => self.eight,
            rest if rest - 8 < self.most_single => self.eight + (rest - 8) as f32 * self.one,
            _ => widest,
        };
        full as f32 * widest + rest + cloths as f32 * self.per_cloth
    }

    /// Cost of a cloth among many in a tick, µs.
    pub fn of_one_among_many(&self) -> f32 {
        let (bits, cost) = self.widest();
        cost / (1 << bits) as f32 + self.per_cloth
    }

    /// The widest batch: the binary logarithm of its number of lanes, and its cost, µs.
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
