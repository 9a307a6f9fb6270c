//! Hierarchical position-based dynamics (Müller 2008): coarser cloths are solved before the cloth itself, so
//! that a pull at one end reaches the other after a few sweeps.
//!
//! From the paper: each level keeps some vertices of the finer one, with their masses; the levels are solved
//! once in a substep, the coarsest first; links of coarse levels resist stretch only, since links under
//! compression would remove wrinkles; and a vertex that a level lacks moves by the mean displacement of its
//! parents in that level since the prediction, weighted by one over their distances at rest.
//!
//! Not from the paper: the choice of a level's vertices and links. The paper thins any mesh greedily and
//! collapses its edges onto the remaining vertices; here a level keeps every second row and column of a grid
//! and is linked like the finest level, so a vertex has two or four parents, all at the same distance.

use glam::Vec3;

use super::{
    pbd::{Bending, Pbd},
    projection::project,
    sheet::{Link, Sheet},
    stepper::Stepper,
};
use crate::scenes::Scene;

/// Fewest vertices along a side of the coarsest level.
const COARSEST: usize = 3;

/// A cloth under hierarchical position-based dynamics.
#[derive(Clone, Debug)]
pub struct Hpbd {
    passes: usize,
    /// The coarser levels, the coarsest first.
    levels: Vec<Level>,
    finest: Pbd,
    previous: Vec<Vec3>,
    predicted: Vec<Vec3>,
}

/// A cloth with some of the vertices.
#[derive(Clone, Debug)]
struct Level {
    links: Vec<Link>,
    /// Vertices that only the next finer level has, each with its parents in this level.
    children: Vec<(usize, Parents)>,
}

/// Four vertices whose displacements are averaged. A vertex between two parents lists each of them twice.
type Parents = [usize; 4];

impl Hpbd {
    /// The method, initialised for a sheet of the scene.
    #[must_use]
    pub fn new(sheet: &Sheet, scene: &Scene, passes: usize) -> Self {
        let [columns, rows] = [scene.columns, scene.rows];
        let strides = (1..).map(|level| 1 << level).take_while(|stride| {
            [columns, rows]
                .iter()
                .all(|side| (side - 1) % stride == 0 && (side - 1) / stride + 1 >= COARSEST)
        });
        let mut levels: Vec<Level> = strides.map(|stride| Level::new(scene, stride)).collect();
        levels.reverse();
        Self {
            passes,
            levels,
            finest: Pbd::new(sheet, Bending::OverOne, passes),
            previous: sheet.positions.clone(),
            predicted: sheet.positions.clone(),
        }
    }
}

impl Stepper for Hpbd {
    fn substep(&mut self, sheet: &mut Sheet, h: f32) {
        sheet.predict(&mut self.previous, h);
        self.predicted.copy_from_slice(&sheet.positions);
        for level in &self.levels {
            for _ in 0..self.passes {
                level.relax(sheet);
            }
            level.prolong(sheet, &self.predicted);
        }
        self.finest.relax(sheet);
        sheet.take_velocities_from(&self.previous, h);
    }
}

impl Level {
    /// Level of every `stride`-th row and column of the scene's grid.
    fn new(scene: &Scene, stride: usize) -> Self {
        let [dx, dy] = scene.spacing().map(|d| (d * stride as f64) as f32);
        let at = |i: usize, j: usize| j * scene.columns + i;
        let mut links = Vec::new();
        for j in (0..scene.rows).step_by(stride) {
            for i in (0..scene.columns).step_by(stride) {
                let [right, below] = [i + stride, j + stride];
                let mut link = |a, b, rest| links.push(Link { a, b, rest, stiffness: 0.0 });
                if right < scene.columns {
                    link(at(i, j), at(right, j), dx);
                }
                if below < scene.rows {
                    link(at(i, j), at(i, below), dy);
                }
                if right < scene.columns && below < scene.rows {
                    link(at(i, j), at(right, below), dx.hypot(dy));
                    link(at(right, j), at(i, below), dx.hypot(dy));
                }
            }
        }
        let mut children = Vec::new();
        for j in (0..scene.rows).step_by(stride / 2) {
            for i in (0..scene.columns).step_by(stride / 2) {
                let [left, above] = [i, j].map(|k| k / stride * stride);
                let [right, below] = [i, j].map(|k| k.next_multiple_of(stride));
                if (left, above) != (i, j) {
                    let parents = [(left, above), (right, above), (left, below), (right, below)];
                    children.push((at(i, j), parents.map(|(i, j)| at(i, j))));
                }
            }
        }
        Self { links, children }
    }

    /// Shortens every link that is too long, once.
    fn relax(&self, sheet: &mut Sheet) {
        for link in &self.links {
            let d = sheet.positions[link.b] - sheet.positions[link.a];
            if d.length_squared() > link.rest * link.rest {
                project(link, 1.0, &mut sheet.positions, &sheet.inverse_masses);
            }
        }
    }

    /// Moves the children by the mean displacement of their parents since the prediction.
    fn prolong(&self, sheet: &mut Sheet, predicted: &[Vec3]) {
        for (child, parents) in &self.children {
            if sheet.inverse_masses[*child] > 0.0 {
                let moves = parents.map(|parent| sheet.positions[parent] - predicted[parent]);
                sheet.positions[*child] += moves.into_iter().sum::<Vec3>() * 0.25;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat sheet and its first coarser level.
    fn flat() -> (Sheet, Level) {
        let scene = Scene::swing(5);
        (Sheet::new(&scene), Level::new(&scene, 2))
    }

    #[test]
    fn coarse_links_give_way_to_folds() {
        let (mut sheet, level) = flat();
        sheet.positions.iter_mut().for_each(|x| *x *= 0.9);
        let folded = sheet.positions.clone();
        level.relax(&mut sheet);
        assert_eq!(sheet.positions, folded);
        sheet.positions.iter_mut().for_each(|x| *x *= 1.2);
        let stretched = sheet.positions.clone();
        level.relax(&mut sheet);
        assert_ne!(sheet.positions, stretched);
    }

    #[test]
    fn children_follow_their_parents_evenly() {
        let (mut sheet, level) = flat();
        let predicted = sheet.positions.clone();
        // The level's vertices are sheared; its held row is not displaced.
        let shear = |x: Vec3| Vec3::Y * (x.x * x.z);
        for j in (0..5).step_by(2) {
            for i in (0..5).step_by(2) {
                sheet.positions[5 * j + i] += shear(predicted[5 * j + i]);
            }
        }
        level.prolong(&mut sheet, &predicted);
        for (x, before) in sheet.positions.iter().zip(predicted) {
            assert!(x.distance(before + shear(before)) < 1e-6, "{before}");
        }
    }
}
