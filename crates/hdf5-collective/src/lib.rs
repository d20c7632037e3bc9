//! A small, safe binding of HDF5 for arrays of numbers with checksums. All MPI ranks write and read a file together,
//! and each rank handles a range of rows.
//!
//! A file contains only arrays `[rows, width]` in its root group: hard links, little-endian numbers of fixed size,
//! chunks of 16,384 rows with Fletcher's checksum, no compression and no time stamps. Equal contents give equal bytes.
//! [`Reader`] rejects other files before it allocates memory.
//!
//! All functions of [`Writer`] and [`Reader`] are collective. An error on one rank is an error on all ranks, except
//! [`Error::Torn`].
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
