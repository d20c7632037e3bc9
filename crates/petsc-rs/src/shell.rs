//! Callbacks from PETSc: the product of a shell matrix, and a user-defined preconditioner.
//!
//! A callback is registered for the duration of one PETSc call. A panic in it must not pass through C code: PETSc
//! receives an error code, and the panic resumes after the call returns.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::marker::PhantomData;
use std::os::raw::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::ptr::{self, NonNull};
use std::{mem, slice};

use crate::error::{Result, check, int};
use crate::ffi;
use crate::petsc::Petsc;

/// y = A x on this rank's part, called equally often on all ranks.
pub type Product<'f> = dyn FnMut(&[f64], &mut [f64]) + 'f;

/// A preconditioner of the caller's own, of [`Ksp::set_pc_shell`](crate::Ksp::set_pc_shell).
pub trait ShellPc {
    /// Builds it for the present operator. Called by every rank.
    fn set_up(&mut self) -> std::result::Result<(), PcFailure>;
    /// z = B r on this rank's part, with B about the inverse of the operator. Called by every rank.
    fn apply(&mut self, r: &[f64], z: &mut [f64]) -> std::result::Result<(), PcFailure>;
}

/// Why a preconditioner cannot be used, as PCFailedReason has it: KSP then ends with DIVERGED_PC_FAILED.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PcFailure {
    /// a pivot is zero, or of the wrong sign
    ZeroPivot,
    /// anything else
    Other,
}

/// The place at which PETSc's callbacks find what was lent to them.
pub(crate) struct Slot<T: ?Sized> {
    lent: Cell<Option<NonNull<T>>>,
    rows: Cell<usize>,
    panic: RefCell<Option<Box<dyn Any + Send>>>,
}

/// Ends a loan.
struct Loan<'s, T: ?Sized>(&'s Slot<T>);

impl<T: ?Sized> Drop for Loan<'_, T> {
    fn drop(&mut self) {
        self.0.lent.set(None);
    }
}

impl<T: ?Sized> Slot<T> {
    /// A place for what works on vectors of which this rank has `rows` entries.
    pub fn new(rows: usize) -> Box<Self> {
        Box::new(Self {
            lent: Cell::new(None),
            rows: Cell::new(rows),
            panic: RefCell::new(None),
        })
    }

    /// Vectors have so many entries here from now on.
    pub fn set_rows(&self, rows: usize) {
        self.rows.set(rows);
    }

    /// Makes `call` with `callback` in this place; a panic of the callback goes on after it.
    fn lend<R>(&self, callback: NonNull<T>, call: impl FnOnce() -> R) -> R {
        self.lent.set(Some(callback));
        let loan = Loan(self);
        let result = call();
        drop(loan);
        if let Some(panic) = self.panic.take() {
            resume_unwind(panic);
        }
        result
    }

    /// What `work` makes of the callback; an error code without one, and where it panicked.
    fn with(&self, work: impl FnOnce(&mut T) -> ffi::PetscErrorCode) -> ffi::PetscErrorCode {
        let Some(mut callback) = self.lent.take() else {
            return FAILED;
        };
        // SAFETY: `lend` was given an exclusive borrow that outlives the call of PETSc that led here; while it is used
        // the place is empty, so that nothing else reaches it.
        let outcome = catch_unwind(AssertUnwindSafe(|| work(unsafe { callback.as_mut() })));
        self.lent.set(Some(callback));
        outcome.unwrap_or_else(|panic| {
            self.panic.replace(Some(panic));
            FAILED
        })
    }
}

/// What PETSc receives of a callback that is not there or panicked.
const FAILED: ffi::PetscErrorCode = ffi::PETSC_ERR_USER as ffi::PetscErrorCode;

impl Slot<Product<'static>> {
    /// Makes `call`, in which PETSc multiplies by `product`.
    pub fn lend_product<R>(&self, product: &mut Product<'_>, call: impl FnOnce() -> R) -> R {
        // SAFETY: only the lifetime is changed; `lend` forgets the pointer before the borrow ends.
        let product = unsafe { mem::transmute::<NonNull<Product<'_>>, NonNull<Product<'static>>>(product.into()) };
        self.lend(product, call)
    }
}

