//! The summary at the end of the log.

use super::Run;
use crate::indicators;
use crate::limit_load;
use crate::log::{duration, short};
use bsmpm::kinematics::Kinematics;
use bsmpm_io::exit;
use bsmpm_io::failure::FAILURE;
use bsmpm_io::manifest::Summary;
use bsmpm_messages::code_of;
use mpi::topology::Communicator;

/// What ends a run that is continued later.
#[derive(Clone, Copy, Debug)]
pub(super) enum StopCause {
    /// Ctrl-C, or the signal of another process.
    Signal,
    /// `--max-steps`.
    MaxSteps,
    /// `--max-wall`.
    MaxWall,
}

impl<K: Kinematics<D>, const D: usize> Run<'_, K, D> {
    /// The limit of the command line that has been reached.
    pub(super) fn limit(&self) -> StopCause {
        let most = self.arguments.max_steps;
        if most.is_some_and(|most| self.simulation.steps() >= most) {
            StopCause::MaxSteps
        } else {
            StopCause::MaxWall
        }
    }

    /// The unit of the time, behind a number.
    pub(super) fn time_unit(&self) -> &'static str {
        if self.case.analysis.kind.is_timeless() {
            ""
        } else {
            " s"
        }
    }

    /// A time with its unit.
    pub(super) fn moment(&self, t: f64) -> String {
        format!("{}{}", short(t), self.time_unit())
    }

    /// Prints what was found, what was done, where the results are and what to do next.
    pub(super) fn summarise(&mut self, code: u8) {
        let Some(mut ledger) = self.ledger.take() else { return };
        let manifest = ledger.manifest().clone();
        let directory = ledger.path().display().to_string();
        self.ledger = Some(ledger);
        for line in limit_load::report_lines(&self.case, &manifest.limit_loads) {
            self.log.line("limit-load", &line);
        }
        if !manifest.indicators.is_empty() {
            self.log.detail("indicators", &indicators::line(&manifest.indicators));
        }
        let unusual = manifest.indicators.values().filter(|found| found.unusual);
        // A complete run has named those that end it.
        let is_complete = [exit::DONE, exit::CHECK, exit::INDICATOR].contains(&code);
        for found in unusual.clone().filter(|found| !(is_complete && found.ends_run())) {
            self.log.warning("indicator", &indicators::description(found));
        }
        if manifest.summary.settled_steps > 0 {
            self.log.line("settled", &settled(&manifest.summary));
        }
        let of_indicators = unusual.map(|found| Some(found.code.as_str()));
        let of_warnings = manifest.warnings.iter().map(|warning| code_of(warning));
        let codes: Vec<Option<&str>> = of_warnings.chain(of_indicators).collect();
        self.log.line("end", &self.work(&manifest.summary, code));
        self.log.detail("cost", &cost(&manifest.summary));
        self.log.line(
            "results",
            &format!("Results: {directory} (run.json, history.csv, steps.csv; frames.pvd opens in ParaView)."),
        );
        match code {
            exit::STOPPED => self.log.cause("stop", &self.continuing()),
            _ if manifest.failure.is_some() => {
                self.log.line(
                    "next",
                    &format!("Cause and position: {directory}/{FAILURE}. Pictures: `bsmpm plot {directory}`."),
                );
            }
            _ => self.log.line("next", &format!("Pictures: `bsmpm plot {directory}`.")),
        }
        if let Some(text) = counted(&codes) {
            self.log.line("warnings", &text);
        }
    }

    /// What was done.
    fn work(&self, summary: &Summary, code: u8) -> String {
        let how = match code {
            exit::DONE => "Finished",
            exit::CHECK => "Finished with a failed check",
            exit::INDICATOR => "Finished with an indicator beyond its limit",
            exit::STOPPED => "Stopped",
            _ => "Failed",
        };
        let t = self.moment(self.simulation.time());
        let steps = summary.steps;
        if code == exit::STOPPED && steps == 0 {
            return format!(
                "Stopped before the first step was complete, after {}.",
                duration(self.wall())
            );
        }
        let mean = summary.iterations as f64 / steps.max(1) as f64;
        let cuts = match summary.cutbacks {
            0 => String::new(),
            1 => ", 1 rejected attempt".into(),
            cuts => format!(", {cuts} rejected attempts"),
        };
        let elapsed = duration(self.wall());
        format!("{how} at t = {t}: {steps} steps in {elapsed}, {mean:.1} iterations per step{cuts}.")
    }

    /// Why the run stopped, and how to continue.
    fn continuing(&self) -> String {
        let cause = match self.stop_cause {
            Some(StopCause::MaxSteps) => "--max-steps",
            Some(StopCause::MaxWall) => "--max-wall",
            Some(StopCause::Signal) | None => "a signal (Ctrl-C or kill)",
        };
        let ranks = self.universe.world().size().unsigned_abs() as usize;
        let command = self.arguments.continuing(ranks);
        let state = if self.simulation.steps() == 0 {
            "initial"
        } else {
            "last converged"
        };
        format!("The run was stopped by {cause}. Its {state} state is saved. To continue: {command}")
    }
}

/// How many warnings there are, by their codes, and where they are explained.
fn counted(codes: &[Option<&str>]) -> Option<String> {
    let first = codes.iter().flatten().next().unwrap_or(&"CODE");
    match codes.len() {
        0 => None,
        1 => Some(format!(
            "1 warning, listed in run.json. It is explained by `bsmpm explain {first}`."
        )),
        all => Some(format!(
            "{all} warnings, listed in run.json. They are explained by `bsmpm explain CODE`."
        )),
    }
}

/// Steps whose energy criterion was not met.
fn settled(summary: &Summary) -> String {
    format!(
        "note: {} of {} steps met the force tolerance, but not the energy tolerance, as where much of the material yields. \
         Increase analysis.steps.",
        summary.settled_steps, summary.steps
    )
}

/// What it cost.
fn cost(summary: &Summary) -> String {
    let largest = summary.peak_memory.iter().max().copied().unwrap_or(0) as f64 / 1_048_576.0;
    format!(
        "Cost: {} of processor time, {largest:.0} MiB of memory on the largest rank.",
        duration(summary.cpu_seconds)
    )
}
