//! The layouts of a batch: the pack and lane of each particle, and the order in which constraints are solved.
//!
//! There are four. [`SideBySide`](crate::batch::side_by_side::SideBySide) holds up to as many cloths of one
//! fabric as there are lanes: a pack holds the same particle of each cloth, and numbers of the fabric are
//! the same in all lanes. [`Mixed`](crate::batch::mixed::Mixed) does so with cloths of different fabrics of one
//! topology: numbers of the fabric are each lane's own. [`SingleCloth`](crate::batch::single_cloth::SingleCloth) spreads one cloth across
//! the lanes: a pack holds consecutive particles of a row of its grid, constraints that share no particle
//! are solved in one pack, and numbers of the fabric are each lane's own, too.
//! [`SingleNet`](crate::batch::single_net::SingleNet) does so with a net, whose lines are gathered.
//!
//! Kernels are written once for all, over [`Constant`] and [`Particles`].

use core::fmt::Debug;
use core::ops::Range;

use glam::Vec3;

use crate::batch::masses::Masses;
use crate::constraints::factors::Factors;
use crate::constraints::stiffness::Stiffness;
use crate::fabric::{BendLine, Chains, Fabric, RestBends, Ribbon, Tether};
use crate::geometry::corners::CornerSums;
use crate::simd::constant::Constant;
use crate::simd::lane::{Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

/// Index of a cloth, and vectors to be written into its lanes, one for each particle; zero is written if
/// there are none.
pub(crate) type OfCloth<'a> = (usize, Option<&'a [Vec3]>);

/// Order of a single cloth's particles in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    /// Particles of a row of the grid are consecutive.
    RowMajor,
    /// Particles of a column of the grid are consecutive.
    ColumnMajor,
}

