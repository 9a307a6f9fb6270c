//! The system that sews cloths.

use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_time::Time;
use bunting_solver::{Lacing, Seams};

use crate::batch::batches::ClothBatches;
use crate::cloth::error::ClothError;
use crate::cloth::events::ClothFailed;
use crate::cloth::instance::ClothInstance;
use crate::cloth::mesh::ClothMesh;
use crate::fabric::known_level::KnownLevel;
use crate::fabric::levels::ClothLevels;
use crate::lod::rest_timer::RestTimer;
use crate::seams::error::SeamError;
use crate::seams::events::{ClothSeamClosed, ClothSeamOpened};
use crate::seams::seam::{ClothSeams, Seam};
use crate::seams::seam_stitches::SeamStitches;
use crate::seams::sewn::{KnownStitches, SeamProgress, SewnCloth};
use crate::seams::stitches::stitches_of;

/// A cloth that is sewn.
type SeamedCloth = (
    Entity,
    &'static ClothInstance,
    Ref<'static, ClothMesh>,
    Ref<'static, ClothSeams>,
    &'static mut SewnCloth,
    &'static mut RestTimer,
);

/// Gives each cloth in a lane its seams, since a cloth that has entered a lane has none.
pub(crate) fn sew_cloths(
    mut cloths: Query<SeamedCloth>,
    mut removed: RemovedComponents<ClothSeams>,
    instances: Query<&ClothInstance, Without<ClothSeams>>,
    time: Res<Time>,
    mut batches: ResMut<ClothBatches>,
    mut commands: Commands,
) {
    for instance in instances.iter_many(removed.read()) {
        if let Some(lane) = instance.lane() {
            batches.lane(lane).unsew();
        }
    }
    let tick = time.delta_secs();
    for (entity, instance, mesh, seams, mut sewn, mut timer) in &mut cloths {
        let (Some(lane), Some(levels)) = (instance.lane(), &instance.levels) else { continue };
        if mesh.is_changed() || !sewn.fits(levels, instance.level) {
            sewn.known = None;
        }
        if seams.is_changed() || sewn.known.is_none() {
            sewn.find_stitches(&seams.seams, &mesh, levels, instance.level, |seam, source| {
                let error = ClothError::Seam { entity, seam, source };
                ClothFailed::report(&mut commands, entity, error);
            });
        }
        let SewnCloth { known: Some(known), progress } = &mut *sewn else { continue };
        progress.resize(seams.seams.len(), SeamProgress::default());
        let mut lacings = Vec::with_capacity(progress.len());
        let mut first = 0;
        for (index, (seam, progress)) in seams.seams.iter().zip(progress).enumerate() {
            let stitches = &known.of_seams[index];
            let end = first + stitches.stitches.len();
            if !stitches.stitches.is_empty() {
                match progress.advance(seam, tick) {
                    Some(SeamChange::Closed) => {
                        commands.trigger(ClothSeamClosed { entity, seam: index })
                    }
                    Some(SeamChange::Opened) => {
                        commands.trigger(ClothSeamOpened { entity, seam: index })
                    }
                    None => {}
                }
                let closing = progress.closing;
                if closing > 0.0 {
                    timer.restart();
                }
                lacings.push(Lacing {
                    stitches: stitches.closed(first, seam.closed),
                    length: seam.length / instance.growth.end(),
                    closing,
                });
                progress.closing = (closing - tick).max(0.0);
            }
            first = end;
        }
        batches.lane(lane).sew(&known.seams, lacings);
    }
}

/// What has happened to a seam in a tick.
enum SeamChange {
    Closed,
    Opened,
}

impl SeamProgress {
    /// Takes over how far a seam is closed in a tick (s), and returns what has happened to it.
    fn advance(&mut self, seam: &Seam, tick: f32) -> Option<SeamChange> {
        let was_open = self.closed == 0.0;
        self.closed = seam.closed;
        if seam.closed == 0.0 {
            *self = Self::default();
            return (!was_open).then_some(SeamChange::Opened);
        }
        if was_open {
            self.closing = seam.closing;
        }
        let is_closed = seam.closed >= 1.0 && self.closing <= tick;
        let is_new = is_closed && !self.is_reported;
        self.is_reported = is_closed;
        is_new.then_some(SeamChange::Closed)
    }
}

impl SewnCloth {
    /// Whether the stitches are those of a level.
    fn fits(&self, levels: &Arc<ClothLevels>, level: usize) -> bool {
        self.known.as_ref().is_some_and(|known| known.of.is(levels, level))
    }

    /// The stitches of a seam, given its index, if it has any and its sides are as before.
    fn kept(&self, index: usize, seam: &Seam) -> Option<&SeamStitches> {
        let known = self.known.as_ref()?;
        let (sides, reversed) = known.sides.get(index)?;
        let stitches = &known.of_seams[index];
        let is_same = *sides == seam.sides && *reversed == seam.reversed;
        (is_same && !stitches.stitches.is_empty()).then_some(stitches)
    }

    /// Finds the stitches of seams at a level. A seam whose sides are as before keeps its stitches: a slider that moves in each frame
    /// costs no search. Defects are reported with the index of the seam.
    fn find_stitches(
        &mut self,
        seams: &[Seam],
        mesh: &ClothMesh,
        levels: &Arc<ClothLevels>,
        level: usize,
        mut report: impl FnMut(usize, SeamError),
    ) {
        let mut of_seams = Vec::with_capacity(seams.len());
        for (index, seam) in seams.iter().enumerate() {
            let found = seam.check_numbers().and_then(|()| match self.kept(index, seam) {
                Some(kept) => Ok(kept.clone()),
                None => stitches_of(seam, mesh, levels, level),
            });
            of_seams.push(found.unwrap_or_else(|error| {
                report(index, error);
                SeamStitches::default()
            }));
        }
        let all: Vec<_> = of_seams.iter().flat_map(|it| it.stitches.iter().copied()).collect();
        let is_same =
            |known: &&KnownStitches| known.of_seams.iter().flat_map(|it| &it.stitches).eq(&all);
        let known = self.known.as_ref().filter(is_same);
        let sides = seams.iter().map(|seam| (seam.sides.clone(), seam.reversed)).collect();
        let seams = match known {
            Some(known) => Some(Arc::clone(&known.seams)),
            None => Seams::new(levels.fabric(level), &all).ok().map(Arc::new),
        };
        self.known = seams.map(|seams| KnownStitches {
            of: KnownLevel::new(levels, level),
            sides,
            of_seams,
            seams,
        });
    }
}
