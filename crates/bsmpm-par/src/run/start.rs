//! What a run tells and does before its first step.

use super::Run;
use crate::machine;
use crate::setup;
use bsmpm::error::StepError;
use bsmpm::step::Report;
use bsmpm_io::manifest;

impl Run<'_> {
    /// Tells what is to be told, and gives the points their stress at the start. Fails on all ranks.
    pub(super) fn begin(&mut self) -> Result<(), StepError> {
        if let Some(ledger) = &mut self.ledger {
            for warning in ledger.manifest().warnings.clone() {
                self.log.line("warning", &format!("warning: {warning}"));
            }
        }
        if machine::has_reference_blas() {
            self.warn(
                "the BLAS in use is the reference one: factorisations take several times as long as with an optimised one \
                 (on Debian: libopenblas0-serial)"
                    .into(),
            );
        }
        for note in &self.case.notes {
            self.log.detail(&format!("{} = {}: {}", note.key, note.value, note.reason));
        }
        if let Some(start) = setup::start(&self.case, &mut self.simulation)? {
            self.tell_start(start);
        }
        self.record(&Report::default());
        self.frame();
        Ok(())
    }

    /// Tells how well the stress at the start is balanced.
    fn tell_start(&mut self, start: manifest::Initial) {
        if let Some(ledger) = &mut self.ledger {
            ledger.manifest().initial = Some(start);
        }
        let manifest::Initial { unbalance, yielding } = start;
        self.log.line(
            "initial",
            &format!(
                "stress at the start: unbalance {unbalance:.2e} of the largest force, {yielding} point(s) beyond yield"
            ),
        );
    }
}
