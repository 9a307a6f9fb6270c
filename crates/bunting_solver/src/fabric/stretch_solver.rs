//! Which lines of a fabric resist its stretch.

use super::fabric::Fabric;

/// What solves the stretch of a fabric, which tells how exact and how dear its cloths are. It follows from the mesh when the
/// fabric is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StretchSolver {
    /// The rows and columns of a [`Grid`](crate::Grid).
    Grid,
    /// The rows and columns of a grid under a mesh that fills a rectangle, or maps onto one. As exact as a grid, at 1.2 to
    /// 2 times its time.
    BackgroundGrid,
    /// The rows and columns of a grid that reaches beyond the border of a mesh, such as a disk, or a sheet with holes. At 2 to
    /// 5 times the time of a grid; stiff cloth is up to a fifth too soft.
    CutGrid,
    /// The sides of quads that run through a mesh of any shape: of its own, or of quads that are laid onto its triangles. At 2 to
    /// 5 times the time of a grid, tubes with slanting seams up to 8; clothes take half as many substeps again. Those that hang
    /// from a few points sink about a centimetre too far, stiff ones several.
    QuadLines,
    /// Lines laid across the triangles of any other mesh, and of uneven ones without pins: too soft where stiff, at 6 to 13 times
    /// the time of a grid.
    LaidYarns,
}

impl Fabric {
    /// What solves its stretch.
    #[must_use]
    pub fn stretch_solver(&self) -> StretchSolver {
        match self.background() {
            _ if self.grid().is_some() => StretchSolver::Grid,
            None if self.is_net() => StretchSolver::QuadLines,
            None => StretchSolver::LaidYarns,
            Some(background) if background.fabric.is_net() => StretchSolver::QuadLines,
            Some(background) if background.fabric.is_cut() => StretchSolver::CutGrid,
            Some(_) => StretchSolver::BackgroundGrid,
        }
    }
}
