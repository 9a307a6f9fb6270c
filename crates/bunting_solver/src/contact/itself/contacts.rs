//! The contacts of layers, of one cloth or of several, from one phase of a substep to another.

use glam::Vec3;

use crate::contact::itself::cell_pairs::CellPairs;
use crate::contact::itself::cloth::Cloth;
use crate::contact::itself::mesh::ContactMesh;
use crate::contact::itself::pairs::Pairs;
use crate::contact::itself::particles::Particles;
use crate::contact::itself::patches::Cell;
use crate::contact::itself::points::Points;
use crate::contact::itself::rigid_zones::RigidZones;
use crate::contact::itself::rules::Rules;
use crate::contact::itself::search::Search;
use crate::contact::itself::solve::Contacts;
use crate::contact::itself::swept::End;
use crate::contact::itself::touching::FindTouching;
use crate::contact::itself::untangle::Tangles;

/// Part of the distance of layers by which a particle near others may move in a substep and still be under-relaxed.
/// Larger: under-relaxation moves it through others. Smaller: layers at rest tremble.
const FAST: f32 = 0.25;

/// Part of the distance of layers by which particles may move until contacts are found again. Larger: layers come nearer before contacts
/// are found. Smaller: more searches.
const OUTDATED: f32 = 0.5;

/// How the layers of a substep are kept apart.
pub(in crate::contact) struct Layers<'a, R> {
    pub mesh: &'a ContactMesh,
    pub rules: &'a R,
    /// Greatest distance that any layers keep, m.
    pub thickness: f32,
    /// Length of the substep, s.
    pub step: f32,
    /// Rate at which pushes become velocities, 1/s: one over the effective length of the substep.
    pub rate: f32,
}

/// The contacts of layers: scratch arrays of a substep.
#[derive(Clone, Debug, Default)]
pub(in crate::contact) struct LayerContacts {
    search: Search,
    cells: CellPairs,
    /// Those of them whose features may pass through one another at the end of the substep.
    crossing_cells: CellPairs,
    pairs: Pairs,
    pub particles: Particles,
    points: Points,
    contacts: Contacts,
    tangles: Tangles,
    /// Whether each particle has moved so far since contacts were found that some may be missing.
    has_moved: Vec<bool>,
    /// Whether features may pass through one another at the start of the substep.
    may_be_tangled: bool,
    /// Whether contacts have been found in this substep.
    is_begun: bool,
}

impl LayerContacts {
    /// Begins a tick, so that what is found in it does not depend on the last one.
    pub fn begin_tick(&mut self) {
        self.may_be_tangled = true;
        self.is_begun = false;
    }

    /// Whether contacts have been found in this substep.
    pub fn is_begun(&self) -> bool {
        self.is_begun
    }

    /// Finds the contacts of a substep, given where particles are in it so far, unless they have been found before.
    pub fn begin<R: Rules>(&mut self, layers: &Layers<R>) {
        if !core::mem::replace(&mut self.is_begun, true) {
            self.points.read_starts(&self.particles);
            self.find(layers);
        }
    }

    /// Finds the contacts anew if particles have moved so far that any may be missing.
    pub fn renew<R: Rules>(&mut self, layers: &Layers<R>) {
        if self.is_outdated(layers) {
            self.find(layers);
        }
    }

    /// Whether particles have moved so far since the last search that layers may meet which did not in it.
    fn is_outdated<R>(&self, layers: &Layers<R>) -> bool {
        self.search.is_outdated(&self.particles.end, OUTDATED * layers.thickness)
    }

    /// Whether there are features that may touch.
    pub fn meet(&self) -> bool {
        !self.cells.pairs.is_empty()
    }

    fn find<R: Rules>(&mut self, layers: &Layers<R>) {
        let Layers { mesh, rules, thickness, step, .. } = *layers;
        let Self { search, cells, pairs, particles, points, contacts, tangles, .. } = self;
        points.read_ends(particles);
        search.find(&Cloth { mesh, points, thickness }, rules, cells);
        pairs.bound(mesh, cells, points);
        pairs.find(mesh, cells, thickness);
        tangles.clear(particles.start.len());
        if self.may_be_tangled {
            pairs.find_crossings(mesh, cells, End::First);
            pairs.drop_sewn(rules.sewn());
            tangles.find(&pairs.edges_triangles, &particles.start);
            self.may_be_tangled = tangles.is_any();
        } else {
            pairs.drop_sewn(rules.sewn());
        }
        contacts.find(pairs, points, &FindTouching { rules, thickness, step, tangles });
        self.has_moved.clear();
        self.has_moved.resize(particles.end.len(), false);
        contacts.mark_near(&mut particles.is_near);
        tangles.mark_near(&mut particles.is_near);
    }

