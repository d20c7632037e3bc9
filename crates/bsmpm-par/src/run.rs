//! A run: step after step, what is written after each, and the ways in which it ends.

mod diagnosis;
mod failure;
mod start;

use crate::cli::Arguments;
use crate::exit;
use crate::fault::Fault;
use crate::gather;
use crate::launch;
use crate::ledger::Ledger;
use crate::log::Log;
use crate::machine;
use crate::record::Recorder;
use crate::setup;
use crate::simulation::Simulation;
use crate::surfaces;
use crate::timers::Timers;
use bsmpm::control::Accepted;
use bsmpm::kinematics::PlaneStrain;
use bsmpm::seam::Halo;
use bsmpm::step::Report;
use bsmpm_io::manifest::Status;
use bsmpm_scene::{Case, Every};
use mpi::collective::CommunicatorCollectives;
use mpi::environment::Universe;
use mpi::topology::Communicator;
use std::collections::BTreeSet;
use std::rc::Rc;
use std::time::Instant;

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

/// A run under way.
pub struct Run<'p> {
    universe: &'p Universe,
    case: Case,
    arguments: Arguments,
    fault: Option<Fault>,
    simulation: Simulation<'p, PlaneStrain, 2>,
    recorder: Recorder,
    ledger: Option<Ledger>, // on rank 0
    log: Log,
    timers: Rc<Timers>,
    start: Instant,
    frame_times: Vec<f64>,
    last_frame: Option<u64>,
    told_strips: BTreeSet<usize>,
}

