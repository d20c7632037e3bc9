//! HDF5's C functions behind handles that close themselves: the crate's unsafe code, all of it.

use std::ffi::{CStr, CString, c_int, c_uint, c_void};
use std::path::Path;
use std::ptr;

use hdf5_sys::h5::{H5_index_t, H5_iter_order_t, H5get_libversion, H5open, hsize_t};
use hdf5_sys::h5d::{
    H5D_fill_time_t, H5D_layout_t, H5Dcreate2, H5Dget_create_plist, H5Dget_space, H5Dget_type, H5Dopen2, H5Dread,
    H5Dwrite,
};
use hdf5_sys::h5e::{H5E_DEFAULT, H5E_direction_t, H5E_error2_t, H5Eset_auto2, H5Ewalk2};
use hdf5_sys::h5f::{H5F_ACC_RDONLY, H5F_ACC_TRUNC, H5Fclose, H5Fcreate, H5Fopen};
use hdf5_sys::h5g::{H5G_info_t, H5Gget_info};
use hdf5_sys::h5i::{H5I_type_t, H5Idec_ref, H5Iget_type, hid_t};
use hdf5_sys::h5l::{H5L_info1_t, H5L_type_t, H5Lget_info1, H5Lget_name_by_idx};
use hdf5_sys::h5o::{H5Oclose, H5Oopen};
use hdf5_sys::h5p::{
    H5FD_mpio_xfer_t, H5P_CLS_DATASET_CREATE, H5P_CLS_DATASET_XFER, H5P_CLS_FILE_ACCESS, H5P_DEFAULT, H5Pcreate,
    H5Pget_external_count, H5Pget_filter2, H5Pget_layout, H5Pget_nfilters, H5Pset_chunk, H5Pset_dxpl_mpio,
    H5Pset_fapl_mpio, H5Pset_fill_time, H5Pset_fletcher32, H5Pset_obj_track_times,
};
use hdf5_sys::h5pl::H5PLset_loading_state;
use hdf5_sys::h5s::{
    H5S_seloper_t, H5Screate_simple, H5Sget_simple_extent_dims, H5Sget_simple_extent_ndims, H5Sselect_hyperslab,
    H5Sselect_none,
};
use hdf5_sys::h5t::{H5T_IEEE_F64LE, H5T_STD_U8LE, H5T_STD_U16LE, H5T_STD_U64LE, H5Tequal};
use hdf5_sys::h5z::H5Z_FILTER_FLETCHER32;
use mpi::raw::AsRaw;
use mpi::topology::SimpleCommunicator;

use crate::error::{Error, Result};
use crate::shape::{Number, Shape};

/// Rows of a chunk.
const CHUNK: u64 = 16_384;
/// Bytes of the longest name of an array, its end included.
const NAME: usize = 256;

/// A property list, data space, data type or data set; closed with its last handle.
struct Id(hid_t);

impl Id {
    fn new(action: &str, id: hid_t) -> Result<Self> {
        if id < 0 { Err(failed(action)) } else { Ok(Self(id)) }
    }
}

impl Drop for Id {
    fn drop(&mut self) {
        // SAFETY: a valid identifier, of which this is the only owner. An error can no longer be told.
        unsafe { H5Idec_ref(self.0) };
    }
}

/// An open file. It is never closed by itself: closing is collective, and after a failed write it may crash.
pub(crate) struct File(hid_t);

/// An open array of a file.
pub(crate) struct Array {
    id: Id,
    number: Number,
}

fn check(action: &str, code: c_int) -> Result<()> {
    if code < 0 { Err(failed(action)) } else { Ok(()) }
}

/// HDF5's own words for the last call that failed.
fn failed(action: &str) -> Error {
    Error::Library { action: action.to_owned(), reason: words() }
}

fn words() -> String {
    unsafe extern "C" fn note(_: c_uint, error: *const H5E_error2_t, words: *mut c_void) -> c_int {
        // SAFETY: called by H5Ewalk2 below, with a valid entry and the list that was handed over.
        let (words, description) = unsafe { (&mut *words.cast::<Vec<String>>(), (*error).desc) };
        if !description.is_null() {
            // SAFETY: a text of HDF5 that lives as long as the entry.
            words.push(unsafe { CStr::from_ptr(description) }.to_string_lossy().into_owned());
        }
        0
    }
    let mut words: Vec<String> = Vec::new();
    let list = (&raw mut words).cast();
    // SAFETY: the callback has HDF5's signature and gets the list that it expects.
    unsafe { H5Ewalk2(H5E_DEFAULT, H5E_direction_t::H5E_WALK_UPWARD, Some(note), list) };
    words.dedup();
    words.truncate(3);
    if words.is_empty() { "it gave no reason".to_owned() } else { words.join("; ") }
}

