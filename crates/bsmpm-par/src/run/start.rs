//! Reports and output before the first step.

use super::Run;
use crate::machine;
use crate::setup::{self, Start};
use bsmpm::error::StepError;
use bsmpm::initial::EquilibriumSearchReport;
use bsmpm::kinematics::Kinematics;
use bsmpm::step::StepReport;
use bsmpm_io::manifest::{ManifestInitial, ManifestSettling};
use bsmpm_scene::Initial;

/// Part of the largest force beyond which an out-of-balance stress at the start is warned of. Level ground by k0 leaves
/// 0.8 % in four cells of depth: the points' quadrature of linear stress.
const UNBALANCED: f64 = 0.02;

impl<K: Kinematics<D>, const D: usize> Run<'_, K, D> {
    /// Reports what is known, and gives the points their stress at the start. Fails on all ranks.
    pub(super) fn begin(&mut self) -> Result<(), StepError> {
        for renaming in &self.case.renamings {
            self.log.line("note", &format!("note: {renaming}"));
        }
        if let Some(ledger) = &mut self.ledger {
            for warning in ledger.news() {
                self.log.warning("warning", &warning);
            }
        }
        if machine::has_reference_blas() {
            self.warn(
                "W0714: the linear algebra library (BLAS) is the slow reference version. Runs take several times as \
                 long. Install an optimised BLAS (on Debian the package libopenblas0-serial)."
                    .into(),
            );
        }
        for note in &self.case.notes {
            self.log
                .detail("detail", &format!("{} = {} ({})", note.key, note.value, note.reason));
        }
        if self.before.resumed {
            let step = self.simulation.steps();
            let time = self.simulation.time();
            self.log.line(
                "restart",
                &format!("Continuing from step {step} at t = {}.", self.moment(time)),
            );
            return Ok(());
        }
        let mut report = StepReport::default();
        if let Some(start) = setup::start(&self.case, &mut self.simulation)? {
            self.tell_start(&start);
            (report.reactions, report.strips) = (start.0.reactions, start.0.strips);
        }
        self.record(&report);
        if let Some(names) = self.recorder.vacant() {
            self.log.detail(
                "history",
                &format!("No material point is in the box of these histories at the start: {names}."),
            );
        }
        self.profile(|_, profile| profile.times.is_empty());
        self.frame();
        Ok(())
    }

    /// Reports how well the stress at the start is balanced, and warns where the first step will move the body by it.
    fn tell_start(&mut self, (start, settling): &Start) {
        let unbalance = start.force;
        let yielding = start.yielding;
        let settling =
            settling.map(|EquilibriumSearchReport { rounds, evaluations }| ManifestSettling { rounds, evaluations });
        if let Some(ledger) = &mut self.ledger {
            ledger.manifest().initial = Some(ManifestInitial {
                unbalance,
                yielding,
                settling,
            });
        }
        let rounds = settling.map_or(String::new(), |it| {
            format!(", reached in {} equilibrium iterations", it.rounds)
        });
        self.log.detail(
            "initial",
            &format!(
                "Initial stress: residual force {unbalance:.2e} of the largest force, {yielding} material points beyond \
                 yield{rounds}."
            ),
        );
        if unbalance > UNBALANCED {
            let warning = self.against_unbalance(100.0 * unbalance);
            self.warn(warning);
        }
        if yielding > 0 {
            self.warn(format!(
                "W0719: the initial stress exceeds the strength at {yielding} material point(s), so the soil will \
                 move at the start. Set `initial.equilibrium = \"plastic\"`."
            ));
        }
    }

    /// What to do against an out-of-balance initial stress, in % of the largest force.
    fn against_unbalance(&self, percent: f64) -> String {
        let sudden = self.case.sudden_loads();
        // Linear elastic equilibrium is lost by nothing but yield.
        match &self.case.initial {
            Some(Initial::AtRest(_)) if !sudden.is_empty() => format!(
                "W0715: the stress from [initial] ignores {}: {percent:.1} % of the largest force is unbalanced \
                 (limit: 2 %), so the soil will move at the start. Apply these loads over a `ramp`.",
                sudden.join(", ")
            ),
            _ if !self.case.rigid.is_empty() => format!(
                "W0716: the stress from [initial] ignores rigid bodies: {percent:.1} % of the largest force is \
                 unbalanced (limit: 2 %), so the soil will move at the start. Use `gravity.ramp` instead of \
                 [initial]."
            ),
            Some(Initial::Elastic) => format!(
                "W0717: soil yields under the elastic initial stress: {percent:.1} % of the largest force is \
                 unbalanced (limit: 2 %), so the soil will move. Set `initial.equilibrium = \"plastic\"`."
            ),
            _ => format!(
                "W0718: the initial stress from `k0` is not in equilibrium: {percent:.1} % of the largest force is \
                 unbalanced (limit: 2 %), so the soil will move. Set `initial.equilibrium = \"plastic\"`."
            ),
        }
    }
}
