//! Interpolation of vectors by sparse rows of weights, in packs of each layout.

use crate::fabric::{Interpolation, RowGroup, Term};
use crate::simd::lane::{Kernel, Lane, Pack};
use crate::simd::vec3::{Pack3, V3};

/// A vector in memory: of each lane's cloth, or one whose coordinates lie in the lanes.
pub(super) trait Vector<P: Pack>: Copy {
    /// The vector in registers.
    type Register<L: Lane<Pack = P>>: Copy;

    fn zero<L: Lane<Pack = P>>(token: L::Token) -> Self::Register<L>;
    fn load<L: Lane<Pack = P>>(&self, token: L::Token) -> Self::Register<L>;
    fn store<L: Lane<Pack = P>>(&mut self, vector: Self::Register<L>);
    /// `sum` + `vector` × `scale`.
    fn plus_scaled<L: Lane<Pack = P>>(
        sum: Self::Register<L>,
        vector: Self::Register<L>,
        scale: L,
    ) -> Self::Register<L>;
    /// `sum` − `vector` × `scale`.
    fn minus_scaled<L: Lane<Pack = P>>(
        sum: Self::Register<L>,
        vector: Self::Register<L>,
        scale: L,
    ) -> Self::Register<L>;
}

impl<P: Pack> Vector<P> for Pack3<P> {
    type Register<L: Lane<Pack = P>> = V3<L>;

    #[inline(always)]
    fn zero<L: Lane<Pack = P>>(token: L::Token) -> V3<L> {
        V3::splat(token, 0.0)
    }

    #[inline(always)]
    fn load<L: Lane<Pack = P>>(&self, token: L::Token) -> V3<L> {
        V3::load(token, self)
    }

    #[inline(always)]
    fn store<L: Lane<Pack = P>>(&mut self, vector: V3<L>) {
        vector.store(self);
    }

    #[inline(always)]
    fn plus_scaled<L: Lane<Pack = P>>(sum: V3<L>, vector: V3<L>, scale: L) -> V3<L> {
        sum.plus_scaled(vector, scale)
    }

    #[inline(always)]
    fn minus_scaled<L: Lane<Pack = P>>(sum: V3<L>, vector: V3<L>, scale: L) -> V3<L> {
        sum.minus_scaled(vector, scale)
    }
}

impl<P: Pack> Vector<P> for P {
    type Register<L: Lane<Pack = P>> = L;

    #[inline(always)]
    fn zero<L: Lane<Pack = P>>(token: L::Token) -> L {
        L::splat(token, 0.0)
    }

    #[inline(always)]
    fn load<L: Lane<Pack = P>>(&self, token: L::Token) -> L {
        L::load(token, self)
    }

    #[inline(always)]
    fn store<L: Lane<Pack = P>>(&mut self, vector: L) {
        vector.store(self);
    }

    #[inline(always)]
    fn plus_scaled<L: Lane<Pack = P>>(sum: L, vector: L, scale: L) -> L {
        sum.plus_product(vector, scale)
    }

    #[inline(always)]
    fn minus_scaled<L: Lane<Pack = P>>(sum: L, vector: L, scale: L) -> L {
        sum.minus_product(vector, scale)
    }
}

/// Overwrites the vector of each row that has terms by the interpolated one.
pub(super) struct Interpolate<'a, V> {
    pub rows: &'a Interpolation,
    pub from: &'a [V],
    pub to: &'a mut [V],
}

/// Adds the interpolated vector of each row.
pub(super) struct AddInterpolated<'a, V> {
    pub rows: &'a Interpolation,
    pub from: &'a [V],
    pub to: &'a mut [V],
}

/// The difference of vectors and the interpolated ones, for each row that has terms.
pub(super) struct Remainder<'a, V> {
    pub rows: &'a Interpolation,
    pub from: &'a [V],
    pub of: &'a [V],
    pub to: &'a mut [V],
}

/// What is done with the interpolated vector of one row.
trait OfRow<V> {
    /// Whether terms are subtracted.
    const SUBTRACTS: bool;

    /// The vector that terms are added to or subtracted from.
    fn start<P: Pack, L: Lane<Pack = P>>(&self, token: L::Token, row: usize) -> V::Register<L>
    where
        V: Vector<P>;

    /// The place of the result.
    fn place(&mut self, row: usize) -> &mut V;
}

