//! Ends a run: writes the last frame, the last checkpoint and the manifest `run.json`.

use super::Run;
use super::summary::StopCause;
use crate::indicators::{self, IndicatorState};
use crate::launch;
use crate::limit_load;
use crate::machine;
use bsmpm::kinematics::Kinematics;
use bsmpm::parallel::Halo;
use bsmpm_io::directory::HISTORY;
use bsmpm_io::exit;
use bsmpm_io::manifest::{Communication, SolverNames, Status};
use bsmpm_io::table;
use bsmpm_ranks::linear::Tallies;
use bsmpm_ranks::simulation::Simulation;
use bsmpm_ranks::traffic::TrafficKind;
use mpi::collective::CommunicatorCollectives;
use mpi::topology::Communicator;
use std::collections::BTreeMap;
use std::rc::Rc;

impl<K: Kinematics<D>, const D: usize> Run<'_, K, D> {
    /// Ends the run at the last converged state; the work of a step that was given up counts for nothing.
    pub(super) fn stop(mut self, cause: StopCause) -> u8 {
        self.stop_cause = Some(cause);
        self.end(Status::Stopped, exit::STOPPED)
    }

    /// Ends the run before it has a state to continue from.
    pub(super) fn stop_at_start(mut self) -> u8 {
        self.log.cause(
            "stop",
            "Stopped by a signal before the initial stress was computed. There is no state to continue from: start the run again.",
        );
        let written = self
            .ledger
            .as_mut()
            .map_or(Ok(()), |ledger| ledger.close(Status::Stopped, exit::STOPPED));
        self.require(written);
        exit::STOPPED
    }

    /// Ends a run that came to the end of the case.
    pub(super) fn finish(self) -> u8 {
        // Its checks, and its indicators.
        let mut failed = [0.0; 2];
        let mut run = self;
        run.tell_vacant();
        let mut warnings = Vec::new();
        if let Some(ledger) = &mut run.ledger {
            failed[0] = f64::from(!ledger.judge());
            if let Ok(history) = table::read(&ledger.path().join(HISTORY)) {
                ledger.manifest().limit_loads = limit_load::found(&run.case, &history);
            }
            warnings = limit_load::warnings(&ledger.manifest().limit_loads);
            for check in ledger.manifest().checks.iter().filter(|check| !check.passed) {
                let [value, least, most] = [check.value, check.min, check.max].map(in_words);
                let quantity = &check.quantity;
                run.log.failure(&format!(
                    "E0730: the check of `{quantity}` failed: the value is {value} (allowed: {least} to {most}). The \
                     run is complete, with exit code 77. Look at history.csv, or change the limits of [[check]]."
                ));
            }
        }
        warnings.into_iter().for_each(|warning| run.warn(warning));
        run.judge_itself();
        if let Some(ledger) = &mut run.ledger {
            let ending = ledger
                .manifest()
                .indicators
                .iter()
                .filter(|(_, found)| found.ends_run());
            let ending: Vec<_> = ending.collect();
            for (_, found) in &ending {
                run.log.failure(&indicators::description(found));
            }
            if !ending.is_empty() {
                failed[1] = 1.0;
                let names: Vec<&str> = ending.iter().map(|(name, _)| name.as_str()).collect();
                run.log.cause("acceptance", &indicators::acceptance(&names));
            }
        }
        run.simulation.halo.all_reduce_max(&mut failed);
        let (status, code) = match failed.map(|failed| failed > 0.0) {
            [true, _] => (Status::Failed, exit::CHECK),
            [false, true] => (Status::Failed, exit::INDICATOR),
            [false, false] => (Status::Finished, exit::DONE),
        };
        if run.case.output.checkpoint.at_end {
            run.end(status, code)
        } else {
            run.close(status, code)
        }
    }

    /// Ends the run with a frame and a checkpoint of the last converged state.
    pub(super) fn end(mut self, status: Status, code: u8) -> u8 {
        self.frame_if_new();
        match self.checkpoint() {
            Ok(()) => self.close(status, code),
            Err(code) => code,
        }
    }

    /// Ends the run with a frame.
    pub(super) fn close(mut self, status: Status, code: u8) -> u8 {
        self.frame_if_new();
        // A run that came to its end has its code by its indicators.
        if ![exit::DONE, exit::CHECK, exit::INDICATOR].contains(&code) {
            self.judge_itself();
        }
        self.account();
        let written = self.ledger.as_mut().map_or(Ok(()), |ledger| ledger.close(status, code));
        self.require(written);
        self.log.finish();
        self.summarise(code);
        code
    }

    /// Writes into the manifest how far the run can be trusted, if it has made a step. Collective.
    fn judge_itself(&mut self) {
        if self.simulation.steps() == 0 {
            return;
        }
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("indicators");
        let Simulation {
            model,
            points,
            state,
            halo,
            ..
        } = &self.simulation;
        let time = self.simulation.time();
        let budget = self.simulation.progress().budget;
        match IndicatorState::of(model, points, &state.crossed, time, &self.recorder, budget, &**halo) {
            Ok(indicators) => {
                if let Some(ledger) = &mut self.ledger {
                    let history = table::read(&ledger.path().join(HISTORY)).ok();
                    let manifest = ledger.manifest();
                    manifest.indicators = indicators.indicators(&self.case, &manifest.summary, history.as_ref());
                }
            }
            Err(error) => launch::end(&self.universe.world(), exit::BUG, &error),
        }
    }

    /// Writes into the manifest what the run has cost so far. Collective.
    pub(super) fn account(&mut self) {
        let world = self.universe.world();
        let cpu = machine::cpu_seconds();
        let memory = machine::peak_memory();
        let mut all_memory = vec![0_u64; world.size().unsigned_abs() as usize];
        world.all_gather_into(&memory, &mut all_memory[..]);
        let own: Vec<f64> = self.timers.traffic().counts().numbers().collect();
        let mut total = [&[cpu], &own[..]].concat();
        let mut most = own;
        self.simulation.halo.all_reduce_sum(&mut total);
        self.simulation.halo.all_reduce_max(&mut most);
        let wall = self.wall();
        let tallies = &self.simulation.tallies();
        let Some(ledger) = &mut self.ledger else { return };
        let manifest = ledger.manifest();
        manifest.linear = linear(&self.before.linear, tallies);
        manifest.summary.cpu_seconds = self.before.cpu_seconds + total[0];
        manifest.summary.peak_memory = all_memory;
        manifest.timers = self.before.timers.clone();
        manifest.communication = communication(&self.before.communication, &total[1..], &most);
        for (phase, seconds) in self.timers.seconds() {
            *manifest.timers.entry(phase.to_owned()).or_default() += seconds;
        }
        manifest.timers.insert("wall".into(), wall);
    }
}

