//! A lone cloth fills the lanes with its own yarns.
//!
//! Yarns of one colour share no particle, so it makes no difference which are solved first, or whether
//! all at once. Those of a grid run along its rows, columns and diagonals. With the particles of a row
//! side by side in memory, columns that lie side by side are yarns, one in each lane; so are diagonals,
//! where each row begins one particle further on; and rows are, once the sheet is turned. The kernels
//! are those of cloths in the lanes, and every yarn has its scalar bits.
//!
//! What is done to each particle by itself is done to a pack of one row, and triangles are summed by
//! packs of cells.

mod air;
mod bend_lines;
mod cells;
mod normals;
mod ribbons;
mod sheets;
mod tethers;
mod threads;

pub(crate) use sheets::{Facing, Sheets};
pub(crate) use tethers::PackedTethers;

use cells::Cells;
use glam::Vec3;
use ribbons::Ribbons;
use sheets::Plane;

use crate::batch::lane_batch::LaneBatch;
use crate::batch::places::Constant;
use crate::constraints::Knot;
use crate::fabric::{BendLine, CHAINS_PER_PAIR, Chains, Fabric};
use crate::simd::lane::Pack;
use crate::simd::vec3::{Pack3, splat3};
use crate::step::parameters::{BendFactors, Parameters};

/// What the lanes of a pack are of the fabric: links' classes, lines' profiles.
type OfLanes = Vec<Option<u32>>;

/// One cloth, cut from a grid.
#[derive(Clone, Debug)]
pub(crate) struct Weave<P: Pack> {
    pub sheets: Sheets,
    /// Whether the positions are here, and not in the batch.
    holds_positions: bool,

    pub strands: Chains<P>,
    /// For each colour of the strands, along what its yarns lie.
    pub facings: Vec<Facing>,
    pub target: Vec<P>,
    pub knots: Vec<Knot<P>>,
    /// For each class of the strands' links, the fabric's class in each lane.
    classes: Vec<OfLanes>,
    /// For each class, one in lanes that have a link, zero in others.
    pub present: Vec<P>,
    /// For each class, as in the batch's parameters.
    pub compliance: Vec<P>,

    /// Rows, then columns.
    pub bend_lines: Vec<(Facing, Vec<BendLine>)>,
    /// For each profile of these lines, the fabric's profile in each lane.
    profiles: Vec<OfLanes>,
    pub bend_factors: Vec<BendFactors<P, P>>,
    pub ribbons: Ribbons<P>,
    pub moments: Vec<Pack3<P>>,

    pub tethers: PackedTethers<P>,
    pub far_tethers: PackedTethers<P>,
    cells: Cells<P>,
    velocity: Plane,
}

impl<P: Pack> Weave<P> {
    /// None unless the fabric is a grid whose yarns run straight.
    pub fn of(fabric: &Fabric) -> Option<Self> {
        let grid = fabric.grid()?;
        let sheets = Sheets::new::<P>(grid);
        let (strands, facings, classes) = threads::strands(fabric, &sheets)?;
        let cells = Cells::of(fabric, sheets.stride())?;
        let nothing = P::splat(0.0);
        let (bend_lines, profiles) = bend_lines::lines::<P>(fabric, &sheets);
        let present = |of_lanes: &OfLanes| P::of(|lane| f32::from(of_lanes[lane].is_some()));
        let mut weave = Self {
            holds_positions: false,
            target: vec![nothing; strands.target_count()],
            knots: vec![Knot::new(); CHAINS_PER_PAIR * strands.longest()],
            present: classes.iter().map(present).collect(),
            compliance: vec![nothing; classes.len()],
            bend_factors: profiles.iter().map(|of| bend_lines::factors(fabric, of)).collect(),
            moments: vec![splat3(Vec3::ZERO); grid.columns.max(grid.rows) as usize],
            ribbons: Ribbons::of(fabric, &sheets),
            tethers: PackedTethers::of(fabric, fabric.tethers()),
            far_tethers: PackedTethers::of(fabric, fabric.far_tethers()),
            velocity: sheets.plane(),
            cells,
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

    /// Begins with a cloth's positions, of which the pins' stay.
    pub fn begin(&mut self, positions: &[Vec3]) {
        self.sheets.clear();
        self.tethers.set_pins(positions);
        self.far_tethers.set_pins(positions);
    }

    /// Takes over what is constant over many substeps.
    pub fn set_parameters(&mut self, parameters: &Parameters<P>) {
        let only = |pack: &P| pack.lanes()[0];
        for (compliance, of_lanes) in self.compliance.iter_mut().zip(&self.classes) {
            *compliance = P::of(|lane| {
                of_lanes[lane]
                    .map_or(0.0, |class| only(&parameters.link_compliance[class as usize]))
            });
        }
        self.ribbons.set_parameters(parameters);
        for (factors, of_lanes) in self.bend_factors.iter_mut().zip(&self.profiles) {
            for (row, factor) in factors.rows.iter_mut().enumerate() {
                let of = |lane: usize| {
                    of_lanes[lane]
                        .map(|profile| &parameters.bend_factors[profile as usize].rows[row])
                };
                factor.near = P::of(|lane| of(lane).map_or(0.0, |row| only(&row.near)));
                factor.far = P::of(|lane| of(lane).map_or(0.0, |row| only(&row.far)));
                factor.inverse = P::of(|lane| of(lane).map_or(0.0, |row| only(&row.inverse)));
            }
        }
    }
}

impl<P: Pack, C: Constant<P>> LaneBatch<P, C> {
    /// The cloth in its weave, positions and all, if it is woven. Where several cloths lie in the lanes
    /// (`C::SIDE` is 1) it is none: asked first, that spares the compiler all that is done with it.
    pub fn woven(&mut self) -> Option<&mut Weave<P>> {
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

#[cfg(test)]
mod tests {
    use super::Weave;
    use crate::fabric::{Fabric, FabricBuilder, Grid};
    use crate::simd::lane::Pack8;

    fn flag(columns: u32, rows: u32, cell_height: f32) -> Fabric {
        let (width, height) = ((columns - 1) as f32, (rows - 1) as f32 * cell_height);
        let grid = FabricBuilder::grid(Grid::new(columns, rows, width, height));
        grid.pin_where(|_, uv| uv.x == 0.0).build().expect("a good fabric")
    }

    #[test]
    fn grids_are_woven() {
        for (columns, rows) in [(33, 33), (17, 9), (5, 23), (8, 16), (2, 9), (9, 2), (2, 2)] {
            let weave = Weave::<Pack8>::of(&flag(columns, rows, 0.8));
            assert!(weave.is_some(), "{columns} × {rows}");
        }
    }

    #[test]
    fn what_zigzags_is_not() {
        assert!(Weave::<Pack8>::of(&flag(5, 17, 0.1)).is_none());
    }
}
