//! Sheets of other sizes that fall on their edges: towels of the size of the example's, and a sheet from a height.

use bunting_solver::{ClothSnapshot, Collider, Drive, FabricMaterial};
use glam::{Quat, Vec3};
use parry3d::shape::SharedShape;

use super::{
    super::{
        rig::{GRAVITY, Trial, sheet, substeps},
        row::Row,
    },
    layers::LAYERS,
    watch::Watch,
};
use crate::product::TICK;

/// A sheet that falls on its edge.
#[derive(Clone, Copy)]
struct Fall {
    name: &'static str,
    /// Numbers of columns and rows.
    particles: [u32; 2],
    /// Width and height, m.
    size: [f32; 2],
    /// Height of the lower edge above the floor, m.
    drop: f32,
    /// Angle by which the sheet leans, rad.
    lean: f32,
    /// Distance that layers keep, m.
    layers: f32,
    substeps: u32,
}

const TOWEL: Fall = Fall {
    name: "towel of 21 × 41 dropped on its edge",
    particles: [21, 41],
    size: [0.5, 1.0],
    drop: 0.05,
    lean: 0.08,
    layers: LAYERS,
    substeps: 2,
};

const ALL: [Fall; 4] = [
    TOWEL,
    Fall { substeps: 4, ..TOWEL },
    Fall { name: "towel of 21 × 41 with layers of 3 mm", layers: 3e-3, ..TOWEL },
    Fall {
        name: "sheet of 33² dropped from 0.3 m on its edge",
        particles: [33, 33],
        size: [1.0, 1.0],
        drop: 0.3,
        ..TOWEL
    },
];

/// Rows of the most intersecting pairs in a tick, and of those at rest.
pub(super) fn rows(quick: bool) -> Vec<Row> {
    let falls = if quick { &ALL[..2] } else { &ALL };
    falls.iter().flat_map(|fall| fall.rows()).collect()
}

impl Fall {
    fn rows(&self) -> [Row; 2] {
        /// Most pairs in a tick.
        const MOST: f64 = 2.0;
        let (watch, us) = self.watch(4.0);
        let name = format!("{}, {} substeps", self.name, self.substeps);
        let unit = "intersecting pairs";
        [
            Row::new(format!("{name}: a tick"), unit, watch.most as f64, MOST, us),
            Row::new(format!("{name}: at rest"), unit, watch.last as f64, 0.0, us),
        ]
    }

    /// Drops the sheet, and watches it for some seconds; returns the mean time of a tick, too, µs.
    fn watch(&self, seconds: f32) -> (Watch, f64) {
        let ([columns, rows], [width, height]) = (self.particles, self.size);
        let fabric = sheet(columns, rows, width, height);
        let mut start = ClothSnapshot::at_rest(&fabric);
        for at in &mut start.positions {
            *at = Quat::from_rotation_x(self.lean) * *at + (height + self.drop) * Vec3::Y;
        }
        let material = FabricMaterial { area_density: 0.35, ..FabricMaterial::COTTON };
        let gravity = -GRAVITY * Vec3::Y;
        let mut cloth =
            Trial::from(&fabric, &start, material, gravity).with(substeps(self.substeps));
        cloth.drive(Drive { gravity, ..Drive::default() });
        cloth.keep_layers_apart(Some(self.layers));
        let floor = SharedShape::halfspace(Vec3::Y);
        cloth.touch([Collider {
            friction: 0.5,
            ..Collider::fixed(floor, Vec3::ZERO, Quat::IDENTITY)
        }]);
        let mut watch = Watch::default();
        for _ in 0..(seconds / TICK) as usize {
            cloth.tick();
            watch.note(&cloth);
        }
        (watch, cloth.us())
    }
}
