//! Writes and reads checkpoints. Each rank writes the array rows of its points and nodes; the other data
//! ([`CheckpointState`]) are the same on all ranks.

mod issued;
mod read;
mod refusal;
mod sanity;
mod state;
mod write;

pub use issued::{IssuedWarning, SurfaceCounts};
pub use read::{CheckpointChoice, OpenCheckpoint, find};
pub use refusal::Refusal;
pub(crate) use refusal::{agree, broadcast};
pub(crate) use sanity::require;
pub use state::{
    BooksForm, CheckpointState, CrossedState, Files, FlowedState, FreeFieldState, Outlet, RecordState, Row,
};
pub(crate) use state::{rigid_accelerations, rigid_numbers, rows};
pub(crate) use write::room;
pub use write::{Contents, write};

use bsmpm::points::Column;
use bsmpm_io::checkpoint::{ArrayNumber, RecordedArray};
use hdf5_collective::Shape;

/// The array that holds the text.
const STATE: &str = "state";
/// The array of the nodal displacement of the last converged step, a row for each layer of nodes.
const GUESS: &str = "guess";

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
fn named(name: &str, shape: Shape) -> RecordedArray {
    let number = match shape.number {
        hdf5_collective::Number::U8 => ArrayNumber::U8,
        hdf5_collective::Number::U16 => ArrayNumber::U16,
        hdf5_collective::Number::U64 => ArrayNumber::U64,
        hdf5_collective::Number::F64 => ArrayNumber::F64,
    };
    RecordedArray {
        name: name.to_owned(),
        number,
        rows: shape.rows,
        width: shape.width,
    }
}
