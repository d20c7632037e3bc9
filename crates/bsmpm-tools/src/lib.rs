#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod batch;
mod case;
pub mod cli;
pub mod compare;
pub mod element;
pub mod error;
pub mod estimate;
pub mod explain;
pub mod fos;
mod grid_convergence;
pub mod keys;
mod launch;
pub mod limit_load;
mod line;
mod picture;
pub mod plot;
mod record;
mod reference;
mod report;
pub mod slurm;
pub mod sweep;
pub mod validate;
pub mod verify_case;

pub use error::Error;
