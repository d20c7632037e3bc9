//! Start and end of the program: what it says, and how a failure on one rank ends all of them.

use bsmpm_io::exit::{BUG, WRONG_LAUNCH};
use bsmpm_io::lock;
use bsmpm_ranks::launch::{self, LaunchFailure};
use mpi::environment::Universe;
use mpi::topology::SimpleCommunicator;
use std::fmt::Display;
use std::io::Write;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// Starts MPI; from here on a panic on any rank ends the job. `Err` holds the exit code.
pub fn start() -> Result<Universe, u8> {
    age();
    launch::start(|world, reason| end(world, BUG, &reason)).map_err(|failure| {
        say(&format!("bsmpm-par: {failure}"));
        match failure {
            LaunchFailure::NoMpi => BUG,
            LaunchFailure::Apart(_) => WRONG_LAUNCH,
        }
    })
}

/// Ends the job on all ranks with `code`, for failures that the other ranks do not know of. Prints `reason` once.
pub fn end(world: &SimpleCommunicator, code: u8, reason: &dyn Display) -> ! {
    say(&format!("bsmpm-par: {reason}"));
    lock::abandon();
    launch::abort(world, code)
}

/// Writes a line to stderr; where nobody listens there is nothing left to do.
pub fn say(line: &str) {
    let mut stderr = std::io::stderr().lock();
    let _ = writeln!(stderr, "{line}").and_then(|()| stderr.flush());
}

/// How long this process has been there: what a limit of time is compared with, so that starting libraries, making
/// points and reading a checkpoint count, too.
pub fn age() -> Duration {
    static BEGUN: OnceLock<Instant> = OnceLock::new();
    BEGUN.get_or_init(Instant::now).elapsed()
}
