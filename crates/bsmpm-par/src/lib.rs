#![doc = include_str!("../README.md")]
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