impl Slot<dyn ShellPc> {
    /// Makes `call`, in which PETSc preconditions by `pc`.
    pub fn lend_pc<R>(&self, pc: &mut dyn ShellPc, call: impl FnOnce() -> R) -> R {
        // SAFETY: only the lifetime is changed; `lend` forgets the pointer before the borrow ends.
        let pc = unsafe { mem::transmute::<NonNull<dyn ShellPc + '_>, NonNull<dyn ShellPc>>(pc.into()) };
        self.lend(pc, call)
    }
}

/// A square matrix that is known by its product only.
pub(crate) struct Shell<'p> {
    raw: ffi::Mat,
    slot: *mut Slot<Product<'static>>,
    _petsc: PhantomData<&'p ()>,
}

impl<'p> Shell<'p> {
    /// A matrix of which this rank has `rows` rows. Collective.
    pub fn new(petsc: &'p Petsc, rows: usize) -> Result<Self> {
        let local = int("matrix rows", rows)?;
        let global = int("matrix rows", petsc.total("matrix rows", rows)?)?;
        let mut shell = Self {
            raw: ptr::null_mut(),
            slot: Box::into_raw(Slot::new(rows)),
            _petsc: PhantomData,
        };
        let place = shell.slot.cast::<c_void>();
        // SAFETY: PETSc runs; the slot outlives the matrix, and only `multiply` reads it.
        check(unsafe { ffi::MatCreateShell(petsc.comm(), local, local, global, global, place, &mut shell.raw) })?;
        // SAFETY: PETSc wants the callback as a function without arguments, and calls it as `multiply` is declared.
        let callback = unsafe { mem::transmute::<Multiply, unsafe extern "C" fn()>(multiply) };
        // SAFETY: the handle is valid; the callback lives for ever.
        check(unsafe { ffi::MatShellSetOperation(shell.raw, ffi::MATOP_MULT, Some(callback)) })?;
        Ok(shell)
    }

    pub fn raw(&self) -> ffi::Mat {
        self.raw
    }

    pub fn slot(&self) -> &Slot<Product<'static>> {
        // SAFETY: made by `Box::into_raw` above, freed by the drop only; nothing borrows it exclusively.
        unsafe { &*self.slot }
    }

    /// Informs PETSc that products differ from now on, so that what was built from the matrix is built again.
    /// Collective.
    pub fn changed(&self) -> Result<()> {
        // SAFETY: the handle is valid; the two calls belong together, and count the matrix's states.
        check(unsafe { ffi::MatAssemblyBegin(self.raw, ffi::MAT_FINAL_ASSEMBLY) })?;
        // SAFETY: as above.
        check(unsafe { ffi::MatAssemblyEnd(self.raw, ffi::MAT_FINAL_ASSEMBLY) })
    }
}

impl Drop for Shell<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle is valid or null; a solver that knew the matrix is gone, or has another one.
        let _ = check(unsafe { ffi::MatDestroy(&mut self.raw) });
        // SAFETY: made by `Box::into_raw` above; the matrix that knew it is gone.
        drop(unsafe { Box::from_raw(self.slot) });
    }
}

type Multiply = unsafe extern "C" fn(ffi::Mat, ffi::Vec, ffi::Vec) -> ffi::PetscErrorCode;

