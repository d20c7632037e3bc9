//! Writes a file.

use std::path::Path;

use crate::error::{Error, Result};
use crate::handle::File;
use crate::library::Hdf5;
use crate::shape::{Number, Shape};

/// A file that is being written. One that is dropped is not closed: [`Writer::close`] is collective.
pub struct Writer<'h> {
    hdf5: &'h Hdf5<'h>,
    file: File,
}

impl<'h> Writer<'h> {
    /// A new file, in the place of an older one.
    ///
    /// # Errors
    /// [`Error::Library`] when it cannot be made.
    pub fn create(hdf5: &'h Hdf5<'h>, path: &Path) -> Result<Self> {
        let file = hdf5.agree(File::create(&hdf5.world(), path))?;
        Ok(Self { hdf5, file })
    }

    /// Adds an array of this rank's rows, in little-endian bytes, behind those of the ranks before it; width and number
    /// must be the same on all ranks. Returns its shape.
    ///
    /// # Errors
    /// [`Error::Torn`] when it cannot be written, [`Error::Foreign`] when this rank has no whole rows.
    pub fn write(&mut self, name: &str, number: Number, width: u64, rows: &[u8]) -> Result<Shape> {
        let size = Shape { number, rows: 0, width }.row_bytes().filter(|&size| size > 0);
        let whole = size
            .filter(|size| rows.len().is_multiple_of(*size))
            .ok_or_else(|| Error::foreign_array(name, "has no whole rows"));
        let count = (rows.len() / self.hdf5.agree(whole)?) as u64;
        let (start, total) = self.hdf5.place(count);
        let shape = Shape {
            number,
            rows: total,
            width,
        };
        // Other ranks may wait within HDF5 for one that fails here, too.
        let array = self.file.add(name, shape).map_err(|error| torn(name, &error))?;
        if total > 0 {
            array
                .write(start, count, width, rows)
                .map_err(|error| torn(name, &error))?;
        }
        Ok(shape)
    }

    /// Closes the file; it is not on the disk yet.
    ///
    /// # Errors
    /// [`Error::Torn`] when the rest of it cannot be written.
    pub fn close(self) -> Result<()> {
        self.file.close().map_err(|error| torn("the end of the file", &error))
    }
}

fn torn(name: &str, error: &Error) -> Error {
    Error::Torn {
        name: name.to_owned(),
        reason: error.to_string(),
    }
}
