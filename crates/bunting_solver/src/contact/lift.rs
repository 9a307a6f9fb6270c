//! Lifts displayed triangles out of shapes: particles keep their clearance, but a triangle between them can cut
//! a sharp edge.

use glam::{Quat, Vec3};

use crate::contact::collider::Collider;
use crate::contact::obstacle::Obstacle;
use crate::contact::plane::Plane;
use crate::fabric::Fabric;

/// Number of sweeps over the triangles. Fewer: a triangle that is cut in two places remains cut in one.
const SWEEPS: usize = 3;

/// Computes displacements of a displayed cloth's particles that lift its triangles out of colliders. Its
/// buffers are kept from one cloth to the next.
///
/// Meshes of triangles without orientation have no inside and are skipped.
///
/// ```
/// use bunting_solver::{ClothSnapshot, Collider, FabricBuilder, Grid, SurfaceLift};
/// use glam::{Quat, Vec3};
/// use parry3d::shape::SharedShape;
///
/// // A thin cuboid sticks through the middle of a cell, where no particle is.
/// let fabric = FabricBuilder::grid(Grid::new(9, 9, 1.0, 1.0)).build()?;
/// let positions = ClothSnapshot::at_rest(&fabric).positions;
/// let at = (positions[0] + positions[10]) / 2.0;
/// let spike = Collider::fixed(SharedShape::cuboid(0.01, 0.01, 0.05), at, Quat::IDENTITY);
///
/// let mut lifts = Vec::new();
/// SurfaceLift::default().compute(&fabric, &positions, 2e-3, [&spike], &mut lifts);
/// assert!(!lifts.is_empty());
/// # Ok::<(), bunting_solver::FabricError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct SurfaceLift {
    /// Positions in the frame of the present collider, m.
    positions: Vec<Vec3>,
    /// Plane of the present collider nearest to each particle, if it has been computed.
    planes: Vec<Option<Plane>>,
    /// Displacements so far, in the cloth's frame, m.
    lifts: Vec<Vec3>,
}

impl SurfaceLift {
    /// Writes the particles to be displaced, and their displacements (m), into `into`. `positions` are those
    /// of a fabric's particles in the cloth's frame, m. Colliders have their poses at the end of the tick.
    pub fn compute<'a>(
        &mut self,
        fabric: &Fabric,
        positions: &[Vec3],
        thickness: f32,
        colliders: impl IntoIterator<Item = &'a Collider>,
        into: &mut Vec<(u32, Vec3)>,
    ) {
        into.clear();
        let cutting =
            colliders.into_iter().filter(|collider| Obstacle::can_cut(&*collider.shape.0));
        let mut cutting = cutting.peekable();
        if cutting.peek().is_none() {
            return;
        }
        self.lifts.clear();
        self.lifts.resize(positions.len(), Vec3::ZERO);
        for collider in cutting {
            let pose = collider.pose_at(1.0);
            let lifted = positions.iter().zip(&self.lifts).map(|(at, lift)| at + lift);
            self.positions.clear();
            self.positions.extend(lifted.map(|at| pose.inverse_transform_point(at)));
            self.planes.clear();
            self.planes.resize(positions.len(), None);
            let obstacle = Obstacle::new(collider, thickness);
            for _ in 0..SWEEPS {
                if !self.sweep(fabric, &obstacle, pose.rotation) {
                    break;
                }
            }
        }
        let displaced = (0..).zip(&self.lifts).filter(|(_, lift)| **lift != Vec3::ZERO);
        into.extend(displaced.map(|(particle, lift)| (particle, *lift)));
    }

    /// Lifts every triangle that an obstacle cuts. Returns whether any was cut.
    fn sweep(&mut self, fabric: &Fabric, obstacle: &Obstacle, rotation: Quat) -> bool {
        let mut any = false;
        for triangle in fabric.triangles() {
            let particles = triangle.map(|particle| particle as usize);
            let corners = particles.map(|particle| self.positions[particle]);
            if obstacle.is_beside(&corners) || self.is_above(particles, &corners, obstacle) {
                continue;
            }
            let Some(cut) = obstacle.deepest_cut(&corners) else { continue };
            let inverse_masses = particles.map(|at| f32::from(!fabric.is_pinned(at)));
            let Some(parts) = cut.corner_shifts(inverse_masses) else { continue };
            any = true;
            for (part, particle) in parts.into_iter().zip(particles) {
                let lift = cut.normal * (cut.depth * part);
                self.positions[particle] += lift;
                self.lifts[particle] += rotation * lift;
                self.planes[particle] = None;
            }
        }
        any
    }

    /// Whether the whole triangle lies above the plane nearest to one of its corners.
    fn is_above(
        &mut self,
        particles: [usize; 3],
        corners: &[Vec3; 3],
        obstacle: &Obstacle,
    ) -> bool {
        particles.into_iter().zip(corners).any(|(particle, corner)| {
            let plane = match self.planes[particle] {
                Some(plane) => plane,
                None => {
                    let Some(plane) = obstacle.nearest_plane(*corner) else { return false };
                    *self.planes[particle].insert(plane)
                }
            };
            obstacle.least_distance(*corner, &plane, corners) >= obstacle.kept
        })
    }
}
