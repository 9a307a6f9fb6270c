//! Writes pictures without a window.

use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

use bevy::app::PluginGroupBuilder;
use bevy::camera::RenderTarget;
use bevy::core_pipeline::tonemapping::DebandDither;
use bevy::log::{Level, LogPlugin};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::render_resource::TextureFormat;
use bevy::render::settings::{Backends, WgpuSettings};
use bevy::render::view::screenshot::{Screenshot, save_to_disk};
use bevy::tasks::block_on;
use bevy::time::TimeUpdateStrategy;
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use bevy::world_serialization::WorldInstanceReady;
use bevy_bunting::prelude::*;
use bevy_bunting::{CostTable, LodCosts};
use bunting_scenes::Model;

use crate::headless::{self, ONE_TICK};
#[cfg(feature = "inspector")]
use crate::render::inspector;
use crate::render::picture_options::PictureOptions;
use crate::render::viewer;
use crate::{ASSETS, Example, Options};

/// Number of frames after which waiting for a model or a picture ends.
const MAX_FRAMES: u32 = 10_000;

impl PictureOptions {
    /// Prepares pictures whose names begin with `name`. None if no pictures are wanted, or if none can be
    /// written; the reason is then printed.
    #[must_use]
    pub fn open(&self, name: &str) -> Option<Pictures> {
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
        Some(Pictures { directory, name: name.to_lowercase().replace(' ', "_"), times, size })
    }
}

/// Simulates an example, prints its measurements and writes pictures of it. Fails if a measurement
/// exceeds its limit.
pub fn run(example: &impl Example, options: &Options, mut pictures: Pictures) -> ExitCode {
    let mut app = App::new();
    let stage = example.stage();
    let camera = stage.camera();
    app.add_plugins(
        windowless()
            .set(headless::task_pools(options))
            .set(LogPlugin { level: Level::WARN, ..default() }),
    )
    .add_plugins((count_models, stage));
    #[cfg(feature = "inspector")]
    app.add_plugins(inspector::plugin);
    example.draw(&mut app);
    headless::start(&mut app, example);
    pictures.set_up(&mut app, camera);
    headless::simulate(&mut app, example, options, |app, now| pictures.take_due(app, now))
}

/// Whether any Vulkan driver is installed, including software drivers.
fn any_driver() -> bool {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    !block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN)).is_empty()
}

/// Bevy's plugins for rendering without a window.
fn windowless() -> PluginGroupBuilder {
    let settings = WgpuSettings { backends: Some(Backends::VULKAN), ..default() };
    let plugins = DefaultPlugins
        .set(AssetPlugin { file_path: ASSETS.to_owned(), ..default() })
        .set(WindowPlugin {
            primary_window: None,
            exit_condition: ExitCondition::DontExit,
            ..default()
        })
        .set(RenderPlugin {
            render_creation: settings.into(),
            // With asynchronous compilation the first frames would lack meshes whose pipelines are not
            // compiled yet.
            synchronous_pipeline_compilation: true,
            ..default()
        })
        .disable::<WinitPlugin>();
    // Browsers have neither threads nor this plugin.
    #[cfg(not(target_arch = "wasm32"))]
    let plugins = plugins.disable::<bevy::render::pipelined_rendering::PipelinedRenderingPlugin>();
    plugins
}

/// Counts the models that are loaded.
fn count_models(app: &mut App) {
    app.init_resource::<LoadedModels>();
    app.add_observer(|_: On<WorldInstanceReady>, mut loaded: ResMut<LoadedModels>| loaded.0 += 1);
}

/// Number of models that are loaded.
#[derive(Resource, Debug, Default)]
struct LoadedModels(usize);

/// Pictures still to be written.
#[derive(Debug)]
pub struct Pictures {
    directory: PathBuf,
    name: String,
    /// Simulated times, s, descending.
    times: Vec<f64>,
    /// Size, pixels.
    size: UVec2,
}

impl Pictures {
    /// Makes the levels of detail the same on every machine, gives the viewer a camera, and waits until all models are loaded.
    fn set_up(&self, app: &mut App, camera: impl Bundle) {
        let viewer = viewer(app);
        let world = app.world_mut();
        // With measured costs, levels of detail and the ticks in which new cloths begin depend on the machine's load.
        world.resource_mut::<ClothBudget>().costs = LodCosts::Fixed(CostTable::default());
        let UVec2 { x: width, y: height } = self.size;
        let target = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
        let target = RenderTarget::Image(world.resource_mut::<Assets<Image>>().add(target).into());
        // Noise against banding would make the files half as large again.
        let plain = DebandDither::Disabled;
        let camera = (camera, plain, Camera { is_active: false, ..default() }, target);
        world.entity_mut(viewer).insert(camera);
        let models = world.query::<&Model>().iter(world).count();
        draw_until(app, |world| world.resource::<LoadedModels>().0 == models);
    }

    /// Writes the pictures that are due after `now` simulated seconds.
    fn take_due(&mut self, app: &mut App, now: f64) {
        while let Some(time) = self.times.pop_if(|time| *time <= now) {
            let target = activate_camera(app.world_mut(), true);
            let file = self.directory.join(format!("{}_{time:05.2}_s.png", self.name));
            let shot = app.world_mut().spawn(Screenshot(target)).observe(save_to_disk(file)).id();
            draw_until(app, |world| world.get_entity(shot).is_err());
            activate_camera(app.world_mut(), false);
        }
    }
}

/// Turns the only camera on or off, and returns its target.
fn activate_camera(world: &mut World, active: bool) -> RenderTarget {
    let mut cameras = world.query::<(&mut Camera, &RenderTarget)>();
    let (mut camera, target) = cameras.single_mut(world).expect("the viewer has the only camera");
    camera.is_active = active;
    target.clone()
}

/// Draws frames without simulating, until a condition holds.
fn draw_until(app: &mut App, done: impl Fn(&World) -> bool) {
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(0));
    for _ in 0..MAX_FRAMES {
        if done(app.world()) {
            break;
        }
        app.update();
    }
    app.insert_resource(ONE_TICK);
}
