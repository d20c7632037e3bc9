//! A small, safe binding of HDF5: checksummed arrays of numbers that all ranks write and read together, a slice of rows
//! each. It knows nothing of what the numbers mean.
//!
//! A file holds arrays `[rows, width]` in its root group and nothing else: hard links, little-endian numbers of fixed
//! size, chunks of 16,384 rows with Fletcher's checksum, no compression, no time stamps, so that equal contents make
//! equal bytes. [`Reader`] refuses whatever else a file may hold before it makes room for any of it.
//!
//! Every function of [`Writer`] and [`Reader`] is collective, and so are their errors, but for [`Error::Torn`].
#![deny(unsafe_code)]

mod error;
#[allow(unsafe_code)]
mod handle;
mod library;
mod reader;
mod shape;
mod writer;

pub use error::{Error, Result};
pub use library::{Hdf5, version};
pub use reader::Reader;
pub use shape::{Number, Shape, room};
pub use writer::Writer;
