//! Exit codes of `bsmpm-par`; the manual explains them (`reference/exit-codes.md`).

/// The end of the case was reached, and all its checks passed.
pub const DONE: u8 = 0;
/// The command line is wrong. clap uses this code, too.
pub const USAGE: u8 = 2;
/// The case is wrong, or cannot be run on this number of ranks or with the available libraries.
pub const CASE: u8 = 65;
/// The case file is missing or cannot be read.
pub const MISSING: u8 = 66;
/// Internal error of the program.
pub const BUG: u8 = 70;
/// The case needs more memory than allowed.
pub const MEMORY: u8 = 71;
/// Repeated restarts make no progress.
pub const STALLED: u8 = 72;
/// The output directory cannot be used, or another run has locked it.
pub const DIRECTORY: u8 = 73;
/// A file could not be read or written.
pub const WRITE: u8 = 74;
/// The run was stopped on request.
pub const STOPPED: u8 = 75;
/// A checkpoint cannot be used.
pub const CHECKPOINT: u8 = 76;
/// A check of the case failed.
pub const CHECK: u8 = 77;
/// N separate runs were started instead of one run on N ranks.
pub const WRONG_LAUNCH: u8 = 78;
/// The smallest step did not converge, or energy was created. The last converged state is saved.
pub const NO_CONVERGENCE: u8 = 80;
/// Material left the grid where this is not allowed, or all of it left through outflow boundaries, or a load lost its
/// material. The last converged state is saved.
pub const LEFT: u8 = 81;

/// The end of the case was reached and its checks passed, but an indicator is beyond a limit, and the case does not
/// accept that. The result is likely to be wrong by 10 % or more.
pub const INDICATOR: u8 = 82;

/// All exit codes.
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
    fn the_page_of_the_manual_has_every_code() {
        let page = include_str!("../../bsmpm-book/src/reference/exit-codes.md");
        let mut sections = page.split("\n## ");
        let section = sections.find(|section| section.starts_with("bsmpm-par\n"));
        let rows = section.expect("the codes of bsmpm-par").lines();
        let codes = rows.filter_map(|line| line.strip_prefix("| ")?.split(" | ").next());
        let mut documented: Vec<u8> = codes.filter_map(|code| code.parse().ok()).collect();
        documented.dedup(); // a code may have several rows
        assert_eq!(documented, ALL);
    }
}
