//! Starts PETSc after MPI, ends it before MPI, and lets all ranks agree on errors.

use std::cell::Cell;
use std::ffi::{CString, c_char, c_int};
use std::marker::PhantomData;
use std::ptr;
use std::sync::Once;

use mpi::collective::{CommunicatorCollectives, SystemOperation};
use mpi::environment::Universe;
use mpi::raw::AsRaw;
use mpi::topology::Communicator;

use crate::error::{Error, Result, c_string, check, keep_error};
use crate::ffi;

/// Put behind the caller's options: no `.petscrc`, no signal handlers, no report at the end.
pub(crate) const FIXED_OPTIONS: [&str; 4] = ["-skip_petscrc", "-no_signal_handler", "-options_left", "false"];

/// Environment variables from which PETSc would take options.
const OPTION_VARIABLES: [&str; 2] = ["PETSC_OPTIONS", "PETSC_OPTIONS_YAML"];

/// The running PETSc on all ranks of the universe: borrows MPI, so that it ends before
/// MPI_Finalize; the objects borrow it, so that they end before PetscFinalize.
pub struct Petsc<'u> {
    universe: &'u Universe,
    /// PETSc keeps pointers to both until it is finalised.
    _arguments: (Vec<CString>, Vec<*mut c_char>),
    /// an option asks for viewers of solvers
    views: Cell<bool>,
    _one_thread: PhantomData<*mut ()>,
}

impl<'u> Petsc<'u> {
    /// Starts PETSc with `options`, e.g. `["-ksp_type", "cg"]`, and with no others: `.petscrc` files
    /// are not read, and `PETSC_OPTIONS` and `PETSC_OPTIONS_YAML` are removed from the environment.
    /// Collective. To be called while no other thread reads the environment.
    ///
    /// Every option is passed on, also those that write files (`-log_view :path`) or attach a
    /// debugger: filtering them is the caller's part.
    pub fn initialize(universe: &'u Universe, options: &[&str]) -> Result<Self> {
        static SILENCE: Once = Once::new();
        let mut running = ffi::PetscBool::from(false);
        // SAFETY: may be called at any time; the pointer is valid.
        check(unsafe { ffi::PetscInitialized(&mut running) })?;
        if running != ffi::PetscBool::from(false) {
            return Err(Error::Unsupported("PETSc is running already"));
        }
        let texts = std::iter::once("petsc-rs")
            .chain(options.iter().copied())
            .chain(FIXED_OPTIONS)
            .map(c_string)
            .collect::<Result<Vec<_>>>()?;
        let mut pointers: Vec<_> = texts.iter().map(|text| text.as_ptr().cast_mut()).collect();
        let mut count = c_int::try_from(pointers.len()).map_err(|_| Error::TooLarge {
            what: "number of options",
            value: pointers.len(),
        })?;
        pointers.push(ptr::null_mut());

        for name in OPTION_VARIABLES {
            if std::env::var_os(name).is_some() {
                // SAFETY: std's lock guards against Rust threads; the doc above excludes others.
                unsafe { std::env::remove_var(name) };
            }
        }
        let mut silenced = Ok(());
        SILENCE.call_once(|| {
            let no_context = ptr::null_mut();
            // SAFETY: the handler has PETSc's signature, needs no context and lives for ever.
            silenced = check(unsafe { ffi::PetscPushErrorHandler(Some(keep_error), no_context) });
        });
        silenced?;
        let mut argv = pointers.as_mut_ptr();
        // SAFETY: MPI runs (the universe lives); the communicator is set before the start, as
        // PETSc's manual asks; argc and argv describe texts kept until the drop.
        check(unsafe {
            ffi::PETSC_COMM_WORLD = universe.world().as_raw();
            ffi::PetscInitialize(&mut count, &mut argv, ptr::null(), ptr::null())
        })?;
        let views = Cell::new(options.iter().any(|option| is_view(option)));
        Ok(Self {
            universe,
            _arguments: (texts, pointers),
            views,
            _one_thread: PhantomData,
        })
    }

    /// Takes note of an option that was set.
    pub(crate) fn note_option(&self, name: &str) {
        self.views.set(self.views.get() || is_view(name));
    }

    /// Whether an option asks for viewers of solvers.
    pub(crate) fn views(&self) -> bool {
        self.views.get()
    }

    /// Number of ranks.
    pub fn ranks(&self) -> usize {
        self.universe.world().size().unsigned_abs() as usize
    }

    /// Number of this rank, from 0.
    pub fn rank(&self) -> usize {
        self.universe.world().rank().unsigned_abs() as usize
    }

    pub(crate) fn comm(&self) -> mpi::ffi::MPI_Comm {
        self.universe.world().as_raw()
    }

    /// The largest number of all ranks. Collective.
    pub(crate) fn most(&self, mine: i32) -> i32 {
        let mut most = mine;
        self.universe
            .world()
            .all_reduce_into(&mine, &mut most, SystemOperation::max());
        most
    }

    /// The outcome of this rank, or `OtherRank` where only others failed. Collective.
    pub(crate) fn agree<T>(&self, mine: Result<T>) -> Result<T> {
        match (self.most(i32::from(mine.is_err())) > 0, mine) {
            (true, Ok(_)) => Err(Error::OtherRank),
            (_, mine) => mine,
        }
    }

    /// The sum of `local` over the ranks, refused when PETSc's integer cannot hold it. Collective.
    pub(crate) fn total(&self, what: &'static str, local: usize) -> Result<usize> {
        let mine = local as u64;
        let mut sum = 0_u64;
        let world = self.universe.world();
        world.all_reduce_into(&mine, &mut sum, SystemOperation::sum());
        let value = usize::try_from(sum).unwrap_or(usize::MAX);
        crate::error::int(what, value).map(|_| value)
    }
}

impl Drop for Petsc<'_> {
    fn drop(&mut self) {
        // SAFETY: started by `initialize`; every object borrowed `self`, so all are destroyed, and
        // MPI still runs because the universe is borrowed. An error here can no longer be reported.
        let _ = check(unsafe { ffi::PetscFinalize() });
    }
}

/// Version of the PETSc linked at run time: major, minor, subminor. Needs no running PETSc.
pub fn version() -> (u32, u32, u32) {
    let mut major = 0;
    let mut minor = 0;
    let mut subminor = 0;
    let mut release = 0;
    // SAFETY: the pointers are valid; the function reads constants only and cannot fail.
    unsafe { ffi::PetscGetVersionNumber(&mut major, &mut minor, &mut subminor, &mut release) };
    [major, minor, subminor]
        .map(|part| u32::try_from(part).unwrap_or(0))
        .into()
}

/// Bits of PETSc's integer, 32 or 64.
pub const fn petsc_int_bits() -> u32 {
    ffi::PetscInt::BITS
}

/// Whether an option makes a solver open a viewer.
fn is_view(option: &str) -> bool {
    ["_view", "_converged_reason", "_converged_rate"]
        .iter()
        .any(|part| option.contains(part))
}
