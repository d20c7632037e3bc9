//! Reports failed steps.

use super::{Run, diagnosis};
use crate::log::short;
use bsmpm::control::Failure;
use bsmpm::error::{FailureKind, StepError};
use bsmpm::kinematics::Kinematics;
use bsmpm::step::Counts;
use bsmpm_io::exit;
use bsmpm_io::manifest::Status;
use bsmpm_messages::{code_of, without_code};
use bsmpm_ranks::launch;

impl<K: Kinematics<D>, const D: usize> Run<'_, K, D> {
    /// Ends the run after a step that failed.
    pub(super) fn fail(mut self, failure: &Failure) -> u8 {
        let t = self.moment(failure.t);
        let made = self.simulation.steps();
        let subject = match (failure.attempts.last(), failure.attempts.len()) {
            (Some(StepError::EnergyMade { .. }), _) => format!("step {made} at t = {t} was the last"),
            (_, 1) => format!("step {} failed (t = {t})", made + 1),
            (_, attempts) => format!("step {} failed (t = {t}, {attempts} attempts)", made + 1),
        };
        if let Some((_, rejected)) = failure.attempts.split_last() {
            self.log.rejected(made + 1, rejected);
        }
        if let Some(ledger) = &mut self.ledger {
            ledger.attempts(failure.attempts.len() - 1, failure.counts);
        }
        let (run, code) = self.give_up(failure, &subject);
        run.end(Status::Failed, code)
    }

    /// Ends the run whose points could not be given their stress at the start.
    pub(super) fn fail_at_start(self, error: StepError) -> u8 {
        let failure = Failure {
            t: 0.0,
            dt: 0.0,
            attempts: vec![error],
            counts: Counts::default(),
        };
        let (run, code) = self.give_up(&failure, "the initial stress failed");
        run.close(Status::Failed, code)
    }

    /// Ends the run whose points cannot go on in a stage.
    pub(super) fn fail_at_stage(self, error: StepError) -> u8 {
        let t = self.simulation.time();
        let subject = format!("the stage at t = {} failed", self.moment(t));
        let failure = Failure {
            t,
            dt: 0.0,
            attempts: vec![error],
            counts: Counts::default(),
        };
        let (run, code) = self.give_up(&failure, &subject);
        run.close(Status::Failed, code)
    }

    /// Writes why the run ends, and prints it with its code. `subject` is what failed.
    fn give_up(mut self, failure: &Failure, subject: &str) -> (Self, u8) {
        let step = self.simulation.steps() + 1;
        let code = launch::agree(&self.universe.world(), exit_code_of(failure.attempts.last(), step));
        let report = diagnosis::of(&self.universe.world(), failure, step, &self.case);
        let error = report.attempts.last().map_or("", String::as_str);
        let cause = without_code(error);
        let head = code_of(error).map_or_else(String::new, |code| format!("{code}: "));
        let advice = report
            .advice
            .first()
            .map_or_else(String::new, |advice| format!(" {advice}"));
        self.log.failure(&format!("{head}{subject}: {cause}{advice}"));
        if let Some(place) = report.worst.first() {
            let at: Vec<String> = place.position.iter().map(|x| short(*x)).collect();
            let kind = if place.kind == "point" {
                "material point"
            } else {
                "node"
            };
            self.log.cause(
                "place",
                &format!("Location: {kind} {} at [{}] m.", place.id, at.join(", ")),
            );
        }
        let written = self.ledger.as_mut().map_or(Ok(()), |ledger| ledger.failure(&report));
        self.require(written);
        (self, code)
    }
}

/// The exit code of a run that ended with this error of a step. A load whose points have no material when the run
/// starts is the case's error; later its material has left it.
fn exit_code_of(error: Option<&StepError>, step: u64) -> u8 {
    match error.map(|error| error.meaning().kind) {
        Some(FailureKind::LostLoad) if step == 1 => exit::CASE,
        Some(FailureKind::Case) => exit::CASE,
        Some(FailureKind::LostLoad | FailureKind::LeftMaterial) => exit::LEFT,
        Some(FailureKind::NoConvergence) | None => exit::NO_CONVERGENCE,
    }
}
