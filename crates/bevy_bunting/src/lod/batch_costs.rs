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
    /// The pool of cloths of several fabrics that are put together in mixed batches; none where there is only this
    /// fabric.
    pub pool: Option<Pool>,
    /// Cost of each cloth besides its batch.
    pub per_cloth: f32,
    /// Cost of one change between this level and a coarser one on a screen, µs.
    pub change: f32,
}

/// Cloths that do not fill half of a batch of their own fabric, of all fabrics of one topology.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pool {
    /// Number of the pool.
    pub index: u32,
    /// Cost of a mixed batch, which has eight lanes, µs.
    pub eight: f32,
}

impl BatchCosts {
    /// Cost of a number of cloths of one fabric in a tick, µs, without those of them that are in the pool.
    pub fn of(&self, cloths: u32) -> f32 {
        let (in_batches, pooled) = self.own(cloths);
        let rest = if self.pool.is_none() { self.rest(pooled) } else { 0.0 };
        in_batches + rest + cloths as f32 * self.per_cloth
    }

    /// Number of cloths, of so many of one fabric, that are in the pool.
    pub fn pooled(&self, cloths: u32) -> u32 {
        if self.pool.is_some() { self.own(cloths).1 } else { 0 }
    }

    /// Cost of the batches of a pool of so many cloths, µs.
    pub fn of_pool(&self, cloths: u32) -> f32 {
        let Some(Pool { eight, .. }) = self.pool else { return 0.0 };
        let mixed = Self { eight, sixteen: None, pool: None, ..*self };
        let (in_batches, rest) = mixed.own(cloths);
        in_batches + mixed.rest(rest)
    }

    /// Cost of batches of cloths of one fabric that are half full or more, µs, and the number of cloths left.
    fn own(&self, cloths: u32) -> (f32, u32) {
        let (bits, widest) = self.widest();
        // Shifts replace a division, since the governor calls this in its innermost loop.
        let full = cloths >> bits;
        let (part, left) = match cloths - (full << bits) {
            rest if rest <= self.most_single || rest < 4 => (0.0, rest),
            ..=8 => (self.eight, 0),
            rest if rest - 8 < self.most_single => (self.eight, rest - 8),
            _ => (widest, 0),
        };
        (full as f32 * widest + part, left)
    }

    /// Cost of batches of less than four cloths in one batch, or in a batch each, µs.
    fn rest(&self, cloths: u32) -> f32 {
        if cloths <= self.most_single { cloths as f32 * self.one } else { self.eight }
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
            pool: None,
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
        // Of several fabrics, cloths that do not fill half a batch are in the pool.
        let pool = Some(Pool { index: 0, eight: 3.5 });
        let pooled = BatchCosts { pool, ..costs };
        assert_eq!([1, 3, 4, 9, 17, 19].map(|count| pooled.pooled(count)), [1, 3, 0, 0, 1, 3]);
        assert_eq!([1, 3, 4, 19].map(|count| pooled.of(count)), [0.5, 1.5, 5.0, 14.5]);
        let each = [0, 1, 2, 8, 9, 16, 17, 26].map(|count| pooled.of_pool(count));
        assert_eq!(each, [0.0, 1.0, 3.5, 3.5, 4.5, 7.0, 8.0, 14.0]);
    }
}
