//! Solves the constraints of a substep, stage by stage.

use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::{Layout, Positions};
use crate::batch::mixed::Mixed;
use crate::batch::side_by_side::SideBySide;
use crate::batch::single_cloth::SingleCloth;
use crate::batch::single_net::SingleNet;
use crate::constraints::order::{Stage, order_of};
use crate::simd::lane::Pack;
use crate::step::Scheme;

/// A layout whose cloths may be solved by the scheme of Gauss–Seidel: side by side alone.
pub(crate) trait Relaxed<P: Pack>: Layout<P> {
    /// Solves all constraints of a batch.
    fn solve_gauss_seidel(_: &mut LaneBatch<P, Self>) {
        unreachable!("a lone cloth is laid out for its scheme, and a mixed batch has yarns");
    }
}

impl<P: Pack> Relaxed<P> for SideBySide<P> {
    fn solve_gauss_seidel(batch: &mut LaneBatch<P, Self>) {
        batch.solve_gauss_seidel();
    }
}

impl<P: Pack> Relaxed<P> for SingleCloth<P> {}
impl<P: Pack> Relaxed<P> for Mixed<P> {}
impl Relaxed<crate::simd::registers::Pack8> for SingleNet {}

impl<P: Pack, Y: Relaxed<P>> LaneBatch<P, Y> {
    /// Projects the predicted positions onto all constraints.
    pub fn solve_constraints(&mut self) {
        self.solve_all_bending();
        self.solve_all_but_bending();
    }

    /// The first part of [`solve_constraints`](Self::solve_constraints) in the scheme of yarns: bending, if it comes first.
    pub fn solve_all_bending(&mut self) {
        let has_stages = self.clock.settings.scheme == Scheme::Yarns;
        if has_stages && !self.clock.stands_still() && self.stages()[0] == Stage::Bending {
            self.solve_stage(Stage::Bending);
        }
    }

    /// The second part of [`solve_constraints`](Self::solve_constraints): all that is left.
    pub fn solve_all_but_bending(&mut self) {
        if self.clock.stands_still() {
            return;
        }
        if self.clock.settings.scheme == Scheme::GaussSeidel {
            Y::solve_gauss_seidel(self);
            self.close_seams();
            return;
        }
        for &stage in self.stages().iter().filter(|stage| **stage != Stage::Bending) {
            self.solve_stage(stage);
        }
        self.close_seams();
        // This call copies the positions back from the constraints' arrays.
        self.positions.packs_mut();
        self.sum_reactions();
        self.solve_guides();
        self.solve_contacts();
    }
}

impl<P: Pack, Y: Layout<P>> LaneBatch<P, Y> {
    /// The stages of the substep that has begun.
    fn stages(&self) -> &'static [Stage] {
        let is_even = self.clock.begun.is_multiple_of(2);
        order_of(&self.fabric, self.clock.settings.substeps)[usize::from(is_even)]
    }

    fn solve_stage(&mut self, stage: Stage) {
        let passes = self.clock.settings.passes;
        match stage {
            Stage::Bending => self.solve_all_bends(),
            Stage::BendingOfTautLines => self.solve_bends_of_taut_lines(),
            Stage::Lines => self.solve_lines(passes),
            Stage::Strips => self.solve_strips(passes),
            Stage::LinesBothWays => self.solve_lines_both_ways(passes),
            Stage::Tethers => self.solve_tethers(),
            Stage::Sweep => (0..passes / 2).for_each(|_| self.sweep_links(false)),
            Stage::SweepBackwards => (0..passes / 2).for_each(|_| self.sweep_links(true)),
            Stage::Overlong => self.solve_overlong_chains(),
        }
        if matches!(stage, Stage::Lines | Stage::Strips | Stage::LinesBothWays) {
            self.move_all_layers_apart();
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::batch::lane_batch::LaneBatch;
    use crate::constraints::bench::{cloth_at, positions};
    use crate::constraints::chain::Pass;
    use crate::fabric::{Fabric, FabricBuilder, FabricMaterial, LinkFamily, Resolution};
    use crate::simd::lane::Pack;
    use crate::simd::registers::Pack1;

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
        let mesh = FabricBuilder::new(rings.clone().map(place).collect(), quads.collect());
        let net = mesh.resampled(Resolution::Particles(ROUND * ACROSS)).expect("a good mesh");
        Fabric::clone(&net.fabric)
    }

    #[test]
    fn a_net_is_solved_by_self_adjoint_projections() {
        let net = &torus();
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
    fn bending_after_lines_leaves_their_tensions() {
        let net = &torus();
        let material = FabricMaterial { bend_stiffness: 1.0, ..FabricMaterial::FLAG_POLYESTER };
        let wavy = |at: &Vec3| *at * (1.0 + 0.1 * libm::sinf(40.0 * at.x));
        let start: Vec<Vec3> = net.rest_positions().iter().map(wavy).collect();
        let mut batch = cloth_at(net, material, &start);
        assert!(batch.parameters.any_bends_stiffly());
        batch.solve_warp_and_weft(Pass::First);
        let targets_of = |batch: &LaneBatch<Pack1>| -> Vec<f32> {
            batch.link_target.iter().map(|at| at.lanes()[0]).collect()
        };
        let (stretched, targets) = (positions(&batch), targets_of(&batch));
        batch.solve_bends_of_taut_lines();
        assert!(positions(&batch) != stretched && targets_of(&batch) == targets);
    }
}