/// A layout, with the fabric's constraints arranged for it.
pub(crate) trait Layout<P: Pack>: Clone + Debug + Send + Sync + 'static {
    /// Number of the fabric for a pack.
    type Constant: Constant<P>;
    /// Storage of positions.
    type Positions: Positions<P, Constant = Self::Constant>;
    /// A tether, or one in each lane.
    type Tether: PackedTether<P>;
    /// Sums over the triangles at each particle.
    type Triangles<'a>: CornerSums<P, Field = <Self::Positions as Positions<P>>::Field>;

    /// Greatest number of cloths in a batch.
    const CLOTHS: usize;
    /// Number of fabrics that a batch holds: one, or one for each cloth.
    const FABRICS: usize = 1;

    /// Which of the batch's fabrics is that of a cloth.
    fn fabric_of(cloth: usize) -> usize {
        if Self::FABRICS == 1 { 0 } else { cloth }
    }

    /// The lanes of a cloth.
    fn lanes(cloth: usize) -> Range<usize>;

    /// Number of packs of each array of the state.
    fn pack_count(&self) -> usize;

    /// The pack and the lane of a particle of a cloth.
    fn locate(&self, particle: usize, cloth: usize) -> (usize, usize);

    /// The particle in a lane at an index by which [`Particles`] access it in an order; none where the lane has none.
    fn particle_at(&self, _order: Order, index: u32, _lane: usize) -> Option<u32> {
        Some(index)
    }

    /// Index in row-major order of the first particle of a pack, by which [`Particles`] access it.
    fn index_of_pack(&self, pack: usize) -> u32 {
        pack as u32
    }

    /// Indices, as of [`index_of_pack`](Self::index_of_pack), of the neighbours of a pack's particles on a grid: those before
    /// and after them in their rows, those above and below them. In lanes without a neighbour there is any particle.
    fn neighbours_of_pack(&self, pack: usize, particles: &[usize], rest: &RestBends) -> [u32; 4] {
        let at = self.index_of_pack(pack);
        // The neighbours of a pack's particles in their rows are a pack as well.
        let in_row = |side: usize| {
            let has_neighbour = |&&particle: &&usize| rest.has_neighbour(particle, side);
            particles.iter().find(has_neighbour).map_or(at, |&particle| {
                (at + rest.neighbours[particle][side]).wrapping_sub(particle as u32)
            })
        };
        let [_, _, above, below] = rest.neighbours[particles[0]];
        let in_column = |of: u32| self.index_of_pack(self.locate(of as usize, 0).0);
        [in_row(0), in_row(1), in_column(above), in_column(below)]
    }

    /// Reads the vectors of a cloth, particle by particle.
    fn read(&self, packs: &[Pack3<P>], cloth: usize, into: &mut Vec<Vec3>);

    /// Reads a number of each particle of a cloth.
    fn read_numbers(&self, packs: &[P], cloth: usize, into: &mut [f32]) {
        for (particle, value) in into.iter_mut().enumerate() {
            let (pack, lane) = self.locate(particle, cloth);
            *value = packs[pack].lanes()[lane];
        }
    }

    /// Writes the vectors of cloths, and zero into lanes of a cloth without a particle.
    fn write(&self, packs: &mut [Pack3<P>], cloths: &[OfCloth]);

    /// Converts one number for each particle to one for each pack; zero in lanes without a particle.
    fn constants(&self, of_particles: &[f32]) -> Vec<Self::Constant>;

    /// Index of the partial sum to which each pack adds. It depends on the columns of the pack's particles
    /// only, so that sums have the same bits in all layouts.
    fn partial_sums(&self) -> Vec<u8>;

    /// Writes a number of each particle of a cloth.
    fn write_numbers(&self, of_particles: &[f32], cloth: usize, packs: &mut [P]) {
        for (particle, &value) in of_particles.iter().enumerate() {
            let (pack, lane) = self.locate(particle, cloth);
            packs[pack].lanes_mut()[lane] = value;
        }
    }

    /// Creates the storage of positions from those of the packs, m.
    fn positions(&self, packs: Vec<Pack3<P>>) -> Self::Positions;

    /// Chains of links, colour by colour, and the cells whose diagonals are links.
    fn chains<'a>(&'a self, fabric: &'a Fabric) -> &'a Chains<Self::Constant>;

    /// The order of particles in memory that the chains of a colour need.
    fn order_of_chains(&self, colour: usize) -> Order;

    /// For each class of links, one in lanes with a link and zero in others; empty if every lane has a link.
    fn linked(&self) -> &[P];

    /// Lines along which a grid bends, and the order of particles in memory that they need.
    fn bend_lines<'a>(
        &'a self,
        fabric: &'a Fabric,
    ) -> impl Iterator<Item = (Order, &'a [BendLine])>;

    /// Ribbons along which a grid twists, and the order of particles in memory that they need.
    fn ribbons<'a>(&'a self, fabric: &'a Fabric) -> (Order, &'a [Ribbon]);

    /// Tethers to the farthest pins, and to the nearest pins.
    fn tethers<'a>(&'a self, fabric: &'a Fabric) -> [&'a [Self::Tether]; 2];

    /// Compliances and factorised systems of chains, bend lines and ribbons.
    fn factors(&self) -> &Factors<P, Self::Constant>;

    /// Takes over the numbers of a cloth's fabric. Called only where batches hold different fabrics.
    fn set_fabric(&mut self, _: usize, _: &Fabric, _: &mut Masses<P, Self::Constant>) {
        unreachable!("a batch of one fabric keeps it");
    }

    /// Computes the factors of a cloth.
    fn set_stiffness(&mut self, cloth: usize, fabric: &Fabric, stiffness: &Stiffness);

    /// Takes over where a cloth's pins are, given the positions of all its particles, m.
    fn set_pins(&mut self, cloth: usize, fabric: &Fabric, positions: &[Vec3]);

    /// The triangles, for sums that depend on positions only.
    fn triangles<'a>(&'a mut self, fabric: &'a Fabric) -> Self::Triangles<'a>;

    /// The triangles, for sums that depend on velocities too, and the velocities in the form that these sums
    /// read.
    fn moving_triangles<'a>(
        &'a mut self,
        fabric: &'a Fabric,
        velocity: &'a [Pack3<P>],
    ) -> (Self::Triangles<'a>, &'a <Self::Positions as Positions<P>>::Field);
}

