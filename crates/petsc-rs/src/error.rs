//! Errors of PETSc, which a silent error handler returns as Rust values, and errors of this crate's checks of lengths,
//! ranges and integer conversions.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_int, c_void};

use crate::ffi;

/// What every fallible call of this crate returns.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a call failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// PETSc returned an error code; the trace runs from the place of the error outwards.
    #[error("PETSc error {code}: {message} (in {})", trace.join(" < "))]
    Petsc {
        /// PETSC_ERR_*
        code: i64,
        /// the text of the place where it arose
        message: String,
        /// `function (file:line)`, innermost first
        trace: Vec<String>,
    },
    /// A linear solve did not converge, or its preconditioner or factor failed.
    #[error("the linear solve failed after {iterations} iterations: {name} ({reason})")]
    Diverged {
        /// KSPConvergedReason, <= 0
        reason: i32,
        /// its name, and that of the factor's failure if there is one
        name: String,
        /// iterations done
        iterations: usize,
    },
    /// A number does not fit PETSc's integer.
    #[error(
        "{what} = {value} does not fit the {}-bit indices of this PETSc",
        crate::petsc_int_bits()
    )]
    TooLarge {
        /// the quantity
        what: &'static str,
        /// its value
        value: usize,
    },
    /// A slice or a vector has the wrong length.
    #[error("{what} has length {got} where {expected} is needed")]
    Length {
        /// the argument
        what: &'static str,
        /// its length
        got: usize,
        /// the length needed
        expected: usize,
    },
    /// An index lies outside its range.
    #[error("{what}[{entry}] = {index} is outside 0..{bound}")]
    OutOfRange {
        /// the argument
        what: &'static str,
        /// the position in it
        entry: usize,
        /// the value there
        index: usize,
        /// one more than the largest allowed
        bound: usize,
    },
    /// The rows of a CSR pattern are not as they must be.
    #[error("local row {row} of the CSR pattern: {why}")]
    Pattern {
        /// local row, from 0
        row: usize,
        /// what is wrong there
        why: &'static str,
    },
    /// PETSc would ignore the request, or cannot be asked it in this state.
    #[error("not possible here: {0}")]
    Unsupported(&'static str),
    /// A text for PETSc contains a NUL byte.
    #[error("{0:?} contains a NUL byte")]
    Nul(String),
    /// This rank's part was good, that of another rank was not.
    #[error("another rank failed in the same call")]
    OtherRank,
}

#[derive(Default)]
struct Caught {
    message: String,
    trace: Vec<String>,
}

thread_local! {
    static CAUGHT: RefCell<Caught> = RefCell::default();
}

/// PETSc's error handler: keeps message and trace for [`check`], prints nothing, returns the code.
///
/// # Safety
/// `func`, `file` and `message` are null or NUL-terminated, as PETSc passes them.
pub(crate) unsafe extern "C" fn keep_error(
    _comm: mpi::ffi::MPI_Comm,
    line: c_int,
    func: *const c_char,
    file: *const c_char,
    code: ffi::PetscErrorCode,
    kind: ffi::PetscErrorType,
    message: *const c_char,
    _context: *mut c_void,
) -> ffi::PetscErrorCode {
    // SAFETY: PETSc passes null or NUL-terminated texts that live during this call.
    let (func, file, message) = unsafe { (text(func), text(file), text(message)) };
    // Fails only while the thread ends: the code alone is reported then.
    let _ = CAUGHT.try_with(|caught| {
        let Ok(mut caught) = caught.try_borrow_mut() else {
            return;
        };
        if kind == ffi::PETSC_ERROR_INITIAL {
            *caught = Caught {
                message: message.trim().to_owned(),
                trace: Vec::new(),
            };
        }
        caught.trace.push(format!("{func} ({file}:{line})"));
    });
    code
}

/// The text at `pointer`, empty when null.
///
/// # Safety
/// `pointer` is null or a NUL-terminated text.
pub(crate) unsafe fn text(pointer: *const c_char) -> String {
    if pointer.is_null() {
        return String::new();
    }
    // SAFETY: not null, so NUL-terminated by the contract.
    unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
}

/// Turns a PETSc error code, `int` up to 3.18 and an enum later, into a `Result`.
pub(crate) fn check(code: impl Into<i64>) -> Result<()> {
    let code = code.into();
    if code == 0 {
        return Ok(());
    }
    let Caught { message, trace } = CAUGHT.take();
    Err(Error::Petsc { code, message, trace })
}

/// `value` as PETSc's integer, never wrapped.
pub(crate) fn int(what: &'static str, value: usize) -> Result<ffi::PetscInt> {
    ffi::PetscInt::try_from(value).map_err(|_| Error::TooLarge { what, value })
}

/// Indices as PETSc's integers, each below `bound`.
pub(crate) fn indices(what: &'static str, values: &[usize], bound: usize) -> Result<Vec<ffi::PetscInt>> {
    let mut converted = Vec::with_capacity(values.len());
    for (entry, &index) in values.iter().enumerate() {
        if index >= bound {
            return Err(Error::OutOfRange {
                what,
                entry,
                index,
                bound,
            });
        }
        converted.push(int(what, index)?);
    }
    Ok(converted)
}

/// Refuses a length other than the expected one.
pub(crate) fn same_length(what: &'static str, got: usize, expected: usize) -> Result<()> {
    if got == expected {
        Ok(())
    } else {
        Err(Error::Length { what, got, expected })
    }
}

/// `value` as a C string.
pub(crate) fn c_string(value: &str) -> Result<CString> {
    CString::new(value).map_err(|_| Error::Nul(value.to_owned()))
}
