//! The constraints of a lone mesh that has no background grid: eight that share no particle are solved at once, in the lanes.
//!
//! Neighbours on a mesh are no neighbours in memory, so particles are vectors (`vector_particles.rs`), which are
//! gathered and transposed. Hinges and links are packed such that their order stays that of the scalar code
//! (`in_order`), yarns by colours (`laid_yarns/across_lanes.rs`): the bits are those of cloths side by side.

mod hinges;
mod in_order;
mod links;

pub(crate) use self::in_order::packs_in_order;

use fearless_simd::Simd;
use glam::Vec3;

use self::hinges::{HingePack, SolveHinges, hinge_packs};
use self::links::{LinkPack, SweepLinks, link_packs};
use super::laid_yarns::YarnPacks;
use super::vector_particles::{VectorParticle, VectorParticles};
use crate::batch::lane_batch::LaneBatch;
use crate::batch::layout::Positions;
use crate::fabric::{Fabric, LaidYarns};
use crate::simd::lane::Pack;
use crate::simd::level::dispatch;
use crate::simd::vec3::{lane3, set_lane3};

/// The particles and constraints of a lone mesh.
#[derive(Clone, Debug)]
pub(crate) struct LoneMesh {
    particles: Vec<VectorParticle>,
    hinges: Vec<HingePack>,
    links: Vec<LinkPack>,
    /// None if the fabric has no laid yarns.
    yarns: Option<YarnPacks>,
    /// Scratch array of the compliances of the classes of hinges, 1/m⁴, or of links, 1/m².
    compliance: Vec<f32>,
}

impl LoneMesh {
    /// The constraints of a fabric; none if it is a grid, or has one.
    pub fn of(fabric: &Fabric) -> Option<Self> {
        if fabric.grid().is_some() || fabric.background().is_some() {
            return None;
        }
        Some(Self {
            particles: vec![VectorParticle::new(); fabric.particle_count()],
            hinges: hinge_packs(fabric),
            links: link_packs(fabric),
            yarns: YarnPacks::of(fabric),
            compliance: Vec::new(),
        })
    }

    /// Projects every hinge, from the first to the last and then backwards, given the compliances of their classes.
    pub(super) fn solve_hinges(&mut self, compliance: impl Iterator<Item = f32>) {
        self.compliance.clear();
        self.compliance.extend(compliance);
        self.run_hinges();
    }

    /// Solves each link once, from the first to the last or backwards, given the compliances of their classes.
    pub(super) fn sweep_links(
        &mut self,
        is_backwards: bool,
        compliance: impl Iterator<Item = f32>,
    ) {
        self.compliance.clear();
        self.compliance.extend(compliance);
        self.run_links(is_backwards);
    }

    /// Solves the laid yarns, if there are any, given the compliance of a square of each family, σ/(Y h²), 1/m².
    pub(super) fn solve_yarns(&mut self, laid: &LaidYarns, compliance: [f32; 3], passes: u32) {
        if let Some(yarns) = &mut self.yarns {
            yarns.solve(laid, compliance, passes, VectorParticles(&mut self.particles));
        }
    }

    fn run_hinges(&mut self) {
        let solve = SolveHinges {
            packs: &mut self.hinges,
            compliance: &self.compliance,
            particles: VectorParticles(&mut self.particles),
        };
        dispatch!(token => solve_hinges(token, solve));
    }

    fn run_links(&mut self, is_backwards: bool) {
        let sweep = SweepLinks {
            packs: &self.links,
            is_backwards,
            compliance: &self.compliance,
            particles: VectorParticles(&mut self.particles),
        };
        dispatch!(token => sweep_links(token, sweep));
    }
}

impl<P: Pack> LaneBatch<P> {
    /// Copies the particles of the cloth in the first lane to where constraints are solved across the lanes.
    pub(super) fn begin_lone_mesh(&mut self) {
        let Some(mesh) = &mut self.lone_mesh else { return };
        let state = self.positions.packs().iter().zip(&self.correction).zip(&self.masses.inverse);
        for (particle, ((position, correction), inverse_mass)) in
            mesh.particles.iter_mut().zip(state)
        {
            let [x, y, z] = lane3(position, 0).to_array();
            let predicted = [x, y, z, inverse_mass.lanes()[0]];
            particle.predicted.lanes_mut().copy_from_slice(&predicted);
            let [x, y, z] = lane3(correction, 0).to_array();
            particle.correction.lanes_mut().copy_from_slice(&[x, y, z, 0.0]);
        }
    }

    /// Copies the sums of corrections back.
    pub(super) fn end_lone_mesh(&mut self) {
        let Some(mesh) = &self.lone_mesh else { return };
        for (correction, particle) in self.correction.iter_mut().zip(&mesh.particles) {
            let [x, y, z, _] = particle.correction.vector();
            set_lane3(correction, 0, Vec3::new(x, y, z));
        }
    }
}

#[inline(always)]
fn solve_hinges<S: Simd>(token: S, solve: SolveHinges<'_>) {
    solve.run(token);
}

#[inline(always)]
fn sweep_links<S: Simd>(token: S, sweep: SweepLinks<'_>) {
    sweep.run(token);
}
