//! The loop of a run: steps, output and end.

mod diagnosis;
mod end;
mod failure;
mod frame;
mod save;
mod stage;
mod start;
mod step_warnings;
mod summary;

use crate::checkpoint::IssuedWarning;
use crate::cli::Arguments;
use crate::fault::Fault;
use crate::launch;
use crate::ledger::RunWriter;
use crate::log::Log;
use crate::record::Recorder;
use bsmpm::control::AcceptedStep;
use bsmpm::error::StepError;
use bsmpm::kinematics::Kinematics;
use bsmpm::parallel::Halo;
use bsmpm::step::StepReport;
use bsmpm_io::exit;
use bsmpm_io::manifest::{Communication, SolverNames};
use bsmpm_messages::code_of;
use bsmpm_ranks::simulation::Simulation;
use bsmpm_ranks::timers::Timers;
use bsmpm_scene::Case;
use hdf5_collective::Hdf5;
use mpi::environment::Universe;
use mpi::topology::Communicator;
use save::SaveTimes;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use std::time::Instant;
use summary::StopCause;

/// What is to be run, and how.
#[derive(Debug)]
pub struct Task {
    /// the case
    pub case: Case,
    /// the command line
    pub arguments: Arguments,
    /// a fault on demand
    pub fault: Option<Fault>,
}

/// A simulation, and what is recorded of it.
pub struct RecordedSimulation<'p, K, const D: usize> {
    /// The simulation.
    pub simulation: Simulation<'p, K, D>,
    /// What is recorded of it.
    pub recorder: Recorder<D>,
}

/// What a run writes with.
pub struct RunFiles<'p> {
    /// HDF5, initialised.
    pub hdf5: &'p Hdf5<'p>,
    /// Files of the run, on rank 0.
    pub ledger: Option<RunWriter>,
    /// Messages on the terminal.
    pub log: Log,
}

/// A run under way.
pub struct Run<'p, K, const D: usize> {
    universe: &'p Universe,
    case: Case,
    arguments: Arguments,
    fault: Option<Fault>,
    simulation: Simulation<'p, K, D>,
    recorder: Recorder<D>,
    ledger: Option<RunWriter>, // on rank 0
    log: Log,
    timers: Rc<Timers>,
    start: Instant,
    frame_times: Vec<f64>,
    last_frame: Option<u64>,
    issued: BTreeSet<IssuedWarning>,
    hdf5: &'p Hdf5<'p>,
    saving: SaveTimes,
    stop_cause: Option<StopCause>,
    before: PriorState,
}

/// What of a run was there before this program went on with it.
#[derive(Debug, Default)]
pub struct PriorState {
    /// whether anything was
    pub resumed: bool,
    /// whether that was in another directory
    pub is_branch: bool,
    /// step of the newest frame
    pub last_frame: Option<u64>,
    /// warnings that are given once, and were given
    pub issued: BTreeSet<IssuedWarning>,
    /// s  by phase; on rank 0
    pub timers: BTreeMap<String, f64>,
    /// what the ranks had sent each other, by kind; on rank 0
    pub communication: BTreeMap<String, Communication>,
    /// how its linear solves had ended; on rank 0
    pub linear: BTreeMap<String, SolverNames>,
    /// s  of processor time; on rank 0
    pub cpu_seconds: f64,
}

impl<'p, K: Kinematics<D>, const D: usize> Run<'p, K, D> {
    /// A run at its start, or where it goes on, which is now.
    pub fn new(
        universe: &'p Universe,
        files: RunFiles<'p>,
        task: Task,
        scene: RecordedSimulation<'p, K, D>,
        timers: Rc<Timers>,
        mut before: PriorState,
    ) -> Self {
        let Task { case, arguments, fault } = task;
        let RunFiles { hdf5, ledger, log } = files;
        let RecordedSimulation { simulation, recorder } = scene;
        let start = Instant::now();
        let frame_times = bsmpm_scene::model::frame_times(&case);
        let last_frame = before.last_frame;
        let has_gaps = ledger.as_ref().is_some_and(RunWriter::has_gaps);
        let newest = (before.resumed && !before.is_branch).then(|| simulation.steps());
        let saving = SaveTimes::new(newest, before.is_branch || has_gaps, simulation.steps());
        Self {
            universe,
            case,
            arguments,
            fault,
            simulation,
            recorder,
            ledger,
            log,
            timers,
            start,
            frame_times,
            last_frame,
            issued: std::mem::take(&mut before.issued),
            hdf5,
            saving,
            stop_cause: None,
            before,
        }
    }

