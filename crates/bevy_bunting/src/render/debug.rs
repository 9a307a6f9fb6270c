//! Gizmos: attachments, strain, wind, contacts and levels of detail of cloths.

use bevy_app::{App, Plugin, PostUpdate};
use bevy_camera::visibility::{ViewVisibility, VisibilitySystems};
use bevy_color::palettes::css::{AQUA, BLUE, LIME, MAGENTA, ORANGE, RED, VIOLET, WHITE, YELLOW};
use bevy_color::{Mix, Srgba};
use bevy_ecs::prelude::*;
use bevy_gizmos::AppGizmoBuilder;
use bevy_gizmos::config::GizmoConfigGroup;
use bevy_gizmos::gizmos::Gizmos;
use bevy_math::{Isometry3d, Vec3};
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use bevy_transform::TransformSystems;
use bevy_transform::components::GlobalTransform;
use bunting_solver::{EffortCause, LinkFamily};

use crate::batch::batches::ClothBatches;
use crate::cloth::instance::ClothInstance;
use crate::cloth::state::ClothState;
use crate::display::surface::ClothSurface;
use crate::environment::wind::tick_wind::TickWind;
use crate::lod::effort::ClothEffort;
use crate::render::contact_lines::contact_lines;

/// Half the size of the cross on an attached particle, m.
const CROSS: f32 = 0.02;

/// Strain (either sign) from which on links are drawn in full colour.
const FULL_STRAIN: f32 = 0.01;

/// Time that the air takes to move by the length of its arrow, s.
const ARROW_TIME: f32 = 0.1;

/// Length of a stroke for each pass, and distance of two strokes, m.
const STROKE: [f32; 2] = [0.05, 0.02];

/// Colours of the levels of detail, the finest first; the last holds for all coarser ones.
const LEVEL_COLOURS: [Srgba; 4] = [LIME, YELLOW, ORANGE, RED];

/// Choice of the gizmos that are drawn. As a group in Bevy's `GizmoConfigStore` it holds for all cloths; as a
/// component it holds for one cloth and overrides the group. By default no gizmos are drawn.
///
/// ```
/// use bevy_bunting::ClothGizmos;
///
/// // On a cloth: its pins and its strain.
/// let shown = ClothGizmos { attachments: true, strain: true, ..ClothGizmos::default() };
/// # assert!(!shown.wind);
/// ```
#[derive(Component, GizmoConfigGroup, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[type_path = "bevy_bunting"]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct ClothGizmos {
    /// Crosses on the particles that are attached.
    pub attachments: bool,
    /// Distance constraints, coloured by strain: blue from 1 % compression on, white at rest length, red from
    /// 1 % stretch on.
    pub strain: bool,
    /// An arrow from the middle of the cloth, as long as the way of the air in 0.1 s.
    pub wind: bool,
    /// Warp and weft links in the colour of the level of detail: green is the finest, then yellow, orange and
    /// red.
    pub levels: bool,
    /// A stroke for each substep of a tick, above the cloth's first particle, as many times 5 cm long as there are passes.
    /// The colour tells what needs them: white for weight, aqua for air, orange for the frame, red for
    /// motion, yellow for colliders.
    pub effort: bool,
    /// A line along the normal, 2 cm long, where a particle touches a collider (aqua), and where a cloth touches itself
    /// (yellow) or another cloth (orange). Contacts are those at the end of the last tick; a sleeping cloth has none.
    /// Computing them costs a query of the shape for each particle near it.
    pub contacts: bool,
}

impl ClothGizmos {
    /// All gizmos are drawn.
    pub const ALL: Self = Self {
        attachments: true,
        strain: true,
        wind: true,
        levels: true,
        effort: true,
        contacts: true,
    };
}