impl<'p> Run<'p> {
    /// A run at its start, which is now.
    pub fn new(
        universe: &'p Universe,
        Task { case, arguments, fault }: Task,
        simulation: Simulation<'p, PlaneStrain, 2>,
        recorder: Recorder,
        (ledger, log): (Option<Ledger>, Log),
        timers: Rc<Timers>,
    ) -> Self {
        let (start, frame_times, last_frame) = (Instant::now(), setup::frame_times(&case), None);
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
            told_strips: BTreeSet::new(),
        }
    }

    /// Steps to the end of the case, or to what ends the run before; returns the exit code.
    pub fn until_the_end(mut self) -> u8 {
        if let Err(error) = self.begin() {
            return self.fail_at_start(error);
        }
        let mut slowest = 0.0_f64;
        loop {
            let step = self.simulation.steps() + 1;
            self.frame_on_request();
            let stop = self.arguments.max_steps.is_some_and(|most| step > most) || self.out_of_time(slowest);
            if stop && self.simulation.time() < self.case.analysis.end {
                return self.end(Status::Stopped, exit::STOPPED);
            }
            if self.simulation.halo.is_interrupted() && self.simulation.time() < self.case.analysis.end {
                return self.stop_on_request();
            }
            if let Some(fault) = self.fault {
                fault.strike(self.rank(), step);
            }
            let begin = Instant::now();
            match self.simulation.advance() {
                None => return self.finish(),
                Some(Ok(accepted)) => self.accept(&accepted),
                Some(Err(failure)) if failure.is_interruption() => return self.stop_on_request(),
                Some(Err(failure)) => return self.fail(&failure),
            }
            slowest = slowest.max(begin.elapsed().as_secs_f64());
        }
    }

    /// A warning, told and kept.
    fn warn(&mut self, warning: String) {
        self.log.line("warning", &format!("warning: {warning}"));
        if let Some(ledger) = &mut self.ledger {
            ledger.manifest().warnings.push(warning);
        }
    }

    fn accept(&mut self, accepted: &Accepted) {
        let (step, wall) = (self.simulation.steps(), self.start.elapsed().as_secs_f64());
        self.log.step(step, accepted, wall);
        let written = self.ledger.as_mut().map_or(Ok(()), |ledger| ledger.step(step, accepted, wall));
        self.require(written);
        if step == 1 {
            self.tell_unused_options();
        }
        self.tell_strips_without_material(accepted);
        self.record(&accepted.report);
        if self.wants_frame(accepted.t) {
            self.frame();
        }
    }

    /// Misspelt options of PETSc would do nothing in silence.
    fn tell_unused_options(&mut self) {
        let unused = self.simulation.unused_options();
        let given = |name: &String| self.arguments.petsc.iter().any(|option| option.strip_prefix('-') == Some(name));
        let misspelt: Vec<String> = unused.into_iter().filter(given).collect();
        for name in misspelt {
            let warning =
                format!("the PETSc option -{name} was not used: it is misspelt, or the solver has no such part");
            self.warn(warning);
        }
    }

    /// A strip that holds nothing does nothing, which no other number tells.
    fn tell_strips_without_material(&mut self, accepted: &Accepted) {
        for (number, _) in accepted.report.strips.iter().enumerate().filter(|(_, strip)| strip.held == 0) {
            if self.told_strips.insert(number) {
                let name = surfaces::name_of_strip(&self.case, number);
                self.warn(format!("{name} holds nothing: at t = {} no free material is at it", accepted.t));
            }
        }
    }

    /// A row of histories.
    fn record(&mut self, report: &Report) {
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("histories");
        let Simulation { model, points, halo, .. } = &self.simulation;
        let time = self.simulation.time();
        let row = match self.recorder.row(model, points, (time, report), &**halo) {
            Ok(row) => row,
            Err(error) => launch::end(&self.universe.world(), exit::BUG, &error),
        };
        let step = self.simulation.steps();
        let written = self.ledger.as_mut().map_or(Ok(()), |ledger| ledger.history(step, time, &row));
        self.require(written);
    }

    fn wants_frame(&self, time: f64) -> bool {
        let every =
            matches!(self.case.output.every, Some(Every::Steps(n)) if self.simulation.steps().is_multiple_of(n));
        // The schedule hits wanted times to the bit, unless two of them are closer than a millionth of a step.
        let close = |wanted: &f64| (wanted - time).abs() <= 1e-6 * self.case.analysis.dt;
        every || self.frame_times.iter().any(close)
    }

    fn frame(&mut self) {
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("frames");
        let (step, time) = (self.simulation.steps(), self.simulation.time());
        let frame =
            gather::frame(&self.universe.world(), &self.simulation.points, self.case.grid.lower(), (step, time));
        let written = match (&mut self.ledger, frame) {
            (Some(ledger), Some(frame)) => ledger.frame(&frame),
            _ => Ok(()),
        };
        self.require(written);
        self.last_frame = Some(step);
    }

    /// A frame of the last converged state, if a signal has asked for one that is not there yet.
    fn frame_on_request(&mut self) {
        if self.simulation.halo.requests().take_frame() && self.last_frame != Some(self.simulation.steps()) {
            self.log.line("frame", "a frame is written, as a signal has asked");
            self.frame();
        }
    }

    /// Ends the run at the last converged state; the work of a step that was given up counts for nothing.
    fn stop_on_request(self) -> u8 {
        self.log.line("stop", "stopped by a signal; the last converged state is saved");
        self.end(Status::Stopped, exit::STOPPED)
    }

    fn finish(self) -> u8 {
        let mut failed = [0.0];
        let mut run = self;
        if let Some(ledger) = &mut run.ledger {
            failed[0] = f64::from(!ledger.judge());
            for check in ledger.manifest().checks.iter().filter(|check| !check.passed) {
                run.log.failure(&format!(
                    "check failed: {} = {:?}, wanted {:?} to {:?}",
                    check.quantity, check.value, check.min, check.max
                ));
            }
        }
        run.simulation.halo.maximum(&mut failed);
        if failed[0] > 0.0 { run.end(Status::Failed, exit::CHECK) } else { run.end(Status::Finished, exit::DONE) }
    }

    fn end(mut self, status: Status, code: u8) -> u8 {
        if self.last_frame != Some(self.simulation.steps()) {
            self.frame();
        }
        let world = self.universe.world();
        let (cpu, memory) = (machine::cpu_seconds(), machine::peak_memory());
        let mut all_memory = vec![0_u64; world.size().unsigned_abs() as usize];
        world.all_gather_into(&memory, &mut all_memory[..]);
        let mut total = [cpu];
        self.simulation.halo.reduce(&mut total);
        let written = match &mut self.ledger {
            Some(ledger) => {
                let manifest = ledger.manifest();
                manifest.summary.cpu_seconds = total[0];
                manifest.summary.peak_memory = all_memory;
                manifest.timers = self.timers.seconds().into_iter().map(|(k, v)| (k.to_owned(), v)).collect();
                manifest.timers.insert("wall".into(), self.start.elapsed().as_secs_f64());
                ledger.close(status, code)
            }
            None => Ok(()),
        };
        self.require(written);
        self.log.finish();
        self.summarise(status);
        code
    }

    fn summarise(&mut self, status: Status) {
        let Some(ledger) = &mut self.ledger else { return };
        let summary = ledger.manifest().summary.clone();
        let text = format!(
            "{status:?} at t = {}: {} steps, {} iterations, {} cuts, {:.1} s by the clock, {:.1} CPU s, {:.0} MiB on the largest rank; written to {}",
            self.simulation.time(),
            summary.steps,
            summary.iterations,
            summary.cutbacks,
            self.start.elapsed().as_secs_f64(),
            summary.cpu_seconds,
            summary.peak_memory.iter().max().copied().unwrap_or(0) as f64 / 1_048_576.0,
            ledger.path().display()
        );
        self.log.line("end", &text);
    }

    fn out_of_time(&self, slowest: f64) -> bool {
        let Some(limit) = self.arguments.max_wall else { return false };
        let mut needed = [self.start.elapsed().as_secs_f64() + 1.5 * slowest];
        self.simulation.halo.maximum(&mut needed);
        needed[0] > limit.as_secs_f64()
    }

    /// Ends the job if rank 0 could not write: the other ranks do not know of it.
    fn require(&self, written: Result<(), bsmpm_io::Error>) {
        if let Err(error) = written {
            launch::end(&self.universe.world(), error.exit_code(), &error);
        }
    }

    fn rank(&self) -> usize {
        self.universe.world().rank().unsigned_abs() as usize
    }
}
