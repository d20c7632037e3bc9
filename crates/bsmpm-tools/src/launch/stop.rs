//! A process that another thread may ask to end, with the signal by which batch systems and people do (TERM).

use std::io::{self, ErrorKind};
use std::process::{Command, ExitStatus};
use std::sync::{Mutex, MutexGuard, PoisonError};

use rustix::io::Errno;
use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, kill_process, waitid};

/// What a run and those who may stop it share.
#[derive(Debug, Default)]
pub(crate) struct Stop(Mutex<StopState>);

#[derive(Debug, Default)]
struct StopState {
    is_asked: bool,
    /// while its number is that of no other process
    process: Option<Pid>,
}

impl Stop {
    /// Asks the run to end, once; one that has not begun never does.
    pub fn ask(&self) {
        let mut state = self.state();
        if let (false, Some(process)) = (state.is_asked, state.process) {
            // It may have ended by itself: then nobody is there to hear it.
            let _ = kill_process(process, Signal::TERM);
        }
        state.is_asked = true;
    }

    /// Whether the run was asked to end, in time or not.
    pub fn is_asked(&self) -> bool {
        self.state().is_asked
    }

    /// Runs a command to its end.
    pub(super) fn status(&self, command: &mut Command) -> io::Result<ExitStatus> {
        let mut state = self.state();
        if state.is_asked {
            return Err(ErrorKind::Interrupted.into());
        }
        let mut child = command.spawn()?;
        let process = Pid::from_child(&child);
        state.process = Some(process);
        drop(state);
        // It is waited for in two steps: until nobody can send it a signal any more, no other process may get its
        // number.
        let ended = || waitid(WaitId::Pid(process), WaitIdOptions::EXITED | WaitIdOptions::NOWAIT);
        while ended().is_err_and(|error| error == Errno::INTR) {}
        self.state().process = None;
        child.wait()
    }

    fn state(&self) -> MutexGuard<'_, StopState> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::os::unix::process::ExitStatusExt;
    use std::thread;

    use super::*;

    #[test]
    fn a_process_ends_when_it_is_asked_to_and_none_begins_afterwards() {
        let stop = Stop::default();
        thread::scope(|scope| {
            let run = scope.spawn(|| stop.status(Command::new("sleep").arg("1000")));
            while stop.state().process.is_none() {
                thread::yield_now();
            }
            stop.ask();
            stop.ask();
            assert_eq!(run.join().unwrap().unwrap().signal(), Some(Signal::TERM.as_raw()));
        });
        assert!(stop.is_asked());
        assert_eq!(stop.status(&mut Command::new("true")).unwrap_err().kind(), ErrorKind::Interrupted);
    }

    #[test]
    fn a_process_that_ends_by_itself_has_its_own_code() {
        let stop = Stop::default();
        assert_eq!(stop.status(Command::new("sh").args(["-c", "exit 80"])).unwrap().code(), Some(80));
        stop.ask();
        assert!(stop.status(&mut Command::new("./nowhere")).is_err());
    }
}