/// The positions of all particles: in packs, and in further arrays that constraints need.
pub(crate) trait Positions<P: Pack>: Clone + Debug + Send + Sync + 'static {
    /// Number of the fabric for a pack.
    type Constant: Constant<P>;
    /// Particles in the form in which constraints access them.
    type Particles<'a>: Particles<P, Constant = Self::Constant>;
    /// Particles for constraints along lines, which [bring](Particles::bring) those of a line before they solve it.
    type Lines<'a>: Particles<P, Constant = Self::Constant>;
    /// Vectors of all particles in the form that sums over triangles read.
    type Field: ?Sized;

    /// The positions in packs, m. Valid only between the phases of a substep, when constraints do not hold
    /// the positions.
    fn packs(&self) -> &[Pack3<P>];

    /// The positions in packs, m, copied back from the constraints' arrays.
    fn packs_mut(&mut self) -> &mut Vec<Pack3<P>>;

    /// The packs, to be overwritten: whatever constraints hold is discarded.
    fn overwritten(&mut self) -> &mut [Pack3<P>] {
        self.packs_mut()
    }

    /// The particles in an order, for the constraints. `inverse_masses` are given for each pack, 1/m².
    fn particles<'a>(
        &'a mut self,
        order: Order,
        inverse_masses: &'a [P],
        linked: &'a [P],
    ) -> Self::Particles<'a>;

    /// The same for constraints along lines.
    fn lines<'a>(
        &'a mut self,
        order: Order,
        inverse_masses: &'a [P],
        linked: &'a [P],
    ) -> Self::Lines<'a>;

    /// The positions in the form that sums over triangles read.
    fn field(&mut self) -> &Self::Field;

    /// Sets the inverse mass of each particle of a cloth, 1/m².
    fn set_inverse_masses(&mut self, of_particles: &[f32]);

    /// Discards the constraints' arrays, before a new state is written.
    fn clear(&mut self);
}

/// The particles that constraints move: in each pack one of each cloth, or several of one cloth.
pub(crate) trait Particles<P: Pack> {
    /// Number of the fabric for a pack.
    type Constant: Constant<P>;

    /// Brings the particles in the first columns of rows to where the other functions find them.
    #[inline(always)]
    fn bring<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        _: L::Token,
        _: &[[u32; N]],
        _columns: usize,
    ) {
    }

    /// Puts particles back that have been brought, from the first row to the last: a particle in several rows is where the last one
    /// has it.
    #[inline(always)]
    fn put_back<L: Lane<Pack = P>, const N: usize>(
        &mut self,
        _: L::Token,
        _: &[[u32; N]],
        _columns: usize,
    ) {
    }

    /// Position, m.
    fn position<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> V3<L>;

    /// Overwrites the position, m.
    fn set_position<L: Lane<Pack = P>>(&mut self, token: L::Token, at: u32, position: V3<L>);

    /// Moves a particle from its position, m, by `direction` × `factor`.
    #[inline(always)]
    fn correct<L: Lane<Pack = P>>(
        &mut self,
        token: L::Token,
        at: u32,
        position: V3<L>,
        (direction, factor): (V3<L>, L),
    ) {
        self.set_position(token, at, position.plus_scaled(direction, factor));
    }

    /// Inverse mass per unit area density, 1/m²; zero if the particle is pinned.
    fn inverse_mass<L: Lane<Pack = P>>(&self, token: L::Token, at: u32) -> L;

    /// One; zero in lanes without a link of this class while other lanes have one. Divided by the diagonal of
    /// a link's row in place of one, it leaves such a lane without tension.
    fn one_if_linked<L: Lane<Pack = P>>(&self, token: L::Token, class: u32) -> L;
}

/// A tether of each cloth, or tethers of several particles of one cloth.
pub(crate) trait PackedTether<P: Pack> {
    /// Index of the tethered particle, or of the first one.
    fn particle(&self) -> u32;

    /// Position of the pin, m.
    fn pin<L: Lane<Pack = P>, S: Particles<P>>(&self, token: L::Token, particles: &S) -> V3<L>;

    /// Length at rest, m; infinite in lanes without a tether.
    fn length<L: Lane<Pack = P>>(&self, token: L::Token) -> L;
}

impl<P: Pack> PackedTether<P> for Tether {
    #[inline(always)]
    fn particle(&self) -> u32 {
        self.particle
    }

    #[inline(always)]
    fn pin<L: Lane<Pack = P>, S: Particles<P>>(&self, token: L::Token, particles: &S) -> V3<L> {
        particles.position(token, self.pin)
    }

    #[inline(always)]
    fn length<L: Lane<Pack = P>>(&self, token: L::Token) -> L {
        L::splat(token, self.length)
    }
}