fn text(text: &str) -> Result<CString> {
    CString::new(text).map_err(|_| Error::Foreign { item: format!("{text:?}"), reason: "holds a zero byte".to_owned() })
}

fn path(path: &Path) -> Result<CString> {
    text(
        path.to_str()
            .ok_or_else(|| Error::Foreign { item: path.display().to_string(), reason: "is no UTF-8".to_owned() })?,
    )
}

/// Starts the library: it prints nothing and loads no code.
pub(crate) fn start() -> Result<()> {
    for name in ["HDF5_PLUGIN_PATH", "HDF5_PLUGIN_PRELOAD"] {
        if std::env::var_os(name).is_some() {
            // SAFETY: std's lock guards against Rust threads; `Hdf5::initialize` excludes others.
            unsafe { std::env::remove_var(name) };
        }
    }
    let mut none: c_int = 0;
    // SAFETY: may be called at any time; the pointer is valid.
    unsafe {
        check("start", H5open())?;
        check("be silent", H5Eset_auto2(H5E_DEFAULT, None, ptr::null_mut()))?;
        check("do without plugins", H5PLset_loading_state(&raw mut none))
    }
}

/// Version of the library linked at run time.
pub(crate) fn version() -> (u32, u32, u32) {
    let (mut major, mut minor, mut release) = (0, 0, 0);
    // SAFETY: the pointers are valid; the function reads constants only.
    unsafe { H5get_libversion(&raw mut major, &raw mut minor, &raw mut release) };
    (major, minor, release)
}

/// File access by all ranks of a communicator.
fn shared(world: &SimpleCommunicator) -> Result<Id> {
    // SAFETY: the class exists once the library runs; the communicator lives, and HDF5 duplicates it.
    unsafe {
        let access = Id::new("set up the access", H5Pcreate(*H5P_CLS_FILE_ACCESS))?;
        check("set up the access", H5Pset_fapl_mpio(access.0, world.as_raw(), mpi::ffi::RSMPI_INFO_NULL))?;
        Ok(access)
    }
}

fn kind(number: Number) -> hid_t {
    match number {
        Number::U8 => *H5T_STD_U8LE,
        Number::U16 => *H5T_STD_U16LE,
        Number::U64 => *H5T_STD_U64LE,
        Number::F64 => *H5T_IEEE_F64LE,
    }
}

impl File {
    pub(crate) fn create(world: &SimpleCommunicator, file: &Path) -> Result<Self> {
        let (access, name) = (shared(world)?, path(file)?);
        // SAFETY: valid text and property list.
        let id = unsafe { H5Fcreate(name.as_ptr(), H5F_ACC_TRUNC, H5P_DEFAULT, access.0) };
        if id < 0 { Err(failed("create the file")) } else { Ok(Self(id)) }
    }

    pub(crate) fn open(world: &SimpleCommunicator, file: &Path) -> Result<Self> {
        let (access, name) = (shared(world)?, path(file)?);
        // SAFETY: valid text and property list.
        let id = unsafe { H5Fopen(name.as_ptr(), H5F_ACC_RDONLY, access.0) };
        if id < 0 { Err(failed("open the file")) } else { Ok(Self(id)) }
    }

    /// Closes the file; its arrays must be closed.
    pub(crate) fn close(self) -> Result<()> {
        // SAFETY: open, and closed only here.
        check("close the file", unsafe { H5Fclose(self.0) })
    }

    /// A new array; one without rows has neither chunks nor checksums.
    pub(crate) fn add(&self, name: &str, shape: Shape) -> Result<Array> {
        let name = text(name)?;
        let action = "make an array";
        let space = space([shape.rows, shape.width])?;
        // SAFETY: valid identifiers, texts, and arrays of two numbers.
        unsafe {
            let layout = Id::new(action, H5Pcreate(*H5P_CLS_DATASET_CREATE))?;
            check(action, H5Pset_obj_track_times(layout.0, 0))?;
            check(action, H5Pset_fill_time(layout.0, H5D_fill_time_t::H5D_FILL_TIME_NEVER))?;
            if shape.rows > 0 {
                let chunk: [hsize_t; 2] = [shape.rows.min(CHUNK), shape.width];
                check(action, H5Pset_chunk(layout.0, 2, chunk.as_ptr()))?;
                check(action, H5Pset_fletcher32(layout.0))?;
            }
            let id = H5Dcreate2(self.0, name.as_ptr(), kind(shape.number), space.0, H5P_DEFAULT, layout.0, H5P_DEFAULT);
            Ok(Array { id: Id::new(action, id)?, number: shape.number })
        }
    }

