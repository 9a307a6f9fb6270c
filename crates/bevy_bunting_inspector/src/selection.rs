//! The cloth that is shown and tuned.

use bevy_app::{App, Plugin};
use bevy_bunting::prelude::*;
use bevy_ecs::prelude::*;
use bevy_picking::prelude::*;

/// The cloth that is shown and tuned. It may be set at any time; a cloth that is despawned is selected no more.
///
/// ```
/// use bevy_bunting::prelude::*;
/// use bevy_bunting_inspector::SelectedCloth;
/// use bevy_ecs::prelude::*;
///
/// let mut world = World::new();
/// let flag = world.spawn(ClothMesh::grid(17, 17, 1.0, 1.0)).id();
/// world.insert_resource(SelectedCloth(Some(flag)));
/// ```
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SelectedCloth(pub Option<Entity>);

/// Selects the cloth on which a pointer clicks with its primary button. Clicks need Bevy's picking and
/// [`ClothDragPlugin`], which finds the cloth under the pointer; without them, [`SelectedCloth`] is set by the panel's list or
/// by the app.
///
/// ```
/// use bevy_app::prelude::*;
/// use bevy_bunting_inspector::{ClothSelectionPlugin, SelectedCloth};
///
/// let mut app = App::new();
/// app.add_plugins(ClothSelectionPlugin);
/// assert_eq!(app.world().resource::<SelectedCloth>(), &SelectedCloth(None));
/// ```
#[derive(Debug, Default)]
pub struct ClothSelectionPlugin;

impl Plugin for ClothSelectionPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<SelectedCloth>().add_observer(select).add_observer(deselect);
    }
}

fn select(
    click: On<Pointer<Click>>,
    cloths: Query<(), With<ClothMesh>>,
    mut selected: ResMut<SelectedCloth>,
) {
    let cloth = click.original_event_target();
    if click.button == PointerButton::Primary && cloths.contains(cloth) {
        selected.set_if_neq(SelectedCloth(Some(cloth)));
    }
}

fn deselect(removed: On<Remove, ClothMesh>, mut selected: ResMut<SelectedCloth>) {
    if selected.0 == Some(removed.entity) {
        selected.0 = None;
    }
}
