//! From the command line to a run that is ready: every way to be refused before anything is written.

use crate::cli::{self, Arguments};
use crate::fault::Fault;
use crate::launch;
use crate::ledger::Ledger;
use crate::log::Log;
use crate::record::Recorder;
use crate::run::{Run, Task};
use crate::setup;
use crate::simulation::Simulation;
use crate::slab::Slabs;
use crate::source;
use crate::timers::Timers;
use bsmpm_scene::Case;
use mpi::collective::Root;
use mpi::environment::Universe;
use mpi::topology::Communicator;
use petsc_rs::Petsc;
use std::rc::Rc;

/// Exit code of a case that cannot be run on so many ranks.
const CASE: u8 = 65;
/// Exit code of a case that needs more memory than allowed.
const MEMORY: u8 = 71;

/// MUMPS: ordering by approximate minimum fill, of all that were tried the cheapest for plane grids, and twice the
/// workspace that it estimates, which on several ranks is at times too little. Iterative methods: a tolerance whose
/// solutions are trusted, unlike those of PETSc's 1e-5. The user's own options come later and win.
const DEFAULTS: [&str; 6] = ["-mat_mumps_icntl_7", "2", "-mat_mumps_icntl_14", "100", "-ksp_rtol", "1e-10"];

/// Runs what the command line asks for and returns the exit code; the same on every rank.
pub fn run(universe: &Universe) -> u8 {
    match prepare(universe) {
        Ok(Some((task, slabs))) => solve(universe, task, slabs).unwrap_or_else(|code| code),
        Ok(None) => 0,
        Err(code) => code,
    }
}

/// Prints a reason on rank 0 and hands the exit code on.
fn refuse(universe: &Universe, code: u8, reason: &str) -> u8 {
    if universe.world().rank() == 0 {
        eprintln!("bsmpm-par: {reason}");
    }
    code
}

/// What is to be run, `None` if it was only to be checked; `Err` holds the exit code, and rank 0 has said why.
fn prepare(universe: &Universe) -> Result<Option<(Task, Slabs)>, u8> {
    let world = universe.world();
    let (speaks, ranks) = (world.rank() == 0, world.size().unsigned_abs() as usize);
    let arguments = Arguments::read(speaks)?;
    let fault = Fault::from_environment(ranks).map_err(|reason| refuse(universe, cli::USAGE, &reason))?;
    let case = source::read(&world, &arguments)?;
    let needed = case.estimate().bytes;
    if arguments.max_memory.is_some_and(|limit| needed > limit) {
        let reason = format!("the case needs about {needed} bytes, more than --max-memory allows");
        return Err(refuse(universe, MEMORY, &reason));
    }
    let Some(slabs) = setup::slabs(&case, ranks) else {
        let columns = case.grid.axes[0].cells();
        let reason =
            format!("{ranks} ranks are too many: the grid has {columns} columns of cells, so at most {columns} ranks");
        return Err(refuse(universe, CASE, &reason));
    };
    if arguments.check {
        if speaks {
            source::describe(&case, ranks);
        }
        return Ok(None);
    }
    Ok(Some((Task { case, arguments, fault }, slabs)))
}

fn solve(universe: &Universe, task: Task, slabs: Slabs) -> Result<u8, u8> {
    let Task { case, arguments, .. } = &task;
    let rank = universe.world().rank().unsigned_abs() as usize;
    let model = setup::model(case).map_err(|error| refuse(universe, CASE, &error.to_string()))?;
    let options: Vec<&str> = DEFAULTS.into_iter().chain(arguments.petsc.iter().map(String::as_str)).collect();
    let petsc = Petsc::initialize(universe, &options)
        .map_err(|error| refuse(universe, launch::BUG, &format!("PETSc could not be started: {error}")))?;
    let timers = Rc::new(Timers::default());
    let points = setup::points(case, slabs.columns(rank));
    let seam = (universe, &petsc, setup::linear(case));
    let simulation = Simulation::new(seam, model, (slabs, points), setup::schedule(case), Rc::clone(&timers));
    let recorder = Recorder::new(&case.histories, case.grid.lower(), &simulation.points, &*simulation.halo);
    let ledger = open_ledger(universe, arguments, case, &recorder)?;
    let log = Log::new(rank == 0, arguments.quiet, arguments.verbose, arguments.log_format, case.analysis.end);
    let run = Run::new(universe, task, simulation, recorder, (ledger, log), timers);
    Ok(run.until_the_end())
}

/// Rank 0 claims the directory; all ranks learn the outcome.
fn open_ledger(
    universe: &Universe,
    arguments: &Arguments,
    case: &Case,
    recorder: &Recorder,
) -> Result<Option<Ledger>, u8> {
    let world = universe.world();
    let mut refused = 0_u8;
    let ledger = (world.rank() == 0)
        .then(|| Ledger::open(arguments, case, world.size().unsigned_abs() as usize, recorder.columns()))
        .and_then(|opened| {
            opened
                .map_err(|error| {
                    eprintln!("bsmpm-par: {error}");
                    refused = error.exit_code();
                })
                .ok()
        });
    world.process_at_rank(0).broadcast_into(&mut refused);
    if refused == 0 { Ok(ledger) } else { Err(refused) }
}
