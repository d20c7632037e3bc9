#![doc = include_str!("../README.md")]
#![deny(unsafe_code)]

pub mod checkpoint;
pub mod cli;
mod fault;
pub mod gather;
pub mod indicators;
pub mod launch;
pub mod ledger;
mod limit_load;
pub mod log;
pub mod machine;
pub mod memory;
pub mod profile;
pub mod program;
pub mod record;
pub mod restart;
pub mod run;
pub mod setup;
pub mod source;
mod space;
mod terminal;
