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

/// Count of numbers that the requests add to a reduction.
pub const WIDTH: usize = 2;

/// Requests of this rank, and those that all ranks have agreed on.
#[derive(Debug, Default)]
pub struct Requests {
    stop: Arc<AtomicBool>,
    save: Arc<AtomicBool>,
    stop_agreed: Cell<bool>,
    save_agreed: Cell<bool>,
    reject: Cell<bool>, // not from a signal; set by all ranks together
}

impl Requests {
    /// Registers the signal handlers and returns the requests. Call it once.
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

    /// Returns this rank's contribution to the next sum over the ranks.
    pub fn share(&self) -> [f64; WIDTH] {
        [
            self.stop.load(Ordering::Relaxed),
            self.save.swap(false, Ordering::Relaxed),
        ]
        .map(f64::from)
    }

    /// Stores the sums of the ranks' contributions.
    pub fn agree(&self, [stop, save]: [f64; WIDTH]) {
        self.stop_agreed.set(self.stop_agreed.get() || stop > 0.0);
        self.save_agreed.set(self.save_agreed.get() || save > 0.0);
    }

    /// Returns whether the run must stop.
    pub fn stop(&self) -> bool {
        self.stop_agreed.get()
    }

    /// Requests that the next converged step be rejected.
    pub fn reject_next(&self) {
        self.reject.set(true);
    }

    /// Returns whether a converged step must be rejected, and clears the request.
    pub fn take_rejection(&self) -> bool {
        self.reject.take()
    }

    /// Returns whether a frame and a checkpoint are requested, and clears the request.
    pub fn take_save(&self) -> bool {
        self.save_agreed.take()
    }
}

/// Registers a handler: the first SIGTERM or SIGINT sets `stop`, the second one has its default effect. One atomic
/// operation decides which signal is the first, because two threads may handle two signals at the same time.
#[allow(unsafe_code)]
fn register_ending(signal: c_int, ending: Arc<AtomicBool>, stop: Arc<AtomicBool>) -> io::Result<()> {
    // SAFETY: `handle` is async-signal-safe.
    unsafe { low_level::register(signal, move || handle(signal, &ending, &stop)) }.map(drop)
}

/// Handles a signal. Atomic stores and `emulate_default_handler` are async-signal-safe.
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
