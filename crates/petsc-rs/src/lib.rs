//! A small, safe binding of PETSc: distributed vectors, sparse matrices, and Krylov or direct solvers.
//!
//! PETSc neither prints nor aborts: its errors are returned as [`Error`]. All ranks must make a call marked
//! *collective*, in the same order. If the arguments of one rank are invalid, all ranks return an `Err` (ranks with
//! valid arguments [`Error::OtherRank`]), so no rank waits for another. Other calls are local.
//!
//! ```no_run
//! # fn main() -> petsc_rs::Result<()> {
//! use petsc_rs::{Ksp, Matrix, Petsc, Vector};
//! let universe = mpi::initialize().expect("MPI starts once");
//! let petsc = Petsc::initialize(&universe, &["-ksp_type", "cg"])?;
//! let mut matrix = Matrix::from_coo(&petsc, 2, 1, &[0, 1], &[0, 1])?; // on one rank
//! matrix.set_values(&[2.0, 4.0])?;
//! let mut b = Vector::new(&petsc, 2)?;
//! b.copy_from(&[2.0, 2.0])?;
//! let mut x = Vector::new(&petsc, 2)?;
//! let mut ksp = Ksp::new(&petsc)?;
//! ksp.set_operator(&matrix)?;
//! ksp.set_from_options()?;
//! let info = ksp.solve(&b, &mut x)?;
//! assert!(info.iterations <= 2);
//! # Ok(())
//! # }
//! ```
//!
//! The crate needs PETSc 3.18 or later with real scalars in double precision. Indices can have 32 or 64 bits.

mod error;
mod ksp;
mod matrix;
mod options;
mod petsc;
mod shell;
mod vector;

pub use error::{Error, Result};
pub use ksp::{Ksp, NormType, SolveInfo, Tolerances};
pub use matrix::{Matrix, Symmetry};
pub use petsc::{Petsc, petsc_int_bits, version};
pub use shell::{PcFailure, Product, ShellPc};
pub use vector::Vector;

/// What bindgen made of PETSc's headers.
#[allow(
    missing_docs,
    dead_code,
    non_camel_case_types,
    non_snake_case,
    non_upper_case_globals,
    clippy::all,
    clippy::undocumented_unsafe_blocks
)]
mod ffi {
    include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
}
