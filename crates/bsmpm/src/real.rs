//! Number type of formulas that evaluate one material point, or eight at a time (SIMD), with bitwise identical results.

use nalgebra::Scalar;
use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A number, or several side by side.
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
    /// What is true of each.
    type Mask: Copy + Debug + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;

    /// `value`, as many times as this has numbers.
    fn like(self, value: f64) -> Self;

    /// Square root.
    fn root(self) -> Self;

    /// Cube root.
    fn cube_root(self) -> Self;

    /// Absolute value.
    fn magnitude(self) -> Self;

    /// This magnitude with the sign of the other.
    fn signed(self, sign: Self) -> Self;

    /// `self < other`
    fn below(self, other: Self) -> Self::Mask;

    /// `self <= other`
    fn at_most(self, other: Self) -> Self::Mask;

    /// The one where the mask is true, the other elsewhere.
    fn choose(mask: Self::Mask, one: Self, other: Self) -> Self;

    /// Whether it is true of at least one.
    fn any(mask: Self::Mask) -> bool;

    /// Where the mask is true what `rare` makes of the arguments, one by one; elsewhere this.
    fn unless(self, mask: Self::Mask, arguments: [Self; 2], rare: fn([f64; 2]) -> f64) -> Self;
}

/// What is made of 0, 1 and 2. Unlike an array's `map` it is inlined whatever the numbers are.
#[inline(always)]
pub fn three<T>(of: impl Fn(usize) -> T) -> [T; 3] {
    [of(0), of(1), of(2)]
}

/// Of the first where the mask holds, of the second elsewhere.
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
