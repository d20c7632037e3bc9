//! Checkpoints on all ranks: the columns of the points, a slice of rows each, and a text of everything that is the same
//! everywhere. What makes a file a checkpoint is `bsmpm_io::checkpoint`'s part; what is in the text is the caller's.

mod read;
mod refusal;
mod write;

pub use read::{Wanted, find, read};
pub use refusal::Refusal;
pub use write::{Contents, write};

use bsmpm::points::Column;
use bsmpm_io::checkpoint::{Array, Number};
use hdf5_collective::Shape;

/// The array that holds the text.
const STATE: &str = "state";

/// How a column stands in the file: what its numbers are, and how many of them make a row.
fn form(column: &dyn Column) -> (hdf5_collective::Number, u64) {
    let number = match column.number() {
        bsmpm::points::Number::U16 => hdf5_collective::Number::U16,
        bsmpm::points::Number::U64 => hdf5_collective::Number::U64,
        bsmpm::points::Number::F64 => hdf5_collective::Number::F64,
    };
    (number, column.width() as u64)
}

/// An array of the file as the record names it.
fn named(name: &str, shape: Shape) -> Array {
    let number = match shape.number {
        hdf5_collective::Number::U8 => Number::U8,
        hdf5_collective::Number::U16 => Number::U16,
        hdf5_collective::Number::U64 => Number::U64,
        hdf5_collective::Number::F64 => Number::F64,
    };
    Array { name: name.to_owned(), number, rows: shape.rows, width: shape.width }
}
