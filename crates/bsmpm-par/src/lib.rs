//! The solver program around the physics: slabs and ranks, halos, migration, PETSc, files and the log.
//!
//! One program for any number of ranks; a single rank is a cut into one slab. `bsmpm` computes, this crate connects.
#![deny(unsafe_code)]

pub mod checkpoint;
pub mod cli;
pub mod exit;
mod fault;
pub mod gather;
pub mod halo;
pub mod indicators;
pub mod ksp;
pub mod launch;
pub mod ledger;
pub mod load;
pub mod log;
pub mod machine;
pub mod memory;
pub mod migrate;
pub mod plan;
pub mod program;
pub mod record;
pub mod restart;
pub mod run;
pub mod setup;
pub mod signals;
pub mod simulation;
pub mod slab;
pub mod source;
mod space;
pub mod stencil;
pub mod timers;
pub mod traffic;
