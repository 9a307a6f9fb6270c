//! Pictures without a window.

use std::fs;
use std::path::PathBuf;

use bevy::app::PluginGroupBuilder;
use bevy::camera::RenderTarget;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::TextureFormat;
use bevy::render::settings::{Backends, WgpuSettings};
use bevy::render::view::screenshot::{Screenshot, save_to_disk};
use bevy::tasks::block_on;
use bevy::time::TimeUpdateStrategy;
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use bevy::world_serialization::WorldInstanceReady;
use bevy_bunting::prelude::*;
use bunting_scenes::Model;
use clap::Args;

use crate::{ASSETS, ONE_TICK};

/// Frames after which a model or a picture that has not come will never come.
const PATIENCE: u32 = 10_000;

/// Which pictures to take, and where they go.
#[derive(Clone, Debug, Args)]
pub struct Album {
    /// Write pictures as PNG into this directory.
    #[arg(long, value_name = "DIR", requires = "headless")]
    pictures: Option<PathBuf>,
    /// When to take them, in seconds.
    #[arg(
        long,
        value_name = "SECONDS",
        value_delimiter = ',',
        default_value = "9,10,11",
        requires = "pictures"
    )]
    at: Vec<f64>,
    /// Their width in pixels; the height is 9/16 of it.
    #[arg(long, default_value_t = 1280, value_parser = clap::value_parser!(u32).range(16..=8192), requires = "pictures")]
    width: u32,
}

impl Album {
    /// Makes ready to take pictures, whose names begin with `name`. None if none are wanted, or none
    /// can be taken; it then says why.
    #[must_use]
    pub fn open(&self, name: &'static str) -> Option<Pictures> {
        let directory = self.pictures.clone()?;
        if !any_driver() {
            eprintln!("no pictures: there is no Vulkan driver");
            return None;
        }
        if let Err(error) = fs::create_dir_all(&directory) {
            eprintln!("no pictures: {}: {error}", directory.display());
            return None;
        }
        let mut times = self.at.clone();
        times.sort_by(|a, b| b.total_cmp(a));
        let size = UVec2::new(self.width, self.width * 9 / 16);
        Some(Pictures { directory, name, times, size })
    }
}

/// Whether any Vulkan driver is installed; one in software counts.
fn any_driver() -> bool {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    !block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN)).is_empty()
}

/// Bevy's plugins for rendering without a window.
#[must_use]
pub fn windowless() -> PluginGroupBuilder {
    let settings = WgpuSettings { backends: Some(Backends::VULKAN), ..default() };
    DefaultPlugins
        .set(AssetPlugin { file_path: ASSETS.to_owned(), ..default() })
        .set(WindowPlugin {
            primary_window: None,
            exit_condition: ExitCondition::DontExit,
            ..default()
        })
        .set(RenderPlugin {
            render_creation: settings.into(),
            // Else the first frames lack what is not compiled yet.
            synchronous_pipeline_compilation: true,
            ..default()
        })
        .disable::<WinitPlugin>()
        .disable::<PipelinedRenderingPlugin>()
}

/// Counts the models that are there to be seen.
pub fn plugin(app: &mut App) {
    app.init_resource::<LoadedModels>();
    app.add_observer(|_: On<WorldInstanceReady>, mut loaded: ResMut<LoadedModels>| loaded.0 += 1);
}

/// Number of models that are there to be seen.
#[derive(Resource, Debug, Default)]
struct LoadedModels(usize);

/// Pictures still to be taken.
#[derive(Debug)]
pub struct Pictures {
    directory: PathBuf,
    name: &'static str,
    /// The next last, s.
    times: Vec<f64>,
    size: UVec2,
}

impl Pictures {
    /// Gives the viewer a camera and waits until all models are loaded.
    ///
    /// # Panics
    ///
    /// Unless the world has one [`LodViewer`].
    pub fn set_up(&self, app: &mut App, camera: impl Bundle) {
        let world = app.world_mut();
        let target = Image::new_target_texture(
            self.size.x,
            self.size.y,
            TextureFormat::Rgba8UnormSrgb,
            None,
        );
        let target = RenderTarget::Image(world.resource_mut::<Assets<Image>>().add(target).into());
        let viewer = world
            .query_filtered::<Entity, With<LodViewer>>()
            .single(world)
            .expect("a scene has one viewer");
        let camera = (camera, Camera { is_active: false, ..default() }, target);
        world.entity_mut(viewer).insert(camera);
        let models = world.query::<&Model>().iter(world).count();
        draw_until(app, |world| world.resource::<LoadedModels>().0 == models);
    }

    /// Takes the pictures that are due after `now` seconds.
    pub fn take_due(&mut self, app: &mut App, now: f64) {
        while let Some(time) = self.times.pop_if(|time| *time <= now) {
            let target = self.open_shutter(app.world_mut(), true);
            let file = self.directory.join(format!("{}_{time:05.2}_s.png", self.name));
            let shot = app.world_mut().spawn(Screenshot(target)).observe(save_to_disk(file)).id();
            draw_until(app, |world| world.get_entity(shot).is_err());
            self.open_shutter(app.world_mut(), false);
        }
    }

    /// Lets the camera draw or not, and tells where it draws to.
    fn open_shutter(&self, world: &mut World, open: bool) -> RenderTarget {
        let mut cameras = world.query::<(&mut Camera, &RenderTarget)>();
        let (mut camera, target) =
            cameras.single_mut(world).expect("the viewer has the only camera");
        camera.is_active = open;
        target.clone()
    }
}

/// Draws frames while time stands still, until something has happened.
fn draw_until(app: &mut App, happened: impl Fn(&World) -> bool) {
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(0));
    for _ in 0..PATIENCE {
        if happened(app.world()) {
            break;
        }
        app.update();
    }
    app.insert_resource(ONE_TICK);
}