/// MATOP_MULT: y = A x by the product that was lent.
///
/// # Safety
/// `shell` was made by [`Shell::new`] and still lives; `x` and `y` are distinct vectors of its layout.
unsafe extern "C" fn multiply(shell: ffi::Mat, x: ffi::Vec, y: ffi::Vec) -> ffi::PetscErrorCode {
    let mut place = ptr::null_mut::<c_void>();
    // SAFETY: the handle and the pointer are valid; the context is the slot of `Shell::new`.
    let code = unsafe { ffi::MatShellGetContext(shell, (&raw mut place).cast()) };
    if code != 0 {
        return code;
    }
    // SAFETY: a slot by the contract, which is only shared.
    let slot = unsafe { &*place.cast::<Slot<Product<'static>>>() };
    slot.with(|product| {
        // SAFETY: distinct vectors of the slot's layout by the contract.
        unsafe {
            on_arrays(slot.rows.get(), x, y, |x, y| {
                product(x, y);
                0
            })
        }
    })
}

/// PCSETUP of a shell preconditioner: builds the one that was lent.
///
/// # Safety
/// `pc` has a slot as its context, which still lives.
pub(crate) unsafe extern "C" fn pc_set_up(pc: ffi::PC) -> ffi::PetscErrorCode {
    // SAFETY: the contract's.
    let slot = match unsafe { pc_slot(pc) } {
        Ok(slot) => slot,
        Err(code) => return code,
    };
    slot.with(|shell| fail(pc, shell.set_up().err()))
}

/// PCAPPLY of a shell preconditioner: y = B x by the one that was lent.
///
/// # Safety
/// `pc` has a slot as its context, which still lives; `x` and `y` are distinct vectors of its layout.
pub(crate) unsafe extern "C" fn pc_apply(pc: ffi::PC, x: ffi::Vec, y: ffi::Vec) -> ffi::PetscErrorCode {
    // SAFETY: the contract's.
    let slot = match unsafe { pc_slot(pc) } {
        Ok(slot) => slot,
        Err(code) => return code,
    };
    // SAFETY: distinct vectors of the slot's layout by the contract.
    slot.with(|shell| unsafe { on_arrays(slot.rows.get(), x, y, |x, y| apply(pc, shell, x, y)) })
}

/// Sets y = B x by the preconditioner that was lent; `pc` is failed with it.
fn apply(pc: ffi::PC, shell: &mut dyn ShellPc, x: &[f64], y: &mut [f64]) -> ffi::PetscErrorCode {
    match shell.apply(x, y) {
        Ok(()) => 0,
        Err(failure) => {
            // Norms and products of it tell the other ranks, too.
            y.fill(f64::INFINITY);
            fail(pc, Some(failure))
        }
    }
}

/// The slot that a shell preconditioner has as its context.
///
/// # Safety
/// It has one, which still lives.
unsafe fn pc_slot<'s>(pc: ffi::PC) -> std::result::Result<&'s Slot<dyn ShellPc>, ffi::PetscErrorCode> {
    let mut place = ptr::null_mut::<c_void>();
    // SAFETY: the handle and the pointer are valid.
    let code = unsafe { ffi::PCShellGetContext(pc, (&raw mut place).cast()) };
    if code == 0 {
        // SAFETY: a slot by the contract, which is only shared.
        Ok(unsafe { &*place.cast::<Slot<dyn ShellPc>>() })
    } else {
        Err(code)
    }
}

/// Notes in the preconditioner whether it has failed; KSP looks there.
fn fail(pc: ffi::PC, failure: Option<PcFailure>) -> ffi::PetscErrorCode {
    let reason = match failure {
        None => ffi::PC_NOERROR,
        Some(PcFailure::ZeroPivot) => ffi::PC_FACTOR_NUMERIC_ZEROPIVOT,
        Some(PcFailure::Other) => ffi::PC_FACTOR_OTHER,
    };
    // SAFETY: PETSc handed the handle to the callback that calls this.
    unsafe { ffi::PCSetFailedReason(pc, reason) }
}

/// Gives the arrays of this rank to `work`, of two vectors with `rows` entries here.
///
/// # Safety
/// `x` and `y` are distinct valid vectors with so many entries on this rank.
unsafe fn on_arrays(
    rows: usize,
    x: ffi::Vec,
    y: ffi::Vec,
    work: impl FnOnce(&[f64], &mut [f64]) -> ffi::PetscErrorCode,
) -> ffi::PetscErrorCode {
    let mut from = ptr::null();
    let mut to = ptr::null_mut();
    // SAFETY: valid handles and pointers by the contract; the array is given back below.
    let code = unsafe { ffi::VecGetArrayRead(x, &mut from) };
    if code != 0 {
        return code;
    }
    // SAFETY: as above.
    let code = unsafe { ffi::VecGetArray(y, &mut to) };
    if code != 0 {
        return code;
    }
    let done = match rows {
        0 => work(&[], &mut []),
        // SAFETY: PETSc's arrays hold `rows` entries each and do not overlap, as the vectors are distinct.
        rows => work(unsafe { slice::from_raw_parts(from, rows) }, unsafe {
            slice::from_raw_parts_mut(to, rows)
        }),
    };
    // SAFETY: the arrays of the calls above, once each.
    let codes = unsafe {
        [
            done,
            ffi::VecRestoreArrayRead(x, &mut from),
            ffi::VecRestoreArray(y, &mut to),
        ]
    };
    codes.into_iter().find(|code| *code != 0).unwrap_or(0)
}
