//! Number type of formulas that evaluate one material point, or eight at a time (SIMD), with bitwise identical results.

use nalgebra::Scalar;
use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Number, or vector of numbers (SIMD).
pub trait Real:
    Scalar
    + Copy
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// Result of a comparison, one per number.
    type Mask: Copy + Debug + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;

    /// Returns `value` in every number of the vector.
    fn like(self, value: f64) -> Self;

    /// Returns the square root.
    fn root(self) -> Self;

    /// Returns the cube root.
    fn cube_root(self) -> Self;

    /// Returns the absolute value.
    fn magnitude(self) -> Self;

    /// Returns the magnitude with the sign of `sign`.
    fn signed(self, sign: Self) -> Self;

    /// Returns `self < other`.
    fn below(self, other: Self) -> Self::Mask;

    /// Returns `self <= other`.
    fn at_most(self, other: Self) -> Self::Mask;

    /// Returns `one` where the mask is true, `other` elsewhere.
    fn choose(mask: Self::Mask, one: Self, other: Self) -> Self;

    /// Returns whether the mask is true for at least one number.
    fn any(mask: Self::Mask) -> bool;

    /// Returns `rare` of the arguments, number by number, where the mask is true; elsewhere `self`.
    fn unless(self, mask: Self::Mask, arguments: [Self; 2], rare: fn([f64; 2]) -> f64) -> Self;
}

/// Returns `of` for 0, 1 and 2. Unlike `map` of an array it is inlined for all number types.
#[inline(always)]
pub fn three<T>(of: impl Fn(usize) -> T) -> [T; 3] {
    [of(0), of(1), of(2)]
}

/// Returns `first` where the mask is true, `second` elsewhere.
#[inline(always)]
pub fn choose<R: Real>(mask: R::Mask, first: [R; 3], second: [R; 3]) -> [R; 3] {
    [
        R::choose(mask, first[0], second[0]),
        R::choose(mask, first[1], second[1]),
        R::choose(mask, first[2], second[2]),
    ]
}

impl Real for f64 {
    type Mask = bool;

    #[inline(always)]
    fn like(self, value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn cube_root(self) -> Self {
        self.cbrt()
    }

    #[inline(always)]
    fn magnitude(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn signed(self, sign: Self) -> Self {
        self.copysign(sign)
    }

    #[inline(always)]
    fn below(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        self <= other
    }

    #[inline(always)]
    fn choose(mask: bool, one: Self, other: Self) -> Self {
        if mask { one } else { other }
    }

    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }

    #[inline(always)]
    fn unless(self, mask: bool, arguments: [Self; 2], rare: fn([f64; 2]) -> f64) -> Self {
        if mask { rare(arguments) } else { self }
    }
}