    /// Names of everything in the root group, if all of it is linked in the plain way.
    pub(crate) fn names(&self) -> Result<Vec<String>> {
        let mut group = H5G_info_t::default();
        // SAFETY: an open file; the pointer is valid.
        check("read the file's contents", unsafe { H5Gget_info(self.0, &raw mut group) })?;
        (0..group.nlinks).map(|index| self.name(index)).collect()
    }

    fn name(&self, index: u64) -> Result<String> {
        let (action, root) = ("read a name", c".");
        let mut name = [0_u8; NAME];
        let mut link = H5L_info1_t::default();
        // SAFETY: an open file, valid texts, and a buffer of the length that is told.
        let length = unsafe {
            let (by, order) = (H5_index_t::H5_INDEX_NAME, H5_iter_order_t::H5_ITER_INC);
            H5Lget_name_by_idx(self.0, root.as_ptr(), by, order, index, name.as_mut_ptr().cast(), NAME, H5P_DEFAULT)
        };
        check(action, if length < 0 { -1 } else { 0 })?;
        let foreign = |item: &str, reason: &str| Error::Foreign { item: item.to_owned(), reason: reason.to_owned() };
        let name = CStr::from_bytes_until_nul(&name).ok().and_then(|name| name.to_str().ok());
        let name = name.filter(|name| isize::try_from(name.len()) == Ok(length as isize) && !name.is_empty());
        let name = name.ok_or_else(|| foreign("a name in the file", "is none of ours"))?.to_owned();
        // SAFETY: an open file, a valid text and pointer.
        check(action, unsafe { H5Lget_info1(self.0, text(&name)?.as_ptr(), &raw mut link, H5P_DEFAULT) })?;
        if link.type_ == H5L_type_t::H5L_TYPE_HARD { Ok(name) } else { Err(foreign(&name, "is linked, not there")) }
    }

    /// An array of the file and its shape, if it is one that this library could have written.
    pub(crate) fn array(&self, name: &str) -> Result<(Array, Shape)> {
        let foreign = |reason: &str| Error::Foreign { item: format!("the array {name}"), reason: reason.to_owned() };
        let label = text(name)?;
        // SAFETY: an open file and a valid text; opening the object before the array tells a group or type apart.
        let id = unsafe {
            let object = H5Oopen(self.0, label.as_ptr(), H5P_DEFAULT);
            check("open an object", if object < 0 { -1 } else { 0 })?;
            let is_array = H5Iget_type(object) == H5I_type_t::H5I_DATASET;
            H5Oclose(object);
            if !is_array {
                return Err(foreign("is no array"));
            }
            Id::new("open an array", H5Dopen2(self.0, label.as_ptr(), H5P_DEFAULT))?
        };
        let [rows, width] = extent(&id)?.ok_or_else(|| foreign("has not two dimensions"))?;
        let number = number(&id)?.ok_or_else(|| foreign("holds other numbers than ours"))?;
        if let Some(reason) = strange_storage(&id, rows)? {
            return Err(foreign(reason));
        }
        Ok((Array { id, number }, Shape { number, rows, width }))
    }
}

impl Array {
    /// Writes the rows from `start` on; all ranks together, also those without a row.
    pub(crate) fn write(&self, (start, count, width): (u64, u64, u64), rows: &[u8]) -> Result<()> {
        assert_eq!(rows.len() as u64, count * width * self.number.bytes() as u64, "rows of another size");
        let action = "write an array";
        let (memory, place) =
            (selection(&self.id, (0, count, width), true)?, selection(&self.id, (start, count, width), false)?);
        // SAFETY: valid identifiers; the buffer has the bytes that the selection names, as asserted.
        unsafe {
            let transfer = Id::new(action, H5Pcreate(*H5P_CLS_DATASET_XFER))?;
            check(action, H5Pset_dxpl_mpio(transfer.0, H5FD_mpio_xfer_t::H5FD_MPIO_COLLECTIVE))?;
            check(action, H5Dwrite(self.id.0, kind(self.number), memory.0, place.0, transfer.0, rows.as_ptr().cast()))
        }
    }

