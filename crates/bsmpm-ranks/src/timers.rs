//! Wall-clock time by phase, for `run.json`.

use crate::traffic::Traffic;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::time::Instant;

/// Seconds of every phase; the physics, which knows no clock, is what remains of the steps.
#[derive(Debug, Default)]
pub struct Timers {
    seconds: RefCell<BTreeMap<&'static str, f64>>,
    traffic: Traffic,
}

/// Adds to its phase when dropped.
pub struct PhaseTimer<'a> {
    timers: &'a Timers,
    phase: &'static str,
    start: Instant,
}

impl Timers {
    /// Times `phase` until the value is dropped; phases may nest, each counts its own whole span.
    pub fn time(&self, phase: &'static str) -> PhaseTimer<'_> {
        PhaseTimer {
            timers: self,
            phase,
            start: Instant::now(),
        }
    }

    /// Seconds by phase so far.
    pub fn seconds(&self) -> BTreeMap<&'static str, f64> {
        self.seconds.borrow().clone()
    }

    /// The counter of what this rank sends the others.
    pub fn traffic(&self) -> &Traffic {
        &self.traffic
    }
}

impl Drop for PhaseTimer<'_> {
    fn drop(&mut self) {
        *self.timers.seconds.borrow_mut().entry(self.phase).or_default() += self.start.elapsed().as_secs_f64();
    }
}
