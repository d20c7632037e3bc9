//! Wraps HDF5's C functions in handles that close themselves. All unsafe code of the crate is in this module.

mod array;

use std::ffi::{CStr, CString, c_int, c_uint, c_void};
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::ptr;

use hdf5_sys::h5::{H5_index_t, H5_iter_order_t, H5get_libversion, H5open, hsize_t};
use hdf5_sys::h5d::{H5D_fill_time_t, H5Dcreate2, H5Dopen2};
use hdf5_sys::h5e::{H5E_DEFAULT, H5E_direction_t, H5E_error2_t, H5Eset_auto2, H5Ewalk2};
use hdf5_sys::h5f::{H5F_ACC_RDONLY, H5F_ACC_TRUNC, H5F_scope_t, H5Fclose, H5Fcreate, H5Fflush, H5Fopen};
use hdf5_sys::h5g::{H5G_info_t, H5Gget_info};
use hdf5_sys::h5i::{H5I_type_t, H5Idec_ref, H5Iget_type, hid_t};
use hdf5_sys::h5l::{H5L_info1_t, H5L_type_t, H5Lget_info1, H5Lget_name_by_idx};
use hdf5_sys::h5o::{H5Oclose, H5Oopen};
use hdf5_sys::h5p::{
    H5P_CLS_DATASET_CREATE, H5P_CLS_FILE_ACCESS, H5P_DEFAULT, H5Pcreate, H5Pset_chunk, H5Pset_fapl_mpio,
    H5Pset_fill_time, H5Pset_fletcher32, H5Pset_obj_track_times,
};
use hdf5_sys::h5pl::H5PLset_loading_state;
use hdf5_sys::h5t::{H5T_IEEE_F64LE, H5T_STD_U8LE, H5T_STD_U16LE, H5T_STD_U64LE};
use mpi::raw::AsRaw;
use mpi::topology::SimpleCommunicator;

pub(crate) use array::Array;
use array::{extent, number, space, strange_storage};

use crate::error::{Error, Result};
use crate::shape::{CHUNK, Number, Shape};

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
        // SAFETY: a valid identifier, of which this is the only owner. An error can no longer be reported.
        unsafe { H5Idec_ref(self.0) };
    }
}

/// An open file. It is never closed by itself: closing is collective, and after a failed write it may crash.
pub(crate) struct File(hid_t);

fn check(action: &str, code: c_int) -> Result<()> {
    if code < 0 { Err(failed(action)) } else { Ok(()) }
}

/// HDF5's own words for the last call that failed.
fn failed(action: &str) -> Error {
    Error::Library {
        action: action.to_owned(),
        reason: words(),
    }
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
    if words.is_empty() {
        "it gave no reason".to_owned()
    } else {
        words.join("; ")
    }
}

fn text(text: &str) -> Result<CString> {
    CString::new(text).map_err(|_| Error::foreign(format!("{text:?}"), "holds a zero byte"))
}

fn path(path: &Path) -> Result<CString> {
    CString::new(path.as_os_str().as_bytes()).map_err(|_| Error::foreign(path.display().to_string(), "holds a NUL"))
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
    let mut major = 0;
    let mut minor = 0;
    let mut release = 0;
    // SAFETY: the pointers are valid; the function reads constants only.
    unsafe { H5get_libversion(&raw mut major, &raw mut minor, &raw mut release) };
    (major, minor, release)
}

