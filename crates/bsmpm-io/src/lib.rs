#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

pub mod atomic;
pub mod checkpoint;
pub mod directory;
pub mod disk;
pub mod error;
pub mod exit;
pub mod failure;
pub mod frame;
pub mod frames;
pub mod lock;
pub mod manifest;
mod relative;
pub mod residuals;
pub mod steps;
pub mod table;
pub mod utc;
pub mod vtu;
mod vtu_read;
mod xml;

pub use error::Error;
