//! A run: step after step, what is written after each, and the ways in which it ends.

mod diagnosis;
mod end;
mod failure;
mod save;
mod stage;
mod start;

use crate::checkpoint::Outlet;
use crate::cli::Arguments;
use crate::fault::Fault;
use crate::gather::{self, Around, FrameMoment, Gathering};
use crate::launch;
use crate::ledger::Ledger;
use crate::log::Log;
use crate::profile;
use crate::record::Recorder;
use bsmpm::control::Accepted;
use bsmpm::error::StepError;
use bsmpm::kinematics::Kinematics;
use bsmpm::observe::projection::projected_pressure;
use bsmpm::parallel::Halo;
use bsmpm::step::StepReport;
use bsmpm::water::observed::PoreWater;
use bsmpm_io::exit;
use bsmpm_io::frame::Parts;
use bsmpm_io::manifest::{Communication, ManifestOutflow, SolverNames, Status};
use bsmpm_ranks::simulation::Simulation;
use bsmpm_ranks::timers::Timers;
use bsmpm_scene::model::vector;
use bsmpm_scene::words::FrameField;
use bsmpm_scene::{Case, Every, Profile};
use hdf5_collective::Hdf5;
use mpi::environment::Universe;
use mpi::topology::Communicator;
use save::Saving;
use std::collections::{BTreeMap, BTreeSet};
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

/// Cells that a rigid body may move in a step at the soil that it touches.
const FASTEST: f64 = 0.5;
/// Cells that points may be in a rigid body.
const DEEPEST: f64 = 0.05;

/// A run under way.
pub struct Run<'p, K, const D: usize> {
    universe: &'p Universe,
    case: Case,
    arguments: Arguments,
    fault: Option<Fault>,
    simulation: Simulation<'p, K, D>,
    recorder: Recorder<D>,
    ledger: Option<Ledger>, // on rank 0
    log: Log,
    timers: Rc<Timers>,
    start: Instant,
    frame_times: Vec<f64>,
    last_frame: Option<u64>,
    told_strips: BTreeSet<usize>,
    told_rigid: BTreeSet<usize>,
    hdf5: &'p Hdf5<'p>,
    saving: Saving,
    before: Before,
}

/// What of a run was there before this program went on with it.
#[derive(Debug, Default)]
pub struct Before {
    /// whether anything was
    pub resumed: bool,
    /// whether that was in another directory
    pub is_branch: bool,
    /// step of the newest frame
    pub last_frame: Option<u64>,
    /// strips of which it was told that they hold nothing
    pub told_strips: BTreeSet<usize>,
    /// rigid bodies of which it was told what is doubtful of them
    pub told_rigid: BTreeSet<usize>,
    /// s  by phase; on rank 0
    pub timers: BTreeMap<String, f64>,
    /// what the ranks had told each other, by kind; on rank 0
    pub communication: BTreeMap<String, Communication>,
    /// how its linear solves had ended; on rank 0
    pub linear: BTreeMap<String, SolverNames>,
    /// s  of processor time; on rank 0
    pub cpu_seconds: f64,
}

