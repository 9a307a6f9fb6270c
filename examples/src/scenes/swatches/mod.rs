//! Gauze, linen and wool hang on a rail against the sun.

#[cfg(feature = "render")]
mod draw;
mod rail;
mod swatch;

use bevy::ecs::schedule::ScheduleLabel;
use bevy::prelude::*;
use bevy_bunting::prelude::*;

use crate::limits::Limit;
use crate::scenes::swatches::rail::{RAIL, SPACING};
use crate::scenes::swatches::swatch::{SIZE, Swatch};
use crate::strain::greatest_mean;
use crate::{OrbitExample, View};

/// Limit of the mean strain of a cloth: larger strain would be visible.
const STRAIN_LIMIT: f32 = 0.01;

const SWATCHES: [Swatch; 3] = [
    Swatch {
        fabric: FabricMaterial::SILK,
        colour: [0.93, 0.86, 0.70],
        threads: 400.0,
        relief: 0.15,
        gaps: 1.0,
        transmission: 0.5,
    },
    Swatch {
        fabric: FabricMaterial::COTTON,
        colour: [0.30, 0.48, 0.62],
        threads: 200.0,
        relief: 0.25,
        gaps: 0.5,
        transmission: 0.3,
    },
    Swatch {
        fabric: FabricMaterial {
            area_density: 0.3,
            bend_stiffness: 3e-4,
            ..FabricMaterial::COTTON
        },
        colour: [0.90, 0.66, 0.46],
        threads: 90.0,
        relief: 0.4,
        gaps: 0.2,
        transmission: 0.08,
    },
];

/// Three cloths on a rail.
#[derive(Clone, Copy, Debug)]
pub struct Swatches;

impl OrbitExample for Swatches {
    const NAME: &'static str = "Swatches";
    const SECONDS: f64 = 8.0;
    const VIEW: View = View { eye: Vec3::new(0.3, 1.3, 0.95), centre: Vec3::new(0.05, 1.27, 0.0) };

    #[cfg(feature = "render")]
    const STAGE: crate::render::stage::Stage = draw::STAGE;

    fn build(app: &mut App, _schedule: impl ScheduleLabel) {
        let mut commands = app.world_mut().commands();
        commands.spawn(WindField::steady(Vec3::new(0.3, 0.0, 0.3)).with_gusts(0.6, 0.7, 5));
        let rail = commands.spawn(Transform::from_xyz(0.0, RAIL, 0.0)).id();
        for (index, swatch) in (0_u8..).zip(SWATCHES) {
            let left = (f32::from(index) - 1.0) * SPACING - 0.03;
            commands.spawn((
                swatch,
                ClothMesh::grid(37, 51, SIZE.x, SIZE.y),
                ClothMaterial(swatch.fabric),
                SelfCollision::default(),
                Attachment::new(rail, AttachedVertices::Corners(vec![ClothCorner::TopLeft]))
                    .with_offset(Transform::from_xyz(left, 0.0, 0.0)),
            ));
        }
    }

    /// Greatest mean strain of a cloth.
    fn measure(world: &mut World) -> Vec<Limit> {
        let strain = greatest_mean(world);
        vec![Limit { name: "mean strain of a cloth", value: strain, limit: STRAIN_LIMIT }]
    }

    #[cfg(feature = "render")]
    fn draw(app: &mut App) {
        app.add_plugins(draw::plugin);
    }
}
