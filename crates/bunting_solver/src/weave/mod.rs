//! A lone cloth fills the lanes with its own yarns.
//!
//! Yarns of one colour share no particle, so it makes no difference which are solved first, or whether
//! all at once. Those of a grid run along its rows, columns and diagonals. With the particles of a row
//! side by side in memory, eight columns that lie side by side are eight yarns, one in each lane; so
//! are eight diagonals, where each row begins one particle further on; and eight rows are, once the
//! sheet is turned. The kernels are those of cloths in the lanes, and every yarn has its scalar bits.

mod bend_lines;
mod sheets;
mod threads;

pub(crate) use sheets::{Facing, Sheets};

use crate::constraints::Knot;
use crate::fabric::{ABREAST, BendLine, Fabric, Strands};
use crate::lane_batch::LaneBatch;
use crate::lanes::{Pack, Pack8};
use crate::parameters::{BendFactors, Parameters};
use crate::vector::{Pack3, splat3};

/// Lines of a grid side by side.
const SIDE: usize = Pack8::WIDTH;

/// One cloth, cut from a grid, while its constraints are solved.
#[derive(Clone, Debug)]
pub(crate) struct Weave {
    pub sheets: Sheets,
    /// Whether the positions are here, and not in the batch.
    holds_positions: bool,

    pub strands: Strands<Pack8>,
    /// For each colour of the strands, along what its yarns lie.
    pub facings: Vec<Facing>,
    pub target: Vec<Pack8>,
    pub knots: Vec<Knot<Pack8>>,
    /// For each class of the strands' links, the fabric's class in each lane.
    classes: Vec<[Option<u32>; SIDE]>,
    /// For each class, one in lanes that have a link, zero in others.
    pub present: Vec<Pack8>,
    /// For each class, as in the batch's parameters.
    pub compliance: Vec<Pack8>,

    /// Rows, then columns.
    pub bend_lines: Vec<(Facing, Vec<BendLine>)>,
    /// For each profile of these lines, the fabric's profile in each lane.
    profiles: Vec<[Option<u32>; SIDE]>,
    pub bend_factors: Vec<BendFactors<Pack8, Pack8>>,
    pub moments: Vec<Pack3<Pack8>>,
}

impl Weave {
    /// None unless the fabric is a grid whose yarns run straight.
    pub fn of(fabric: &Fabric) -> Option<Self> {
        let grid = fabric.grid()?;
        let sheets = Sheets::new(grid);
        let (strands, facings, classes) = threads::strands(fabric, &sheets)?;
        let nothing = Pack8::splat(0.0);
        let (bend_lines, profiles) = bend_lines::lines(fabric, &sheets);
        let mut weave = Self {
            holds_positions: false,
            target: vec![nothing; strands.target_count()],
            knots: vec![Knot::new(); ABREAST * strands.longest()],
            present: classes
                .iter()
                .map(|of_lanes| pack(of_lanes, |class| f32::from(class.is_some())))
                .collect(),
            compliance: vec![nothing; classes.len()],
            bend_factors: profiles
                .iter()
                .map(|of_lanes| bend_lines::factors(fabric, of_lanes))
                .collect(),
            moments: vec![splat3(glam::Vec3::ZERO); grid.columns.max(grid.rows) as usize],
            sheets,
            strands,
            facings,
            classes,
            bend_lines,
            profiles,
        };
        weave.sheets.set_weights(fabric.inverse_areas());
        Some(weave)
    }

    /// Takes over what the scalar solver would read from the only lane's parameters.
    pub fn set_parameters<P: Pack>(&mut self, parameters: &Parameters<P>) {
        let only = |pack: &P| pack.lanes()[0];
        for (compliance, of_lanes) in self.compliance.iter_mut().zip(&self.classes) {
            *compliance = pack(of_lanes, |class| {
                class.map_or(0.0, |class| only(&parameters.link_compliance[class as usize]))
            });
        }
        for (factors, of_lanes) in self.bend_factors.iter_mut().zip(&self.profiles) {
            for (row, factor) in factors.rows.iter_mut().enumerate() {
                let of = |profile: Option<u32>| {
                    profile.map(|profile| &parameters.bend_factors[profile as usize].rows[row])
                };
                factor.near = pack(of_lanes, |at| of(at).map_or(0.0, |row| only(&row.near)));
                factor.far = pack(of_lanes, |at| of(at).map_or(0.0, |row| only(&row.far)));
                factor.inverse = pack(of_lanes, |at| of(at).map_or(0.0, |row| only(&row.inverse)));
            }
        }
    }
}

impl<P: Pack> LaneBatch<P> {
    /// The cloth in its weave, positions and all, if it is woven.
    pub fn woven(&mut self) -> Option<&mut Weave> {
        let weave = self.weave.as_deref_mut()?;
        if !weave.holds_positions {
            weave.sheets.read(&self.position);
            weave.holds_positions = true;
        }
        Some(weave)
    }

    /// Gives the positions back to the batch, if the weave has them.
    pub fn unravel(&mut self) {
        if let Some(weave) = &mut self.weave
            && weave.holds_positions
        {
            weave.sheets.write(&mut self.position);
            weave.holds_positions = false;
        }
    }
}

/// A number for each lane.
fn pack<T: Copy>(lanes: &[T; SIDE], number: impl Fn(T) -> f32) -> Pack8 {
    let mut pack = Pack8::splat(0.0);
    for (value, &lane) in pack.lanes_mut().iter_mut().zip(lanes) {
        *value = number(lane);
    }
    pack
}
#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::fabric::{FabricBuilder, FabricMaterial, Grid};
    use crate::lanes::Pack1;
    use crate::snapshot::ClothSnapshot;
    use crate::step::{Drive, StepSettings};
    use crate::vector::lane3;

    fn bits(batch: &LaneBatch<Pack1>) -> Vec<[u32; 3]> {
        batch.position.iter().map(|at| lane3(at, 0).to_array().map(f32::to_bits)).collect()
    }

    #[test]
    fn each_solve_has_the_scalar_bits() {
        let grid = FabricBuilder::grid(Grid::new(13, 11, 1.0, 1.0));
        let fabric = grid.pin([57, 58, 59, 70, 71, 72, 84, 86]).build().expect("a good fabric");
        let fabric = Arc::new(fabric);
        let mut woven = LaneBatch::<Pack1>::new(Arc::clone(&fabric));
        woven.insert(0, &ClothSnapshot::at_rest(&fabric), FabricMaterial::DENIM);
        let drive = Drive { wind: glam::Vec3::new(1.0, 2.0, 5.0), ..Drive::default() };
        woven.slots[0].as_mut().expect("a cloth").drive = drive;
        let mut scalar = woven.clone();
        scalar.weave = None;
        for _ in 0..20 {
            for batch in [&mut woven, &mut scalar] {
                batch.begin_tick(1.0 / 120.0, StepSettings::yarns(1));
                batch.integrate();
            }
            let solves: [fn(&mut LaneBatch<Pack1>); 3] =
                [LaneBatch::solve_bending, |batch| batch.solve_yarns(2), LaneBatch::polish];
            for (index, solve) in solves.into_iter().enumerate() {
                for batch in [&mut woven, &mut scalar] {
                    solve(batch);
                    batch.unravel();
                }
                assert_eq!(bits(&woven), bits(&scalar), "{index}");
            }
            woven.update_velocities();
            scalar.update_velocities();
        }
    }
}
