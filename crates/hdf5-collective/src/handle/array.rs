//! An array of an open HDF5 file: reads and writes rows, and checks type and storage.

use std::ffi::c_int;
use std::ptr;

use hdf5_sys::h5::hsize_t;
use hdf5_sys::h5d::{H5D_layout_t, H5Dget_create_plist, H5Dget_space, H5Dget_type, H5Dread, H5Dwrite};
use hdf5_sys::h5p::{
    H5FD_mpio_xfer_t, H5P_CLS_DATASET_XFER, H5P_DEFAULT, H5Pcreate, H5Pget_external_count, H5Pget_filter2,
    H5Pget_layout, H5Pget_nfilters, H5Pset_dxpl_mpio,
};
use hdf5_sys::h5s::{
    H5S_seloper_t, H5Screate_simple, H5Sget_simple_extent_dims, H5Sget_simple_extent_ndims, H5Sselect_hyperslab,
    H5Sselect_none,
};
use hdf5_sys::h5t::H5Tequal;
use hdf5_sys::h5z::H5Z_FILTER_FLETCHER32;

use super::{Id, check, kind};
use crate::error::Result;
use crate::shape::Number;

/// An open array of a file.
pub(crate) struct Array {
    pub(super) id: Id,
    pub(super) number: Number,
}

impl Array {
    /// Writes the rows from `start` on; all ranks together, also those without a row.
    pub(crate) fn write(&self, start: u64, count: u64, width: u64, rows: &[u8]) -> Result<()> {
        assert_eq!(
            rows.len() as u64,
            count * width * self.number.bytes() as u64,
            "rows of another size"
        );
        let action = "write an array";
        let memory = selection(&self.id, 0, count, width, true)?;
        let place = selection(&self.id, start, count, width, false)?;
        // SAFETY: valid identifiers; the buffer has the bytes that the selection names, as asserted.
        unsafe {
            let transfer = Id::new(action, H5Pcreate(*H5P_CLS_DATASET_XFER))?;
            check(
                action,
                H5Pset_dxpl_mpio(transfer.0, H5FD_mpio_xfer_t::H5FD_MPIO_COLLECTIVE),
            )?;
            check(
                action,
                H5Dwrite(
                    self.id.0,
                    kind(self.number),
                    memory.0,
                    place.0,
                    transfer.0,
                    rows.as_ptr().cast(),
                ),
            )
        }
    }

    /// Reads the rows from `start` on into a buffer of their size; each rank for itself.
    pub(crate) fn read(&self, start: u64, count: u64, width: u64, rows: &mut [u8]) -> Result<()> {
        assert_eq!(
            rows.len() as u64,
            count * width * self.number.bytes() as u64,
            "rows of another size"
        );
        if count == 0 {
            return Ok(());
        }
        let memory = selection(&self.id, 0, count, width, true)?;
        let place = selection(&self.id, start, count, width, false)?;
        // SAFETY: valid identifiers; the buffer has the bytes that the selection names, as asserted.
        let read = unsafe {
            H5Dread(
                self.id.0,
                kind(self.number),
                memory.0,
                place.0,
                H5P_DEFAULT,
                rows.as_mut_ptr().cast(),
            )
        };
        check("read an array", read)
    }
}

pub(super) fn space(dims: [hsize_t; 2]) -> Result<Id> {
    // SAFETY: two dimensions, which HDF5 copies; null stands for the same as the largest.
    Id::new("make a data space", unsafe {
        H5Screate_simple(2, dims.as_ptr(), ptr::null())
    })
}

/// The rows from `start` on, in memory or in the file; nothing where there are none.
fn selection(array: &Id, start: u64, count: u64, width: u64, in_memory: bool) -> Result<Id> {
    let action = "select rows";
    // SAFETY: an open array or a new space, and arrays of two numbers.
    unsafe {
        let chosen = if in_memory {
            space([count.max(1), width])?
        } else {
            Id::new(action, H5Dget_space(array.0))?
        };
        if count == 0 {
            check(action, H5Sselect_none(chosen.0))?;
        } else {
            let from: [hsize_t; 2] = [start, 0];
            let size: [hsize_t; 2] = [count, width];
            let set = H5S_seloper_t::H5S_SELECT_SET;
            let each = ptr::null();
            check(
                action,
                H5Sselect_hyperslab(chosen.0, set, from.as_ptr(), each, size.as_ptr(), each),
            )?;
        }
        Ok(chosen)
    }
}

/// Rows and width; none for another number of dimensions.
pub(super) fn extent(array: &Id) -> Result<Option<[u64; 2]>> {
    let action = "read an array's size";
    let mut dims: [hsize_t; 2] = [0; 2];
    // SAFETY: an open array; as many dimensions are read as there is room for.
    unsafe {
        let space = Id::new(action, H5Dget_space(array.0))?;
        if H5Sget_simple_extent_ndims(space.0) != 2 {
            return Ok(None);
        }
        check(
            action,
            H5Sget_simple_extent_dims(space.0, dims.as_mut_ptr(), ptr::null_mut()),
        )?;
    }
    Ok(Some(dims))
}

pub(super) fn number(array: &Id) -> Result<Option<Number>> {
    // SAFETY: an open array, and types that live as long as the library.
    unsafe {
        let found = Id::new("read an array's type", H5Dget_type(array.0))?;
        Ok(Number::ALL
            .into_iter()
            .find(|&number| H5Tequal(found.0, kind(number)) > 0))
    }
}

/// What an array's storage has that this library never makes: files beside it, views of other arrays, other filters.
pub(super) fn strange_storage(array: &Id, rows: u64) -> Result<Option<&'static str>> {
    // SAFETY: an open array and its property list; null where a result is not wanted.
    unsafe {
        let list = Id::new("read an array's storage", H5Dget_create_plist(array.0))?;
        // The number of files makes sense for contiguous storage only; there are none elsewhere.
        if H5Pget_external_count(list.0) > 0 {
            return Ok(Some("lies in other files"));
        }
        let wanted = if rows == 0 {
            H5D_layout_t::H5D_CONTIGUOUS
        } else {
            H5D_layout_t::H5D_CHUNKED
        };
        if H5Pget_layout(list.0) != wanted {
            return Ok(Some("is stored in another way than ours"));
        }
        if H5Pget_nfilters(list.0) != c_int::from(rows > 0) {
            return Ok(Some("has other filters than a checksum"));
        }
        let mut flags = 0;
        let mut values = 0;
        let null = ptr::null_mut();
        if rows > 0
            && H5Pget_filter2(
                list.0,
                0,
                &raw mut flags,
                &raw mut values,
                null,
                0,
                ptr::null_mut(),
                ptr::null_mut(),
            ) != H5Z_FILTER_FLETCHER32
        {
            return Ok(Some("has another filter than a checksum"));
        }
    }
    Ok(None)
}
