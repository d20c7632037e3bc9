//! Steps that cannot be made: what is told, where it was worst, and the exit code.

use super::Run;
use crate::exit;
use crate::launch;
use bsmpm::control::Failure;
use bsmpm::error::{Measures, StepError};
use bsmpm_io::manifest::{self, Status};
use mpi::collective::CommunicatorCollectives;
use mpi::topology::Communicator;

impl Run<'_> {
    /// Ends the run after a step that failed.
    pub(super) fn fail(mut self, failure: &Failure) -> u8 {
        let last = failure.attempts.last();
        let told = format!(
            "step {} failed at t = {} after {} attempt(s), the last with dt = {:.3e}",
            self.simulation.steps() + 1,
            failure.t,
            failure.attempts.len(),
            failure.dt
        );
        if let Some(ledger) = &mut self.ledger {
            ledger.attempts(failure.attempts.len() - 1, failure.counts);
        }
        let end = "; the last converged state is saved";
        self.give_up(last, failure.t, (&told, end))
    }

    /// Ends the run whose points could not be given their stress at the start.
    pub(super) fn fail_at_start(self, error: &StepError) -> u8 {
        self.give_up(Some(error), 0.0, ("the stress at the start", ""))
    }

    fn give_up(mut self, error: Option<&StepError>, time: f64, (told, end): (&str, &str)) -> u8 {
        let step = self.simulation.steps() + 1;
        let code = launch::agree(&self.universe.world(), code_of(error, step));
        let reason = error.map_or_else(String::new, ToString::to_string);
        let worst = self.worst_place(error);
        let place = worst.as_ref().map_or_else(String::new, |w| format!("; {} {} at {:?}", w.kind, w.id, w.position));
        self.log.failure(&format!("{told}: {reason}{place}{end}"));
        if let Some(ledger) = &mut self.ledger {
            let finite = |measures: &Measures| Some(measures.energy).filter(|energy| energy.is_finite());
            let residuals = match error {
                Some(StepError::NotConverged { history, .. }) => history.iter().map(finite).collect(),
                _ => Vec::new(),
            };
            ledger.manifest().failure = Some(manifest::Failure { step, time, reason, residuals, worst });
        }
        self.end(Status::Failed, code)
    }

    /// The point or node that the error is about: of the points that ranks name the one with the smallest id, of the
    /// nodes the one whose forces are the least balanced.
    fn worst_place(&self, error: Option<&StepError>) -> Option<manifest::Worst> {
        let world = self.universe.world();
        let lower = self.case.grid.lower();
        let (mut kind, mut own) = ("point", [f64::INFINITY; 4]); // order among the places, number, x, y
        if let Some(StepError::NotConverged { worst, .. }) = error {
            kind = "node";
            if let [x, y] = worst.x[..] {
                own = [-worst.force, worst.number as f64, lower[0] + x, lower[1] + y];
            }
        } else if let Some((id, x)) = error.and_then(StepError::point) {
            own = [id as f64, id as f64, lower[0] + x[0], lower[1] + x[1]];
        }
        let mut all = vec![0.0_f64; own.len() * world.size().unsigned_abs() as usize];
        world.all_gather_into(&own[..], &mut all[..]);
        let named = all.chunks_exact(own.len()).filter(|place| place.iter().all(|number| number.is_finite()));
        let worst = named.min_by(|a, b| a[0].total_cmp(&b[0]))?;
        Some(manifest::Worst { kind: kind.into(), id: worst[1] as u64, position: worst[2..].to_vec() })
    }
}

/// The exit code of the error of a step. A load whose points have no material when the run starts is the case's error;
/// later its material has left it.
fn code_of(error: Option<&StepError>, step: u64) -> u8 {
    match error {
        Some(StepError::Unloaded { .. }) if step == 1 => exit::CASE,
        Some(StepError::Unloaded { .. } | StepError::Left { .. } | StepError::Outside { .. }) => exit::LEFT,
        _ => exit::NO_CONVERGENCE,
    }
}
