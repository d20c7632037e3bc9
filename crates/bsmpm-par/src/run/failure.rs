//! Steps that cannot be made: what is told, and the exit code.

use super::{Run, diagnosis};
use bsmpm::control::Failure;
use bsmpm::error::StepError;
use bsmpm::kinematics::Kinematics;
use bsmpm::step::Counts;
use bsmpm_io::exit;
use bsmpm_io::manifest::Status;
use bsmpm_ranks::launch;

impl<K: Kinematics<D>, const D: usize> Run<'_, K, D> {
    /// Ends the run after a step that failed.
    pub(super) fn fail(mut self, failure: &Failure) -> u8 {
        let told = match failure.attempts.last() {
            Some(StepError::EnergyMade { .. }) => {
                format!("ended after step {} at t = {}", self.simulation.steps(), failure.t)
            }
            _ => format!(
                "step {} failed at t = {} after {} attempt(s), the last with dt = {:.3e}",
                self.simulation.steps() + 1,
                failure.t,
                failure.attempts.len(),
                failure.dt
            ),
        };
        if let Some(ledger) = &mut self.ledger {
            ledger.attempts(failure.attempts.len() - 1, failure.counts);
        }
        let (run, code) =
            self.give_up(failure, (&told, "; the last converged state is saved, failure.json tells more"));
        run.end(Status::Failed, code)
    }

    /// Ends the run whose points could not be given their stress at the start.
    pub(super) fn fail_at_start(self, error: StepError) -> u8 {
        let failure = Failure { t: 0.0, dt: 0.0, attempts: vec![error], counts: Counts::default() };
        let (run, code) = self.give_up(&failure, ("the stress at the start", "; failure.json tells more"));
        run.close(Status::Failed, code)
    }

    /// Ends the run whose points cannot go on in a stage.
    pub(super) fn fail_at_stage(self, error: StepError) -> u8 {
        let t = self.simulation.time();
        let failure = Failure { t, dt: 0.0, attempts: vec![error], counts: Counts::default() };
        let told = format!("the stage at t = {t}");
        let (run, code) = self.give_up(&failure, (&told, "; failure.json tells more"));
        run.close(Status::Failed, code)
    }

    fn give_up(mut self, failure: &Failure, (told, end): (&str, &str)) -> (Self, u8) {
        let step = self.simulation.steps() + 1;
        let code = launch::agree(&self.universe.world(), code_of(failure.attempts.last(), step));
        let report = diagnosis::of(&self.universe.world(), failure, step, &self.case);
        let reason = report.attempts.last().map_or("", String::as_str);
        let place = report.worst.first();
        let place = place.map_or_else(String::new, |w| format!("; {} {} at {:?}", w.kind, w.id, w.position));
        let advice = report.advice.first().map_or_else(String::new, |advice| format!("; try: {advice}"));
        self.log.failure(&format!("{told}: {reason}{place}{advice}{end}"));
        let written = self.ledger.as_mut().map_or(Ok(()), |ledger| ledger.failure(&report));
        self.require(written);
        (self, code)
    }
}

/// The exit code of the error of a step. A load whose points have no material when the run starts is the case's error;
/// later its material has left it.
fn code_of(error: Option<&StepError>, step: u64) -> u8 {
    match error {
        Some(StepError::Unloaded { .. }) if step == 1 => exit::CASE,
        Some(StepError::Undrained { .. }) => exit::CASE,
        Some(
            StepError::Unloaded { .. } | StepError::Left { .. } | StepError::Emptied { .. } | StepError::Outside { .. },
        ) => exit::LEFT,
        _ => exit::NO_CONVERGENCE,
    }
}
