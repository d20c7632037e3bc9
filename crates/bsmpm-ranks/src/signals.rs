//! Handles operating-system signals: a signal to one rank acts on all.
//!
//! SIGUSR1, SIGTERM and SIGINT stop the run at the last converged state. A second SIGTERM or SIGINT ends the run at
//! once. SIGUSR2 writes a frame and a checkpoint.

use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1, SIGUSR2};
use signal_hook::{flag, low_level};
use std::cell::Cell;
use std::ffi::c_int;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Numbers that the requests add to a reduction.
pub const WIDTH: usize = 2;

/// The requests of this rank, and those that all ranks know of.
#[derive(Debug, Default)]
pub struct Requests {
    stop: Arc<AtomicBool>,
    save: Arc<AtomicBool>,
    stop_agreed: Cell<bool>,
    save_agreed: Cell<bool>,
    reject: Cell<bool>, // no signal, but a fault that all ranks know of
}

impl Requests {
    /// Those of the signals that come from now on. To be called once.
    pub fn of_signals() -> io::Result<Self> {
        let requests = Self::default();
        let ending = Arc::new(AtomicBool::new(false));
        for signal in [SIGTERM, SIGINT] {
            register_ending(signal, Arc::clone(&ending), Arc::clone(&requests.stop))?;
        }
        flag::register(SIGUSR1, Arc::clone(&requests.stop))?;
        flag::register(SIGUSR2, Arc::clone(&requests.save))?;
        Ok(requests)
    }

    /// This rank's share of the next sum over the ranks.
    pub fn share(&self) -> [f64; WIDTH] {
        [
            self.stop.load(Ordering::Relaxed),
            self.save.swap(false, Ordering::Relaxed),
        ]
        .map(f64::from)
    }

    /// Takes the sums of the ranks' shares.
    pub fn agree(&self, [stop, save]: [f64; WIDTH]) {
        self.stop_agreed.set(self.stop_agreed.get() || stop > 0.0);
        self.save_agreed.set(self.save_agreed.get() || save > 0.0);
    }

    /// Whether the run is to stop.
    pub fn stop(&self) -> bool {
        self.stop_agreed.get()
    }

    /// Wants the next step that converges to be given up.
    pub fn reject_next(&self) {
        self.reject.set(true);
    }

    /// Whether a step that has converged is to be given up; asked once, the next one is not.
    pub fn take_rejection(&self) -> bool {
        self.reject.take()
    }

    /// Whether a frame and a checkpoint are wanted; asked once, they are no longer.
    pub fn take_save(&self) -> bool {
        self.save_agreed.take()
    }
}

/// Lets the first SIGTERM or SIGINT set `stop`, and the second one do what it does to any program. One atomic operation
/// decides which signal is the first, because two threads may handle two signals at the same time.
#[allow(unsafe_code)]
fn register_ending(signal: c_int, ending: Arc<AtomicBool>, stop: Arc<AtomicBool>) -> io::Result<()> {
    // SAFETY: `handle` is async-signal-safe.
    unsafe { low_level::register(signal, move || handle(signal, &ending, &stop)) }.map(drop)
}

/// What a signal does. Atomic stores and `emulate_default_handler` are async-signal-safe.
fn handle(signal: c_int, ending: &AtomicBool, stop: &AtomicBool) {
    if ending.swap(true, Ordering::SeqCst) {
        let _ = low_level::emulate_default_handler(signal);
    }
    stop.store(true, Ordering::SeqCst);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_counts_once_it_has_been_summed_and_a_save_is_wanted_once() {
        let requests = Requests::default();
        requests.agree(requests.share());
        assert!(!requests.stop() && !requests.take_save());
        requests.save.store(true, Ordering::Relaxed);
        assert!(!requests.take_save(), "the others do not know of it yet");
        requests.agree(requests.share());
        assert!(requests.take_save() && !requests.take_save());
        // That of another rank, and later reductions in which nobody asks.
        requests.agree([1.0, 0.0]);
        requests.agree(requests.share());
        assert!(requests.stop() && !requests.take_save());
    }
}
