//! A material that shows the weave of cloth.

use bevy_app::prelude::*;
use bevy_asset::{Asset, embedded_asset};
use bevy_math::Vec2;
use bevy_pbr::{ExtendedMaterial, MaterialExtension, MaterialPlugin, StandardMaterial};
use bevy_reflect::Reflect;
use bevy_render::render_resource::AsBindGroup;
use bevy_shader::ShaderRef;

/// Adds [`WovenMaterial`] to an app that has Bevy's `PbrPlugin`. Not among [`ClothPlugins`](crate::ClothPlugins).
///
/// ```
/// use bevy_app::prelude::*;
/// use bevy_bunting::prelude::*;
///
/// // In an app: App::new().add_plugins((DefaultPlugins, ClothPlugins::default(), WeavePlugin));
/// # let _ = (App::new(), WeavePlugin);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct WeavePlugin;

/// Bevy's material, and the weave of a cloth. [`Weave::on`] makes one.
///
/// Light that passes through cloth is Bevy's own `diffuse_transmission`. Cloth that is to stop it where another object's
/// shadow falls on its other side needs Bevy's `TransmittedShadowReceiver`.
pub type WovenMaterial = ExtendedMaterial<StandardMaterial, Weave>;

/// Plain weave: threads along both texture coordinates, each alternately above and below the others.
///
/// Where a thread is smaller than two pixels, the weave fades into its mean, and does not flicker. The mesh needs texture
/// coordinates, as those of grids: 1 across the cloth.
///
/// ```
/// # use bevy_bunting::prelude::*;
/// # use bevy_math::Vec2;
/// # use bevy_pbr::StandardMaterial;
/// // Coarse linen, 1.5 m wide and 1 m high, with 8 threads a centimetre.
/// let linen = StandardMaterial { diffuse_transmission: 0.3, ..StandardMaterial::default() };
/// let linen = Weave::new(Vec2::new(1.5, 1.0), 800.0).on(linen);
/// assert_eq!(linen.extension.threads, Vec2::new(1200.0, 800.0));
/// assert!(linen.base.double_sided);
/// ```
#[derive(Asset, AsBindGroup, Reflect, Clone, Copy, Debug, PartialEq)]
#[type_path = "bevy_bunting"]
pub struct Weave {
    /// Number of threads from 0 to 1 of each texture coordinate.
    #[uniform(100)]
    pub threads: Vec2,
    /// Height of the threads above the gaps, in distances of two threads. 0 is smooth; linen has about 0.2.
    #[uniform(100)]
    pub relief: f32,
    /// Part of the light that passes through the gaps between threads, of all light that falls there: 0 for dense cloth, 1
    /// for gauze.
    #[uniform(100)]
    pub gaps: f32,
}

impl Weave {
    /// The weave of a cloth whose texture coordinates go from 0 to 1 over `size` (m), with a number of threads in a metre.
    #[must_use]
    pub fn new(size: Vec2, threads_per_metre: f32) -> Self {
        Self { threads: (size * threads_per_metre).round(), relief: 0.2, gaps: 0.3 }
    }

    /// A material with this weave of which both faces are drawn, each with its own normals.
    #[must_use]
    pub fn on(self, base: StandardMaterial) -> WovenMaterial {
        let base = StandardMaterial { double_sided: true, cull_mode: None, ..base };
        ExtendedMaterial { base, extension: self }
    }
}

impl Plugin for WeavePlugin {
    fn build(&self, app: &mut App) {
        embedded_asset!(app, "weave.wgsl");
        app.add_plugins(MaterialPlugin::<WovenMaterial>::default());
    }
}

impl MaterialExtension for Weave {
    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn deferred_fragment_shader() -> ShaderRef {
        SHADER.into()
    }
}

const SHADER: &str = "embedded://bevy_bunting/render/weave.wgsl";