/// File access by all ranks of a communicator.
fn shared(world: &SimpleCommunicator) -> Result<Id> {
    // SAFETY: the class exists once the library runs; the communicator lives, and HDF5 duplicates it.
    unsafe {
        let access = Id::new("set up the access", H5Pcreate(*H5P_CLS_FILE_ACCESS))?;
        check(
            "set up the access",
            H5Pset_fapl_mpio(access.0, world.as_raw(), mpi::ffi::RSMPI_INFO_NULL),
        )?;
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
        let access = shared(world)?;
        let name = path(file)?;
        // SAFETY: valid text and property list.
        let id = unsafe { H5Fcreate(name.as_ptr(), H5F_ACC_TRUNC, H5P_DEFAULT, access.0) };
        if id < 0 {
            Err(failed("create the file"))
        } else {
            Ok(Self(id))
        }
    }

    pub(crate) fn open(world: &SimpleCommunicator, file: &Path) -> Result<Self> {
        let access = shared(world)?;
        let name = path(file)?;
        // SAFETY: valid text and property list.
        let id = unsafe { H5Fopen(name.as_ptr(), H5F_ACC_RDONLY, access.0) };
        if id < 0 {
            Err(failed("open the file"))
        } else {
            Ok(Self(id))
        }
    }

    /// Closes the file; its arrays must be closed.
    pub(crate) fn close(self) -> Result<()> {
        // SAFETY: open. Every rank's part goes to the disk, not only what the first one's system holds.
        check("write the file", unsafe {
            H5Fflush(self.0, H5F_scope_t::H5F_SCOPE_GLOBAL)
        })?;
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
            let id = H5Dcreate2(
                self.0,
                name.as_ptr(),
                kind(shape.number),
                space.0,
                H5P_DEFAULT,
                layout.0,
                H5P_DEFAULT,
            );
            Ok(Array {
                id: Id::new(action, id)?,
                number: shape.number,
            })
        }
    }

    /// Names of everything in the root group, if all of it is linked in the plain way.
    pub(crate) fn names(&self) -> Result<Vec<String>> {
        let mut group = H5G_info_t::default();
        // SAFETY: an open file; the pointer is valid.
        check("read the file's contents", unsafe {
            H5Gget_info(self.0, &raw mut group)
        })?;
        (0..group.nlinks).map(|index| self.name(index)).collect()
    }

    fn name(&self, index: u64) -> Result<String> {
        let action = "read a name";
        let root = c".";
        let mut name = [0_u8; NAME];
        let mut link = H5L_info1_t::default();
        // SAFETY: an open file, valid texts, and a buffer of the length that is given.
        let length = unsafe {
            let by = H5_index_t::H5_INDEX_NAME;
            let order = H5_iter_order_t::H5_ITER_INC;
            H5Lget_name_by_idx(
                self.0,
                root.as_ptr(),
                by,
                order,
                index,
                name.as_mut_ptr().cast(),
                NAME,
                H5P_DEFAULT,
            )
        };
        check(action, if length < 0 { -1 } else { 0 })?;
        let name = CStr::from_bytes_until_nul(&name)
            .ok()
            .and_then(|name| name.to_str().ok());
        let name = name.filter(|name| isize::try_from(name.len()) == Ok(length as isize) && !name.is_empty());
        let name = name
            .ok_or_else(|| Error::foreign("a name in the file", "is none of ours"))?
            .to_owned();
        // SAFETY: an open file, a valid text and pointer.
        check(action, unsafe {
            H5Lget_info1(self.0, text(&name)?.as_ptr(), &raw mut link, H5P_DEFAULT)
        })?;
        if link.type_ == H5L_type_t::H5L_TYPE_HARD {
            Ok(name)
        } else {
            Err(Error::foreign(name, "is linked, not there"))
        }
    }

    /// An array of the file and its shape, if it is one that this library could have written.
    pub(crate) fn array(&self, name: &str) -> Result<(Array, Shape)> {
        let label = text(name)?;
        // SAFETY: an open file and a valid text; opening the object before the array distinguishes a group or type.
        let id = unsafe {
            let object = H5Oopen(self.0, label.as_ptr(), H5P_DEFAULT);
            check("open an object", if object < 0 { -1 } else { 0 })?;
            let is_array = H5Iget_type(object) == H5I_type_t::H5I_DATASET;
            H5Oclose(object);
            if !is_array {
                return Err(Error::foreign_array(name, "is no array"));
            }
            Id::new("open an array", H5Dopen2(self.0, label.as_ptr(), H5P_DEFAULT))?
        };
        let [rows, width] = extent(&id)?.ok_or_else(|| Error::foreign_array(name, "has not two dimensions"))?;
        let number = number(&id)?.ok_or_else(|| Error::foreign_array(name, "holds other numbers than ours"))?;
        if let Some(reason) = strange_storage(&id, rows)? {
            return Err(Error::foreign_array(name, reason));
        }
        Ok((Array { id, number }, Shape { number, rows, width }))
    }
}
