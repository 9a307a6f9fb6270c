//! The order in which constraints are solved in a substep.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::batch::mixed::Mixed;
use crate::batch::side_by_side::SideBySide;
use crate::batch::single_cloth::SingleCloth;
use crate::batch::single_net::SingleNet;
use crate::simd::lane::Pack;
use crate::step::Scheme;

impl<P: Pack> LaneBatch<P, SideBySide<P>> {
    /// Projects the predicted positions onto all constraints.
    ///
    /// A mesh with a background grid is solved on that (`background.rs`). The hinges of other meshes are
    /// solved forwards and backwards, and so are the yarns that are laid across them (`laid_yarns/`). Each solve of a
    /// yarn is a projection, self-adjoint in the metric of the masses, with eigenvalues from 0 to 1. A sequence of
    /// solves that reads the same backwards is self-adjoint, too, and a product of two such sequences still has real
    /// eigenvalues from 0 to 1, like an implicit step of a stiffer cloth. A product of three different projections has
    /// complex eigenvalues: circulatory forces, which make a mesh at rest vibrate and spin. Hinges, yarns and tethers are
    /// three. Every second substep therefore solves yarns before hinges, so that its circulatory forces have the opposite
    /// sign (`both_ways.rs`); tethers end both orders.
    pub fn solve_constraints(&mut self) {
        self.solve_all_bending();
        self.solve_all_but_bending();
    }

    /// The first part of [`solve_constraints`](Self::solve_constraints) in the scheme of yarns: bending.
    pub fn solve_all_bending(&mut self) {
        if self.clock.stands_still() || self.clock.settings.scheme == Scheme::GaussSeidel {
            return;
        }
        if self.fabric.bends_along_lines() {
            self.solve_bending_before_stretch();
        } else if self.background.is_some() {
            self.solve_bending_on_background();
        } else if !self.bends_mesh_after_stretch() {
            self.solve_dihedral_both_ways();
        }
    }

    /// The second part of [`solve_constraints`](Self::solve_constraints); with Gauss–Seidel, all of it.
    pub fn solve_all_but_bending(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        match self.clock.settings.scheme {
            Scheme::GaussSeidel => self.solve_gauss_seidel(),
            Scheme::Yarns if self.fabric.has_shear_cells() => self.solve_grid_and_contacts(),
            Scheme::Yarns if self.background.is_some() => self.solve_stretch_on_background(),
            Scheme::Yarns => {
                if self.fabric.grid().is_some() {
                    self.solve_chains_both_ways(self.clock.settings.passes);
                } else {
                    self.solve_stretch_of_mesh(self.clock.settings.passes);
                    if self.bends_mesh_after_stretch() {
                        self.solve_dihedral_both_ways();
                    }
                }
                self.solve_tethers();
                self.sum_reactions();
                self.solve_guides();
                self.solve_contacts();
            }
        }
    }

    /// Whether this substep solves the hinges of a mesh with laid yarns after its yarns, as each tick's second, fourth and so on do.
    fn bends_mesh_after_stretch(&self) -> bool {
        self.clock.begun.is_multiple_of(2)
    }

    /// Solves the laid yarns of a mesh. A sweep over its links, forwards before them and backwards after, holds
    /// particles that few yarns move.
    fn solve_stretch_of_mesh(&mut self, passes: u32) {
        self.begin_lone_mesh();
        self.sweep_mesh(false);
        self.solve_laid_yarns(passes);
        self.sweep_mesh(true);
        self.apply_corrections();
    }

    /// Solves all yarns forwards and then backwards in each pass, and adds to the sums of corrections.
    fn solve_laid_yarns(&mut self, passes: u32) {
        if let Some(mesh) = &mut self.lone_mesh {
            let compliance = self.layout.modulus_compliance.map(|pack| pack.lanes()[0]);
            mesh.solve_yarns(self.fabric.laid_yarns(), compliance, passes);
        } else {
            self.solve_yarns_side_by_side(passes);
        }
    }
}

/// A layout of grids that are solved by the scheme of yarns.
pub(crate) trait GridLayout {}

impl<P: Pack> GridLayout for SingleCloth<P> {}
impl<P: Pack> GridLayout for Mixed<P> {}

impl GridLayout for SingleNet {}

impl<P: Pack, Y: Layout<P> + GridLayout> LaneBatch<P, Y> {
    /// Projects the predicted positions onto all constraints.
    pub fn solve_constraints(&mut self) {
        self.solve_all_bending();
        self.solve_all_but_bending();
    }

    /// The first part of [`solve_constraints`](Self::solve_constraints): bending.
    pub fn solve_all_bending(&mut self) {
        if !self.clock.stands_still() {
            self.solve_bending_before_stretch();
        }
    }

