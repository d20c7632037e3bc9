//! Exit codes of the programs.
#![doc = include_str!("exit.md")]

/// The case's end was reached, and all its checks passed.
pub const DONE: u8 = 0;
/// The command line is wrong; clap ends with it, too.
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
/// The output directory cannot be used, or another run holds it.
pub const DIRECTORY: u8 = 73;
/// Reading or writing a file failed.
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
/// Material left the grid where it must not, or all of it through outflow faces, or a load its material;
/// the last converged state is saved.
pub const LEFT: u8 = 81;

/// The case's end was reached and its checks passed, but an indicator of the run is beyond its limit, which the case
/// does not accept: the answer is likely to be wrong by 10 % or more.
pub const INDICATOR: u8 = 82;

/// All of them.
pub const ALL: [u8; 16] = [
    DONE,
    USAGE,
    CASE,
    MISSING,
    BUG,
    MEMORY,
    STALLED,
    DIRECTORY,
    WRITE,
    STOPPED,
    CHECKPOINT,
    CHECK,
    WRONG_LAUNCH,
    NO_CONVERGENCE,
    LEFT,
    INDICATOR,
];

#[cfg(test)]
mod tests {
    use super::ALL;

    #[test]
    fn the_table_has_every_code_once() {
        let rows = include_str!("exit.md")
            .lines()
            .filter_map(|line| line.strip_prefix("| ")?.split(" | ").next());
        let documented: Vec<u8> = rows
            .flat_map(|codes| codes.split(", "))
            .filter_map(|code| code.parse().ok())
            .collect();
        assert_eq!(documented, ALL);
    }
}