impl<'p, K: Kinematics<D>, const D: usize> Run<'p, K, D> {
    /// A run at its start, or where it goes on, which is now.
    pub fn new(
        (universe, hdf5): (&'p Universe, &'p Hdf5<'p>),
        Task { case, arguments, fault }: Task,
        (simulation, recorder): (Simulation<'p, K, D>, Recorder<D>),
        (ledger, log): (Option<Ledger>, Log),
        timers: Rc<Timers>,
        mut before: Before,
    ) -> Self {
        let (start, frame_times, last_frame) =
            (Instant::now(), bsmpm_scene::model::frame_times(&case), before.last_frame);
        let has_gaps = ledger.as_ref().is_some_and(Ledger::has_gaps);
        let newest = (before.resumed && !before.is_branch).then(|| simulation.steps());
        let saving = Saving::new(newest, before.is_branch || has_gaps, simulation.steps());
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
            told_strips: std::mem::take(&mut before.told_strips),
            told_rigid: std::mem::take(&mut before.told_rigid),
            hdf5,
            saving,
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
                return self.end(Status::Stopped, exit::STOPPED);
            }
            if self.simulation.halo.is_interrupted() && self.simulation.time() < self.case.analysis.end {
                return self.stop_on_request();
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
                    return self.stop_on_request();
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
        self.warn(format!("step {step} converged and was rejected, as BSMPM_FAULT wants; it is made again"));
    }

    /// A warning, told and kept.
    fn warn(&mut self, warning: String) {
        self.log.line("warning", &format!("warning: {warning}"));
        if let Some(ledger) = &mut self.ledger
            && !ledger.manifest().warnings.contains(&warning)
        {
            ledger.manifest().warnings.push(warning);
        }
    }

    /// Fails on all ranks if a stage that begins then cannot.
    fn accept(&mut self, accepted: &Accepted) -> Result<(), StepError> {
        let (step, wall) = (self.simulation.steps(), self.wall());
        self.log.step(step, accepted, wall);
        let written =
            self.ledger.as_mut().map_or(Ok(()), |ledger| ledger.step(step, accepted, (self.simulation.cost(), wall)));
        self.require(written);
        if self.saving.is_first(step) {
            self.tell_unused_options();
        }
        self.tell_strips_without_material(accepted);
        self.tell_drains(accepted);
        self.tell_rigid(accepted);
        self.tell_meeting(accepted);
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

    /// A rigid body that comes so fast that points are met too late, or so light a penalty that they go into it.
    fn tell_rigid(&mut self, accepted: &Accepted) {
        for (number, report) in accepted.report.rigid.iter().enumerate() {
            let (name, t) = (self.case.rigid[number].name.clone(), accepted.t);
            let (advance, depth) = (report.advance, report.penetration);
            if advance > FASTEST && self.told_rigid.insert(2 * number) {
                self.warn(format!(
                    "rigid `{name}`: at t = {t} it moves {advance:.2} cells in a step at soil that it touches; points are met \
                     right up to {FASTEST}: more steps"
                ));
            }
            if depth > DEEPEST && self.told_rigid.insert(2 * number + 1) {
                self.warn(format!(
                    "rigid `{name}`: at t = {t} points are {depth:.2} cells in it, usually 1e-5: it was pushed over them, or \
                     its force is beyond what its penalty is made for; more steps"
                ));
            }
        }
    }

    /// Rigid bodies do not touch each other.
    fn tell_meeting(&mut self, accepted: &Accepted) {
        let (bodies, reports) = (&self.simulation.model.boundary.rigid, &accepted.report.rigid);
        let meets = |a: usize, b: usize| bodies[a].reaches_into(&reports[a].moved, (&bodies[b], &reports[b].moved));
        let pairs = (0..reports.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        let meeting: Vec<(usize, usize)> = pairs.filter(|&(a, b)| meets(a, b) || meets(b, a)).collect();
        for (a, b) in meeting {
            let (one, other) = (self.case.rigid[a].name.clone(), self.case.rigid[b].name.clone());
            if self.told_rigid.insert(2 * self.case.rigid.len() + a * self.case.rigid.len() + b) {
                self.warn(format!(
                    "rigid `{one}`: at t = {} it is in rigid `{other}`: rigid bodies do not touch each other, and go through",
                    accepted.t
                ));
            }
        }
    }

    /// A strip that holds nothing, or no longer the material that it held, does nothing of what it is there for, which
    /// no other number tells.
    fn tell_strips_without_material(&mut self, accepted: &Accepted) {
        for (number, strip) in accepted.report.strips.iter().enumerate() {
            let on = &self.simulation.model.boundary.strips[number];
            if !on.acts() {
                continue;
            }
            let points = on.points.len();
            let (name, t) = (bsmpm_scene::surfaces::name_of_strip(&self.case, number), accepted.t);
            let mut kind = number;
            let told = if strip.held == 0 {
                format!("{name} holds nothing: at t = {t} no free material is at it")
            } else if 2 * strip.left_behind > points {
                kind += accepted.report.strips.len();
                format!(
                    "{name} has let go: at t = {t} most of it is more than half a cell ahead of the material that it held at the \
                     start, and its force is no longer that of a strip that holds; smaller cells and more points_per_cell \
                     hold longer, and soil that must not be pulled wants a motion without it"
                )
            } else if strip.moved_on > 0 {
                kind += 2 * accepted.report.strips.len();
                format!(
                    "{name} comes down at t = {t} more than half a cell from where it had come off: it meets the material as \
                     high as where it left it, which is right on a level surface only"
                )
            } else {
                continue;
            };
            if self.told_strips.insert(kind) {
                self.warn(told);
            }
        }
    }

    /// A drain or an inflow most of which has no ground near lets nothing through there.
    fn tell_drains(&mut self, accepted: &Accepted) {
        let (Some(water), t) = (&accepted.report.water, accepted.t) else { return };
        let wanted = self.simulation.model.surfaces().water;
        let points: Vec<usize> = wanted.iter().map(|points| points.len()).collect();
        let of_strips = 3 * self.simulation.model.boundary.strips.len();
        for number in (0..points.len()).filter(|&number| 2 * water.held[number] < points[number]) {
            let name = bsmpm_scene::surfaces::name_of_drain(&self.case, number);
            if self.told_strips.insert(of_strips + number) {
                self.warn(format!(
                    "{name}: at t = {t} most of it is out of the grid or has no ground near, and lets no water through; where the \
                     surface heaves, a grid that goes on a cell beyond it"
                ));
            }
        }
    }

    /// Material that leaves is told when the first does, and counted in the manifest.
    fn tell_outflow(&mut self, accepted: &Accepted) {
        let Some(outflow) = &accepted.report.outflow else { return };
        if self.recorder.left().points == 0 {
            let message = format!("material leaves the grid from t = {} on: run.json counts it", accepted.t);
            self.log.line("outflow", &message);
        }
        let Simulation { points, halo, .. } = &self.simulation;
        let lost = self.recorder.let_out(outflow, points, &**halo);
        let Outlet { points, mass } = self.recorder.left();
        if let Some(ledger) = &mut self.ledger {
            ledger.manifest().outflow = Some(ManifestOutflow { points, mass: mass * self.case.geometry.whole() });
        }
        for name in lost {
            let t = accepted.t;
            self.warn(format!(
                "history {name}: the point that it followed has left the grid at t = {t}; it reads 0 since"
            ));
        }
    }

    /// A row of histories.
    fn record(&mut self, report: &StepReport) {
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("histories");
        let Simulation { model, points, halo, .. } = &self.simulation;
        let time = self.simulation.time();
        let row = match self.recorder.row(model, points, (time, report), &**halo) {
            Ok(row) => row,
            Err(error) => launch::end(&self.universe.world(), exit::BUG, &error),
        };
        let step = self.simulation.steps();
        if let (Some(ledger), Some(front)) = (&mut self.ledger, self.recorder.front(&row)) {
            ledger.front(front);
        }
        let written = self.ledger.as_mut().map_or(Ok(()), |ledger| ledger.history(step, time, &row));
        self.require(written);
    }

    fn wants_frame(&self, time: f64) -> bool {
        let every =
            matches!(self.case.output.every, Some(Every::Steps(n)) if self.simulation.steps().is_multiple_of(n));
        every || self.frame_times.iter().any(|wanted| self.is_now(*wanted, time))
    }

    /// The schedule hits wanted times to the bit, unless two of them are closer than a millionth of a step.
    fn is_now(&self, wanted: f64, time: f64) -> bool {
        (wanted - time).abs() <= 1e-6 * self.case.analysis.dt
    }

    /// Rows of the profiles that are wanted now. Collective.
    fn profile(&mut self, wanted: impl Fn(&Self, &Profile) -> bool) {
        let (step, time) = (self.simulation.steps(), self.simulation.time());
        for number in 0..self.case.profiles.len() {
            let profile = &self.case.profiles[number];
            if !wanted(self, profile) {
                continue;
            }
            let Simulation { model, points, halo, .. } = &self.simulation;
            let rows = profile::rows(profile, (model, self.case.grid.lower()), points, &**halo);
            let ledger = self.ledger.as_mut();
            let written = ledger.map_or(Ok(()), |ledger| ledger.profile(number, (step, time), &rows));
            self.require(written);
        }
    }

    /// Names of what the frames' fields number, where frames have fields on request.
    fn names(&self) -> Vec<(&'static str, Vec<String>)> {
        let case = &self.case;
        let materials = case.materials.iter().map(|material| material.name.clone()).collect();
        let bodies = || case.bodies.iter().map(|body| body.name.clone().unwrap_or_default()).collect();
        let of_bodies = case.output.fields.contains(&FrameField::Body).then(|| (FrameField::Body.field(), bodies()));
        let of_materials = (!case.output.fields.is_empty()).then_some(("material", materials));
        of_materials.into_iter().chain(of_bodies).collect()
    }

    fn frame(&mut self) {
        let timers = Rc::clone(&self.timers);
        let _timed = timers.time("frames");
        let begin = Instant::now();
        let (step, time) = (self.simulation.steps(), self.simulation.time());
        let world = self.universe.world();
        let Simulation { model, points, halo, .. } = &self.simulation;
        let projected = self.case.output.projected_pressure.then(|| projected_pressure(model, points, &**halo));
        let projected = projected.transpose().unwrap_or_else(|error| launch::end(&world, exit::BUG, &error));
        let moment = FrameMoment { step, time, lower: gather::spatial(&vector::<D, _>(self.case.grid.lower())) };
        let (names, fields) = (self.names(), &self.case.output.fields);
        let bodies = if fields.contains(&FrameField::Body) { self.case.ids() } else { Vec::new() };
        let around =
            Around { materials: &model.materials, bodies: &bodies, water: PoreWater::of(model, points, time), fields };
        let mut frame = Gathering::new(&world, (points, around), projected.as_deref(), moment);
        let written = match &mut self.ledger {
            Some(ledger) => {
                let (head, points) = (frame.head(), frame.points());
                ledger.manifest().frame_units = frame.units(self.case.geometry.volume_unit());
                ledger.manifest().frame_names =
                    names.iter().map(|(field, names)| ((*field).to_owned(), names.clone())).collect();
                let names: Vec<_> = names.into_iter().map(|(field, names)| (format!("{field}_names"), names)).collect();
                ledger.frame(Parts { head, points, names: &names, next: &mut || frame.block() })
            }
            None => {
                while frame.block().is_some() {}
                Ok(())
            }
        };
        self.require(written);
        self.last_frame = Some(step);
        self.saving.frame_took(begin.elapsed());
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
