//! Tests of pointers on a cloth, without a window.

mod drag;
mod pins;

use std::time::Duration;

use bevy_app::{App, PreUpdate, TaskPoolPlugin};
use bevy_camera::{Camera, NormalizedRenderTarget};
use bevy_ecs::prelude::*;
use bevy_math::{Dir3, Ray3d, Vec2, Vec3};
use bevy_picking::backend::ray::{RayId, RayMap};
use bevy_picking::pointer::{Location, PointerAction, PointerId, PointerInput};
use bevy_picking::{InteractionPlugin, PickingPlugin, PickingSystems};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

use crate::ClothDrag;
use crate::prelude::*;

const TICK: Duration = Duration::from_micros(15_625);

/// Distance of the camera from the curtain, m.
const AWAY: f32 = 3.0;

/// The ray of the pointer, in the world.
#[derive(Resource)]
struct Ray(Ray3d);

/// A camera that looks at a curtain from the front, and a pointer.
struct Scene {
    app: App,
    curtain: Entity,
}

impl Scene {
    fn new(curtain: impl Bundle) -> Self {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin))
            .add_plugins((PickingPlugin, InteractionPlugin))
            .add_plugins((ClothPlugins::default(), ClothDragPlugin))
            .insert_resource(TimeUpdateStrategy::ManualDuration(TICK))
            .insert_resource(Ray(Ray3d::new(Vec3::ZERO, Dir3::X)));
        let world = app.world_mut();
        let camera = (Camera::default(), Transform::from_xyz(0.0, 0.0, AWAY));
        let camera = world.spawn(camera).id();
        world.spawn(PointerId::Mouse);
        let hung = Attachment::in_place(ClothEdge::Top);
        let at = Transform::from_xyz(-0.5, 0.5, 0.0);
        let curtain = (ClothMesh::grid(17, 17, 1.0, 1.0), hung, at, curtain);
        let curtain = world.spawn(curtain).id();
        // A camera without a window has no rays of its own.
        let point = move |mut rays: ResMut<RayMap>, ray: Res<Ray>| {
            rays.map.insert(RayId::new(camera, PointerId::Mouse), ray.0);
        };
        let after_rays = point.after(PickingSystems::ProcessInput).before(PickingSystems::Backend);
        app.add_systems(PreUpdate, after_rays);
        app.finish();
        app.cleanup();
        let mut scene = Self { app, curtain };
        scene.point_at(Vec2::splat(5.0));
        scene.run(30);
        scene
    }

    /// Points at a place in the plane of the curtain, m.
    fn point_at(&mut self, place: Vec2) {
        let eye = Vec3::Z * AWAY;
        let direction = Dir3::new(place.extend(0.0) - eye).expect("a direction");
        self.app.insert_resource(Ray(Ray3d::new(eye, direction)));
        self.send(PointerAction::Move { delta: Vec2::ONE });
    }

    fn send(&mut self, action: PointerAction) {
        let target = NormalizedRenderTarget::None { width: 100, height: 100 };
        let location = Location { target, position: Vec2::splat(50.0) };
        self.app.world_mut().write_message(PointerInput::new(PointerId::Mouse, location, action));
    }

    fn run(&mut self, frames: usize) {
        (0..frames).for_each(|_| self.app.update());
    }

    fn hands(&mut self) -> usize {
        let world = self.app.world_mut();
        world.query::<&ClothDrag>().iter(world).count()
    }

    /// Place of the particle that hangs at the middle of the curtain, in the world, m.
    fn middle(&self) -> Vec3 {
        let entity = self.app.world().entity(self.curtain);
        let state = entity.get::<ClothState>().expect("a state");
        let frame = entity.get::<GlobalTransform>().expect("a place");
        frame.transform_point(state.positions()[8 * 17 + 8])
    }
}
