//! Tests of defects that newcomers met in their first hour and that rendering shows.

use bevy_camera::visibility::Visibility;
use bevy_ecs::hierarchy::ChildOf;

use super::*;

fn activity(app: &App, cloth: Entity) -> ClothActivity {
    app.world().get::<ClothState>(cloth).expect("a cloth").activity()
}

#[test]
fn hidden_cloth_is_not_simulated() {
    let mut app = app(TICK);
    let parent = app.world_mut().spawn((Transform::default(), Visibility::default())).id();
    let cloth = spawn(&mut app, ChildOf(parent));
    run(&mut app, 10);
    assert_eq!(activity(&app, cloth), ClothActivity::Ticking);
    for hidden in [cloth, parent] {
        app.world_mut().entity_mut(hidden).insert(Visibility::Hidden);
        run(&mut app, 3);
        assert_eq!(activity(&app, cloth), ClothActivity::Hidden);
        assert_eq!(app.world().resource::<crate::ClothBatches>().batch_count(), 0);
        app.world_mut().entity_mut(hidden).insert(Visibility::Inherited);
        run(&mut app, 3);
        assert_eq!(activity(&app, cloth), ClothActivity::Ticking);
    }
}

#[test]
fn a_clone_is_drawn_with_meshes_of_its_own() {
    for given in [false, true] {
        let mut app = app(TICK);
        let cloth = if given {
            let mesh = flag_mesh(&mut app);
            let mesh = add(&mut app, mesh);
            spawn(&mut app, mesh)
        } else {
            spawn(&mut app, ())
        };
        run(&mut app, 10);
        let clone = app.world_mut().entity_mut(cloth).clone_and_spawn();
        app.world_mut().entity_mut(clone).insert(Transform::from_xyz(0.5, 0.0, 0.0));
        run(&mut app, 10);
        assert_ne!(handle(&app, clone), handle(&app, cloth));
        assert!(is_current(&app, clone) && is_current(&app, cloth));
        app.world_mut().despawn(cloth);
        run(&mut app, 10);
        assert!(is_current(&app, clone));
        assert!(failures(&app).is_empty());
    }
}
