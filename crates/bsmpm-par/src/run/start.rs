//! What a run tells and does before its first step.

use super::Run;
use crate::machine;
use crate::setup::{self, Start};
use bsmpm::error::StepError;
use bsmpm::initial::Settling;
use bsmpm::kinematics::Kinematics;
use bsmpm::step::StepReport;
use bsmpm_io::manifest::{ManifestInitial, ManifestSettling};
use bsmpm_messages::headed;
use bsmpm_scene::Initial;

/// Part of the largest force beyond which an out-of-balance stress at the start is warned of. Level ground by k0 leaves
/// .8 % in four cells of depth: the points' quadrature of linear stress.
const UNBALANCED: f64 = 0.02;

impl<K: Kinematics<D>, const D: usize> Run<'_, K, D> {
    /// Tells what is to be told, and gives the points their stress at the start. Fails on all ranks.
    pub(super) fn begin(&mut self) -> Result<(), StepError> {
        for renaming in &self.case.renamings {
            self.log.line("note", &format!("note: {renaming}"));
        }
        if let Some(ledger) = &mut self.ledger {
            for warning in ledger.news() {
                self.log.line("warning", &headed(&warning, "warning"));
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
        if self.before.resumed {
            let (step, time) = (self.simulation.steps(), self.simulation.time());
            self.log.line("restart", &format!("goes on from step {step}, t = {time}"));
            return Ok(());
        }
        let mut report = StepReport::default();
        if let Some(start) = setup::start(&self.case, &mut self.simulation)? {
            self.tell_start(&start);
            (report.reactions, report.strips) = (start.0.reactions, start.0.strips);
        }
        self.record(&report);
        if let Some(names) = self.recorder.vacant() {
            self.log.line("history", &format!("histories without a point in their box at the start: {names}"));
        }
        self.profile(|_, profile| profile.times.is_empty());
        self.frame();
        Ok(())
    }

    /// Tells how well the stress at the start is balanced, and warns where the first step will move the body by it.
    fn tell_start(&mut self, (start, settling): &Start) {
        let (unbalance, yielding) = (start.force, start.yielding);
        let settling = settling.map(|Settling { rounds, evaluations }| ManifestSettling { rounds, evaluations });
        if let Some(ledger) = &mut self.ledger {
            ledger.manifest().initial = Some(ManifestInitial { unbalance, yielding, settling });
        }
        self.log.line(
            "initial",
            &format!(
                "stress at the start: unbalance {unbalance:.2e} of the largest force, {yielding} point(s) beyond yield{}",
                settling.map_or(String::new(), |it| format!(", settled in {} round(s)", it.rounds))
            ),
        );
        if unbalance > UNBALANCED {
            let sudden = self.case.sudden_loads();
            let growing =
                format!("{}: what acts in full from time 0 has no part in it: give a ramp", sudden.join(", "));
            // Linear elastic equilibrium is lost by nothing but yield.
            let advice = match &self.case.initial {
                Some(Initial::AtRest(_)) if !sudden.is_empty() => &growing,
                _ if !self.case.rigid.is_empty() => {
                    "rigid bodies have no part in it: where they hold soil let gravity grow over a ramp, without [initial]"
                }
                Some(Initial::Elastic) => {
                    "the elastic stress is beyond yield; equilibrium = \"plastic\" leads it to equilibrium before the first \
                     step, and gravity with a ramp and no [initial] lets the body yield as it is loaded"
                }
                _ => {
                    "k0 is for level ground and layers; equilibrium = \"plastic\" leads it to equilibrium before the first \
                     step, gravity = \"elastic\" balances other shapes, too"
                }
            };
            self.warn(format!(
                "the stress at the start leaves {:.1} % of the largest force unbalanced: the first step moves the body by it \
                 ({advice})",
                100.0 * unbalance
            ));
        }
        if yielding > 0 {
            self.warn(format!(
                "the stress at the start is beyond yield at {yielding} point(s): the first step returns it to the yield \
                 surface, and moves the body by what is lost; [initial] equilibrium = \"plastic\" does so before it"
            ));
        }
    }
}
