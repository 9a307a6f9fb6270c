//! Materials, regions and settings of all cloths: any of them is simulated, or told.

use std::time::Duration;

use bevy_app::App;
use bevy_bunting::bunting_solver::{RegionShape, Scheme};
use bevy_bunting::prelude::*;
use bevy_math::Vec3;
use bevy_time::TimeUpdateStrategy;
use bevy_transform::prelude::*;
use bunting_tests::run;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

use super::beside::{app_of_its_own, assert_all_finite, flag_goes_on};
use super::for_all;
use super::numbers::{number, uv, vector};

/// A preset of which some numbers are others.
fn material() -> BoxedStrategy<FabricMaterial> {
    let presets = [FabricMaterial::FLAG_POLYESTER, FabricMaterial::SILK, FabricMaterial::DENIM];
    (select(presets.to_vec()), vec((0..11_usize, number()), 1..4))
        .prop_map(|(mut material, numbers)| {
            for (field, number) in numbers {
                let fields = [
                    &mut material.area_density,
                    &mut material.warp_stiffness,
                    &mut material.weft_stiffness,
                    &mut material.shear_stiffness,
                    &mut material.bend_stiffness,
                    &mut material.damping,
                    &mut material.internal_damping,
                    &mut material.pressure_coefficient,
                    &mut material.friction_coefficient,
                    &mut material.thickness,
                    &mut material.surface_friction,
                ];
                *fields.into_iter().nth(field).expect("a field") = number;
            }
            material
        })
        .boxed()
}

fn region() -> BoxedStrategy<MaterialRegion> {
    let shape = prop_oneof![
        vec(number(), 0..60).prop_map(RegionShape::Vertices),
        (uv(), uv()).prop_map(|(from, to)| RegionShape::UvBox { from, to }),
        (uv(), uv(), number()).prop_map(|(from, to, width)| RegionShape::UvLine {
            from,
            to,
            width
        }),
        (0..5_u32, vec(number(), 0..20))
            .prop_map(|(columns, weights)| RegionShape::Image { columns, weights }),
        vec(number(), 0..4).prop_map(RegionShape::Depth),
    ];
    (shape, number(), number(), number())
        .prop_map(|(shape, stretch, bending, density)| MaterialRegion {
            shape,
            stretch,
            bending,
            density,
        })
        .boxed()
}

fn limits() -> BoxedStrategy<StepLimits> {
    let schemes = [Scheme::Yarns, Scheme::GaussSeidel];
    (select(schemes.to_vec()), 0..20_u32, 0..20_u32, 0..1000_u32, 0..5_u32)
        .prop_map(|(scheme, least, most, rate, passes)| StepLimits {
            scheme,
            substeps: least..=most,
            rate,
            passes,
        })
        .boxed()
}

#[test]
fn any_material_is_simulated_or_told() {
    let inputs = (material(), vec(region(), 0..3), material());
    for_all(48, inputs, |(material, regions, later)| {
        let spawn = |app: &mut App| {
            let held = Attachment::in_place(ClothEdge::Top);
            let cloth = (
                ClothMesh::grid(9, 6, 1.0, 0.6),
                ClothMaterial(material),
                ClothRegions(regions),
                held,
            );
            app.world_mut().spawn(cloth).id()
        };
        _ = flag_goes_on(spawn, |app, cloth| {
            app.world_mut().entity_mut(cloth).insert(ClothMaterial(later));
        });
    });
}

#[test]
fn any_settings_leave_cloth_finite() {
    let inputs = (vector(), number(), vec(limits(), 0..3), vec(0..250_u64, 1..8), material());
    for_all(48, inputs, |(gravity, air_density, steps, frames, material)| {
        let mut app = app_of_its_own();
        let held = || Attachment::in_place(ClothEdge::Left);
        app.world_mut().spawn(WindField::steady(Vec3::new(4.0, 0.0, 1.0)));
        app.world_mut().spawn((
            ClothMesh::grid(9, 6, 1.0, 0.6),
            held(),
            LodSet::new([5.0]).pinned_to(1),
        ));
        app.world_mut().spawn((ClothMesh::grid(9, 6, 1.0, 0.6), held(), ClothMaterial(material)));
        app.world_mut()
            .spawn((ClothMesh::grid(5, 5, 0.6, 0.6), Transform::from_xyz(3.0, 0.0, 0.0)));
        run(&mut app, 3);
        {
            let mut settings = app.world_mut().resource_mut::<ClothSettings>();
            (settings.gravity, settings.air_density, settings.steps) =
                (gravity, air_density, steps);
        }
        for frame in frames {
            app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(frame)));
            app.update();
            assert_all_finite(&mut app);
        }
    });
}