/// How the linear solves `before` ended and those since then.
fn linear(before: &BTreeMap<String, SolverNames>, tallies: &Tallies) -> BTreeMap<String, SolverNames> {
    let mut all = before.clone();
    let kinds = [
        ("stiffness", &tallies.definite),
        ("newton", &tallies.general),
        ("water", &tallies.water),
    ];
    for (name, tally) in kinds {
        let Some(tally) = tally else { continue };
        let solver = all.entry(name.to_owned()).or_default();
        (solver.ksp, solver.pc) = (tally.ksp.clone(), tally.pc.clone());
        for (reason, count) in &tally.reasons {
            *solver.reasons.entry(reason.clone()).or_default() += count;
        }
    }
    all
}

/// What the ranks have sent each other `before` and since then, of which the sums over the ranks are known and the
/// largest.
fn communication(
    before: &BTreeMap<String, Communication>,
    sums: &[f64],
    largest: &[f64],
) -> BTreeMap<String, Communication> {
    let numbers = sums.chunks_exact(3).zip(largest.chunks_exact(3));
    let mut kinds = BTreeMap::new();
    for (kind, (sum, most)) in TrafficKind::ALL.into_iter().zip(numbers) {
        let mut all = before.get(kind.name()).copied().unwrap_or_default();
        all.calls += most[0] as u64;
        all.messages += sum[1] as u64;
        all.bytes += sum[2] as u64;
        all.most_messages += most[1] as u64;
        all.most_bytes += most[2] as u64;
        kinds.insert(kind.name().to_owned(), all);
    }
    kinds
}

/// A number with seven digits, or a dash for none.
fn in_words(number: Option<f64>) -> String {
    let Some(number) = number else {
        return "-".to_owned();
    };
    format!("{number:.6e}").parse().unwrap_or(number).to_string()
}
