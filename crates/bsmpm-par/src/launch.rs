//! Starts and ends the program on all ranks.

use crate::terminal::{self, Terminal};
use bsmpm_io::exit::{BUG, WRONG_LAUNCH};
use bsmpm_io::lock;
use bsmpm_messages::headed;
use bsmpm_ranks::launch::{self, LaunchFailure};
use mpi::environment::Universe;
use mpi::topology::SimpleCommunicator;
use std::fmt::Display;
use std::fs::File;
use std::io::Write;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Starts MPI; from here on a panic on any rank ends the job. `Err` holds the exit code.
pub fn start() -> Result<Universe, u8> {
    age();
    launch::start(|world, reason| end(world, BUG, &reason)).map_err(|failure| {
        complain(&failure.to_string());
        match failure {
            LaunchFailure::NoMpi => BUG,
            LaunchFailure::Apart(_) => WRONG_LAUNCH,
        }
    })
}

/// Ends the job on all ranks with `code`, for failures that the other ranks do not know of. Prints `reason` once.
pub fn end(world: &SimpleCommunicator, code: u8, reason: &dyn Display) -> ! {
    complain(&reason.to_string());
    lock::abandon();
    launch::abort(world, code)
}

/// The terminal of the launcher, if lines go there directly: after Ctrl-C a launcher does not print them any more.
static TERMINAL: OnceLock<File> = OnceLock::new();
/// Whether the cursor is on a line that the next one is to overwrite.
static IS_DRAWN: AtomicBool = AtomicBool::new(false);

/// Looks for the terminal at which a person watches this process. From here on lines go there.
pub fn watch() -> bool {
    match terminal::find() {
        Some(Terminal::Own) => true,
        Some(Terminal::OfLauncher(file)) => TERMINAL.set(file).is_ok(),
        None => false,
    }
}

/// Writes a line to stderr; where nobody listens there is nothing left to do.
pub fn say(line: &str) {
    let clear = if IS_DRAWN.swap(false, Ordering::Relaxed) {
        CLEAR
    } else {
        ""
    };
    write(&format!("{clear}{line}\n"));
}

/// Prints an error, which begins with its code.
pub fn complain(error: &str) {
    say(&format!("bsmpm-par: {}", headed(error, "error")));
}

/// Writes a line on a terminal that the next line overwrites.
pub fn draw(line: &str) {
    IS_DRAWN.store(true, Ordering::Relaxed);
    write(&format!("{line}{CLEAR}"));
}

/// Removes the line that was drawn last, if it is still there.
pub fn erase() {
    if IS_DRAWN.swap(false, Ordering::Relaxed) {
        write(CLEAR);
    }
}

/// Clears the rest of the line, and moves the cursor to its beginning.
const CLEAR: &str = "\x1b[K\r";

fn write(text: &str) {
    if let Some(mut terminal) = TERMINAL.get() {
        let _ = terminal.write_all(text.as_bytes());
        return;
    }
    let mut stderr = std::io::stderr().lock();
    let _ = stderr.write_all(text.as_bytes()).and_then(|()| stderr.flush());
}

/// How long this process has been there: what a limit of time is compared with, so that starting libraries, making
/// points and reading a checkpoint count, too.
pub fn age() -> Duration {
    static BEGUN: OnceLock<Instant> = OnceLock::new();
    BEGUN.get_or_init(Instant::now).elapsed()
}
