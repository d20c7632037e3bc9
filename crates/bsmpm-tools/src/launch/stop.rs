//! A process that another thread can stop.

use std::io::{self, ErrorKind, Read};
use std::os::unix::net::UnixStream;
use std::process::{Command, ExitStatus, exit};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use rustix::io::Errno;
use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, kill_process, waitid};
use signal_hook::consts::SIGTERM;
use signal_hook::{flag, low_level};

/// What a run and those who may stop it share.
#[derive(Debug, Default)]
pub(crate) struct Stop(Mutex<StopState>);

#[derive(Debug, Default)]
struct StopState {
    is_asked: bool,
    /// while its number is that of no other process
    process: Option<Pid>,
}

/// The processes of this program, of whichever thread.
static UNDER_WAY: UnderWay = UnderWay {
    state: Mutex::new(UnderWayState {
        watches: false,
        ends: false,
        processes: Vec::new(),
    }),
    ended: Condvar::new(),
};

struct UnderWay {
    state: Mutex<UnderWayState>,
    /// one has ended
    ended: Condvar,
}

struct UnderWayState {
    /// signals to this program are heard
    watches: bool,
    /// this program was asked to end
    ends: bool,
    processes: Vec<Pid>,
}

impl UnderWay {
    fn state(&self) -> MutexGuard<'_, UnderWayState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds what `spawn` starts, which is nothing once this program ends.
    fn begin<T>(&'static self, spawn: impl FnOnce() -> io::Result<(T, Pid)>) -> io::Result<(T, Pid)> {
        let mut state = self.state();
        if !state.watches {
            self.watch()?;
            state.watches = true;
        }
        if state.ends {
            return Err(ErrorKind::Interrupted.into());
        }
        let begun = spawn()?;
        state.processes.push(begun.1);
        Ok(begun)
    }

    /// Takes one out that has ended, while its number is that of no other process, and fetches what it left, which is
    /// nobody's business once this program ends.
    fn end<T>(&self, process: Pid, fetch: impl FnOnce() -> T) -> T {
        let mut state = self.state();
        let left = fetch();
        state.processes.retain(|other| *other != process);
        self.ended.notify_all();
        while state.ends {
            state = self.ended.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        left
    }

    /// From now on a first TERM stops the processes and ends this program behind them; a second one ends it at once.
    fn watch(&'static self) -> io::Result<()> {
        let (mut asked, asks) = UnixStream::pair()?;
        let again = Arc::new(AtomicBool::new(false));
        // In this order: the first signal finds `again` unset.
        flag::register_conditional_default(SIGTERM, Arc::clone(&again))?;
        flag::register(SIGTERM, again)?;
        low_level::pipe::register(SIGTERM, asks)?;
        thread::Builder::new().spawn(move || {
            if asked.read_exact(&mut [0]).is_ok() {
                self.stop();
            }
        })?;
        Ok(())
    }

    /// Stops the processes at their last converged states, and ends this program when they have ended.
    fn stop(&self) {
        let mut state = self.state();
        state.ends = true;
        // Not TERM: who signals the whole group has sent that already, and a second one would cost a run its
        // checkpoint.
        state
            .processes
            .iter()
            .for_each(|process| _ = kill_process(*process, Signal::USR1));
        while !state.processes.is_empty() {
            state = self.ended.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        let _ = low_level::emulate_default_handler(SIGTERM);
        exit(128 + SIGTERM);
    }
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
        let (mut child, process) = UNDER_WAY.begin(|| {
            let child = command.spawn()?;
            let process = Pid::from_child(&child);
            Ok((child, process))
        })?;
        state.process = Some(process);
        drop(state);
        // It is waited for in two steps: until nobody can send it a signal any more, no other process may get its
        // number.
        let options = WaitIdOptions::EXITED | WaitIdOptions::NOWAIT;
        while waitid(WaitId::Pid(process), options).is_err_and(|error| error == Errno::INTR) {}
        self.state().process = None;
        UNDER_WAY.end(process, || child.wait())
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
        assert_eq!(
            stop.status(&mut Command::new("true")).unwrap_err().kind(),
            ErrorKind::Interrupted
        );
    }

    #[test]
    fn a_process_that_ends_by_itself_has_its_own_code() {
        let stop = Stop::default();
        assert_eq!(
            stop.status(Command::new("sh").args(["-c", "exit 80"])).unwrap().code(),
            Some(80)
        );
        stop.ask();
        assert!(stop.status(&mut Command::new("./nowhere")).is_err());
    }
}