impl<V> OfRow<V> for Interpolate<'_, V> {
    const SUBTRACTS: bool = false;

    #[inline(always)]
    fn start<P: Pack, L: Lane<Pack = P>>(&self, token: L::Token, _: usize) -> V::Register<L>
    where
        V: Vector<P>,
    {
        V::zero(token)
    }

    #[inline(always)]
    fn place(&mut self, row: usize) -> &mut V {
        &mut self.to[row]
    }
}

impl<V> OfRow<V> for AddInterpolated<'_, V> {
    const SUBTRACTS: bool = false;

    #[inline(always)]
    fn start<P: Pack, L: Lane<Pack = P>>(&self, token: L::Token, row: usize) -> V::Register<L>
    where
        V: Vector<P>,
    {
        self.to[row].load(token)
    }

    #[inline(always)]
    fn place(&mut self, row: usize) -> &mut V {
        &mut self.to[row]
    }
}

impl<V> OfRow<V> for Remainder<'_, V> {
    const SUBTRACTS: bool = true;

    #[inline(always)]
    fn start<P: Pack, L: Lane<Pack = P>>(&self, token: L::Token, row: usize) -> V::Register<L>
    where
        V: Vector<P>,
    {
        self.of[row].load(token)
    }

    #[inline(always)]
    fn place(&mut self, row: usize) -> &mut V {
        &mut self.to[row]
    }
}

macro_rules! kernel {
    ($kernel:ident) => {
        impl<P: Pack, V: Vector<P>> Kernel<P> for $kernel<'_, V> {
            #[inline(always)]
            fn run<L: Lane<Pack = P>>(mut self, token: L::Token) {
                let (rows, from) = (self.rows, self.from);
                for group in rows.groups() {
                    // Short rows, which nearly all are, are unrolled.
                    match group.length {
                        1 => unrolled::<P, V, L, _, 1>(token, rows, group, from, &mut self),
                        2 => unrolled::<P, V, L, _, 2>(token, rows, group, from, &mut self),
                        3 => unrolled::<P, V, L, _, 3>(token, rows, group, from, &mut self),
                        4 => unrolled::<P, V, L, _, 4>(token, rows, group, from, &mut self),
                        5 => unrolled::<P, V, L, _, 5>(token, rows, group, from, &mut self),
                        6 => unrolled::<P, V, L, _, 6>(token, rows, group, from, &mut self),
                        _ => looped::<P, V, L, _>(token, rows, group, from, &mut self),
                    }
                }
            }
        }
    };
}

kernel!(Interpolate);
kernel!(AddInterpolated);
kernel!(Remainder);

/// A group of rows with `N` terms each.
#[inline(always)]
fn unrolled<P: Pack, V: Vector<P>, L: Lane<Pack = P>, T: OfRow<V>, const N: usize>(
    token: L::Token,
    rows: &Interpolation,
    group: &RowGroup,
    from: &[V],
    of_row: &mut T,
) {
    let (terms, _) = rows.terms_of(group).as_chunks::<N>();
    for (&row, terms) in group.rows.iter().zip(terms) {
        let start = of_row.start(token, row as usize);
        let sum = with_terms::<P, V, L, T>(token, start, terms, from);
        of_row.place(row as usize).store(sum);
    }
}

/// A group of rows of any length.
#[inline(always)]
fn looped<P: Pack, V: Vector<P>, L: Lane<Pack = P>, T: OfRow<V>>(
    token: L::Token,
    rows: &Interpolation,
    group: &RowGroup,
    from: &[V],
    of_row: &mut T,
) {
    let terms = rows.terms_of(group).chunks_exact(group.length);
    for (&row, terms) in group.rows.iter().zip(terms) {
        let start = of_row.start(token, row as usize);
        let sum = with_terms::<P, V, L, T>(token, start, terms, from);
        of_row.place(row as usize).store(sum);
    }
}

/// `start` with the weighted vectors added or subtracted.
#[inline(always)]
fn with_terms<P: Pack, V: Vector<P>, L: Lane<Pack = P>, T: OfRow<V>>(
    token: L::Token,
    start: V::Register<L>,
    terms: &[Term],
    from: &[V],
) -> V::Register<L> {
    let mut sum = start;
    for term in terms {
        let vector = from[term.from as usize].load::<L>(token);
        let weight = L::splat(token, term.weight);
        sum = if T::SUBTRACTS {
            V::minus_scaled(sum, vector, weight)
        } else {
            V::plus_scaled(sum, vector, weight)
        };
    }
    sum
}