    /// The second part of [`solve_constraints`](Self::solve_constraints): all other constraints.
    pub fn solve_all_but_bending(&mut self) {
        if !self.clock.stands_still() {
            self.solve_grid_and_contacts();
        }
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// Solves stretch and contacts of a grid after bending, since stretch is stiffer.
    fn solve_grid_and_contacts(&mut self) {
        self.solve_stretch_of_grid();
        // This call copies the positions back from the constraints' arrays.
        self.positions.packs_mut();
        self.sum_reactions();
        self.solve_guides();
        self.solve_contacts();
    }

    /// Solves chains and tethers of a grid, and bending if that comes after them in this substep. For every second pass a
    /// sweep over warp and weft corrects the overshoot of the chains' frozen directions, and chains that still have
    /// overlong links are solved again.
    pub fn solve_stretch_of_grid(&mut self) {
        let passes = self.clock.settings.passes;
        let begins_with_tethers = self.begins_with_tethers();
        if begins_with_tethers {
            self.solve_tethers();
        }
        if self.is_narrow() {
            self.solve_strips(passes);
        } else {
            self.solve_chains(passes);
        }
        if begins_with_tethers {
            self.solve_bending_after_stretch();
        } else {
            self.solve_tethers();
        }
        for _ in 0..passes / 2 {
            self.sweep_links();
        }
        self.solve_overlong_chains();
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::batch::lane_batch::LaneBatch;
    use crate::constraints::bench::{cloth_at, positions};
    use crate::constraints::chain::Pass;
    use crate::fabric::{Fabric, FabricBuilder, FabricMaterial, LinkFamily};
    use crate::simd::lane::Pack;
    use crate::simd::registers::Pack1;
    use crate::step::Scheme;

    /// A ball of 30 cm, of twenty triangles.
    fn icosahedron() -> Fabric {
        let golden = 1.618_034;
        let corners = (0..12).map(|corner: u32| {
            let sign = |bit: u32| if corner & bit == 0 { 1.0 } else { -1.0 };
            let mut at = [0.0, sign(1), golden * sign(2)];
            at.rotate_right(corner as usize / 4);
            Vec3::from(at).normalize() * 0.3
        });
        let corners: Vec<Vec3> = corners.collect();
        let near = |a: usize, b: usize| corners[a].distance(corners[b]) < 0.33;
        let mut indices = Vec::new();
        for (a, b, c) in
            (0..12).flat_map(|a| (a..12).flat_map(move |b| (b..12).map(move |c| (a, b, c))))
        {
            if a < b && b < c && near(a, b) && near(b, c) && near(c, a) {
                let outwards = corners[a].cross(corners[b]).dot(corners[c]) > 0.0;
                indices.extend(if outwards { [a, b, c] } else { [a, c, b] }.map(|at| at as u32));
            }
        }
        FabricBuilder::new(corners, indices).build().expect("a good fabric")
    }

    /// Returns |⟨P u, v⟩ − ⟨u, P v⟩|/(|u| |v|) in the metric of the masses, where P is the effect of `solve`
    /// on small displacements u and v of a fabric at rest.
    fn asymmetry(fabric: &Fabric, solve: impl Fn(&mut LaneBatch<Pack1>)) -> f32 {
        const SIZE: f32 = 1e-4;
        let material = FabricMaterial { bend_stiffness: 10.0, ..FabricMaterial::FLAG_POLYESTER };
        let rest = fabric.rest_positions();
        let displaced = |seed: f32| -> Vec<Vec3> {
            let wave = |at: Vec3| {
                Vec3::new(1.0, 2.0, 3.0)
                    .map(|axis| libm::sinf(seed * at.dot(Vec3::new(9.0, 7.0, 4.0)) * axis + axis))
            };
            rest.iter().map(|&at| wave(at)).collect()
        };
        let solved = |by: &[Vec3]| -> Vec<Vec3> {
            let start: Vec<Vec3> = rest.iter().zip(by).map(|(at, by)| *at + *by * SIZE).collect();
            let mut batch = cloth_at(fabric, material, &start);
            solve(&mut batch);
            positions(&batch).iter().zip(rest).map(|(end, at)| (*end - *at) / SIZE).collect()
        };
        let product = |a: &[Vec3], b: &[Vec3]| -> f32 {
            a.iter()
                .zip(b)
                .zip(fabric.particle_areas())
                .map(|((a, b), area)| a.dot(*b) * area)
                .sum()
        };
        let (u, v) = (displaced(1.0), displaced(2.0));
        let difference = product(&solved(&u), &v) - product(&u, &solved(&v));
        difference.abs() / (product(&u, &u) * product(&v, &v)).sqrt()
    }

    /// A torus of quads, whose lines are closed.
    fn torus() -> Fabric {
        const ROUND: u32 = 12;
        const ACROSS: u32 = 8;
        let turn = |at: u32, of: u32| core::f32::consts::TAU * at as f32 / of as f32;
        let rings = (0..ROUND).flat_map(|ring| (0..ACROSS).map(move |at| (ring, at)));
        let place = |(ring, at): (u32, u32)| {
            let (azimuth, polar) = (turn(ring, ROUND), turn(at, ACROSS));
            let away = 0.3 + 0.15 * libm::cosf(polar);
            Vec3::new(
                away * libm::cosf(azimuth),
                0.15 * libm::sinf(polar),
                away * libm::sinf(azimuth),
            )
        };
        let index = |ring: u32, at: u32| (ring % ROUND) * ACROSS + at % ACROSS;
        let quads = rings.clone().flat_map(|(ring, at)| {
            let [a, b] = [0, 1].map(|by| index(ring, at + by));
            let [c, d] = [0, 1].map(|by| index(ring + 1, at + by));
            [a, b, c, c, b, d]
        });
        FabricBuilder::new(rings.clone().map(place).collect(), quads.collect())
            .build()
            .expect("a good fabric")
    }

    #[test]
    fn a_net_is_solved_by_self_adjoint_projections() {
        let mesh = torus();
        let net = &mesh.background().expect("a net").fabric;
        let with = |solve: &dyn Fn(&mut LaneBatch<Pack1>)| {
            asymmetry(net, |batch| {
                batch.set_diagonals_at_rest(0..1);
                batch.solve_warp_and_weft(Pass::First);
                solve(batch);
            })
        };
        let both_ways = with(&|batch| batch.solve_passes_both_ways(2));
        let one_way = with(&|batch| {
            for _ in 0..2 {
                let colours = 0..batch.colour_count();
                batch.solve_colours(colours, Pass::Again, |it| it == LinkFamily::Diagonal);
                batch.solve_warp_and_weft(Pass::Again);
            }
        });
        assert!(both_ways < 1e-4 && one_way > 3e-4, "{both_ways}, one way {one_way}");
    }

    #[test]
    fn a_net_is_bent_before_and_after_stretch_in_turn() {
        let mesh = torus();
        let net = &mesh.background().expect("a net").fabric;
        let material = FabricMaterial { bend_stiffness: 1.0, ..FabricMaterial::FLAG_POLYESTER };
        let wavy = |at: &Vec3| *at * (1.0 + 0.1 * libm::sinf(40.0 * at.x));
        let start: Vec<Vec3> = net.rest_positions().iter().map(wavy).collect();
        for begun in 1..=4 {
            let mut batch = cloth_at(net, material, &start);
            assert!(batch.parameters.any_bends_stiffly());
            batch.clock.begun = begun;
            batch.solve_bending_before_stretch();
            let comes_after = positions(&batch) == start;
            assert_eq!(comes_after, begun % 2 == 1, "substep {begun}");
            batch.solve_warp_and_weft(Pass::First);
            let targets_of = |batch: &LaneBatch<Pack1>| -> Vec<f32> {
                batch.link_target.iter().map(|at| at.lanes()[0]).collect()
            };
            let (stretched, targets) = (positions(&batch), targets_of(&batch));
            batch.solve_bending_after_stretch();
            assert!(positions(&batch) != stretched && targets_of(&batch) == targets);
        }
    }

    #[test]
    fn a_mesh_is_bent_before_and_after_its_yarns_in_turn() {
        let ball = icosahedron();
        let material = FabricMaterial { bend_stiffness: 1.0, ..FabricMaterial::FLAG_POLYESTER };
        let start: Vec<Vec3> =
            ball.rest_positions().iter().map(|at| *at * Vec3::new(1.3, 1.0, 0.8)).collect();
        let solved = |solve: &dyn Fn(&mut LaneBatch<Pack1>)| {
            let mut batch = cloth_at(&ball, material, &start);
            batch.clock.settings.scheme = Scheme::Yarns;
            solve(&mut batch);
            positions(&batch)
        };
        let bend = LaneBatch::<Pack1>::solve_dihedral_both_ways;
        let stretch = |batch: &mut LaneBatch<Pack1>| batch.solve_stretch_of_mesh(1);
        let bent_before = solved(&|batch| {
            bend(batch);
            stretch(batch);
        });
        let bent_after = solved(&|batch| {
            stretch(batch);
            bend(batch);
        });
        assert_ne!(bent_before, bent_after);
        for (begun, expected) in
            [&bent_before, &bent_after, &bent_before, &bent_after].into_iter().enumerate()
        {
            let substep = solved(&|batch| {
                batch.clock.begun = begun as u32 + 1;
                batch.solve_constraints();
            });
            assert_eq!(&substep, expected, "substep {}", begun + 1);
        }
    }

    #[test]
    fn a_mesh_is_solved_by_self_adjoint_projections() {
        let ball = icosahedron();
        let asymmetry = |solve: fn(&mut LaneBatch<Pack1>)| asymmetry(&ball, solve);
        let bending = asymmetry(|batch| batch.solve_dihedral_both_ways());
        let one_way = asymmetry(|batch| batch.solve_dihedral(false));
        assert!(bending < 2e-3 && one_way > 1e-2, "bending {bending}, one way {one_way}");
        let stretch = asymmetry(|batch| batch.solve_stretch_of_mesh(2));
        let one_way = asymmetry(|batch| {
            batch.begin_lone_mesh();
            batch.sweep_mesh(false);
            batch.solve_laid_yarns(2);
            batch.apply_corrections();
        });
        assert!(stretch < 2e-3 && one_way > 1e-2, "stretch {stretch}, one way {one_way}");
    }
}
