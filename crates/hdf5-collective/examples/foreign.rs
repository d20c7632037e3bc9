//! Changes the HDF5 file of a checkpoint into one that this project never writes. Tests use it to verify that invalid
//! files are rejected.
//!
//! - `foreign KIND FILE ARRAY` replaces an array of the file by one of the given kind, see [`forge`].
//! - `foreign set FILE ARRAY AT BITS` sets the number at position AT to 64 bits in hexadecimal (16 bits for arrays of
//!   16-bit numbers).

use hdf5_sys::h5::hsize_t;
use hdf5_sys::h5d::{H5D_layout_t, H5Dclose, H5Dcreate2, H5Dget_space, H5Dopen2, H5Dread, H5Dwrite};
use hdf5_sys::h5f::{H5F_ACC_RDWR, H5F_UNLIMITED, H5Fclose, H5Fopen};
use hdf5_sys::h5g::{H5Gclose, H5Gcreate2};
use hdf5_sys::h5i::hid_t;
use hdf5_sys::h5l::{H5Lcreate_external, H5Lcreate_hard, H5Lcreate_soft, H5Ldelete};
use hdf5_sys::h5p::{
    H5P_CLS_DATASET_CREATE, H5P_DEFAULT, H5Pcreate, H5Pset_chunk, H5Pset_deflate, H5Pset_external, H5Pset_fletcher32,
    H5Pset_layout, H5Pset_virtual,
};
use hdf5_sys::h5s::{H5Screate_simple, H5Sget_simple_extent_npoints};
use hdf5_sys::h5t::{H5T_IEEE_F32LE, H5T_IEEE_F64BE, H5T_IEEE_F64LE, H5T_STD_U16LE, H5T_STD_U64LE};
use std::ffi::CString;
use std::ptr;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let text = |text: &str| CString::new(text).expect("no zero byte");
    let kind = &*arguments[0];
    let file = text(&arguments[1]);
    let array = text(&arguments[2]);
    // SAFETY: a valid text; the library starts itself.
    let id = unsafe { H5Fopen(file.as_ptr(), H5F_ACC_RDWR, H5P_DEFAULT) };
    assert!(id >= 0, "the file can be opened");
    if kind == "set" {
        let bits = u64::from_str_radix(&arguments[4], 16).expect("bits");
        set(id, &array, arguments[3].parse().expect("a number"), bits);
    } else {
        forge(id, &array, kind);
    }
    // SAFETY: open, and not used any more.
    assert!(unsafe { H5Fclose(id) } >= 0, "the file can be closed");
}

/// Changes one number of an array.
fn set(file: hid_t, name: &CString, at: usize, bits: u64) {
    // SAFETY: an open file, valid texts, and buffers with room for all numbers of the array.
    unsafe {
        let array = H5Dopen2(file, name.as_ptr(), H5P_DEFAULT);
        let count = H5Sget_simple_extent_npoints(H5Dget_space(array)) as usize;
        assert!(array >= 0 && at < count, "the array has that number");
        if name.as_bytes() == b"material" {
            let mut numbers = vec![0_u16; count];
            assert!(H5Dread(array, *H5T_STD_U16LE, 0, 0, H5P_DEFAULT, numbers.as_mut_ptr().cast()) >= 0);
            numbers[at] = bits as u16;
            assert!(H5Dwrite(array, *H5T_STD_U16LE, 0, 0, H5P_DEFAULT, numbers.as_ptr().cast()) >= 0);
        } else {
            // Numbers of a kind that both sides share are copied bit by bit.
            let kind = if name.as_bytes() == b"id" {
                *H5T_STD_U64LE
            } else {
                *H5T_IEEE_F64LE
            };
            let mut numbers = vec![0_u64; count];
            assert!(H5Dread(array, kind, 0, 0, H5P_DEFAULT, numbers.as_mut_ptr().cast()) >= 0);
            numbers[at] = bits;
            assert!(H5Dwrite(array, kind, 0, 0, H5P_DEFAULT, numbers.as_ptr().cast()) >= 0);
        }
        H5Dclose(array);
    }
}

/// Replaces an array.
fn forge(file: hid_t, name: &CString, kind: &str) {
    // SAFETY: an open file and valid texts.
    unsafe {
        if kind != "stranger" {
            assert!(
                H5Ldelete(file, name.as_ptr(), H5P_DEFAULT) >= 0,
                "the array can be removed"
            );
        }
        let done = match kind {
            "missing" => 0,
            "group" => H5Gclose(H5Gcreate2(file, name.as_ptr(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)),
            "external-link" => H5Lcreate_external(
                c"/etc/passwd".as_ptr(),
                c"/x".as_ptr(),
                file,
                name.as_ptr(),
                H5P_DEFAULT,
                0,
            ),
            "soft-link" => H5Lcreate_soft(c"/u".as_ptr(), file, name.as_ptr(), H5P_DEFAULT, H5P_DEFAULT),
            "cycle" => H5Lcreate_soft(name.as_ptr(), file, name.as_ptr(), H5P_DEFAULT, H5P_DEFAULT),
            "group-cycle" => H5Lcreate_hard(file, c"/".as_ptr(), file, name.as_ptr(), H5P_DEFAULT, H5P_DEFAULT),
            "stranger" => array(file, &CString::new("stranger").unwrap_or_default(), "plain"),
            _ => array(file, name, kind),
        };
        assert!(done >= 0, "{kind} can be made");
    }
}

/// A new array that is strange in some way.
unsafe fn array(file: hid_t, name: &CString, kind: &str) -> i32 {
    let rows: hsize_t = match kind {
        "huge" => 1 << 40,
        "empty" => 0,
        _ => 64,
    };
    let dims: [hsize_t; 3] = [rows, 2, 2];
    let chunk: [hsize_t; 3] = [64, 2, 2];
    let dimensions = match kind {
        "one-dimension" => 1,
        "three-dimensions" => 3,
        _ => 2,
    };
    // SAFETY: an open file, valid texts, and arrays with as many numbers as there are dimensions.
    unsafe {
        let number = match kind {
            "single" => *H5T_IEEE_F32LE,
            "big-endian" => *H5T_IEEE_F64BE,
            _ => *H5T_IEEE_F64LE,
        };
        let space = H5Screate_simple(dimensions, dims.as_ptr(), ptr::null());
        let list = H5Pcreate(*H5P_CLS_DATASET_CREATE);
        let set = match kind {
            "external-storage" => H5Pset_external(list, c"/etc/passwd".as_ptr(), 0, H5F_UNLIMITED),
            "virtual" => H5Pset_virtual(list, space, c".".as_ptr(), c"/u".as_ptr(), space),
            "compact" => H5Pset_layout(list, H5D_layout_t::H5D_COMPACT),
            "plain" | "empty" => 0,
            "deflate" => H5Pset_chunk(list, dimensions, chunk.as_ptr()).min(H5Pset_deflate(list, 6)),
            "no-checksum" => H5Pset_chunk(list, dimensions, chunk.as_ptr()),
            _ => H5Pset_chunk(list, dimensions, chunk.as_ptr()).min(H5Pset_fletcher32(list)),
        };
        assert!(set >= 0, "{kind} can be asked for");
        let made = H5Dcreate2(file, name.as_ptr(), number, space, H5P_DEFAULT, list, H5P_DEFAULT);
        if made < 0 { made as i32 } else { H5Dclose(made) }
    }
}
