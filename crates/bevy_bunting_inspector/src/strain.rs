//! The strain of the selected cloth.

use bevy_app::{App, Plugin};
use bevy_bunting::prelude::*;
use bevy_diagnostic::{
    Diagnostic, DiagnosticPath, Diagnostics, DiagnosticsStore, RegisterDiagnostic,
};
use bevy_ecs::prelude::*;

use crate::selection::SelectedCloth;

/// Adds the strains of the [`SelectedCloth`] to Bevy's diagnostics, once a tick. While none is selected,
/// nothing is measured.
///
/// ```
/// use bevy_app::prelude::*;
/// use bevy_bunting_inspector::ClothStrainPlugin;
/// use bevy_diagnostic::{DiagnosticsPlugin, DiagnosticsStore};
///
/// let mut app = App::new();
/// app.add_plugins((DiagnosticsPlugin, ClothStrainPlugin));
/// let strain = app.world().resource::<DiagnosticsStore>().get(&ClothStrainPlugin::GREATEST);
/// assert!(strain.is_some_and(|strain| strain.suffix == "%"));
/// ```
#[derive(Debug, Default)]
pub struct ClothStrainPlugin;

impl ClothStrainPlugin {
    /// Greatest strain of any link, diagonals included, %.
    pub const GREATEST: DiagnosticPath =
        DiagnosticPath::const_new("cloth/selected/greatest_strain");

    /// Root mean square of the strains of all links, %.
    pub const MEAN: DiagnosticPath = DiagnosticPath::const_new("cloth/selected/mean_strain");
}

impl Plugin for ClothStrainPlugin {
    fn build(&self, app: &mut App) {
        for path in [Self::GREATEST, Self::MEAN] {
            app.register_diagnostic(Diagnostic::new(path).with_suffix("%"));
        }
        app.init_resource::<SelectedCloth>().add_systems(
            ClothTick,
            (forget_last.before(ClothSystems::Prepare), measure.after(ClothSystems::Publish)),
        );
    }
}

/// Clears the strains of the cloth that was selected before.
fn forget_last(selected: Res<SelectedCloth>, mut diagnostics: ResMut<DiagnosticsStore>) {
    if selected.is_changed() {
        for path in [ClothStrainPlugin::GREATEST, ClothStrainPlugin::MEAN] {
            diagnostics.get_mut(&path).into_iter().for_each(Diagnostic::clear_history);
        }
    }
}

fn measure(selected: Res<SelectedCloth>, cloths: Query<&ClothState>, mut diagnostics: Diagnostics) {
    let Some(state) = selected.0.and_then(|cloth| cloths.get(cloth).ok()) else { return };
    let Some(strains) = Strains::of(state) else { return };
    diagnostics.add_measurement(&ClothStrainPlugin::GREATEST, || 100.0 * strains.greatest);
    diagnostics.add_measurement(&ClothStrainPlugin::MEAN, || 100.0 * strains.mean);
}

/// Strains of a cloth: length over rest length of its links, less 1.
struct Strains {
    greatest: f64,
    /// Root mean square.
    mean: f64,
}

impl Strains {
    /// None for a cloth without links, or that is not simulated.
    fn of(state: &ClothState) -> Option<Self> {
        let greatest = state.strains().map(f64::from).reduce(f64::max)?;
        let squares: f64 = state.strains().map(|strain| f64::from(strain).powi(2)).sum();
        Some(Self { greatest, mean: (squares / state.strains().count() as f64).sqrt() })
    }
}
