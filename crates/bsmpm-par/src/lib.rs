//! The solver program around the physics: slabs and ranks, halos, migration, PETSc, files and the log.
//!
//! One program for any number of ranks; a single rank is a cut into one slab. `bsmpm` computes, this crate connects.
#![deny(unsafe_code)]

pub mod halo;
pub mod ksp;
pub mod launch;
pub mod migrate;
pub mod slab;
pub mod stencil;
pub mod timers;
