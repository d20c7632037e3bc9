#![doc = include_str!("../README.md")]
//! ## The modules
//!
//! What a run leaves in its output directory, and how it is read back: frames for ParaView ([`frame`], [`vtu`],
//! [`frames`]), one row a step ([`table`], [`steps`]), one an iteration ([`residuals`]), the manifest `run.json`
//! ([`manifest`]), `failure.json` ([`failure`]), the directory itself ([`directory`]), which a run that goes on holds
//! alone ([`lock`]), what its [`disk`] has left, what a program ends with ([`exit`]), and how a checkpoint is committed
//! and found again ([`checkpoint`]); the arrays in a checkpoint's HDF5 file are written where the ranks are known, in
//! `bsmpm-par`.
//!
//! Two promises hold for everything that is written: no number that is not finite ever reaches a file, and a file that
//! is replaced is either the old or the new one, whenever the program is killed ([`atomic`]).
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
