//! PETSc's options database: sets options, and lists options that were not used.

use std::ptr;

use crate::error::{Result, c_string, check, text};
use crate::ffi;
use crate::petsc::{FIXED_OPTIONS, Petsc};

impl Petsc<'_> {
    /// Sets an option, e.g. `("-mat_mumps_icntl_7", Some("5"))`, for the `set_from_options` calls
    /// to come. The name begins with a dash. To be done alike on every rank.
    pub fn set_option(&self, name: &str, value: Option<&str>) -> Result<()> {
        self.note_option(name);
        let name = c_string(name)?;
        let value = value.map(c_string).transpose()?;
        let value = value.as_ref().map_or(ptr::null(), |value| value.as_ptr());
        // SAFETY: PETSc runs; null is the global database; both texts are copied by PETSc.
        check(unsafe { ffi::PetscOptionsSetValue(ptr::null_mut(), name.as_ptr(), value) })
    }

    /// Names, without the dash, of the options that were set and that PETSc has not read so far:
    /// misspelt ones, or ones of a solver that is not in use.
    pub fn unused_options(&self) -> Result<Vec<String>> {
        let mut count = 0;
        let mut names = ptr::null_mut();
        let mut values = ptr::null_mut();
        // SAFETY: PETSc runs; the pointers are valid; the arrays are given back below.
        check(unsafe { ffi::PetscOptionsLeftGet(ptr::null_mut(), &mut count, &mut names, &mut values) })?;
        let left = (0..usize::try_from(count).unwrap_or(0))
            // SAFETY: PETSc filled `count` NUL-terminated names.
            .map(|entry| unsafe { text(*names.add(entry)) })
            .filter(|name| !FIXED_OPTIONS.contains(&format!("-{name}").as_str()))
            .collect();
        // SAFETY: the arrays of the call above, once.
        check(unsafe { ffi::PetscOptionsLeftRestore(ptr::null_mut(), &mut count, &mut names, &mut values) })?;
        Ok(left)
    }
}
