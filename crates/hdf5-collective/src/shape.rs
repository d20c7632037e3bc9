//! Shape of an array in a file: number type, rows and width.

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

/// Rows of a chunk.
pub(crate) const CHUNK: u64 = 16_384;

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

    /// Bytes that it takes in a file, rather too many: of several chunks the last one is whole, too; each has a
    /// checksum and a place in the index, and the array a header.
    fn room(&self) -> u64 {
        let chunks = self.rows.div_ceil(CHUNK);
        let rows = if chunks > 1 {
            chunks.saturating_mul(CHUNK)
        } else {
            self.rows
        };
        let numbers = rows
            .saturating_mul(self.width)
            .saturating_mul(self.number.bytes() as u64);
        numbers.saturating_add(chunks.saturating_mul(256)).saturating_add(8192)
    }
}

/// Bytes of a file with arrays of these shapes, rather too many.
pub fn room(shapes: impl IntoIterator<Item = Shape>) -> u64 {
    shapes
        .into_iter()
        .map(|shape| shape.room())
        .fold(1 << 14, u64::saturating_add)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_counts_whole_chunks_and_no_more_than_there_are_numbers() {
        let of = |rows| {
            room([Shape {
                number: Number::F64,
                rows,
                width: 2,
            }])
        };
        let around = of(0);
        assert_eq!(of(100) - around, 1600 + 256);
        assert_eq!(of(CHUNK + 1) - around, 2 * (16 * CHUNK + 256));
        assert_eq!(of(u64::MAX), u64::MAX);
    }
}
