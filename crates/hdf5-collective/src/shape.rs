//! What an array is: numbers, rows, width.

/// What a number of an array is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Number {
    /// A byte.
    U8,
    /// 16 bits without a sign.
    U16,
    /// 64 bits without a sign.
    U64,
    /// A float of double precision.
    F64,
}

impl Number {
    /// Every kind.
    pub const ALL: [Self; 4] = [Self::U8, Self::U16, Self::U64, Self::F64];

    /// Bytes of one.
    pub fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 => 2,
            Self::U64 | Self::F64 => 8,
        }
    }
}

/// An array of all ranks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// What it holds.
    pub number: Number,
    /// Rows of all ranks.
    pub rows: u64,
    /// Numbers of a row.
    pub width: u64,
}

impl Shape {
    /// Bytes of a row; none where they are more than can be counted.
    pub fn row_bytes(&self) -> Option<usize> {
        usize::try_from(self.width).ok()?.checked_mul(self.number.bytes())
    }
}