    /// Reads the rows from `start` on into a buffer of their size; each rank for itself.
    pub(crate) fn read(&self, (start, count, width): (u64, u64, u64), rows: &mut [u8]) -> Result<()> {
        assert_eq!(rows.len() as u64, count * width * self.number.bytes() as u64, "rows of another size");
        if count == 0 {
            return Ok(());
        }
        let (memory, place) =
            (selection(&self.id, (0, count, width), true)?, selection(&self.id, (start, count, width), false)?);
        // SAFETY: valid identifiers; the buffer has the bytes that the selection names, as asserted.
        let read =
            unsafe { H5Dread(self.id.0, kind(self.number), memory.0, place.0, H5P_DEFAULT, rows.as_mut_ptr().cast()) };
        check("read an array", read)
    }
}

fn space(dims: [hsize_t; 2]) -> Result<Id> {
    // SAFETY: two dimensions, which HDF5 copies; null stands for the same as the largest.
    Id::new("make a data space", unsafe { H5Screate_simple(2, dims.as_ptr(), ptr::null()) })
}

/// The rows from `start` on, in memory or in the file; nothing where there are none.
fn selection(array: &Id, (start, count, width): (u64, u64, u64), in_memory: bool) -> Result<Id> {
    let action = "select rows";
    // SAFETY: an open array or a new space, and arrays of two numbers.
    unsafe {
        let chosen = if in_memory { space([count.max(1), width])? } else { Id::new(action, H5Dget_space(array.0))? };
        if count == 0 {
            check(action, H5Sselect_none(chosen.0))?;
        } else {
            let (from, size): ([hsize_t; 2], [hsize_t; 2]) = ([start, 0], [count, width]);
            let (set, each) = (H5S_seloper_t::H5S_SELECT_SET, ptr::null());
            check(action, H5Sselect_hyperslab(chosen.0, set, from.as_ptr(), each, size.as_ptr(), each))?;
        }
        Ok(chosen)
    }
}

/// Rows and width; none for another number of dimensions.
fn extent(array: &Id) -> Result<Option<[u64; 2]>> {
    let action = "read an array's size";
    let mut dims: [hsize_t; 2] = [0; 2];
    // SAFETY: an open array; as many dimensions are read as there is room for.
    unsafe {
        let space = Id::new(action, H5Dget_space(array.0))?;
        if H5Sget_simple_extent_ndims(space.0) != 2 {
            return Ok(None);
        }
        check(action, H5Sget_simple_extent_dims(space.0, dims.as_mut_ptr(), ptr::null_mut()))?;
    }
    Ok(Some(dims))
}

fn number(array: &Id) -> Result<Option<Number>> {
    // SAFETY: an open array, and types that live as long as the library.
    unsafe {
        let found = Id::new("read an array's type", H5Dget_type(array.0))?;
        Ok(Number::ALL.into_iter().find(|&number| H5Tequal(found.0, kind(number)) > 0))
    }
}

/// What an array's storage has that this library never makes: files beside it, views of other arrays, other filters.
fn strange_storage(array: &Id, rows: u64) -> Result<Option<&'static str>> {
    // SAFETY: an open array and its property list; null where a result is not wanted.
    unsafe {
        let list = Id::new("read an array's storage", H5Dget_create_plist(array.0))?;
        // The number of files makes sense for contiguous storage only; there are none elsewhere.
        if H5Pget_external_count(list.0) > 0 {
            return Ok(Some("lies in other files"));
        }
        let wanted = if rows == 0 { H5D_layout_t::H5D_CONTIGUOUS } else { H5D_layout_t::H5D_CHUNKED };
        if H5Pget_layout(list.0) != wanted {
            return Ok(Some("is stored in another way than ours"));
        }
        if H5Pget_nfilters(list.0) != c_int::from(rows > 0) {
            return Ok(Some("has other filters than a checksum"));
        }
        let (mut flags, mut values, null) = (0, 0, ptr::null_mut());
        if rows > 0
            && H5Pget_filter2(list.0, 0, &raw mut flags, &raw mut values, null, 0, ptr::null_mut(), ptr::null_mut())
                != H5Z_FILTER_FLETCHER32
        {
            return Ok(Some("has another filter than a checksum"));
        }
    }
    Ok(None)
}
