//! The order of the stages in which a substep solves the constraints of a cloth. Contacts come after each pass over lines
//! (`contact/passes.rs`), and after all stages.
//!
//! Each solve of a line is a projection, self-adjoint in the metric of the masses, with eigenvalues from 0 to 1. A sequence of
//! solves that reads the same backwards is self-adjoint, too, and a product of two such sequences still has real eigenvalues from 0 to
//! 1, like an implicit step of a stiffer cloth. A product of three different projections has complex eigenvalues: circulatory forces, which
//! make a cloth at rest vibrate and spin. Bending, lines, tethers and sweep are four: nets that hung from one vertex swung ever wider.
//! Therefore every second substep reverses the order, so that its circulatory forces are those of the substep before with the
//! opposite sign: but for the place of the sweep, which ends both, one order is the reverse of the other, and the eigenvalues of a product
//! are those of its factors in cyclic order. Rows and columns of a calm grid hardly act on one another, and need no second order; those of a
//! grid that is stiff, twisted or drawn out do. Such grids take many substeps ([`Loads`](crate::Loads)), which only make them rattle the
//! more in one order.

use crate::fabric::Fabric;

/// A part of the solution of a cloth's constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Bending and twist (`bending.rs`, `twist.rs`, `stiff_bending.rs`).
    Bending,
    /// The same after lines, whose tensions stay as they are.
    BendingOfTautLines,
    /// Warp, weft and shear of a grid (`chain.rs`, `shear.rs`).
    Lines,
    /// The same of a grid of a few columns or rows, two lines at once (`strip.rs`).
    Strips,
    /// Warp, weft and shear in an order that reads the same backwards (`both_ways.rs`).
    LinesBothWays,
    /// Tethers to pins (`tether.rs`).
    Tethers,
    /// A sweep over single links of warp and weft, which corrects the overshoot of lines with frozen directions (`sweep.rs`).
    Sweep,
    /// The same with the last colour first. This was chosen by measurement: where links go backwards, too, four nets of eighty
    /// tremble at 8 to 27 mm/s, and none as it is.
    SweepBackwards,
    /// Lines that still have overlong links (`overlong.rs`).
    Overlong,
}

use Stage::{
    Bending, BendingOfTautLines, Lines, LinesBothWays, Overlong, Strips, Sweep, SweepBackwards,
    Tethers,
};

/// The stages of the first, third, … and of the second, fourth, … substep of a tick.
pub(crate) type Order = [&'static [Stage]; 2];

const GRID: Order = [&[Bending, Lines, Tethers, Sweep, Overlong]; 2];
const NARROW_GRID: Order = [&[Bending, Strips, Tethers, Sweep, Overlong]; 2];
const BOTH_ORDERS: Order = [
    &[Tethers, LinesBothWays, BendingOfTautLines, SweepBackwards, Overlong],
    &[Bending, LinesBothWays, Tethers, Sweep, Overlong],
];

/// Most substeps in a tick with which a grid is solved in one order. Fewer: a curtain of 4 m lets a ball of 20 m/s stand out of it by 41 cm in
/// place of 33. More: stiff bands that are twisted vibrate for ever.
const MOST_IN_ONE_ORDER: u32 = 16;

/// The order of a fabric's cloths in ticks of a number of substeps.
pub(crate) fn order_of(fabric: &Fabric, substeps: u32) -> Order {
    if !fabric.strips().is_empty() {
        NARROW_GRID
    } else if fabric.is_net() || substeps > MOST_IN_ONE_ORDER {
        BOTH_ORDERS
    } else {
        GRID
    }
}

#[cfg(test)]
mod tests {
    use super::{BOTH_ORDERS, GRID, MOST_IN_ONE_ORDER, Stage, order_of};
    use crate::fabric::{FabricBuilder, Grid};

    #[test]
    fn grids_that_take_many_substeps_have_both_orders() {
        let grid = FabricBuilder::grid(Grid::new(9, 9, 1.0, 1.0)).build().expect("a good grid");
        assert_eq!(order_of(&grid, MOST_IN_ONE_ORDER), GRID);
        assert_eq!(order_of(&grid, MOST_IN_ONE_ORDER + 1), BOTH_ORDERS);
    }

    /// But for the sweeps, which correct what the lines leave.
    #[test]
    fn every_second_substep_has_the_reverse_order() {
        let main = |stages: &[Stage]| -> Vec<Stage> {
            let kinds = stages.iter().map(|stage| match stage {
                Stage::BendingOfTautLines => Stage::Bending,
                other => *other,
            });
            let sweeps = [Stage::Sweep, Stage::SweepBackwards, Stage::Overlong];
            kinds.filter(|stage| !sweeps.contains(stage)).collect()
        };
        let mut reverse = main(BOTH_ORDERS[1]);
        reverse.reverse();
        assert_eq!(main(BOTH_ORDERS[0]), reverse);
    }
}
