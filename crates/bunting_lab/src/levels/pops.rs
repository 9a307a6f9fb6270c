//! Visible effects of a change of level: flags in an app, and their displayed surface from frame to frame.
//!
//! In the frame of the change each vertex is compared with its linear extrapolation from the last two frames,
//! and with its position on a twin that does not change. A flapping flag departs from the extrapolation
//! without a change, too: `own` says how far.

use bevy_app::App;
use bevy_bunting::{Attachment, ClothEdge, ClothMaterial, ClothMesh, ClothSurface, LodSet};
use bevy_ecs::entity::Entity;
use bevy_transform::components::Transform;
use bunting_solver::{LevelTransfer, StepSettings};
use glam::{Quat, Vec3};
use serde::Serialize;

use crate::{
    game,
    product::{self, material},
    scenes::{Scene, ticks},
    settings::scheme_name,
    stats::{self, worse},
};

/// Pixels of a metre at a distance of one metre: 1080 lines over a field of view of 60°.
pub const PIXELS: f64 = 935.3;
/// Number of flags, and of their twins.
const FLAGS: usize = 4;
/// Frames before a change; in the first of them the flag starts to fly.
const FRAMES: usize = 180;
/// Frames before a change in which the flag's own flapping is measured.
const WATCHED: usize = 20;
/// Frames between the changes of successive moments, which spreads the changes over the gusts.
const STAGGER: usize = 7;

/// Distance in metres at which a flag's change from a level to the next coarser one is observed: 10 m for 33
/// × 33 vertices, and farther for coarser levels as their cells are larger.
#[must_use]
pub fn distance(finer: usize) -> f64 {
    320.0 / (finer - 1) as f64
}

/// Visible effect of one change of level, over many flags. Pixels are those of the vertex with the greatest
/// departure.
#[derive(Clone, Debug, Serialize)]
pub struct Pop {
    /// Scheme.
    pub scheme: &'static str,
    /// Vertices along each side before.
    pub from: usize,
    /// Vertices along each side after.
    pub to: usize,
    /// Distance, m.
    pub distance_m: f64,
    /// Departure from the extrapolated motion in the frame of the change, pixels: mean over the flags.
    pub mean_px: f64,
    /// Departure of the flag with the greatest one, pixels.
    pub worst_px: f64,
    /// Departure that 95 % of the flags do not exceed, pixels: the greatest of sixteen flags, the fifth greatest of
    /// eighty.
    pub p95_px: f64,
    /// Greatest departure in the frames that follow, pixels: mean over the flags.
    pub after_px: f64,
    /// Greatest departure in the frames before, by the flag's own flapping, pixels.
    pub own_px: f64,
    /// Distance from a twin that does not change, in the frame of the change, pixels: mean over the flags.
    pub twin_px: f64,
}

/// Departures of one flag at one change, m.
struct Stray {
    change: f64,
    after: f64,
    own: f64,
    twin: f64,
}

impl Pop {
    /// Changes flags from `from` to `to` vertices a side, the next level, at `moments` moments.
    ///
    /// # Panics
    ///
    /// When the two levels are not neighbours.
    #[must_use]
    pub fn of(from: usize, to: usize, settings: StepSettings, moments: usize) -> Self {
        let strays: Vec<Stray> =
            (0..moments).flat_map(|moment| change(from, to, settings, moment)).collect();
        let distance_m = distance(from.max(to));
        let pixels = |figure: fn(&Stray) -> f64| {
            strays.iter().map(|stray| figure(stray) * PIXELS / distance_m).collect::<Vec<f64>>()
        };
        let mut ascending = pixels(|stray| stray.change);
        ascending.sort_by(f64::total_cmp);
        Self {
            scheme: scheme_name(settings),
            from,
            to,
            distance_m,
            mean_px: stats::mean(&pixels(|stray| stray.change)),
            worst_px: ascending.iter().copied().fold(0.0, worse),
            p95_px: stats::percentile(&ascending, 0.95),
            after_px: stats::mean(&pixels(|stray| stray.after)),
            own_px: stats::mean(&pixels(|stray| stray.own)),
            twin_px: stats::mean(&pixels(|stray| stray.twin)),
        }
    }
}

