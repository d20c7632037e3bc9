//! What the program ends with. Codes of files (73, 74) come with the errors of `bsmpm-io`.
#![doc = include_str!("exit.md")]

/// The case's end was reached, and all its checks passed.
pub const DONE: u8 = 0;
/// The command line is wrong.
pub const USAGE: u8 = 2;
/// The case is wrong, or cannot be run on so many ranks or with the libraries at hand.
pub const CASE: u8 = 65;
/// The case file is missing or cannot be read.
pub const MISSING: u8 = 66;
/// A fault of the program.
pub const BUG: u8 = 70;
/// The case needs more memory than allowed.
pub const MEMORY: u8 = 71;
/// Restarts come to nothing.
pub const STALLED: u8 = 72;
/// A file could not be written.
pub const WRITE: u8 = 74;
/// Stopped on request.
pub const STOPPED: u8 = 75;
/// A checkpoint cannot be used.
pub const CHECKPOINT: u8 = 76;
/// A check of the case failed.
pub const CHECK: u8 = 77;
/// N separate runs where one run on N ranks was meant.
pub const WRONG_LAUNCH: u8 = 78;
/// No convergence at the smallest step, or energy that no work explains; the last converged state is saved.
pub const NO_CONVERGENCE: u8 = 80;
/// Material left the grid, or a load its material; the last converged state is saved.
pub const LEFT: u8 = 81;
