//! Reads an HDF5 file on any number of ranks. Each rank reads an equal range of rows.

use std::ops::Range;
use std::path::Path;

use mpi::topology::Communicator;

use crate::error::{Error, Result};
use crate::handle::File;
use crate::library::Hdf5;
use crate::shape::Shape;

/// A file that is being read. It should be known to be undamaged: HDF5 is not safe on hostile files.
pub struct Reader<'h> {
    hdf5: &'h Hdf5<'h>,
    file: File,
}

impl<'h> Reader<'h> {
    /// Opens a file that [`crate::Writer`] wrote.
    ///
    /// # Errors
    /// [`Error::Library`] if HDF5 does not know it.
    pub fn open(hdf5: &'h Hdf5<'h>, path: &Path) -> Result<Self> {
        let file = hdf5.agree(File::open(&hdf5.world(), path))?;
        Ok(Self { hdf5, file })
    }

    /// Every array and its shape, by name; nothing is read and no room made for it.
    ///
    /// # Errors
    /// [`Error::Foreign`] if there is anything that [`crate::Writer`] never writes.
    pub fn arrays(&self) -> Result<Vec<(String, Shape)>> {
        self.hdf5.agree(self.shapes())
    }

    fn shapes(&self) -> Result<Vec<(String, Shape)>> {
        let mut shapes = Vec::new();
        for name in self.file.names()? {
            let (_, shape) = self.file.array(&name)?;
            shapes.push((name, shape));
        }
        Ok(shapes)
    }

    /// This rank's equal share of an array's rows, in little-endian bytes; in the order of the ranks they are the
    /// array.
    ///
    /// # Errors
    /// [`Error::Library`] if they cannot be read, [`Error::Foreign`] if the array has another shape.
    pub fn share(&self, name: &str, shape: Shape) -> Result<Vec<u8>> {
        let world = self.hdf5.world();
        let rows = share(
            shape.rows,
            world.rank().unsigned_abs().into(),
            world.size().unsigned_abs().into(),
        );
        self.hdf5.agree(self.rows(name, shape, rows))
    }

    /// Some rows of an array, others on every rank if need be, in little-endian bytes.
    ///
    /// # Errors
    /// As [`Reader::share`]; [`Error::Foreign`] for rows that the array does not have.
    pub fn range(&self, name: &str, shape: Shape, rows: Range<u64>) -> Result<Vec<u8>> {
        self.hdf5.agree(self.rows(name, shape, rows))
    }

    fn rows(&self, name: &str, shape: Shape, rows: Range<u64>) -> Result<Vec<u8>> {
        let (array, found) = self.file.array(name)?;
        if found != shape {
            return Err(Error::foreign_array(name, "has another shape than expected"));
        }
        if rows.start > rows.end || rows.end > shape.rows {
            return Err(Error::foreign_array(name, "has fewer rows than expected"));
        }
        let count = rows.end - rows.start;
        let size = shape
            .row_bytes()
            .zip(usize::try_from(count).ok())
            .and_then(|(size, count)| size.checked_mul(count));
        let mut bytes = vec![0; size.ok_or_else(|| Error::foreign_array(name, "is too large"))?];
        array.read(rows.start, count, shape.width, &mut bytes)?;
        Ok(bytes)
    }

    /// Closes the file.
    ///
    /// # Errors
    /// [`Error::Library`] if HDF5 cannot.
    pub fn close(self) -> Result<()> {
        let closed = self.file.close();
        self.hdf5.agree(closed)
    }
}

/// The rows of one of several ranks: all rows once, in order, no share more than a row larger than another.
fn share(rows: u64, rank: u64, ranks: u64) -> Range<u64> {
    let each = rows / ranks;
    let over = rows % ranks;
    let start = rank * each + rank.min(over);
    start..start + each + u64::from(rank < over)
}

#[cfg(test)]
mod tests {
    use super::share;

    #[test]
    fn shares_are_all_rows_once_and_equal() {
        for rows in [0, 1, 2, 3, 7, 100, u64::MAX] {
            for ranks in [1, 2, 3, 4, 7] {
                let shares: Vec<_> = (0..ranks).map(|rank| share(rows, rank, ranks)).collect();
                assert_eq!((shares[0].start, shares[shares.len() - 1].end), (0, rows));
                assert!(shares.windows(2).all(|two| two[0].end == two[1].start));
                let sizes = shares.iter().map(|share| share.end - share.start);
                assert!(sizes.clone().max().unwrap() - sizes.min().unwrap() <= 1);
            }
        }
    }
}
