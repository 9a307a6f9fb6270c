//! Strain of the selected cloth, in diagnostics.

use bevy_app::App;
use bevy_bunting_inspector::{ClothStrainPlugin, SelectedCloth};
use bevy_diagnostic::{DiagnosticPath, DiagnosticsStore};
use bunting_tests::{greatest, run, spawn_flag, stretches};

use crate::tuning::world_with_flag;

fn last(app: &App, path: &DiagnosticPath) -> Option<f64> {
    app.world().resource::<DiagnosticsStore>().get(path).expect("a diagnostic").value()
}

#[test]
fn the_strain_is_that_of_the_selected_cloth() {
    let (mut app, flag) = world_with_flag();
    app.add_plugins(ClothStrainPlugin);
    let other = spawn_flag(&mut app, 5.0 * bevy_math::Vec3::Y);
    run(&mut app, 5);
    assert_eq!(last(&app, &ClothStrainPlugin::GREATEST), None, "nothing is selected");
    app.insert_resource(SelectedCloth(Some(flag)));
    run(&mut app, 20);
    let strain = last(&app, &ClothStrainPlugin::GREATEST).expect("a strain");
    let expected = 100.0 * f64::from(greatest(stretches(&app, flag)) - 1.0);
    assert!((strain - expected).abs() < 1e-3, "{strain} % for {expected} %");
    let mean = last(&app, &ClothStrainPlugin::MEAN).expect("a strain");
    assert!(mean > 0.0 && mean < strain, "{mean} % for at most {strain} %");

    app.insert_resource(SelectedCloth(Some(other)));
    run(&mut app, 1);
    let store = app.world().resource::<DiagnosticsStore>();
    let history = store.get(&ClothStrainPlugin::GREATEST).expect("a diagnostic");
    assert!(history.history_len() <= 1, "{} strains of two cloths", history.history_len());
}
