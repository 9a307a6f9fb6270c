//! Convex shapes in lanes: in each lane another one of the same kind, whose nearest plane has a closed form.

use core::ops::Range;

use glam::{Affine3A, Mat3, Vec3};

use crate::constants::LEAST_LENGTH;
use crate::contact::closed_form::{ClosedForm, Core};
use crate::simd::lane::{Lane, Pack};
use crate::simd::vec3::{Pack3, V3, fill_lanes3};

/// A kind of shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    HalfSpace,
    /// Capsules, and balls as capsules without length.
    Capsule,
    /// Sharp or rounded.
    Cuboid,
    /// Sharp or rounded.
    Cylinder,
    /// Surfaces of triangles, of which each particle knows those near it.
    Triangles,
}

impl Kind {
    /// The kind of a shape, if there are lanes for it. Cones have none: they are rare, and their profile takes more instructions. Nor have
    /// polyhedra, of which each has its own number of faces.
    pub(super) fn of(form: &ClosedForm) -> Option<Self> {
        match form.core {
            Core::HalfSpace(_) => Some(Self::HalfSpace),
            Core::Point | Core::Segment { .. } => Some(Self::Capsule),
            Core::Cuboid { .. } => Some(Self::Cuboid),
            Core::Cylinder { .. } => Some(Self::Cylinder),
            Core::Cone { .. } | Core::Polyhedron(_) => None,
        }
    }
}

/// An affine change of coordinates in each lane: the images of the axes, and of the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct AffinePacks<P>([Pack3<P>; 4]);

impl<P: Pack> AffinePacks<P> {
    pub fn zero() -> Self {
        Self([[P::splat(0.0); 3]; 4])
    }

    pub fn fill(&mut self, lanes: &Range<usize>, change: &Affine3A) {
        let [x, y, z] = Mat3::from(change.matrix3).to_cols_array_2d().map(Vec3::from);
        for (pack, value) in self.0.iter_mut().zip([x, y, z, change.translation.into()]) {
            fill_lanes3(pack, lanes, value);
        }
    }
}

/// The same in registers.
#[derive(Clone, Copy)]
pub(super) struct Affine<L> {
    axes: [V3<L>; 3],
    origin: V3<L>,
}

impl<L: Lane> Affine<L> {
    #[inline(always)]
    pub fn load(token: L::Token, packs: &AffinePacks<L::Pack>) -> Self {
        let [x, y, z, origin] = &packs.0;
        Self {
            axes: [V3::load(token, x), V3::load(token, y), V3::load(token, z)],
            origin: V3::load(token, origin),
        }
    }

    /// The image of a vector.
    #[inline(always)]
    pub fn turned(&self, vector: V3<L>) -> V3<L> {
        let [x, y, z] = self.axes;
        (x * vector.x).plus_scaled(y, vector.y).plus_scaled(z, vector.z)
    }

    /// The image of a point.
    #[inline(always)]
    pub fn moved(&self, point: V3<L>) -> V3<L> {
        self.turned(point) + self.origin
    }
}

/// A shape in each lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShapePacks<P> {
    kind: Kind,
    /// The normal of a half-space, the first end of a capsule's axis, half the edges of a cuboid, or radius and half the height of a
    /// cylinder, m.
    place: Pack3<P>,
    /// From the first to the second end of a capsule's axis, m.
    along: Pack3<P>,
    /// Distance of the surface from the core, m.
    radius: P,
}

impl<P: Pack> ShapePacks<P> {
    pub fn new(kind: Kind) -> Self {
        let zero = P::splat(0.0);
        Self { kind, place: [zero; 3], along: [zero; 3], radius: zero }
    }

    /// Writes a shape of this kind into lanes.
    pub fn fill(&mut self, lanes: &Range<usize>, form: &ClosedForm) {
        let (place, along) = match form.core {
            Core::HalfSpace(normal) => (normal, Vec3::ZERO),
            Core::Point => (Vec3::ZERO, Vec3::ZERO),
            Core::Segment { from, along } => (from, along),
            Core::Cuboid { half } => (half, Vec3::ZERO),
            Core::Cylinder { half_height, radius } | Core::Cone { half_height, radius } => {
                (Vec3::new(radius, half_height, 0.0), Vec3::ZERO)
            }
            Core::Polyhedron(_) => (Vec3::ZERO, Vec3::ZERO),
        };
        fill_lanes3(&mut self.place, lanes, place);
        fill_lanes3(&mut self.along, lanes, along);
        self.radius.lanes_mut()[lanes.clone()].fill(form.radius);
    }

    /// Distance of points from the surface, m, and the unit normals of the nearest planes. Within the core the distance is only known
    /// to be at most zero, and the normal is not that of the surface.
    #[inline(always)]
    pub fn nearest<L: Lane<Pack = P>>(&self, token: L::Token, at: V3<L>) -> (L, V3<L>) {
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let place: V3<L> = V3::load(token, &self.place);
        let foot = match self.kind {
            Kind::HalfSpace => return (at.dot(place), place),
            // These are no closed form.
            Kind::Triangles => at,
            Kind::Capsule => {
                let along: V3<L> = V3::load(token, &self.along);
                let squared = along.dot(along).max(L::splat(token, f32::MIN_POSITIVE));
                let part = ((at - place).dot(along) / squared).max(zero).min(one);
                place.plus_scaled(along, part)
            }
            Kind::Cuboid => V3 {
                x: at.x.max(-place.x).min(place.x),
                y: at.y.max(-place.y).min(place.y),
                z: at.z.max(-place.z).min(place.z),
            },
            Kind::Cylinder => {
                let across = (at.x * at.x).plus_product(at.z, at.z).sqrt();
                let part = (place.x / across.max(L::splat(token, LEAST_LENGTH))).min(one);
                V3 { x: at.x * part, y: at.y.max(-place.y).min(place.y), z: at.z * part }
            }
        };
        let away = at - foot;
        let length = away.dot(away).sqrt();
        let normal = away * (one / length.max(L::splat(token, LEAST_LENGTH)));
        (length - L::load(token, &self.radius), normal)
    }
}