/// Draws [`ClothGizmos`] of visible cloths. Needs Bevy's `GizmoPlugin`, and
/// [`ClothRenderPlugin`](crate::ClothRenderPlugin).
///
/// ```no_run
/// use bevy_app::prelude::*;
/// use bevy_bunting::prelude::*;
/// use bevy_bunting::{ClothDebugPlugin, ClothGizmos};
/// use bevy_ecs::prelude::*;
///
/// /// Shows pins and strain of new cloths.
/// fn show(new: On<Add, ClothMesh>, mut commands: Commands) {
///     let shown = ClothGizmos { attachments: true, strain: true, ..ClothGizmos::default() };
///     commands.entity(new.entity).insert(shown);
/// }
///
/// // In an app: App::new().add_plugins((DefaultPlugins, ClothPlugins::default(), ClothDebugPlugin));
/// App::new().add_plugins((ClothPlugins::default(), ClothDebugPlugin)).add_observer(show);
/// ```
#[derive(Debug, Default)]
pub struct ClothDebugPlugin;

impl Plugin for ClothDebugPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClothGizmos>().init_gizmo_group::<ClothGizmos>().add_systems(
            PostUpdate,
            draw_cloths
                .after(TransformSystems::Propagate)
                .after(VisibilitySystems::MarkNewlyHiddenEntitiesInvisible),
        );
    }
}

type DrawnCloth = (
    &'static ClothInstance,
    &'static ClothState,
    &'static ClothSurface,
    &'static ClothEffort,
    &'static GlobalTransform,
    &'static ViewVisibility,
    Option<&'static ClothGizmos>,
);

fn draw_cloths(
    cloths: Query<DrawnCloth>,
    wind: Option<Res<TickWind>>,
    batches: Option<Res<ClothBatches>>,
    mut gizmos: Gizmos<ClothGizmos>,
) {
    for (instance, state, surface, effort, frame, visibility, own) in &cloths {
        let drawn = *own.unwrap_or(gizmos.config_ext);
        let Some(fabric) = state.fabric() else { continue };
        if !visibility.get() || surface.positions.len() != fabric.particle_count() {
            continue;
        }
        let position = |particle: usize| frame.transform_point(surface.positions[particle]);
        if drawn.levels {
            let colour = LEVEL_COLOURS[state.level().min(LEVEL_COLOURS.len() - 1)];
            for link in fabric.links().iter().filter(|link| link.family != LinkFamily::Diagonal) {
                let [from, to] = link.particles.map(|particle| position(particle as usize));
                gizmos.line(from, to, colour);
            }
        }
        if drawn.strain {
            for link in fabric.links() {
                let [from, to] = link.particles.map(|particle| position(particle as usize));
                let strain = from.distance(to) / link.rest_length - 1.0;
                gizmos.line(from, to, strain_colour(strain));
            }
        }
        if drawn.attachments {
            for particle in (0..fabric.particle_count()).filter(|&each| fabric.is_pinned(each)) {
                gizmos.cross(Isometry3d::from_translation(position(particle)), CROSS, MAGENTA);
            }
        }
        if drawn.effort {
            draw_effort(effort, position(0), &mut gizmos);
        }
        if let (true, Some(batches), Some(lane)) = (drawn.contacts, &batches, instance.lane()) {
            for (from, to, colour) in contact_lines(batches, lane, frame) {
                gizmos.line(from, to, colour);
            }
        }
        if let (true, Some(wind)) = (drawn.wind, &wind) {
            let middle = position(fabric.particle_count() / 2);
            gizmos.arrow(middle, middle + ARROW_TIME * wind.at(middle), AQUA);
        }
    }
}

/// Draws a stroke for each substep above a position, m.
fn draw_effort(effort: &ClothEffort, at: Vec3, gizmos: &mut Gizmos<ClothGizmos>) {
    let colour = match effort.cause() {
        EffortCause::Weight => WHITE,
        EffortCause::Air => AQUA,
        EffortCause::Frame => ORANGE,
        EffortCause::Motion => RED,
        EffortCause::Tension => VIOLET,
        EffortCause::Contacts => YELLOW,
    };
    let [of_pass, apart] = STROKE;
    let settings = effort.settings();
    for substep in 1..=settings.substeps {
        let from = at + Vec3::Y * (apart * substep as f32);
        gizmos.line(from, from + Vec3::X * (of_pass * settings.passes as f32), colour);
    }
}

/// Colour of a strain: blue if compressed, white at rest, red if stretched, and mixtures.
fn strain_colour(strain: f32) -> Srgba {
    let full = if strain < 0.0 { BLUE } else { RED };
    WHITE.mix(&full, (strain.abs() / FULL_STRAIN).min(1.0))
}