    /// Steps to the end of the case, or to what ends the run before; returns the exit code.
    pub fn until_the_end(mut self) -> u8 {
        match self.begin() {
            Ok(()) => {}
            Err(StepError::Interrupted) => return self.stop_at_start(),
            Err(error) => return self.fail_at_start(error),
        }
        let mut slowest = 0.0_f64;
        loop {
            let step = self.simulation.steps() + 1;
            let due = self.due(slowest);
            if due.stop && self.simulation.time() < self.case.analysis.end {
                let limit = self.limit();
                return self.stop(limit);
            }
            if self.simulation.halo.is_interrupted() && self.simulation.time() < self.case.analysis.end {
                return self.stop(StopCause::Signal);
            }
            let saved = if due.checkpoint { self.checkpoint() } else { Ok(()) };
            if let Err(code) = saved.and_then(|()| self.save_on_request()) {
                return code;
            }
            if let Some(fault) = self.fault {
                fault.strike(self.rank(), step);
            }
            if due.reject {
                self.simulation.halo.requests().reject_next();
            }
            let begin = Instant::now();
            match self.simulation.advance() {
                None => return self.finish(),
                Some(Ok(accepted)) => {
                    if let Err(error) = self.accept(&accepted) {
                        return self.fail_at_stage(error);
                    }
                }
                Some(Err(failure)) if failure.is_interruption() && self.simulation.halo.is_interrupted() => {
                    return self.stop(StopCause::Signal);
                }
                Some(Err(failure)) if failure.is_interruption() => self.make_again(step),
                Some(Err(failure)) => return self.fail(&failure),
            }
            slowest = slowest.max(begin.elapsed().as_secs_f64());
        }
    }

    /// A step was given up by a fault on demand, which strikes once.
    fn make_again(&mut self, step: u64) {
        self.fault = None;
        self.warn(format!(
            "W0725: step {step} is repeated although it converged, because the environment variable BSMPM_FAULT \
             requests this. Results do not change. Unset BSMPM_FAULT outside of tests."
        ));
    }

    /// A warning, reported and kept.
    fn warn(&mut self, warning: String) {
        self.log.warning("warning", &warning);
        if let Some(ledger) = &mut self.ledger
            && !ledger.manifest().warnings.contains(&warning)
        {
            ledger.manifest().warnings.push(warning);
        }
    }

    /// A warning about a `subject`, a name of the case, that is given once for each of its codes. `warning` makes its
    /// text, which begins with the `code`.
    fn warn_once(&mut self, code: &str, subject: &str, warning: impl FnOnce() -> String) {
        if self.issued.insert(IssuedWarning::new(code, subject)) {
            let warning = warning();
            debug_assert_eq!(code_of(&warning), Some(code));
            self.warn(warning);
        }
    }

    /// Fails on all ranks if a stage that begins then cannot.
    fn accept(&mut self, accepted: &AcceptedStep) -> Result<(), StepError> {
        let step = self.simulation.steps();
        let wall = self.wall();
        self.log.step(step, accepted, wall);
        let written = self.ledger.as_mut().map_or(Ok(()), |ledger| {
            ledger.step(step, accepted, self.simulation.cost(), wall)
        });
        self.require(written);
        if self.saving.is_first(step) {
            self.tell_unused_options();
        }
        self.tell_strips_without_material(accepted);
        self.tell_drains(accepted);
        self.tell_rigid(accepted);
        self.tell_let_through(accepted);
        self.tell_outflow(accepted);
        self.record(&accepted.report);
        let t = accepted.t;
        // Not with the frames of early stops, so that the rows are the same however often the run stops.
        let framed = self.wants_frame(t) || self.is_now(self.case.analysis.end, t);
        self.profile(|run, profile| match profile.times.is_empty() {
            true => framed,
            false => profile.times.iter().any(|wanted| run.is_now(*wanted, t)),
        });
        if self.wants_frame(accepted.t) {
            self.frame();
        }
        self.begin_stages(accepted.t)
    }

    /// A row of histories.
    fn record(&mut self, report: &StepReport) {
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("histories");
        let Simulation {
            model,
            points,
            state,
            halo,
            ..
        } = &self.simulation;
        let time = self.simulation.time();
        let row = match self.recorder.row(model, points, &state.crossed, time, report, &**halo) {
            Ok(row) => row,
            Err(error) => launch::end(&self.universe.world(), exit::BUG, &error),
        };
        let step = self.simulation.steps();
        if let (Some(ledger), Some(front)) = (&mut self.ledger, self.recorder.front(&row)) {
            ledger.front(front);
        }
        let written = self.ledger.as_mut().map_or(Ok(()), |ledger| {
            ledger.history(step, time, &row, &self.recorder.reported())
        });
        self.require(written);
    }

    /// Ends the job if rank 0 could not write: the other ranks do not know of it.
    fn require(&mut self, written: Result<(), bsmpm_io::Error>) {
        if let Err(error) = written {
            if let Some(ledger) = &mut self.ledger {
                ledger.abandon(error.exit_code());
            }
            launch::end(&self.universe.world(), error.exit_code(), &error);
        }
    }

    /// s  since the run began, without the time between its parts.
    fn wall(&self) -> f64 {
        self.before.timers.get("wall").copied().unwrap_or(0.0) + self.start.elapsed().as_secs_f64()
    }

    fn rank(&self) -> usize {
        self.universe.world().rank().unsigned_abs() as usize
    }
}
