//! A matrix that is known by its product only, for the time of one solve.

use std::marker::PhantomData;
use std::os::raw::c_void;
use std::{ptr, slice};

use crate::error::{Result, check, int};
use crate::ffi;
use crate::petsc::Petsc;

/// What PETSc hands back to the callback.
struct Context<'f> {
    apply: &'f mut dyn FnMut(&[f64], &mut [f64]),
    rows: usize,
}

/// A shell matrix around a closure; PETSc must not use it after its end.
pub(crate) struct Shell<'f> {
    raw: ffi::Mat,
    context: *mut Context<'f>,
    _borrow: PhantomData<&'f mut ()>,
}

impl<'f> Shell<'f> {
    /// A square matrix of which this rank has `rows` rows, and whose product is `apply(x, y)`: y = A x. Collective.
    pub fn new(petsc: &Petsc, rows: usize, apply: &'f mut dyn FnMut(&[f64], &mut [f64])) -> Result<Self> {
        let (local, global) = (int("matrix rows", rows)?, int("matrix rows", petsc.total("matrix rows", rows)?)?);
        let context = Box::into_raw(Box::new(Context { apply, rows }));
        let mut shell = Self { raw: ptr::null_mut(), context, _borrow: PhantomData };
        let place = context.cast::<c_void>();
        // SAFETY: PETSc runs; the context outlives the matrix, which only `multiply` reads it through.
        check(unsafe { ffi::MatCreateShell(petsc.comm(), local, local, global, global, place, &mut shell.raw) })?;
        // SAFETY: PETSc wants the callback as a function without arguments, and calls it as `multiply` is declared.
        let callback = unsafe { std::mem::transmute::<Multiply, unsafe extern "C" fn()>(multiply) };
        // SAFETY: the handle is valid; the callback lives for ever.
        check(unsafe { ffi::MatShellSetOperation(shell.raw, ffi::MATOP_MULT, Some(callback)) })?;
        Ok(shell)
    }

    pub fn raw(&self) -> ffi::Mat {
        self.raw
    }
}

impl Drop for Shell<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle is valid or null; the solver has been given its other matrix again.
        let _ = check(unsafe { ffi::MatDestroy(&mut self.raw) });
        // SAFETY: made by `Box::into_raw` above; the matrix that knew it is gone.
        drop(unsafe { Box::from_raw(self.context) });
    }
}

type Multiply = unsafe extern "C" fn(ffi::Mat, ffi::Vec, ffi::Vec) -> ffi::PetscErrorCode;

/// MATOP_MULT: y = A x through the context's closure.
///
/// # Safety
/// `shell` was made by [`Shell::new`] and still lives; `x` and `y` are distinct vectors of its layout.
unsafe extern "C" fn multiply(shell: ffi::Mat, x: ffi::Vec, y: ffi::Vec) -> ffi::PetscErrorCode {
    let (mut place, mut from, mut to) = (ptr::null_mut::<c_void>(), ptr::null(), ptr::null_mut());
    // SAFETY: valid handles and pointers by the contract; the arrays are given back below.
    unsafe {
        let code = ffi::MatShellGetContext(shell, (&raw mut place).cast());
        if code != 0 {
            return code;
        }
        let code = ffi::VecGetArrayRead(x, &mut from);
        if code != 0 {
            return code;
        }
        let code = ffi::VecGetArray(y, &mut to);
        if code != 0 {
            return code;
        }
        let context = &mut *place.cast::<Context<'_>>();
        match context.rows {
            0 => (context.apply)(&[], &mut []),
            rows => (context.apply)(slice::from_raw_parts(from, rows), slice::from_raw_parts_mut(to, rows)),
        }
        let code = ffi::VecRestoreArrayRead(x, &mut from);
        if code != 0 {
            return code;
        }
        ffi::VecRestoreArray(y, &mut to)
    }
}
