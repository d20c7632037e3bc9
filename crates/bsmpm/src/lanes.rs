//! Eight points at a time, with whatever vectors the machine has: SSE2, AVX2 or AVX-512, chosen at run time.
//!
//! There are eight lanes on every machine, and no operation has another result in a wider register: the bits are the
//! same. What runs in lanes is inlined into one function for each instruction set, so all of it says `#[inline(always)]`.

use crate::real::Real;
pub use fearless_simd::Simd;
use fearless_simd::{Level, Select, SimdBase, SimdFloat, SimdFrom, dispatch, f64x8, mask64x8};
use std::fmt::{Debug, Formatter, Result};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};
use std::sync::OnceLock;

/// Points that are computed at a time.
pub const LANES: usize = 8;

/// A number of eight points.
#[derive(Clone, Copy)]
pub struct Lanes<S: Simd>(f64x8<S>);

/// What is true of each of eight points.
#[derive(Clone, Copy)]
pub struct LaneMask<S: Simd>(mask64x8<S>);

/// What can be done in lanes.
pub trait InLanes {
    /// What it leaves.
    type Output;

    /// Does it; to be inlined always.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

/// Does `work` with the widest vectors of this machine; of fewer where `BSMPM_LANES` names their instruction set (`sse2`,
/// `avx2`), which tests do.
pub fn run<W: InLanes>(work: W) -> W::Output {
    static WIDEST: OnceLock<Level> = OnceLock::new();
    let level = *WIDEST.get_or_init(|| chosen(std::env::var("BSMPM_LANES").ok().as_deref()));
    dispatch!(level, simd => work.run(simd))
}

/// The instruction set of this machine, or the smaller one of the name.
fn chosen(name: Option<&str>) -> Level {
    let widest = Level::new();
    #[cfg(target_arch = "x86_64")]
    let widest = match name {
        Some("sse2") => widest.as_sse2().map_or(widest, Level::Sse2),
        Some("avx2") => widest.as_avx2().map_or(widest, Level::Avx2),
        _ => widest,
    };
    widest
}

impl<S: Simd> Lanes<S> {
    /// The number of each lane.
    #[inline(always)]
    pub fn new(simd: S, numbers: [f64; LANES]) -> Self {
        Self(f64x8::simd_from(simd, numbers))
    }

    /// One number for all lanes.
    #[inline(always)]
    pub fn splat(simd: S, number: f64) -> Self {
        Self(f64x8::splat(simd, number))
    }

    /// The number of each lane.
    #[inline(always)]
    pub fn numbers(self) -> [f64; LANES] {
        self.0.into()
    }
}

impl<S: Simd> Debug for Lanes<S> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        self.numbers().fmt(f)
    }
}

impl<S: Simd> PartialEq for Lanes<S> {
    fn eq(&self, other: &Self) -> bool {
        self.numbers() == other.numbers()
    }
}

impl<S: Simd> Debug for LaneMask<S> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        <[i64; LANES]>::from(self.0).fmt(f)
    }
}

impl<S: Simd> Real for Lanes<S> {
    type Mask = LaneMask<S>;

    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Self(f64x8::splat(self.0.simd, value))
    }

    #[inline(always)]
    fn root(self) -> Self {
        Self(self.0.sqrt())
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
    fn below(self, other: Self) -> LaneMask<S> {
        LaneMask(self.0.simd_lt(other.0))
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> LaneMask<S> {
        LaneMask(self.0.simd_le(other.0))
    }

    #[inline(always)]
    fn choose(mask: LaneMask<S>, one: Self, other: Self) -> Self {
        Self(mask.0.select(one.0, other.0))
    }

    #[inline(always)]
    fn any(mask: LaneMask<S>) -> bool {
        fearless_simd::SimdMask::any_true(mask.0)
    }
}

macro_rules! arithmetic {
    ($($Operation:ident::$operation:ident),+) => {$(
        impl<S: Simd> $Operation for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $operation(self, other: Self) -> Self {
                Self(self.0.$operation(other.0))
            }
        }

        impl<S: Simd> $Operation<f64> for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $operation(self, other: f64) -> Self {
                Self(self.0.$operation(other))
            }
        }
    )+};
}

arithmetic!(Add::add, Sub::sub, Mul::mul, Div::div);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<S: Simd> BitAnd for LaneMask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl<S: Simd> BitOr for LaneMask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl<S: Simd> Not for LaneMask<S> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}