    /// Finds the edges and triangles that may pass through one another at the end of the substep: those of cells that both have contacts, or
    /// one of which has moved since contacts were found.
    fn find_crossings<R: Rules>(&mut self, layers: &Layers<R>) {
        let is_outdated = self.is_outdated(layers);
        let Layers { mesh, rules, thickness, .. } = *layers;
        let Self {
            search,
            cells,
            crossing_cells,
            pairs,
            points,
            particles,
            contacts,
            has_moved,
            ..
        } = self;
        points.read_ends(particles);
        if is_outdated {
            search.mark_moved(&particles.end, OUTDATED * thickness, has_moved);
            search.find(&Cloth { mesh, points, thickness }, rules, cells);
        }
        let has_contacts = |cell: &Cell| cell.particles.iter().any(|&at| contacts.has(at));
        let has_moved = |cell: &Cell| cell.particles.iter().any(|&at| has_moved[at as usize]);
        let may_cross = |pair: [&Cell; 2]| {
            pair.into_iter().all(has_contacts) || pair.into_iter().any(has_moved)
        };
        crossing_cells
            .find_among(cells, |pair| may_cross(pair.map(|cell| &mesh.cells[cell as usize])));
        pairs.bound(mesh, crossing_cells, points);
        pairs.find_crossings(mesh, crossing_cells, End::Last);
        pairs.drop_sewn(layers.rules.sewn());
    }

    /// Moves features that pass through one another at the start of a substep of the length `step`, s.
    pub fn untangle(&mut self, mesh: &ContactMesh, step: f32) {
        self.tangles.untangle(mesh, &mut self.particles, step);
    }

    /// Stops the motion of such features relative to one another.
    pub fn stop_tangled(&mut self) {
        self.tangles.stop(&mut self.particles);
    }

    /// Moves layers apart. Returns whether any were too near.
    pub fn move_apart<R>(&mut self, layers: &Layers<R>, sweeps: usize) -> bool {
        self.contacts.move_apart(&mut self.points, &mut self.particles, sweeps, layers.rate)
    }

    /// Moves layers apart and stops their approach.
    pub fn separate<R>(&mut self, layers: &Layers<R>, sweeps: usize) {
        self.contacts.separate(&mut self.points, &mut self.particles, sweeps, layers.rate);
    }

    /// Particles that must end the substep where they are: those of features that are still much nearer than they must
    /// be, those of zones that have returned, and those near others that move fast, given the distance of layers, m.
    pub fn unrelaxed_particles(&self, thickness: f32) -> impl Iterator<Item = usize> {
        let Self { contacts, particles, .. } = self;
        let is_fast = move |&at: &usize| particles.way(at) > FAST * thickness;
        let returned = (0..particles.touched.len()).filter(|&at| particles.touched[at]);
        let fast = contacts.members().filter(is_fast);
        contacts.pressed_particles(particles).chain(returned).chain(fast)
    }

    /// The contacts of features that are as near as they may be, given what counts as such, m: their particles, a point of
    /// the first feature, m, and the unit normal on its side.
    pub fn touching(&self, within: f32) -> impl Iterator<Item = ([u32; 4], Vec3, Vec3)> {
        self.contacts.touching(&self.particles, within)
    }

    /// Forgets the contacts of the last substep.
    pub fn forget(&mut self) {
        self.contacts.clear();
        self.is_begun = false;
    }

    /// Ends the substep: returns features that pass through one another to where they began in it, and marks their particles.
    /// Returns the zones, if there are any, whose velocities must become their means.
    pub fn return_zones<R: Rules>(&mut self, layers: &Layers<R>) -> Option<RigidZones> {
        self.is_begun = false;
        self.particles.touched.fill(false);
        if !self.meet() {
            return None;
        }
        let mut zones = RigidZones::new(&self.particles);
        let mut grew = false;
        loop {
            self.find_crossings(layers);
            if !zones.grow(&self.pairs.edges_triangles, &self.tangles, &mut self.particles) {
                break;
            }
            grew = true;
        }
        if grew && zones.draw_out(&layers.mesh.edges, &self.particles) {
            zones.give_up(&mut self.particles);
        }
        // Features with pins may still pass through one another.
        self.may_be_tangled |= grew || zones.are_given_up();
        if !grew || zones.are_given_up() {
            return None;
        }
        self.particles.is_near.clone_from(&self.particles.touched);
        Some(zones)
    }
}