fn change(from: usize, to: usize, settings: StepSettings, moment: usize) -> Vec<Stray> {
    let view = View::new(from.max(to));
    let mut app = game::app_in_wind([settings]);
    let levels = |n: usize| usize::from(n < from.max(to));
    let spawn = |app: &mut App| -> Vec<Entity> {
        let lods = LodSet::new([1.0]).pinned_to(levels(from));
        let at = |flag: usize| Vec3::new(0.0, 0.0, 3.0 * flag as f32);
        let flags: Vec<Entity> = (0..FLAGS)
            .map(|flag| game::spawn_flag(app, from.max(to) as u32, at(flag), lods.clone()))
            .collect();
        for &flag in &flags {
            app.world_mut().entity_mut(flag).insert(ClothSurface::default());
        }
        flags
    };
    let (flags, twins) = (spawn(&mut app), spawn(&mut app));
    (0..FRAMES + STAGGER * moment).for_each(|_| app.update());
    let mut frames: Vec<Vec<Vec<Vec3>>> = vec![Vec::new(); FLAGS];
    // A frame shows the tick before: a change in one frame is visible in the next.
    let mut twin = Vec::new();
    for frame in 0..2 * WATCHED {
        if frame + 1 == WATCHED {
            for &flag in &flags {
                app.world_mut().get_mut::<LodSet>(flag).expect("levels").pinned = Some(levels(to));
            }
        }
        app.update();
        if frame == WATCHED {
            twin = twins.iter().map(|&twin| view.of(&app, twin)).collect();
        }
        for (frames, &flag) in frames.iter_mut().zip(&flags) {
            frames.push(view.of(&app, flag));
        }
    }
    let most = |strays: &[f64]| strays.iter().copied().fold(0.0, worse);
    frames
        .iter()
        .zip(&twin)
        .map(|(frames, twin)| {
            let strays: Vec<f64> = frames.windows(3).map(stray).collect();
            Stray {
                change: strays[WATCHED - 2],
                after: most(&strays[WATCHED - 1..]),
                own: most(&strays[..WATCHED - 2]),
                twin: farthest(&frames[WATCHED], twin),
            }
        })
        .collect()
}

/// Greatest departure, in pixels, of the displayed surface of a swing of n × n vertices from its extrapolated
/// motion, while the swing changes its level in every tick for `seconds` s. Without any change a swing of 17
/// × 17 departs by 5.6 pixels, as its lower edge whips.
///
/// # Panics
///
/// When n cannot be halved.
#[must_use]
pub fn thrash(n: usize, settings: StepSettings, seconds: f64) -> f64 {
    let scene = Scene::swing(n);
    let mut app = game::app_in_wind([settings]);
    let level = Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    let pole = app.world_mut().spawn(Transform::from_rotation(level)).id();
    let sheet = (
        ClothMesh::grid(n as u32, n as u32, scene.width as f32, scene.height as f32),
        ClothMaterial(material(&scene)),
        Attachment::new(pole, ClothEdge::Top),
        LodSet::new([1.0]).pinned_to(0),
        ClothSurface::default(),
    );
    let sheet = app.world_mut().spawn(sheet).id();
    let view = View::new(n);
    (0..3).for_each(|_| app.update());
    let mut frames = Vec::new();
    let mut most = 0.0_f64;
    for frame in 0..ticks(seconds) {
        app.world_mut().get_mut::<LodSet>(sheet).expect("levels").pinned = Some((frame + 1) % 2);
        app.update();
        frames.push(view.of(&app, sheet));
        if frames.len() > 3 {
            frames.remove(0);
        }
        if frames.len() == 3 {
            most = worse(most, stray(&frames));
        }
    }
    most * PIXELS / distance(n)
}

/// Reads surfaces with the vertices of the finer of two levels.
struct View {
    transfer: LevelTransfer,
}

impl View {
    fn new(finer: usize) -> Self {
        let [fine, coarse] = [finer, finer / 2 + 1].map(|n| product::fabric(&Scene::flag(n)));
        Self { transfer: LevelTransfer::between(&fine, &coarse).expect("neighbours") }
    }

    fn of(&self, app: &App, cloth: Entity) -> Vec<Vec3> {
        let surface = app.world().get::<ClothSurface>(cloth).expect("a surface");
        if surface.level() == 0 {
            surface.positions.clone()
        } else {
            self.transfer.spread(&surface.positions).collect()
        }
    }
}

/// Greatest distance of a vertex in the last of three frames from its extrapolation from the first two.
fn stray(frames: &[Vec<Vec3>]) -> f64 {
    let pairs = frames[0].iter().zip(&frames[1]);
    let predicted: Vec<Vec3> = pairs.map(|(before, now)| *now + (*now - *before)).collect();
    farthest(&predicted, &frames[2])
}

fn farthest(one: &[Vec3], other: &[Vec3]) -> f64 {
    let distances = one.iter().zip(other).map(|(a, b)| f64::from(a.distance(*b)));
    distances.fold(0.0, worse)
}
