//! Wall-clock time by phase, for `run.json`.

use crate::traffic::Traffic;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::time::Instant;

/// Wall-clock seconds of every phase. The crate `bsmpm` has no clock: its time is the remainder of the steps.
#[derive(Debug, Default)]
pub struct Timers {
    seconds: RefCell<BTreeMap<&'static str, f64>>,
    traffic: Traffic,
}

/// Adds the elapsed time to its phase when dropped.
pub struct PhaseTimer<'a> {
    timers: &'a Timers,
    phase: &'static str,
    start: Instant,
}

impl Timers {
    /// Times `phase` until the returned value is dropped. Phases may nest; each counts its whole duration.
    pub fn time(&self, phase: &'static str) -> PhaseTimer<'_> {
        PhaseTimer {
            timers: self,
            phase,
            start: Instant::now(),
        }
    }

    /// Returns the seconds so far by phase.
    pub fn seconds(&self) -> BTreeMap<&'static str, f64> {
        self.seconds.borrow().clone()
    }

    /// Returns the counter of this rank's messages to other ranks.
    pub fn traffic(&self) -> &Traffic {
        &self.traffic
    }
}

impl Drop for PhaseTimer<'_> {
    fn drop(&mut self) {
        *self.timers.seconds.borrow_mut().entry(self.phase).or_default() += self.start.elapsed().as_secs_f64();
    }
}
