//! Evaluates eight material points at a time by SIMD instructions (SSE2, AVX2 or AVX-512), with bitwise identical
//! results: the width is always eight, and multiply-add is not fused.

use crate::real::Real;
pub use fearless_simd::Simd;
use fearless_simd::{Level, Select, SimdBase, SimdFloat, SimdFrom, SimdMask, f64x4, f64x8, mask64x4, mask64x8};
use std::fmt::{Debug, Formatter, Result};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Range, Sub};
use std::sync::OnceLock;

/// Number of points that are evaluated at a time.
pub const LANES: usize = 8;

/// Computation with SIMD vectors.
pub trait InLanes {
    /// Result of the computation.
    type Output;

    /// Performs the computation. Implementations must be `#[inline(always)]`.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

/// Instruction set that [`run`] uses.
static LEVEL: OnceLock<Level> = OnceLock::new();

/// Performs `work` with the widest vectors of this machine, or the chosen ones. Debug builds use SSE2, because the
/// others would triple the compile time.
pub fn run<W: InLanes>(work: W) -> W::Output {
    run_at(*LEVEL.get_or_init(Level::new), work)
}

/// Selects the instruction set of all later computations: `sse2`, `avx2` or `avx512`; for tests.
///
/// # Errors
/// If this machine does not support it, or a computation was performed before.
pub fn choose(name: &str) -> std::result::Result<(), String> {
    let (_, level) = levels()
        .into_iter()
        .find(|level| level.0 == name)
        .ok_or("this machine has no such vectors")?;
    LEVEL.set(level).map_err(|_| "lanes run already".to_owned())
}

/// Returns the result of `work` with each instruction set of this machine, with its name; for tests.
pub fn with_each<W: InLanes + Clone>(work: &W) -> Vec<(&'static str, W::Output)> {
    levels()
        .into_iter()
        .map(|(name, level)| (name, run_at(level, work.clone())))
        .collect()
}

/// Returns the instruction sets of this machine.
fn levels() -> Vec<(&'static str, Level)> {
    let widest = Level::new();
    #[cfg(target_arch = "x86_64")]
    let all = [
        ("sse2", widest.as_sse2().map(Level::Sse2)),
        ("avx2", widest.as_avx2().map(Level::Avx2)),
        ("avx512", widest.as_avx512().map(Level::Avx512)),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let all = [("widest", Some(widest))];
    all.into_iter()
        .filter_map(|(name, level)| Some((name, level?)))
        .collect()
}

#[inline(always)]
fn run_at<W: InLanes>(level: Level, work: W) -> W::Output {
    match level {
        #[cfg(all(target_arch = "x86_64", not(debug_assertions)))]
        Level::Avx512(simd) => vectorised(simd, work),
        #[cfg(all(target_arch = "x86_64", not(debug_assertions)))]
        Level::Avx2(simd) => vectorised(simd, work),
        #[cfg(target_arch = "x86_64")]
        level => vectorised(level.as_sse2().expect("of every x86-64"), work),
        #[cfg(not(target_arch = "x86_64"))]
        level => fearless_simd::dispatch!(level, simd => work.run(simd)),
    }
}

#[inline(always)]
fn vectorised<S: Simd, W: InLanes>(simd: S, work: W) -> W::Output {
    simd.vectorize(
        #[inline(always)]
        || work.run(simd),
    )
}

/// Splits a range of points into groups of eight; surplus lanes repeat the last point.
#[inline(always)]
pub fn eights(points: Range<usize>) -> impl Iterator<Item = Eight> {
    points.clone().step_by(LANES).map(move |first| Eight {
        first,
        last: points.end - 1,
    })
}

/// Eight consecutive points, or fewer at the end of a range.
#[derive(Clone, Copy, Debug)]
pub struct Eight {
    first: usize,
    last: usize, // last point of the range
}

impl Eight {
    /// Returns the points, each once.
    #[inline(always)]
    pub fn points(self) -> Range<usize> {
        self.first..(self.first + LANES).min(self.last + 1)
    }

    /// Returns the point of a lane.
    #[inline(always)]
    pub fn point(self, lane: usize) -> usize {
        (self.first + lane).min(self.last)
    }

    /// Returns references to the elements of the points, by lane.
    #[inline(always)]
    pub fn of<T>(self, all: &[T]) -> [&T; LANES] {
        let at = |lane: usize| &all[self.point(lane)];
        [at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)]
    }
}

/// Defines a vector type with its mask type.
macro_rules! vector {
    ($(#[$doc:meta])* $Vector:ident($vector:ident), $Mask:ident($mask:ident), $count:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub struct $Vector<S: Simd>($vector<S>);

        /// Results of a comparison.
        #[derive(Clone, Copy, Debug)]
        pub struct $Mask<S: Simd>($mask<S>);

        impl<S: Simd> $Vector<S> {
            /// Creates a vector of equal numbers.
            #[inline(always)]
            pub fn splat(simd: S, number: f64) -> Self {
                Self($vector::splat(simd, number))
            }

            /// Creates a vector from the first numbers of a slice.
            #[inline(always)]
            pub fn first_of(simd: S, numbers: &[f64]) -> Self {
                Self($vector::from_slice(simd, &numbers[..$count]))
            }

            /// Returns the numbers.
            #[inline(always)]
            pub fn numbers(self) -> [f64; $count] {
                self.0.into()
            }
        }

        impl<S: Simd> Debug for $Vector<S> {
            fn fmt(&self, f: &mut Formatter<'_>) -> Result {
                self.numbers().fmt(f)
            }
        }

        impl<S: Simd> PartialEq for $Vector<S> {
            fn eq(&self, other: &Self) -> bool {
                self.numbers() == other.numbers()
            }
        }

        impl<S: Simd> Real for $Vector<S> {
            type Mask = $Mask<S>;

            #[inline(always)]
            fn like(self, value: f64) -> Self {
                Self::splat(self.0.simd, value)
            }

            #[inline(always)]
            fn root(self) -> Self {
                Self(self.0.sqrt())
            }

            #[inline(always)]
            fn cube_root(self) -> Self {
                Self($vector::simd_from(self.0.simd, self.numbers().map(f64::cbrt)))
            }

            #[inline(always)]
            fn magnitude(self) -> Self {
                Self(self.0.abs())
            }

            #[inline(always)]
            fn signed(self, sign: Self) -> Self {
                Self(self.0.copysign(sign.0))
            }

            #[inline(always)]
            fn below(self, other: Self) -> $Mask<S> {
                $Mask(self.0.simd_lt(other.0))
            }

            #[inline(always)]
            fn at_most(self, other: Self) -> $Mask<S> {
                $Mask(self.0.simd_le(other.0))
            }

            #[inline(always)]
            fn choose(mask: $Mask<S>, one: Self, other: Self) -> Self {
                Self(mask.0.select(one.0, other.0))
            }

            #[inline(always)]
            fn any(mask: $Mask<S>) -> bool {
                mask.0.any_true()
            }

            #[inline(always)]
            fn unless(self, mask: $Mask<S>, arguments: [Self; 2], rare: fn([f64; 2]) -> f64) -> Self {
                if !mask.0.any_true() {
                    return self;
                }
                let marks = Self::choose(mask, self.like(1.0), self.like(0.0)).numbers();
                let mut numbers = self.numbers();
                let [first, second] = arguments.map(Self::numbers);
                for lane in (0..$count).filter(|&lane| marks[lane] > 0.0) {
                    numbers[lane] = rare([first[lane], second[lane]]);
                }
                Self($vector::simd_from(self.0.simd, numbers))
            }
        }

        operations!($Vector, Add::add, Sub::sub, Mul::mul, Div::div);

        impl<S: Simd> Neg for $Vector<S> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }

        impl<S: Simd> BitAnd for $Mask<S> {
            type Output = Self;
            #[inline(always)]
            fn bitand(self, other: Self) -> Self {
                Self(self.0 & other.0)
            }
        }

        impl<S: Simd> BitOr for $Mask<S> {
            type Output = Self;
            #[inline(always)]
            fn bitor(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }
        }

        impl<S: Simd> Not for $Mask<S> {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                Self(!self.0)
            }
        }
    };
}

/// Implements operations between vectors, and between vectors and numbers.
macro_rules! operations {
    ($Vector:ident, $($Operation:ident::$operation:ident),+) => {$(
        impl<S: Simd> $Operation for $Vector<S> {
            type Output = Self;
            #[inline(always)]
            fn $operation(self, other: Self) -> Self {
                Self(self.0.$operation(other.0))
            }
        }

        impl<S: Simd> $Operation<f64> for $Vector<S> {
            type Output = Self;
            #[inline(always)]
            fn $operation(self, other: f64) -> Self {
                Self(self.0.$operation(other))
            }
        }
    )+};
}

vector! {
    /// Numbers of eight points.
    Lanes(f64x8), LaneMask(mask64x8), 8
}

vector! {
    /// Numbers of four nodes of a point.
    Quad(f64x4), QuadMask(mask64x4), 4
}

impl<S: Simd> Lanes<S> {
    /// Creates a vector from the number of each lane.
    #[inline(always)]
    pub fn from_fn(simd: S, at: impl Fn(usize) -> f64) -> Self {
        Self(f64x8::simd_from(
            simd,
            [at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)],
        ))
    }
}
